"""Light that is traced from the lights: the picture stays, and caustics lose their noise."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy import stats

from etendue import _core
from etendue.models import mesh as meshes

from .worlds import diffuse, ground, lamp, scene

SIDE, CELL, SEEDS = 32, 4, 48
Place = tuple[_core.Scene, _core.Camera]

WATER = _core.Material("water", "glass", (0.9, 0.95, 1), ior=1.33)
GLASS = _core.Material("glass", "glass", (1, 0.9, 0.8), ior=1.6)
MIRROR = _core.Material("mirror", "specular", (0.9, 0.95, 1), ior=8)


def small_lamp(
    x: float, y: float, z: float, radius: float, radiance: float
) -> tuple[meshes.Mesh, _core.Material]:
    return meshes.disc(radius).flipped().moved(x, y, z), lamp(radiance)


def camera(
    pos: tuple[float, float, float], at: tuple[float, float, float], fov: float, **more: float
) -> _core.Camera:
    direction = tuple(np.subtract(at, pos))
    lens, perspective = more.get("lens", 0), not more.get("panorama", False)
    return _core.Camera(
        pos, direction, (0, 1, 0), fov, lens, np.linalg.norm(direction), perspective, SIDE, SIDE
    )


def ball() -> Place:
    """A lens of few triangles, so that shading normals are far from the geometric ones, seen through a lens."""
    world = scene(
        (ground(8), diffuse(0.7)),
        (meshes.sphere(0.5, 10, 6).moved(y=0.7), GLASS),
        small_lamp(0.7, 2.6, 0.3, 0.6, 10),
    )
    return world, camera((0.3, 1.5, 2.4), (-0.2, 0.0, 0.0), 40, lens=0.08)


def mirrors() -> Place:
    """Two in a row; the second curved by its normals alone."""
    curved = meshes.quad((0.6, 0.1, 0.5), (0.6, 0.1, -0.5), (0.9, 0.9, -0.5), (0.9, 0.9, 0.5))
    bends = np.array([(-1, 0.2, 0.4), (-1, 0.2, -0.4), (-1, 0.6, -0.4), (-1, 0.6, 0.4)])
    curved = replace(curved, normals=bends / np.linalg.norm(bends, axis=1, keepdims=True))
    flat = meshes.quad((-0.8, 0.05, -0.6), (-0.8, 0.05, 0.6), (-1.1, 1.1, 0.6), (-1.1, 1.1, -0.6))
    world = scene(
        (ground(4), diffuse(0.6)), (curved, MIRROR), (flat, MIRROR), small_lamp(-0.1, 1.2, 0, 0.15, 40)
    )
    return world, camera((0, 2, 1.5), (0, 0, 0), 50)


def aquarium() -> Place:
    """Camera and floor under water, where light comes to by one refraction."""
    water = meshes.quad((-2, 0.8, 2), (2, 0.8, 2), (2, 0.8, -2), (-2, 0.8, -2))
    world = scene((ground(4), diffuse(0.7)), (water, WATER), small_lamp(0.5, 2, 0, 0.2, 30))
    return world, camera((0, 0.6, 0.9), (0, 0, 0), 70)


def sunshine() -> Place:
    """Below a sky with a sun, through a prism; a panorama."""
    pixels = np.full((32, 64, 3), 0.3, np.float32)
    pixels[6:9, 20:23] = 80
    prism = meshes.extruded(((-0.4, 0.0), (0.4, 0.0), (0.0, 0.6)), 0.8).moved(y=0.5)
    world = scene((ground(6), diffuse(0.7)), (prism, GLASS), sky=_core.Sky(pixels))
    return world, camera((0.5, 1.4, 1.2), (0, 0.2, 0), 70, panorama=True)


def edge_of_a_panorama() -> Place:
    """The caustic is where the picture's left and right meet, and at its lower edge; of a mirror with two faces."""
    mirror = meshes.quad((0.4, 0.2, 0.3), (0.4, 0.2, -0.3), (0.6, 0.8, -0.3), (0.6, 0.8, 0.3))
    world = scene(
        (ground(6), diffuse(0.7)),
        (meshes.merged([mirror, mirror.flipped()]), MIRROR),
        small_lamp(-0.1, 1.2, 0, 0.1, 60),
    )
    return world, camera((-0.15, 0.7, 0.02), (-1, 0.7, 0.02), 70, panorama=True)


