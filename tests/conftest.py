"""What all tests share: the option --slow, random examples that are the same in every run, the core, a small scene.

ETENDUE_TEST_CORE names another build of etendue._core to test: one with mutants, or with sanitizers.
"""

import importlib.util
import json
import os
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

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

_MESH = """mtllib lit.mtl
v -2 0 -2
v 2 0 -2
v 2 0 2
v -2 0 2
v -0.5 2 -0.5
v 0.5 2 -0.5
v 0 2 0.5
usemtl floor
f 4 3 2
f 4 2 1
usemtl light
f 5 6 7
"""
_MATERIALS = "newmtl floor\nKd 0.5 0.25 0.1\nnewmtl light\nKd 1 1 1\nKe 8 8 8\n"

WriteScene = Callable[..., None]


@pytest.fixture
def lit_scene(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> WriteScene:
    """In the current folder is nothing but lit.json, 8 x 6 pixels, 4 spp; a call with keys rewrites it."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.delenv("ETENDUE_DATA", raising=False)
    Path("lit.obj").write_text(_MESH)
    Path("lit.mtl").write_text(_MATERIALS)

    def write(name: str = "lit.json", **keys: Any) -> None:
        scene = {"mesh_files": ["lit.obj"], **keys.pop("scene", {})}
        framebuffer = {"res_w": 8, "res_h": 6, "sppx": 4, **keys.pop("framebuffer", {})}
        camera = {"pos": [0, 1, 3], "dir": [0, -0.3, -1]}
        data = {"camera": camera, "framebuffer": framebuffer, "scene": scene, **keys}
        Path(name).write_text(json.dumps(data))

    write()
    return write


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption("--slow", action="store_true", help="run the tests marked slow, too")


def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    if config.getoption("--slow"):
        return
    slow = [item for item in items if item.get_closest_marker("slow")]
    config.hook.pytest_deselected(items=slow)
    items[:] = [item for item in items if item not in slow]
