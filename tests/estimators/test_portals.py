"""Directions to smooth glass, sampled at first surfaces: the picture stays, light through windows comes clean."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy import stats

from etendue import _core
from etendue.models import mesh as meshes

from .worlds import check_pieces, diffuse, lamp, looking, scene

SEEDS, SPP, SIDE = 48, 16, 32


def windows(sky: bool = False) -> tuple[_core.Scene, _core.Camera]:
    """A room with panes of tinted glass, a smooth ball of glass, and a mirror. Lamps are outside, or a sky."""
    glass = _core.Material("glass", "glass", (0.9, 0.7, 0.5), ior=1.5)
    mirror = _core.Material("mirror", "specular", (0.8, 0.8, 0.9))
    coated = _core.Material(
        "floor", "layered_ggx", (0.6, 0.6, 0.6), ior=1.6, roughness=0.2, absorb=0, coated=True
    )
    wall = diffuse(0.7)
    quad = meshes.quad
    around = [
        quad((-1, y0, -1), (1, y0, -1), (1, y1, -1), (-1, y1, -1)) for y0, y1 in ((0, 0.6), (1.2, 2))
    ] + [
        quad((x0, 0.6, -1), (x1, 0.6, -1), (x1, 1.2, -1), (x0, 1.2, -1)) for x0, x1 in ((-1, -0.4), (0.4, 1))
    ]
    parts = [
        (quad((-1, 0, -1), (-1, 0, 1), (1, 0, 1), (1, 0, -1)), coated),
        (quad((-1, 0, -1), (-1, 2, -1), (-1, 2, 1), (-1, 0, 1)), wall),
        (quad((-1, 2, -1), (1, 2, -1), (1, 2, 1), (-1, 2, 1)), wall),
        *((part, wall) for part in around),
        (meshes.box(0.8, 0.6, 0.04).moved(y=0.9, z=-1), glass),
        (meshes.box(0.4, 0.6, 0.04).moved(x=0.2, y=0.9, z=-0.9), glass),
        (meshes.sphere(0.15, 6).moved(x=-0.5, y=0.16, z=0.1), glass),
        (quad((0.95, 0.1, -0.5), (0.95, 0.1, 0.5), (0.95, 0.9, 0.5), (0.95, 0.9, -0.5)), mirror),
    ]
    light = None
    if sky:
        image = np.full((16, 32, 3), 0.3, np.float32)
        image[5, 24:26] = 60
        light = _core.Sky(image)
    else:
        parts += [
            (quad((x, y, -2), (x + 0.45, y, -2), (x + 0.45, y + 0.45, -2), (x, y + 0.45, -2)), lamp(10))
            for x, y in ((-0.6, 1.0), (0.3, 1.5), (-0.1, 0.5))
        ]
    return scene(*parts, sky=light), looking((0.2, 1.1, 1.6), (0, 0.5, -0.3), SIDE, fov=55)


def renderer(place: tuple[_core.Scene, _core.Camera], portals: bool, **more: object) -> _core.Renderer:
    """Deals with `sampler`, `seed`, `threads` and the estimator's parameters."""
    settings = {
        name: more.pop(name) for name in ("sampler", "seed", "threads", "first_sample") if name in more
    }
    alone = {"light_tracing": False, "light_splitting": False, "path_reuse": False, "max_cam_path_length": 7}
    made = _core.Renderer(*place, "Pathtracer", {**alone, "portals": portals, **more}, **settings)
    made.prepare()
    assert made.by_portals == portals
    return made


def pictures(
    place: tuple[_core.Scene, _core.Camera], portals: bool, spp: int, **more: object
) -> NDArray[np.float64]:
    """(seeds, height, width, 3)."""
    images = []
    for seed in range(SEEDS):
        made = renderer(place, portals, seed=seed + 1000 * portals, **more)
        made.render(spp)
        assert made.invalid_count == 0
        images.append(made.mean())
    return np.asarray(images, np.float64)


@pytest.mark.parametrize(
    ("sky", "more"),
    [
        (False, {}),
        (False, {"mis": "balance", "path_reuse": True, "light_splitting": True}),
        (False, {"rr_threshold": 0.9, "max_cam_path_length": 4}),
        (True, {}),
    ],
)
def test_the_mean_stays(sky: bool, more: dict[str, object]) -> None:
    """Welch's t-test of blocks of 4 x 4 pixels, or of tiles where pixels share; without, of six times the samples."""
    block, place = 16 if more.get("path_reuse") else 4, windows(sky)
    ours, theirs = (
        pictures(place, portals, SPP * (1 if portals else 6), sampler="independent", **more)
        .reshape(SEEDS, SIDE // block, block, SIDE // block, block, 3)
        .mean((2, 4))
        for portals in (True, False)
    )
    varies = (ours.std(0) > 0) | (theirs.std(0) > 0)
    p = stats.ttest_ind(ours[:, varies], theirs[:, varies], axis=0, equal_var=False).pvalue
    assert p.min() * p.size > 1e-3


def test_light_through_windows_comes_clean() -> None:
    """In the median of the pixels that get any."""
    ours, theirs = (pictures(windows(), portals, SPP).var(0).mean(2) for portals in (True, False))
    lit = theirs > 0
    assert np.median(ours[lit] / theirs[lit]) < 1 / 2


def test_portals_are_used_where_they_pay() -> None:
    """Not where nothing comes through, where light sampling stands alone, or where light is traced from the lights."""
    place = windows()
    assert not _core.Renderer(*place, "Pathtracer", {"portals": False}).by_portals
    assert not _core.Renderer(*place, "Pathtracer", {"mis": "none"}).by_portals
    assert not _core.Renderer(*place, "Pathtracer", {"max_cam_path_length": 2}).by_portals
    assert not _core.Renderer(*place, "NaivePathtracer").by_portals
    traced = _core.Renderer(*place, "Pathtracer")
    assert not (traced.by_portals and traced.light_paths)


@pytest.mark.parametrize("sampler", _core.samplers())
def test_pieces_are_the_whole(sampler: str) -> None:
    place = windows()
    check_pieces(lambda **options: renderer(place, True, sampler=sampler, **options))


def test_a_replay_tells_of_them() -> None:
    made, told = renderer(windows(), True), 0
    for x, y in np.ndindex(SIDE // 2, SIDE // 4):
        path = _core.replay(made, 2 * x, SIDE // 2 + 2 * y, 0)
        own = [c for vertex in path.vertices for c in vertex.contributions]
        total = sum(np.multiply(c.unweighted, c.weight) for c in own + path.by_portals)
        np.testing.assert_allclose(total, path.radiance, rtol=1e-5, atol=1e-6)
        assert all(c.by_portal and c.edges > 2 and 0 < c.weight < 1 for c in path.by_portals)
        told += len(path.by_portals)
    assert told > 0


def test_the_techniques_add_up() -> None:
    made = renderer(windows(), True)
    film = _core.TechniqueFilm(made, 10)
    assert film.render(SPP)
    made.render(SPP)
    np.testing.assert_allclose(film.mean()[0].sum((0, 1)), made.mean(), rtol=1e-4, atol=1e-5)
