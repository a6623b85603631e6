"""The tests have teeth: on every wrong estimator of the list they fail, and on the right one they pass."""

from __future__ import annotations

from pathlib import Path

import pytest

from .mutants import MUTANTS, ROOT, Mutant, build, failing, mutate


@pytest.fixture(scope="module")
def core(tmp_path_factory: pytest.TempPathFactory, worker_id: str) -> Path:
    """The module with all mutants, built once and again after a change of the sources."""
    return build(ROOT / "build" / f"mutants-{worker_id}")


@pytest.fixture(scope="module")
def worker_id(request: pytest.FixtureRequest) -> str:
    return getattr(request.config, "workerinput", {}).get("workerid", "master")


def test_there_are_enough_of_them() -> None:
    assert len(MUTANTS) >= 15
    assert len({m.name for m in MUTANTS}) == len(MUTANTS)


@pytest.mark.parametrize("mutant", MUTANTS, ids=lambda m: m.name)
def test_every_mutant_has_its_place(mutant: Mutant) -> None:
    source = (ROOT / "src" / mutant.file).read_text()
    assert mutate(source, mutant, 1) != source


@pytest.mark.slow
@pytest.mark.xdist_group("mutants")
@pytest.mark.parametrize("number", range(1, len(MUTANTS) + 1), ids=lambda n: MUTANTS[n - 1].name)
def test_mutants_are_caught(core: Path, number: int) -> None:
    assert failing(core, number, MUTANTS[number - 1].tests)


@pytest.mark.slow
@pytest.mark.xdist_group("mutants")
def test_the_right_one_passes(core: Path) -> None:
    for tests in dict.fromkeys(m.tests for m in MUTANTS):
        assert not failing(core, 0, tests), tests
