"""Scenes whose radiance is known: every estimator must give it, by t-test over independent pixels.

Each camera sees one point, so that pixels are independent estimates of one number. One false alarm in a
thousand runs of the whole file is allowed for (Sidak over its tests), and seeds are fixed, so a failure is a
fault.
"""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy import stats

from etendue import _core
from etendue.models import mesh as meshes

from .worlds import Estimator, diffuse, estimators, full_transport, ground, lamp, looking, scene

FALSE_ALARMS = 1e-3
TESTS = 1100  # a bound on how many t-tests this file makes
ALPHA = 1 - (1 - FALSE_ALARMS) ** (1 / TESTS)
# What meshes differ from the round bodies they stand for, and float from real numbers, relative.
MODEL_ERROR = 2e-4

any_estimator = pytest.mark.parametrize("estimator", list(estimators()), ids=str)
full_estimator = pytest.mark.parametrize("estimator", full_transport(), ids=str)


def expect(renderer: _core.Renderer, expected: float, model_error: float = MODEL_ERROR) -> None:
    """A two-sided t-test of the pixels' mean, all of one colour, against the expected radiance.

    Pixels that share paths count as if they were one: at worst their errors are the same.
    """
    pixels = renderer.mean()[..., 0].astype(float).ravel()
    independent = len(pixels) / renderer.sharing
    error = pixels.std(ddof=1) / math.sqrt(independent)
    excess = max(abs(pixels.mean() - expected) - model_error * expected, 0)
    if excess == 0:
        return
    p = 2 * stats.t.sf(excess / error, independent - 1) if error > 0 else 0
    assert p > ALPHA, f"{pixels.mean():.6g} ± {error:.2g} instead of {expected:.6g} (p = {p:.2g})"


@any_estimator
@pytest.mark.parametrize("albedo", [0.5, 0.8])
@pytest.mark.parametrize("edges", [1, 2, 3, 200])
def test_furnace(estimator: Estimator, albedo: float, edges: int) -> None:
    """In a closed box of albedo a and emission 1, n edges see 1 + a + ... + a^(n-1)."""
    taken = min(edges, estimator.longest_path or edges)
    box = scene((meshes.box(2, 2, 2).moved(1, 1, 1).flipped(), diffuse(albedo, emission=1)))
    renderer = estimator.render(box, looking((0.9, 1.1, 1), (0, 0.7, 0.6)), spp=128, edges=edges)
    expect(renderer, (1 - albedo**taken) / (1 - albedo))


@any_estimator
@pytest.mark.parametrize("textured", [False, True], ids=["white", "image"])
def test_uniform_sky_over_a_plane(estimator: Estimator, textured: bool) -> None:
    """Radiance L from everywhere above a Lambertian plane leaves it as albedo L."""
    pixels = np.full((8, 16, 3), 3.0, np.float32) if textured else None
    world = scene((ground(2), diffuse(0.6)), sky=_core.Sky(pixels, intensity=1 if textured else 3))
    expect(estimator.render(world, looking((0.3, 1, 0.2), (0.1, 0, 0)), spp=64), 0.6 * 3)


def irradiance_from_above(light: _core.Light) -> float:
    """Of a plane facing up, by quadrature over the sky: the midpoint rule in cos^2 theta and phi."""
    n = 1024
    r = np.sqrt((np.arange(n) + 0.5) / n)
    phi = 2 * np.pi * (np.arange(2 * n) + 0.5) / (2 * n)
    radius, angle = (grid.ravel() for grid in np.meshgrid(r, phi))
    up = np.stack([radius * np.cos(angle), np.sqrt(1 - radius**2), radius * np.sin(angle)], axis=1)
    return math.pi * float(
        light.Le(np.full(up.shape, [0, 1, 0], np.float32), up.astype(np.float32))[:, 0].mean()
    )


