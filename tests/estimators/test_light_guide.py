"""What is learned about lights before a render: it moves noise, never the picture, and is always the same."""

from __future__ import annotations

import numpy as np
import pytest
from scipy import stats

from etendue import _core
from etendue.models import mesh as meshes

from .worlds import Estimator, diffuse, ground, lamp, looking, scene

LEFT, RIGHT = (-1.0, 0.0, 0.0), (1.0, 0.0, 0.0)
UP = (0.0, 1.0, 0.0)
# Lights, in the order of their meshes.
NEAR_LAMP, STRONG_LAMP = 0, 1


def hanging_lamp(x: float) -> meshes.Mesh:
    """A square that faces down."""
    return meshes.quad((-0.3, 0, -0.3), (0.3, 0, -0.3), (0.3, 0, 0.3), (-0.3, 0, 0.3)).moved(x, 1)


def two_rooms(sky: _core.Sky | None = None) -> _core.Scene:
    """A weak lamp on the left, a strong one on the right, and a wall between them."""
    return scene(
        (hanging_lamp(-1), lamp(1)),
        (hanging_lamp(1), lamp(30)),
        (ground(6), diffuse(0.5)),
        (meshes.box(0.1, 4, 6), diffuse(0.5)),
        sky=sky,
    )


def above(size: int = 16) -> _core.Camera:
    """Sees the floor on both sides of the wall, from beside it."""
    return looking((0, 1.5, 4), (0, 0, 0), size, 60)


def chance(world: _core.Scene, light: int, at: tuple[float, float, float], guide: _core.LightGuide | None):
    """Probability with which any triangle of a light is chosen for a point of the floor."""
    learned = None if guide is None else guide.at(at, UP)
    triangles = range(world.lights[light].triangle_count)
    reference = np.array([at], dtype=np.float32)
    return sum(float(world.light_source_pdf(reference, light, t, learned=learned)[0]) for t in triangles)


def test_a_lamp_behind_a_wall_is_seldom_chosen() -> None:
    world = two_rooms()
    guide = _core.LightGuide(world, above())
    assert chance(world, STRONG_LAMP, LEFT, None) > 0.5
    assert 0 < chance(world, STRONG_LAMP, LEFT, guide) < 0.1
    assert 0 < chance(world, NEAR_LAMP, RIGHT, guide) < chance(world, NEAR_LAMP, RIGHT, None)


def test_a_sky_behind_walls_is_seldom_chosen() -> None:
    """Though it is so strong that by power it is chosen nearly always."""
    world = scene(
        (hanging_lamp(-1), lamp(1)),
        (hanging_lamp(1), lamp(1)),
        (ground(6), diffuse(0.5)),
        (meshes.box(8, 8, 8), diffuse(0.5)),
        sky=_core.Sky(None, 10),
    )
    sky = next(i for i, light in enumerate(world.lights) if light.kind == "SkyLight")
    guide = _core.LightGuide(world, looking((0, 1.5, 3), (0, 0, 0), 16, 60))
    assert chance(world, sky, LEFT, None) > 0.99
    assert 0 < chance(world, sky, LEFT, guide) < 0.3


def test_every_light_may_still_be_chosen() -> None:
    """Wherever paths have come to."""
    world = two_rooms(_core.Sky(None, 0.5))
    guide = _core.LightGuide(world, above())
    known = 0
    for x in np.linspace(-2.9, 2.9, 30):
        for z in np.linspace(-2.9, 2.9, 30):
            factors = guide.at((x, 0.0, z), UP)
            if factors is None:
                continue
            known += 1
            assert 0 < factors.triangles_share < 1
            assert min(factors.root) > 0
            assert np.min(factors.below) > 0
    assert known > 100


@pytest.mark.parametrize("strength", [1e-38, 1e-25, 1e-18, 1e18, 1e25, 3e38])
def test_light_as_bright_or_dim_as_numbers_go(strength: float) -> None:
    world = scene(
        (hanging_lamp(-1), lamp(strength)),
        (hanging_lamp(1), lamp(strength)),
        (ground(6), diffuse(0.5)),
        sky=_core.Sky(None, strength),
    )
    guide = _core.LightGuide(world, above())
    factors = guide.at(LEFT, UP)
    assert factors is not None
    assert 0 < factors.triangles_share <= 1
    for numbers in (factors.root, factors.below):
        assert np.isfinite(numbers).all()
        assert np.min(numbers) > 0
    renderer = _core.Renderer(world, above(), "Pathtracer")
    renderer.render(4)
    if strength < 1e30:  # beyond, products of radiance and weights are no numbers by any choice of lights
        assert renderer.invalid_count == 0


@pytest.mark.parametrize("light_choice", ["learned", "tree"])
@pytest.mark.parametrize("sky", [0.0, 1e-20, 1e-16, 1e-10])
def test_a_sky_that_is_next_to_nothing(sky: float, light_choice: str) -> None:
    world = two_rooms(_core.Sky(None, sky))
    renderer = _core.Renderer(world, above(), "Pathtracer", {"light_choice": light_choice})
    renderer.render(16)
    assert renderer.invalid_count == 0


