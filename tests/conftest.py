"""What all tests share: the option --slow, random examples that are the same in every run, and the core.

ETENDUE_TEST_CORE names another build of etendue._core to test: one with mutants, or with sanitizers.
"""

import importlib.util
import os
import sys

import hypothesis
import pytest


def _use_core(path: str) -> None:
    spec = importlib.util.spec_from_file_location("etendue._core", path)
    assert spec is not None
    assert spec.loader is not None
    import etendue

    module = importlib.util.module_from_spec(spec)
    sys.modules["etendue._core"] = etendue._core = module
    spec.loader.exec_module(module)


if "ETENDUE_TEST_CORE" in os.environ:
    _use_core(os.environ["ETENDUE_TEST_CORE"])

hypothesis.settings.register_profile("etendue", derandomize=True, deadline=None, database=None)
hypothesis.settings.load_profile("etendue")


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption("--slow", action="store_true", help="run the tests marked slow, too")


def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    if config.getoption("--slow"):
        return
    slow = [item for item in items if item.get_closest_marker("slow")]
    config.hook.pytest_deselected(items=slow)
    items[:] = [item for item in items if item not in slow]