PLACES: dict[str, Callable[[], Place]] = {
    "ball": ball,
    "mirrors": mirrors,
    "aquarium": aquarium,
    "sunshine": sunshine,
    "edge": edge_of_a_panorama,
}


def render(place: Place, traced: bool, spp: int, seed: int = 0, **more: object) -> _core.Renderer:
    settings = {name: more.pop(name) for name in ("sampler", "filter", "threads") if name in more}
    renderer = _core.Renderer(
        *place,
        "Pathtracer",
        {"light_tracing": traced, "path_reuse": False, "max_cam_path_length": 8, "rr_threshold": 0.0} | more,
        seed=seed,
        **{"sampler": "independent", **settings},
    )
    assert renderer.render(spp)
    assert renderer.invalid_count == 0
    assert (renderer.light_paths > 0) == traced
    return renderer


def cells(place: Place, traced: bool, spp: int, **more: object) -> NDArray[np.float64]:
    """(seeds, cells, channels)"""
    images = [render(place, traced, spp, seed + 1000 * traced, **more).mean() for seed in range(SEEDS)]
    n = SIDE // CELL
    return (
        np.asarray(images, np.float64)
        .reshape(SEEDS, n, CELL, n, CELL, 3)
        .mean((2, 4))
        .reshape(SEEDS, n * n, 3)
    )


@pytest.mark.parametrize(
    ("name", "more"),
    [
        *((name, {}) for name in PLACES),
        ("ball", {"filter": "box", "mis": "balance", "path_reuse": True}),
        ("mirrors", {"mis": "none", "light_choice": "power"}),
        ("mirrors", {"max_cam_path_length": 3}),
        ("aquarium", {"rr_threshold": 0.5, "rr_min_path_length": 0}),
        ("sunshine", {"mis": "balance"}),
    ],
)
def test_the_mean_stays(name: str, more: dict[str, object]) -> None:
    """Welch's t-test of each cell of pixels."""
    place = PLACES[name]()
    ours, theirs = cells(place, True, 16, **more), cells(place, False, 96, **more)
    differs = np.maximum(ours.std(0), theirs.std(0)) > 1e-5 * theirs.mean(0)
    ours, theirs = ((images - theirs.mean(0))[:, differs] for images in (ours, theirs))
    p = stats.ttest_ind(ours, theirs, axis=0, equal_var=False).pvalue
    assert p.min() * p.size > 1e-3


def test_caustics_lose_their_noise() -> None:
    """A lamp that paths from the camera hardly ever find."""
    world = scene(
        (ground(8), diffuse(0.7)),
        (meshes.sphere(0.5, 32, 16).moved(y=0.7), GLASS),
        small_lamp(0.7, 2.6, 0.3, 0.02, 1e4),
    )
    place = world, camera((0.3, 1.5, 2.4), (-0.2, 0.0, 0.0), 40)
    images = {
        traced: np.array([render(place, traced, 16, seed, sampler="sobol").mean() for seed in range(12)])
        for traced in (True, False)
    }
    assert 10 * images[True].var(0).mean() < images[False].var(0).mean()


def test_nothing_is_traced_where_that_does_not_pay() -> None:
    pane = meshes.quad((-0.2, 0.01, 0.2), (0.2, 0.01, 0.2), (0.2, 0.01, -0.2), (-0.2, 0.01, -0.2))
    below_a_sky = scene((ground(8), diffuse(0.7)), (pane, GLASS), sky=_core.Sky(intensity=1))
    view = camera((0.3, 1.5, 2.4), (0, 0, 0), 40)
    for world in (below_a_sky, scene((ground(8), diffuse()), small_lamp(0, 2, 0, 0.1, 10))):
        assert _core.Renderer(world, view, "Pathtracer").light_paths == 0
    assert _core.Renderer(*ball(), "Pathtracer").light_paths > 0
    assert _core.Renderer(*ball(), "Pathtracer", {"light_tracing": False}).light_paths == 0
    assert _core.Renderer(*ball(), "NaivePathtracer").light_paths == 0


