"""Teapots, rabbits and the sunset."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from etendue.models import _pots_floor, _pots_sky, _pots_teapot, pots
from etendue.models._pots_atmosphere import Atmosphere
from etendue.models._pots_bunny import bunny
from etendue.models._pots_polygonise import polygonised
from etendue.models.mesh import Mesh
from etendue.models.model import Model

CONFIGS = Path(__file__).parents[2] / "configs"
CONFIG = json.loads((CONFIGS / "a04_pots.json").read_text())
NAMES = {
    "Material.001",
    "bunny_specular",
    "bunny_specular.001",
    "teapot_diffuse",
    "teapot_diffuse.001",
    "teapot_specular",
    "teapot_specular.001",
    "teapot_specular.002",
    "light",
}


@pytest.fixture(scope="module")
def scene() -> Model:
    return pots.model()


@pytest.fixture(scope="module")
def sky() -> np.ndarray:
    return _pots_sky.sunset()


def face_normals(mesh: Mesh) -> np.ndarray:
    p = mesh.vertices[mesh.faces]
    return np.cross(p[:, 1] - p[:, 0], p[:, 2] - p[:, 0])


def is_closed(mesh: Mesh) -> bool:
    edges = np.concatenate([mesh.faces[:, [0, 1]], mesh.faces[:, [1, 2]], mesh.faces[:, [2, 0]]])
    n = len(mesh.vertices)
    ahead, back = edges[:, 0] * n + edges[:, 1], edges[:, 1] * n + edges[:, 0]
    return len(np.unique(ahead)) == len(ahead) and np.array_equal(np.sort(ahead), np.sort(back))


def volume(mesh: Mesh) -> float:
    return float(np.einsum("ij,ij->", mesh.vertices[mesh.faces[:, 0]], face_normals(mesh)) / 6)


def test_has_the_materials_of_the_format_page(scene: Model) -> None:
    assert set(scene.parts) == set(scene.materials)
    assert set(scene.parts) >= NAMES
    assert {p["name"] for p in CONFIG["scene"]["materials"]} == NAMES


def test_naive_twin_differs_in_the_algorithm_alone() -> None:
    other = json.loads((CONFIGS / "a04_pots_naive.json").read_text())
    assert {k: v for k, v in other.items() if v != CONFIG[k]} == {"algorithm": "NaivePathtracer"}


def test_geometry_is_sound(scene: Model) -> None:
    assert scene.triangle_count > 150_000
    for meshes in scene.parts.values():
        for mesh in meshes:
            assert np.isfinite(mesh.vertices).all()
            assert (np.linalg.norm(face_normals(mesh), axis=1) > 1e-13).all()
            if mesh.normals is not None:
                np.testing.assert_allclose(np.linalg.norm(mesh.normals, axis=1), 1, atol=1e-6)
                wrong = np.einsum("ij,ikj->ik", face_normals(mesh), mesh.normals[mesh.faces]) <= 0
                # Where the teapot's handle and spout end inside of the body, corners may be folded.
                assert wrong.mean() < 1e-3


def test_rabbits_are_closed_solids_of_the_right_make(scene: Model) -> None:
    for name in ("bunny_specular", "bunny_specular.001"):
        (rabbit,) = scene.parts[name]
        assert is_closed(rabbit)
        assert 20_000 <= len(rabbit.faces) <= 60_000
        assert volume(rabbit) > 0.5


def test_things_stand_on_the_floor_apart_from_each_other_and_from_the_camera(scene: Model) -> None:
    solids = [
        m for name, meshes in scene.parts.items() if name.startswith(("bunny", "teapot")) for m in meshes
    ]
    for i, mesh in enumerate(solids):
        assert mesh.vertices[:, 1].min() == pytest.approx(0.001, abs=1e-6)
        assert (np.linalg.norm(mesh.vertices - CONFIG["camera"]["pos"], axis=1) > 1).all()
        for other in solids[:i]:
            # A coarse sample of one against every vertex of the other.
            gap = np.linalg.norm(mesh.vertices[::40, None] - other.vertices[None, ::40], axis=2)
            assert gap.min() > 0.1


def test_lamp_is_above_outside_of_the_picture_and_shines_on_the_set(scene: Model) -> None:
    (lamp,) = scene.parts["light"]
    at = lamp.vertices.mean(0)
    assert (face_normals(lamp) @ (pots.place(0, 0) - at) > 0).all()
    camera = CONFIG["camera"]
    forward, up = (np.array(camera[k]) / np.linalg.norm(camera[k]) for k in ("dir", "up"))
    v = at - camera["pos"]
    assert np.abs([v @ up, v @ np.cross(forward, up)]).max() > 1.1 * np.tan(np.radians(35)) * (v @ forward)


def test_teapot_is_newells() -> None:
    patches = _pots_teapot.patches()
    assert patches.shape == (32, 4, 4, 3)
    assert len(np.unique(np.round(patches.reshape(-1, 3), 6) + 0.0, axis=0)) == 290
    pot = _pots_teapot.teapot(8)
    np.testing.assert_allclose(pot.vertices.min(0), [-3, 0, -2], atol=1e-9)
    np.testing.assert_allclose(pot.vertices.max(0)[1:], [3.15, 2], atol=1e-9)
    assert pot.vertices[:, 0].max() == pytest.approx(3.43, abs=0.02)
    body = pot.vertices[pot.faces].mean(1)
    on_body = (np.abs(body[:, 1] - 0.75) < 0.45) & (body[:, 2] > 0.7)
    assert (face_normals(pot)[on_body] @ [0, 0, 1] > 0).all()


def test_patches_join_without_gaps() -> None:
    """Every edge of the quarter turns is shared, apart from the rims of lid and body."""
    patches = _pots_teapot.patches()
    edges: dict[tuple[bytes, bytes], int] = {}
    for patch in patches[:24]:
        for edge in (patch[0], patch[-1], patch[:, 0], patch[:, -1]):
            ends = sorted((np.round(edge[k], 6) + 0.0).tobytes() for k in (0, -1))
            if ends[0] != ends[1]:
                edges[ends[0], ends[1]] = edges.get((ends[0], ends[1]), 0) + 1
    assert sorted(edges.values()).count(1) == 8
    assert max(edges.values()) == 2


def test_polygonised_ball_is_round_and_closed() -> None:
    ball = polygonised(lambda p: np.linalg.norm(p, axis=1) - 1, (-1.3,) * 3, (1.3,) * 3, 0.1)
    assert is_closed(ball)
    np.testing.assert_allclose(np.linalg.norm(ball.vertices, axis=1), 1, atol=1e-3)
    assert ball.normals is not None
    np.testing.assert_allclose(ball.normals, ball.vertices, atol=1e-2)
    assert volume(ball) == pytest.approx(4 / 3 * np.pi, rel=0.02)


def test_polygonised_corner_to_corner_solids_stay_closed() -> None:
    boxes = [np.array(c, float) for c in ((0.5, 0.5, 0), (-0.5, -0.5, 0))]

    def field(p: np.ndarray) -> np.ndarray:
        return np.min([np.abs(p - c).max(1) - 0.5 for c in boxes], axis=0)

    assert is_closed(polygonised(field, (-1.5,) * 3, (1.5,) * 3, 0.13))


def test_sky_is_finite_bright_around_the_sun_and_bluer_above(sky: np.ndarray) -> None:
    assert sky.shape == (1024, 2048, 3)
    assert np.isfinite(sky).all()
    assert (sky > 0).all()
    row, column = np.unravel_index(np.argmax(sky.sum(2)), sky.shape[:2])
    assert (column + 0.5) * 360 / 2048 == pytest.approx(_pots_sky.SUN_AZIMUTH, abs=0.4)
    assert 90 - (row + 0.5) * 180 / 1024 == pytest.approx(_pots_sky.SUN_ELEVATION, abs=0.4)
    near_sun, zenith = sky[row - 10, column + 30], sky[20].mean(0)
    assert near_sun[0] > 2 * near_sun[2]
    assert zenith[2] > zenith[0]
    # The sun's row of the picture has no seam at the azimuth where the picture begins.
    np.testing.assert_allclose(sky[:500, 0], sky[:500, -1], rtol=0.02)


def test_sun_has_its_true_size_and_energy(sky: np.ndarray) -> None:
    elevation = 90 - (np.arange(1024) + 0.5) * 180 / 1024
    turn = np.mod((np.arange(2048) + 0.5) * 360 / 2048 - _pots_sky.SUN_AZIMUTH + 180, 360) - 180
    share = _pots_sky._sun_share(elevation, turn)
    solid = np.cos(np.radians(elevation))[:, None] * (np.pi / 1024) ** 2
    assert np.sum(share * solid) == pytest.approx(np.pi * np.radians(0.2665) ** 2, rel=1e-3)
    assert np.ptp(elevation[np.flatnonzero(share.any(1))]) < 0.8


def test_clear_air_lets_the_known_share_of_light_through() -> None:
    """Vertical depths of clear air are about 0.1 in green and 0.25 in blue, and ozone adds a few per cent."""
    air = Atmosphere(45, haze=1e-9, eye=0.0)
    through = air.transmittance(np.array([air.eye]), np.array([1.0]))[0]
    assert -np.log(through[1]) == pytest.approx(0.108 + 0.028, abs=0.02)
    assert -np.log(through[2]) == pytest.approx(0.265, abs=0.03)


def test_same_code_gives_the_same_things() -> None:
    assert np.array_equal(_pots_floor.checker()[::7, ::7], _pots_floor.checker()[::7, ::7])
    one, other = bunny(cell=0.05), bunny(cell=0.05)
    assert np.array_equal(one.vertices, other.vertices)
    assert np.array_equal(one.faces, other.faces)