@any_estimator
def test_uneven_sky_over_a_plane(estimator: Estimator) -> None:
    """Bright and dim parts, each of which a technique may leave to the other: E leaves as albedo E / pi."""
    pixels = np.random.default_rng(4).random((16, 32, 1)).astype(np.float32) ** 3 + 0.05
    pixels[4:6, 7:10] = 12
    world = scene((ground(2), diffuse(0.6)), sky=_core.Sky(np.repeat(pixels, 3, axis=2)))
    expected = 0.6 / math.pi * irradiance_from_above(world.lights[0])
    expect(estimator.render(world, looking((0.3, 1, 0.2), (0.1, 0, 0)), spp=256), expected)


@any_estimator
def test_disc_over_a_plane(estimator: Estimator) -> None:
    """Below the middle of a parallel disc: E = pi L R^2 / (R^2 + h^2)."""
    radius, height = 0.7, 1.1
    disc = meshes.disc(radius, 512).turned("x", 180).moved(y=height)
    world = scene((ground(4), diffuse(0.5)), (disc, lamp(5)))
    renderer = estimator.render(world, looking((1.5, 0.5, 0), (0, 0, 0)), spp=256)
    expect(renderer, 0.5 * 5 * radius**2 / (radius**2 + height**2))


@any_estimator
def test_sphere_over_a_plane(estimator: Estimator) -> None:
    """Under a sphere at distance d: E = pi L (R / d)^2 cos theta, wherever it is wholly above the horizon."""
    radius, centre = 0.5, np.array([0.6, 1.2, 0.0])
    # The polyhedron's outline is a little inside the sphere's: by cos(pi / n), corrected in its radius.
    sphere = meshes.sphere(radius / math.sqrt(math.cos(math.pi / 256)), 256, 128).flat().moved(*centre)
    world = scene((ground(8), diffuse(0.5)), (sphere, lamp(4)))
    renderer = estimator.render(world, looking((-1.5, 0.5, 0), (0, 0, 0)), spp=256)
    d2 = centre @ centre
    expect(renderer, 0.5 * 4 * radius**2 / d2 * centre[1] / math.sqrt(d2))


@any_estimator
@pytest.mark.parametrize("hidden", [False, True], ids=["both", "one-hidden"])
def test_two_lamps(estimator: Estimator, hidden: bool) -> None:
    """Light of two unlike discs adds up; a black card in front of one takes its share away."""
    lamps = [(0.3, 1.0, 8.0, -0.8), (0.6, 1.0, 1.5, 0.9)]  # radius, height, radiance, x
    parts = [(ground(8), diffuse(0.5))]
    expected = 0.0
    for radius, height, radiance, x in lamps:
        parts.append((meshes.disc(radius, 512).turned("x", 180).moved(x, height), lamp(radiance)))
        if not (hidden and x > 0):
            # Of a disc whose middle is x away (Howell, B-13).
            r, h = radius / abs(x), height / abs(x)
            z = 1 + h**2 + r**2
            expected += 0.5 * radiance * 0.5 * (1 - (1 + h**2 - r**2) / math.sqrt(z**2 - 4 * r**2))
    if hidden:
        parts.append((meshes.box(1.2, 0.05, 2).moved(0.75, 0.5), diffuse(0.001)))
    renderer = estimator.render(scene(*parts), looking((-1.5, 0.3, 0), (0, 0, 0)), spp=512, edges=2)
    expect(renderer, expected)


@any_estimator
def test_back_of_a_lamp_is_dark(estimator: Estimator) -> None:
    """A lamp that faces away gives nothing, by any technique."""
    world = scene((ground(2), diffuse(0.5)), (meshes.disc(0.7).moved(y=1), lamp(5)))
    assert estimator.render(world, looking((1.5, 0.5, 0), (0, 0, 0)), spp=16).mean().max() == 0