def test_lamps_that_face_away_are_seldom_tried() -> None:
    world = scene(
        (hanging_lamp(-1).turned("x", 180).moved(y=2), lamp(100)),
        (hanging_lamp(1).turned("x", 180).moved(y=2), lamp(100)),
        (ground(6), diffuse(0.5)),
        sky=_core.Sky(None, 1),
    )
    factors = _core.LightGuide(world, above()).at(LEFT, UP)
    assert factors is not None
    assert 0 < factors.triangles_share < 0.1


def test_of_a_single_point() -> None:
    """A scene seen through a pin hole has cells of no size, and places that are no numbers are in none."""
    camera = _core.Camera((-1, 1.5, 4), (0, -1.5, -4), (0, 1, 0), 1e-30, 0, 1, True, 1, 1)
    guide = _core.LightGuide(two_rooms(), camera, max_edges=2)
    assert guide.at((np.nan, np.inf, 0.0), UP) is None
    renderer = _core.Renderer(two_rooms(), camera, "Pathtracer")
    renderer.render(4)
    assert renderer.invalid_count == 0


@pytest.mark.parametrize("size", [16, 400], ids=["one-round", "two-rounds"])
def test_the_same_whatever_the_threads(size: int) -> None:
    world = two_rooms(_core.Sky(None, 0.5))
    one, three = (_core.LightGuide(world, above(size), threads=threads) for threads in (1, 3))
    for at in (LEFT, RIGHT, (-1.5, 0.0, 1.0)):
        a, b = one.at(at, UP), three.at(at, UP)
        assert a is not None
        assert b is not None
        assert (a.triangles_share, a.root, a.below) == (b.triangles_share, b.root, b.below)


def test_more_is_learned_for_a_larger_picture() -> None:
    assert [_core.LightGuide.paths(above(size)) for size in (16, 256, 400, 512, 4096)] == [
        32_768,
        32_768,
        65_536,
        131_072,
        131_072,
    ]
    world = two_rooms()
    small, large = (_core.LightGuide(world, above(size)) for size in (16, 512))
    # Each trial that finds nothing makes a hidden lamp less likely, down to what every light keeps.
    assert 0 < chance(world, STRONG_LAMP, LEFT, large) < 0.9 * chance(world, STRONG_LAMP, LEFT, small)


def test_nothing_is_learned_of_a_single_lamp() -> None:
    """Of two triangles the power decides, and there is nothing to wait for."""
    world = scene((hanging_lamp(0), lamp(1)), (ground(6), diffuse(0.5)))
    assert _core.LightGuide(world, above()).at((0.0, 0.0, 0.0), UP) is None


def renders(light_choice: str, mis: str, camera: _core.Camera, repeats: int, sky: bool):
    """(repeats, height, width) luminance of independent renders."""
    estimator = Estimator("Pathtracer", {"light_choice": light_choice, "mis": mis})
    world = two_rooms(_core.Sky(None, 0.05) if sky else None)
    images = [estimator.render(world, camera, 64, seed=seed).mean() for seed in range(repeats)]
    return np.array(images, dtype=float) @ [0.2126, 0.7152, 0.0722]


@pytest.mark.parametrize("sky", [False, True], ids=["lamps", "lamps-and-sky"])
@pytest.mark.parametrize("mis", ["power", "balance", "none"])
def test_the_same_picture(mis: str, sky: bool) -> None:
    """Learned choices agree with those by power, tile by tile, on both sides of the wall."""
    tiles = []
    for light_choice in ("learned", "power"):
        images = renders(light_choice, mis, above(16), 24, sky)
        tiles.append(images.reshape(24, 2, 8, 2, 8).mean((2, 4)).reshape(24, -1))
    p = stats.ttest_ind(*tiles, equal_var=False).pvalue
    assert p.min() > 1e-3 / p.size


def test_less_noise_where_a_wall_hides_the_strong_lamp() -> None:
    camera = looking((-1.5, 0.8, 0.5), LEFT, 8)
    variances = {
        choice: renders(choice, "power", camera, 12, False).var(0, ddof=1).mean()
        for choice in ("learned", "tree")
    }
    assert variances["learned"] < 0.5 * variances["tree"]


def test_a_render_that_is_cancelled_while_it_learns() -> None:
    """It has no sample, and goes on as if nothing had happened."""
    world, camera = two_rooms(), above()
    undisturbed = _core.Renderer(world, camera, "Pathtracer", seed=3)
    undisturbed.render(2)
    cancelled = _core.Renderer(world, camera, "Pathtracer", seed=3)
    cancelled.cancel()
    assert not cancelled.render(2)
    assert cancelled.sample_count().max() == 0
    cancelled.cancel()
    assert not cancelled.render_coarse(4)
    assert cancelled.render(2)
    assert np.array_equal(cancelled.sum(), undisturbed.sum())


def test_the_same_whether_coarse_or_replayed_first() -> None:
    world, camera = two_rooms(), above()
    plain = _core.Renderer(world, camera, "Pathtracer", seed=3)
    plain.render(1)
    coarse = _core.Renderer(world, camera, "Pathtracer", seed=3)
    path = _core.replay(coarse, 5, 9, 0)
    coarse.render_coarse(4)
    coarse.render(1)
    assert np.array_equal(plain.sum(), coarse.sum())
    np.testing.assert_allclose(path.radiance, plain.mean()[9, 5], rtol=1e-6)
