"""The Cornell box: its measurements, its frame, its lamp."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from etendue.models import box
from etendue.models.mesh import Mesh, merged, rounded_prism
from etendue.models.model import Model

CONFIGS = Path(__file__).parents[2] / "configs"
PATCHED = {"leftWall_diffuse", "rightWall_diffuse", "floor_diffuse", "shortBox", "light"}
NAMES = PATCHED | {"backWall", "ceiling", "tallBox"}


@pytest.fixture(scope="module")
def scene() -> Model:
    return box.model()


def face_normals(mesh: Mesh) -> np.ndarray:
    p = mesh.vertices[mesh.faces]
    return np.cross(p[:, 1] - p[:, 0], p[:, 2] - p[:, 0])


def test_has_the_materials_of_the_format_page(scene: Model) -> None:
    assert set(scene.parts) == set(scene.materials) == NAMES
    patched = json.loads((CONFIGS / "a04_box.json").read_text())["scene"]["materials"]
    assert {p["name"] for p in patched} == PATCHED


def test_fills_the_frame_of_the_camera(scene: Model) -> None:
    room = merged([m for meshes in scene.parts.values() for m in meshes]).vertices
    np.testing.assert_allclose(room.min(0), [-1, 0, -1], atol=0.002)
    np.testing.assert_allclose(room.max(0), [1, 2, 1], atol=0.008)


def test_geometry_is_sound(scene: Model) -> None:
    for meshes in scene.parts.values():
        for mesh in meshes:
            assert np.isfinite(mesh.vertices).all()
            assert (np.linalg.norm(face_normals(mesh), axis=1) > 1e-12).all()


@pytest.mark.parametrize(
    ("name", "inward"),
    [
        ("floor_diffuse", (0, 1, 0)),
        ("backWall", (0, 0, 1)),
        ("leftWall_diffuse", (1, 0, 0)),
        ("rightWall_diffuse", (-1, 0, 0)),
    ],
)
def test_walls_face_the_room(scene: Model, name: str, inward: tuple[int, int, int]) -> None:
    assert (face_normals(scene.parts[name][0]) @ inward > 0).all()


def test_lamp_shines_down_from_just_below_the_ceiling(scene: Model) -> None:
    lamp = scene.parts["light"][0]
    assert (face_normals(lamp)[:, 1] < 0).all()
    np.testing.assert_allclose(lamp.vertices[:, 1], 1.98)


@pytest.mark.parametrize(
    ("name", "height", "x", "z"), [("shortBox", 165, 186, 168.5), ("tallBox", 330, 368.5, 351.5)]
)
def test_blocks_stand_as_measured(scene: Model, name: str, height: float, x: float, z: float) -> None:
    block = scene.parts[name][0]
    assert block.vertices[:, 1].max() == pytest.approx(height * 2 / 548.8)
    middle = (block.vertices.min(0) + block.vertices.max(0)) / 2
    np.testing.assert_allclose(middle[[0, 2]], [1 - 2 * x / 556, 1 - 2 * z / 559.2], atol=0.01)


def test_naive_twin_differs_in_the_algorithm_alone() -> None:
    one, other = (json.loads((CONFIGS / f"a04_box{suffix}.json").read_text()) for suffix in ("", "_naive"))
    assert (one.pop("algorithm"), other.pop("algorithm")) == ("Pathtracer", "NaivePathtracer")
    assert one == other


def test_build_writes_the_same_bytes_again(tmp_path: Path) -> None:
    for folder in ("a", "b"):
        box.build(tmp_path / folder)
    for name in ("CornellBox-Original.obj", "CornellBox-Original.mtl"):
        assert (tmp_path / "a" / name).read_bytes() == (tmp_path / "b" / name).read_bytes()


@pytest.mark.parametrize("footprint", [[(0, 0), (1, 0), (1, 1), (0, 1)], [(0, 0), (0.2, 1), (1, 0.3)]])
def test_rounded_prism_is_closed_and_its_normals_point_outwards(footprint: list[tuple[float, float]]) -> None:
    prism = rounded_prism(footprint, 0.5, 0.05)
    places, at = np.unique(np.round(prism.vertices, 9), axis=0, return_inverse=True)
    faces = at.reshape(-1)[prism.faces]
    edges = [tuple(e) for e in np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])]
    assert len(set(edges)) == len(edges)
    assert {(b, a) for a, b in edges} == set(edges)
    assert prism.normals is not None
    np.testing.assert_allclose(np.linalg.norm(prism.normals, axis=1), 1)
    assert (np.einsum("ij,ikj->ik", face_normals(prism), prism.normals[prism.faces]) > 0).all()
    outwards = prism.vertices[prism.faces].mean(1) - places.mean(0)
    assert (np.einsum("ij,ij->i", face_normals(prism), outwards) > 0).all()
