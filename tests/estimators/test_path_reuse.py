"""Paths that pixels share: the picture stays, its noise falls, and who shares with whom depends on nothing else."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy import stats

from etendue import _core
from etendue.models import mesh as meshes

from .test_invariance import cornell
from .worlds import diffuse, ground, lamp, looking, scene

SEEDS, SPP, SIDE = 48, 16, 32


def room() -> tuple[_core.Scene, _core.Camera]:
    """Closed, with all that a wrong share would show in: black stripes on the floor, a coat that reflects much, a card
    that hides parts of the walls from parts of the floor, a lamp that is hidden from most of it."""
    coated = _core.Material(
        "coated", "layered_ggx", (0.8, 0.7, 0.6), ior=2.4, roughness=0.4, absorb=0, coated=True
    )
    black, white = _core.Material("black", "diffuse", (0, 0, 0)), diffuse(0.8)
    stripes = [
        meshes.quad((x, 0.001, -1), (x, 0.001, 1), (x + 0.1, 0.001, 1), (x + 0.1, 0.001, -1))
        for x in np.arange(-1, 1, 0.25)
    ]
    card = meshes.quad((0.2, 0.001, -0.4), (0.2, 0.5, -0.4), (0.2, 0.5, 0.6), (0.2, 0.001, 0.6))
    lamp_at = meshes.quad((-0.9, 1.2, -0.2), (-0.6, 1.2, -0.2), (-0.6, 1.2, 0.2), (-0.9, 1.2, 0.2))
    world = scene(
        (meshes.box(2, 2, 2).moved(y=1).flipped(), coated),
        *((stripe, black) for stripe in stripes),
        (card, white),
        (lamp_at, lamp(10)),
    )
    return world, looking((0.3, 1.3, 0.9), (0, 0, 0), SIDE, fov=60)


def means(
    place: tuple[_core.Scene, _core.Camera], reuse: bool, sampler: str = "independent", **more: object
) -> NDArray[np.float64]:
    """(seeds, height, width, 3): pictures."""
    world, camera = place
    images = []
    for seed in range(SEEDS):
        renderer = _core.Renderer(
            world,
            camera,
            "Pathtracer",
            {"path_reuse": reuse, "max_cam_path_length": 8, **more},
            sampler=sampler,
            seed=seed + 1000 * reuse,
        )
        renderer.render(SPP)
        assert renderer.invalid_count == 0
        assert (renderer.sharing > 1) == reuse
        images.append(renderer.mean())
    return np.asarray(images, np.float64)


@pytest.mark.parametrize(
    "settings",
    [{}, {"rr_min_path_length": 0, "rr_threshold": 0.95}, {"mis": "none", "rr_threshold": 0.0}],
    ids=["default", "roulette", "none"],
)
def test_the_mean_stays(settings: dict[str, object]) -> None:
    """Welch's t-test of each tile and each stripe of pixels, whose errors are independent between renders alone."""
    place = room()
    ours, theirs = means(place, True, **settings), means(place, False, **settings)
    regions = {
        "tiles": lambda a: a.reshape(SEEDS, 2, 16, 2, 16, 3).mean((2, 4)),
        "columns": lambda a: a.reshape(SEEDS, SIDE, SIDE // 2, 2, 3).mean((1, 3)),
        "rows": lambda a: a.reshape(SEEDS, SIDE // 2, 2, SIDE, 3).mean((2, 3)),
    }
    for name, of in regions.items():
        p = stats.ttest_ind(of(ours), of(theirs), axis=0, equal_var=False).pvalue
        assert p.min() * p.size > 1e-3, name


def test_noise_falls_and_is_not_that_of_the_next_pixel() -> None:
    # Of a part of the back wall, as pixels of larger pictures see it.
    world, _ = cornell()
    place = world, _core.Camera((0, 1, 2.4), (-0.1, 0.1, -1), (0, 1, 0), 15, 0, 1, True, SIDE, SIDE)
    ours, theirs = means(place, True, sampler="sobol"), means(place, False, sampler="sobol")
    assert np.median(ours.var(0).mean(2) / theirs.var(0).mean(2)) < 0.5
    noise = (ours - ours.mean(0)).mean(3)
    noise /= noise.std(0)
    for there in ((0, 1), (1, 0)):
        shifted = np.roll(noise, there, axis=(1, 2))[:, 1:, 1:]
        assert abs((noise[:, 1:, 1:] * shifted).mean()) < 0.1
    # As a whole they share it, which nobody may forget who adds up pixels.
    tile = noise.reshape(SEEDS, 2, 16, 2, 16).mean((2, 4))
    assert tile.var(0).mean() * 16 * 16 > 2


def test_pixels_share_where_it_pays() -> None:
    """Below an open sky there is nothing to share."""
    world = scene((ground(), diffuse()), sky=_core.Sky(intensity=2))
    assert _core.Renderer(world, looking((0, 1, 1), (0, 0, 0)), "Pathtracer").sharing == 1
    assert _core.Renderer(*cornell(), "Pathtracer").sharing > 1
    assert _core.Renderer(*cornell(), "Pathtracer", {"path_reuse": False}).sharing == 1
    assert _core.Renderer(*cornell(), "NaivePathtracer").sharing == 1
    assert _core.sharing("Pathtracer", {}) == 16
    assert _core.sharing("Pathtracer", {"path_reuse": False}) == 1


@pytest.mark.parametrize("size", [(33, 17), (5, 3), (1, 1)])
def test_groups_are_whole_at_any_size_in_any_order(size: tuple[int, int]) -> None:
    """In pieces, coarse pixels first, or in one go: the same sums."""
    world, _ = cornell()
    camera = _core.Camera((0, 1, 2.4), (0, 0, -1), (0, 1, 0), 70, 0.02, 3, True, *size)
    whole = _core.Renderer(world, camera, "Pathtracer", seed=3, threads=2)
    whole.render(20)
    pieces = _core.Renderer(world, camera, "Pathtracer", seed=3, threads=1)
    for stride in (16, 8, 4, 2):
        pieces.render_coarse(stride)
    for samples in (1, 2, 15, 17, 20):
        pieces.render(samples)
    np.testing.assert_array_equal(whole.mean(), pieces.mean())
    x, y = size[0] - 1, size[1] - 1
    late = _core.Renderer(world, camera, "Pathtracer", seed=3, first_sample=19)
    late.render(1)
    assert list(_core.replay(whole, x, y, 19).radiance) == late.mean()[y, x].tolist()
