"""What all tests share: the option --slow, and random examples that are the same in every run."""

import hypothesis
import pytest

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
