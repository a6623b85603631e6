"""The plates and lamps: equal powers, and every lamp mirrored to the camera by every plate."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from etendue.models import mis
from etendue.models.mesh import Mesh
from etendue.models.model import Model

CONFIG = json.loads((Path(__file__).parents[2] / "configs" / "a04_mis.json").read_text())
NAMES = {name for name, *_ in mis.LAMPS + mis.PLATES} | {"plane"}


@pytest.fixture(scope="module")
def scene() -> Model:
    return mis.model()


def face_normals(mesh: Mesh) -> np.ndarray:
    p = mesh.vertices[mesh.faces]
    return np.cross(p[:, 1] - p[:, 0], p[:, 2] - p[:, 0])


def test_has_the_materials_that_the_config_patches(scene: Model) -> None:
    assert set(scene.parts) == set(scene.materials)
    assert set(scene.parts) >= NAMES == {p["name"] for p in CONFIG["scene"]["materials"]}


def test_geometry_is_sound(scene: Model) -> None:
    for meshes in scene.parts.values():
        for mesh in meshes:
            assert np.isfinite(mesh.vertices).all()
            assert (np.linalg.norm(face_normals(mesh), axis=1) > 1e-13).all()
            if mesh.normals is not None:
                np.testing.assert_allclose(np.linalg.norm(mesh.normals, axis=1), 1, atol=1e-6)
                facing = np.einsum("ij,ikj->ik", face_normals(mesh), mesh.normals[mesh.faces])
                assert (facing > 0).all()


def test_lamps_shine_outwards_with_equal_power(scene: Model) -> None:
    powers = []
    for name, _, strength in mis.LAMPS:
        lamp = scene.parts[name][0]
        outwards = lamp.vertices[lamp.faces].mean(1) - (lamp.vertices.min(0) + lamp.vertices.max(0)) / 2
        assert (np.einsum("ij,ij->i", face_normals(lamp), outwards) > 0).all()
        powers.append(strength * np.linalg.norm(face_normals(lamp), axis=1).sum() / 2)
    np.testing.assert_allclose(powers, powers[0], rtol=0.01)


def test_strengths_are_those_of_the_config() -> None:
    patches = {p["name"]: p for p in CONFIG["scene"]["materials"]}
    for name, colour, strength in mis.LAMPS:
        assert (patches[name]["albedo_col"], patches[name]["emissive_strength"]) == (list(colour), strength)
    for name, roughness, *_ in mis.PLATES:
        assert patches[name]["roughness"] == roughness


def test_every_plate_mirrors_the_row_of_lamps_into_the_picture(scene: Model) -> None:
    eye = np.array(CONFIG["camera"]["pos"])
    row = mis.place(0, *mis.LAMP_ROW)
    for name, _, away, height in mis.PLATES:
        plate = scene.parts[name][0]
        normals = face_normals(plate)
        up = normals[np.argmax(np.linalg.norm(normals, axis=1) * (normals[:, 1] > 0))]
        up /= np.linalg.norm(up)
        at = mis.place(0, away, height)
        to_eye, to_row = (v / np.linalg.norm(v) for v in (eye - at, row - at))
        np.testing.assert_allclose(2 * (up @ to_eye) * up - to_eye, to_row, atol=1e-3)


def test_camera_sees_lamps_and_plates(scene: Model) -> None:
    camera = CONFIG["camera"]
    forward, up = (np.array(camera[k]) / np.linalg.norm(camera[k]) for k in ("dir", "up"))
    half = np.tan(np.radians(camera["fov"] / 2))
    for name in NAMES - {"plane"}:
        v = scene.parts[name][0].vertices - camera["pos"]
        depth = v @ forward
        assert (depth > 0.5).all()
        assert (np.abs(v @ up) < half * depth).all()
        assert (np.abs(v @ np.cross(forward, up)) < half * depth).all()


def test_build_writes_the_same_bytes_again(tmp_path: Path) -> None:
    for folder in ("a", "b"):
        mis.build(tmp_path / folder)
    for name in ("mis.obj", "mis.mtl"):
        assert (tmp_path / "a" / name).read_bytes() == (tmp_path / "b" / name).read_bytes()