@pytest.mark.parametrize("image_filter", ["box", "blackman_harris"])
def test_samples_do_not_depend_on_how_they_are_taken(image_filter: str) -> None:
    """By any number of threads, in pieces, coarse pixels first, from the middle on, or again by a replay."""
    world, view = ball()
    settings = {"seed": 3, "filter": image_filter}
    whole = _core.Renderer(world, view, "Pathtracer", threads=2, **settings)
    whole.render(20)
    assert whole.light_paths > 0
    pieces = _core.Renderer(world, view, "Pathtracer", threads=1, **settings)
    for stride in (16, 8, 4, 2):
        pieces.render_coarse(stride)
    for samples in (1, 2, 15, 17, 20):
        pieces.render(samples)
    np.testing.assert_array_equal(whole.mean(), pieces.mean())
    late = _core.Renderer(world, view, "Pathtracer", first_sample=19, **settings)
    late.render(1)
    found = 0
    for y in range(0, SIDE, 5):
        for x in range(SIDE):
            again = _core.replay(whole, x, y, 19)
            assert list(again.radiance) == late.mean()[y, x].tolist()
            assert all(c.from_light and c.edges > 2 for c in again.from_lights)
            found += len(again.from_lights)
    assert found > 0


def test_a_beauty_render_is_the_same_in_pieces() -> None:
    """Its tiles have different numbers of samples, and paths from lights land on all of them."""
    world, view = ball()
    whole = _core.Renderer(world, view, "Pathtracer", {"path_reuse": False}, seed=4, threads=2)
    assert whole.render_until(0.1)
    assert whole.light_paths > 0
    assert len(np.unique(whole.sample_count())) > 1
    pieces = _core.Renderer(world, view, "Pathtracer", {"path_reuse": False}, seed=4, threads=1)
    while not pieces.render_until(0.1, time_limit=0.05):
        pass
    np.testing.assert_array_equal(whole.sum(), pieces.sum())


def test_light_that_camera_paths_never_find_is_traced() -> None:
    """A lamp of a millimetre in a ball of glass."""
    world = scene(
        (ground(4), diffuse(0.7)), (meshes.sphere(0.2).moved(y=0.5), GLASS), small_lamp(0, 0.5, 0, 1e-3, 1e6)
    )
    renderer = _core.Renderer(world, camera((0.3, 1.5, 2.4), (0, 0, 0), 40), "Pathtracer")
    assert renderer.light_paths > 0
    renderer.render(4)
    assert np.median(renderer.mean()) > 0


def test_techniques_and_parts_add_up_to_the_picture() -> None:
    renderer = _core.Renderer(*mirrors(), "Pathtracer", {"path_reuse": False}, seed=5)
    assert renderer.light_paths > 0
    renderer.split(np.zeros((SIDE, SIDE, 2, 2, 3)))
    renderer.render(24)
    np.testing.assert_allclose(renderer.contributions().sum((2, 3)), renderer.sum(), rtol=1e-4, atol=1e-5)
    film = _core.TechniqueFilm(renderer, 10)
    film.render(24)
    np.testing.assert_allclose(film.mean()[0].sum((0, 1)), renderer.mean(), rtol=1e-4, atol=1e-5)


def test_the_filter_spreads_what_lands() -> None:
    """Of both filters the picture has the same light, as each is of area 1."""
    totals = [render(mirrors(), True, 64, filter=name).mean().mean() for name in _core.filters()]
    assert totals[0] == pytest.approx(totals[1], rel=0.02)
