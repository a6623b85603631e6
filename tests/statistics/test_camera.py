"""The camera from both ends: rays of the film, and the film of points."""

from __future__ import annotations

import numpy as np
import pytest

from etendue import _core

CAMERAS = {
    "pinhole": _core.Camera((1, 2, 3), (0.3, -0.2, -1), (0, 1, 0), 55, 0, 2, True, 64, 48),
    "lens": _core.Camera((1, 2, 3), (0.3, -0.2, -1), (0.1, 1, 0), 35, 0.2, 2, True, 64, 48),
    "panorama": _core.Camera((1, 2, 3), (0.3, -0.2, -1), (0, 1, 0), 55, 0, 2, False, 64, 48),
}


@pytest.mark.parametrize("name", CAMERAS)
def test_the_film_of_a_point_on_a_ray_is_that_of_the_ray(name: str) -> None:
    rng = np.random.default_rng(1)
    film = (rng.random((1000, 2)) * (64, 48)).astype(np.float32)
    lens = rng.random((1000, 2), dtype=np.float32)
    origins, directions = CAMERAS[name].rays(film, lens)
    points = origins + directions * np.exp2(rng.uniform(-1, 6, (1000, 1))).astype(np.float32)
    np.testing.assert_allclose(CAMERAS[name].films_of(points, lens)[0], film, atol=5e-3)


@pytest.mark.parametrize("name", CAMERAS)
def test_film_per_solid_angle(name: str) -> None:
    """The solid angle of a small square of film, of rays from one point of the lens, by differences."""
    rng = np.random.default_rng(2)
    film = (rng.uniform(4, 44, (500, 2))).astype(np.float32)
    lens = rng.random((500, 2), dtype=np.float32)
    half = 0.25

    def direction(dx: float, dy: float) -> np.ndarray:
        return CAMERAS[name].rays(film + np.float32((dx, dy)), lens)[1].astype(float)

    across = (direction(half, 0) - direction(-half, 0)) / (2 * half)
    down = (direction(0, half) - direction(0, -half)) / (2 * half)
    per_pixel = np.linalg.norm(np.cross(across, down), axis=1)
    origins, directions = CAMERAS[name].rays(film, lens)
    film_per_solid_angle = CAMERAS[name].films_of(origins + 3 * directions, lens)[1]
    np.testing.assert_allclose(film_per_solid_angle * per_pixel, 1, rtol=0.01)


def test_nothing_is_seen_behind_the_camera() -> None:
    behind = np.array([[1, 2, 5]], np.float32)
    lens = np.full((1, 2), 0.5, np.float32)
    for name in ("pinhole", "lens"):
        assert all(np.isnan(values).all() for values in CAMERAS[name].films_of(behind, lens))
    assert np.isfinite(CAMERAS["panorama"].films_of(behind, lens)[0]).all()