@any_estimator
@pytest.mark.parametrize("albedo", [0.3, 0.9])
def test_one_bounce_between_parallel_plates(estimator: Estimator, albedo: float) -> None:
    """Under a rectangle the form factors of its four corners' rectangles (Howell, B-3) add up."""
    height, x0, x1, z0, z1 = 0.8, -0.4, 1.0, -0.7, 0.5
    plate = meshes.quad((x0, height, z0), (x1, height, z0), (x1, height, z1), (x0, height, z1))
    world = scene((ground(6), diffuse(albedo)), (plate, lamp(2)))

    def corner(x: float, z: float) -> float:
        a, b = x / height, z / height
        p, q = math.hypot(1, a), math.hypot(1, b)
        return (a / p * math.atan(b / p) + b / q * math.atan(a / q)) / (2 * math.pi)

    factor = sum(corner(abs(x), abs(z)) for x in (x0, x1) for z in (z0, z1))
    renderer = estimator.render(world, looking((2, 0.5, 0), (0, 0, 0)), spp=256, edges=2)
    expect(renderer, albedo * 2 * factor)


def fresnel(cos_i: float, eta: float) -> float:
    cos_t = math.sqrt(1 - (1 - cos_i**2) / eta**2)
    parallel = (eta * cos_i - cos_t) / (eta * cos_i + cos_t)
    perpendicular = (cos_i - eta * cos_t) / (cos_i + eta * cos_t)
    return (parallel**2 + perpendicular**2) / 2


@full_estimator
@pytest.mark.parametrize("bounces", [1, 2, 5])
def test_mirrors(estimator: Estimator, bounces: int) -> None:
    """A ray zigzags between two mirrors and leaves to a white sky: the product of their reflectances."""
    ior, tint = 8.0, 0.9
    mirror = _core.Material("m", "specular", (tint,) * 3, ior=ior)
    low = meshes.quad((-9, 0, 9), (bounces - 0.5, 0, 9), (bounces - 0.5, 0, -9), (-9, 0, -9))
    high = low.moved(y=1).flipped()
    world = scene((low, mirror), (high, mirror), sky=_core.Sky(intensity=2))
    # Down and to the right at 45 degrees, one unit along x a bounce.
    renderer = estimator.render(world, looking((-0.5, 0.5, 0), (0, 0, 0)), spp=64, edges=12)
    expect(renderer, 2 * (tint * fresnel(math.sqrt(0.5), ior)) ** bounces)


@full_estimator
@pytest.mark.parametrize("slabs", [1, 3])
def test_glass_slabs(estimator: Estimator, slabs: int) -> None:
    """Through n slabs of glass: of 2n surfaces, all interreflections summed, (1 - F) / (1 + (2n - 1) F)."""
    ior = 1.6
    glass = _core.Material("g", "glass", (1, 1, 1), ior=ior)
    plates = [meshes.box(400, 0.1, 400).moved(y=0.3 * i) for i in range(slabs)]
    # A lamp above, and black below, so that what is reflected is lost.
    lid = meshes.quad((-900, 2, -900), (900, 2, -900), (900, 2, 900), (-900, 2, 900))
    world = scene((meshes.merged(plates), glass), (lid, lamp(3)))
    camera = looking((0, -1, 0), (0.7, 0, 0.2))
    cos_i = 1 / math.hypot(1, 0.7, 0.2)
    f = fresnel(cos_i, ior)
    renderer = estimator.render(world, camera, spp=512, edges=100)
    expect(renderer, 3 * (1 - f) / (1 + (2 * slabs - 1) * f), model_error=1e-3)


@full_estimator
def test_lamp_inside_glass(estimator: Estimator) -> None:
    """A path that enters glass carries radiance divided by n^2: (1 - F) L / n^2 here."""
    ior = 1.5
    pane = ground(400, y=0)
    bottom = ground(400, y=-0.5)
    glass = _core.Material("g", "glass", (1, 1, 1), ior=ior)
    world = scene((pane, glass), (bottom, lamp(2)))
    renderer = estimator.render(world, looking((0, 1, 0), (0, 0, 0.01)), spp=256)
    expect(renderer, 2 * (1 - fresnel(1 / math.hypot(1, 0.01), ior)) / ior**2)
