"""Whatever is in a file: it loads or raises EtendueError, in little time and memory.

The same targets are fuzzed for hours, with coverage as a guide, by `python -m tests.fuzz`.
"""

from __future__ import annotations

import pytest
from hypothesis import HealthCheck, given, settings

from . import mutations, seeds
from .formats import TARGETS
from .targets import Target


@pytest.mark.parametrize("name", TARGETS)
def test_seeds_load(name: str) -> None:
    with Target(name) as target:
        assert [target(seed) for seed in seeds.corpus(name)] == [True] * len(seeds.corpus(name))


@pytest.mark.parametrize("name", TARGETS)
def test_changed_files(name: str) -> None:
    with Target(name) as target:

        @settings(max_examples=80, suppress_health_check=list(HealthCheck))
        @given(mutations.files(name))
        def check(data: bytes) -> None:
            target(data)

        check()
