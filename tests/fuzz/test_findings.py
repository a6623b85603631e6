"""What fuzzing found, one test each; every one of these ended in another exception, or in the end of the process."""

from __future__ import annotations

import json
import struct
import zlib
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from etendue import EtendueError, _core, load
from etendue.loaders import load_image, load_mesh

from . import seeds


def refused(path: Path, data: bytes) -> str:
    path.write_bytes(data)
    with pytest.raises(EtendueError) as caught:
        load_image(path) if path.suffix in (".exr", ".hdr", ".png") else load_mesh(path, [])
    return str(caught.value)


@pytest.mark.parametrize("coordinate", ["2e9", "1e19", "3e38"])
def test_coordinates_whose_square_is_infinite(tmp_path: Path, coordinate: str) -> None:
    number = coordinate.encode()
    assert "too far away" in refused(tmp_path / "a.obj", seeds.OBJ.replace(b"v 1 0 0", b"v 1 0 " + number))
    assert "too far away" in refused(
        tmp_path / "a.stl", seeds.STL.replace(b"vertex 1 0 0", b"vertex 1 0 " + number)
    )
    data = seeds.gltf()
    data["nodes"][0]["scale"] = [1, 1, 1]
    data["nodes"][0]["translation"] = [float(coordinate), 0, 0]
    assert "too far away" in refused(tmp_path / "a.gltf", json.dumps(data).encode())


def test_ply_that_lacks_a_vertex(tmp_path: Path) -> None:
    """The reader takes a face for the last vertex, whose normal then has too few numbers: no normals, then."""
    file = tmp_path / "a.ply"
    file.write_bytes(seeds.PLY.replace(b"end_header\n0 0 0 0 0 1 255\n", b"end_header\n"))
    assert load_mesh(file, []).meshes[0].normals is None


@pytest.mark.parametrize("materials", [None, 3, {"name": "paint"}])
def test_gltf_whose_materials_are_no_list(tmp_path: Path, materials: Any) -> None:
    text = json.dumps({**seeds.gltf(), "materials": materials}).encode()
    assert refused(tmp_path / "a.gltf", text).startswith(str(tmp_path / "a.gltf"))


@pytest.mark.parametrize("attribute", ["POSITION", "NORMAL"])
def test_gltf_whose_points_are_flat(tmp_path: Path, attribute: str) -> None:
    data = seeds.gltf()
    data["meshes"][0]["primitives"][0]["attributes"][attribute] = 1
    file = tmp_path / "a.gltf"
    if attribute == "POSITION":
        assert "its positions are no points" in refused(file, json.dumps(data).encode())
    else:
        file.write_text(json.dumps(data))
        assert load_mesh(file, []).meshes[0].normals is None


def test_exr_whose_names_are_no_text(tmp_path: Path) -> None:
    wrong = seeds.image("exr", "zip").replace(b"capDate\0", b"capD" + 4 * b"\xff")
    assert "not an image that can be read" in refused(tmp_path / "a.exr", wrong)


def test_small_file_that_claims_a_huge_image(tmp_path: Path) -> None:
    data = bytearray(seeds.image("png"))
    data[16:24] = struct.pack(">II", 8000, 8000)
    data[29:33] = struct.pack(">I", zlib.crc32(bytes(data[12:29])))
    assert f"{len(data)} bytes cannot hold 8000 x 8000 pixels" in refused(tmp_path / "a.png", bytes(data))


@pytest.mark.parametrize(
    ("key", "value"),
    [("pos", [1e30, 0, 0]), ("pos", [0, -2e9, 0]), ("lens_radius", 1e38), ("focal_depth", 3e38)],
)
def test_camera_beyond_single_precision(tmp_path: Path, key: str, value: Any) -> None:
    """Embree, where it is built with assertions, ended the process on such a camera's rays."""
    with pytest.raises(EtendueError, match="out of range"):
        load({"camera": {key: value}, "scene": {"sky": {}}})


@pytest.mark.parametrize("length", [1e-11, 1e30])
def test_camera_whose_direction_cannot_be_squared(length: float) -> None:
    scene = load({"camera": {"dir": [0, 0, -length], "up": [0, length, 0]}, "scene": {"sky": {}}})
    assert scene.render(spp=1, size=(4, 3), threads=1).image == pytest.approx(1)


@pytest.mark.parametrize("size", [1e-10, 1e9])
def test_triangles_whose_area_cannot_be_squared(size: float) -> None:
    corners = np.array([[-1, -1, 0], [1, -1, 0], [0, 1, 0]], np.float32) * np.float32(size)
    mesh = _core.Mesh(corners, np.array([[0, 1, 2]], np.uint32))
    world = _core.Scene([mesh], [_core.Material("m", "diffuse", (0.5,) * 3)], [], _core.Sky())
    camera = _core.Camera((0, 0, 0.3 * size), (0, 0, -1), (0, 1, 0), 40, 0, 1, True, 8, 8)
    renderer = _core.Renderer(world, camera, "Pathtracer", sampler="independent")
    assert renderer.render(64)
    assert renderer.invalid_count == 0
    assert renderer.mean() == pytest.approx(0.5, rel=0.2)
