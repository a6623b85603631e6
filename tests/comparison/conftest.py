"""A scene so small that comparing on it takes a second, and a cache of its own."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

CAMERA = {"pos": [0, 1, 3], "dir": [0, -0.3, -1]}
MESH = """mtllib lit.mtl
v -2 0 -2
v 2 0 -2
v 2 0 2
v -2 0 2
v -0.7 2 -0.7
v 0.7 2 -0.7
v 0.7 2 0.7
v -0.7 2 0.7
usemtl floor
f 4 3 2 1
usemtl light
f 5 6 7 8
"""
MATERIALS = "newmtl floor\nKd 0.8 0.6 0.4\nnewmtl light\nKd 1 1 1\nKe 8 8 8\n"


def write_lit(folder: Path) -> Path:
    """lit.json: a lamp over a floor, 16 x 12 pixels."""
    (folder / "lit.obj").write_text(MESH)
    (folder / "lit.mtl").write_text(MATERIALS)
    data: dict[str, Any] = {
        "camera": CAMERA,
        "framebuffer": {"res_w": 16, "res_h": 12, "sppx": 4},
        "scene": {"mesh_files": ["lit.obj"]},
    }
    path = folder / "lit.json"
    path.write_text(json.dumps(data))
    return path


@pytest.fixture
def lit(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The scene file in a new current folder, with a cache of its own."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("ETENDUE_CACHE", str(tmp_path / "cache"))
    return write_lit(tmp_path)
