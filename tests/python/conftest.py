"""What several test modules share: a scene so small that rendering it takes no time."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

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
