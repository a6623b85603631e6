"""Étendue against an independent judge: Mitsuba 3 renders the same arrays, and the pictures must agree.

Both render a world REPEATS times with independent seeds. The repeats give the mean of the image, and of each
tile, an honest spread, so agreement is a matter of statistics alone: no tolerance. Where they part, one of them
is wrong.
"""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy import stats

from etendue import _core

from . import ours
from .worlds import SIZE, WORLDS, sky

REPEATS, TILE = 16, 8
# Of each test of a distribution; means are held to 3 standard errors.
FALSE_ALARMS = 1e-3
LUMINANCE = np.array([0.2126, 0.7152, 0.0722])

pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def theirs():
    pytest.importorskip(
        "mitsuba", reason="Mitsuba is not installed; ./test --slow installs it (the extra `judge`)"
    )
    from . import theirs

    return theirs


@cache
def pair(name: str) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    from . import theirs

    world = WORLDS[name]()
    return ours.render(world, range(REPEATS)), theirs.render(world, range(REPEATS))


def mean_errors(a: NDArray[np.float64], b: NDArray[np.float64]) -> NDArray[np.float64]:
    """The difference of the images' means, one a channel, in standard errors."""
    means = [images.mean((1, 2)) for images in (a, b)]
    error = np.sqrt(sum(m.var(0, ddof=1) for m in means) / REPEATS)
    return (means[0].mean(0) - means[1].mean(0)) / error


def tile_scores(a: NDArray[np.float64], b: NDArray[np.float64]) -> NDArray[np.float64]:
    """z-scores of the tiles' luminance: Welch's t, sent through its distribution to a standard normal one."""

    def tiles(images: NDArray[np.float64]) -> NDArray[np.float64]:
        n = SIZE // TILE
        return (images @ LUMINANCE).reshape(REPEATS, n, TILE, n, TILE).mean((2, 4)).reshape(REPEATS, -1)

    x, y = tiles(a), tiles(b)
    seen = (x.std(0) > 0) | (y.std(0) > 0)
    assert np.allclose(x[:, ~seen], y[:, ~seen], rtol=1e-5)
    welch = stats.ttest_ind(x[:, seen], y[:, seen], equal_var=False)
    return np.asarray(stats.norm.ppf(stats.t.cdf(welch.statistic, welch.df)))


def verdict(a: NDArray[np.float64], b: NDArray[np.float64]) -> list[str]:
    """What is wrong with the claim that both are pictures of one world."""
    complaints = []
    means = mean_errors(a, b)
    if np.abs(means).max() > 3:
        complaints.append(f"the means differ by {means.round(2)} standard errors")
    z = tile_scores(a, b)
    p = stats.kstest(z, "norm").pvalue
    if p < FALSE_ALARMS:
        complaints.append(f"the tiles' z-scores are not normal (Kolmogorov-Smirnov, p = {p:.2g})")
    low, high = stats.chi2.ppf([FALSE_ALARMS / 2, 1 - FALSE_ALARMS / 2], len(z)) / len(z)
    spread = float(np.mean(z**2))
    if not low < spread < high:
        complaints.append(
            f"the tiles' z-scores have variance {spread:.2f}, not one of {low:.2f} to {high:.2f}"
        )
    worst = float(np.abs(z).max())
    if 2 * stats.norm.sf(worst) * len(z) < FALSE_ALARMS:
        complaints.append(f"a tile is off by {worst:.1f} standard errors")
    return complaints


@pytest.mark.parametrize("name", WORLDS)
def test_same_picture(name: str, theirs) -> None:
    a, b = pair(name)
    assert verdict(a, b) == []


@pytest.mark.parametrize("fault", ["brighter by 1%", "a tile brighter by 10%", "turned round"])
def test_a_small_fault_would_be_seen(fault: str, theirs) -> None:
    a, b = pair("box")
    wrong = a.copy()
    if fault == "brighter by 1%":
        wrong *= 1.01
    elif fault == "turned round":
        wrong = wrong[:, :, ::-1]
    else:
        wrong[:, 32:40, 32:40] *= 1.1
    assert verdict(wrong, b)


def directions(count: int, seed: int) -> NDArray[np.float32]:
    d = np.random.default_rng(seed).normal(size=(count, 3))
    return (d / np.linalg.norm(d, axis=1, keepdims=True)).astype(np.float32)


def test_the_sky_is_the_same_function(theirs) -> None:
    """Orientation and interpolation, so that the worlds are known to be equal before their pictures meet."""
    import drjit
    import mitsuba as mi

    pixels = sky()
    emitter = theirs.sky_emitter(pixels)
    scene = mi.load_dict({"type": "scene", "sky": emitter})
    lamp = _core.Scene([], [], [], _core.Sky(pixels)).lights[0]
    wi = directions(500, 1)
    expected = lamp.Le(np.zeros_like(wi), wi)
    for direction, radiance in zip(wi, expected, strict=True):
        point = drjit.zeros(mi.SurfaceInteraction3f)
        point.wi = mi.Vector3f(*(-direction.astype(float)))
        seen = np.array(scene.environment().eval(point))
        assert seen == pytest.approx(radiance, rel=2e-3, abs=1e-3)


def smith_lambda(w: NDArray[np.float32], alpha: float) -> NDArray[np.float64]:
    cos2 = w[:, 2].astype(float) ** 2
    return (np.sqrt(1 + alpha**2 * (1 - cos2) / cos2) - 1) / 2


@pytest.mark.parametrize("kind", ["diffuse", "translucent", "metal"])
def test_bsdf_values(kind: str, theirs) -> None:
    """The same values from both; a metal's but for masking, which Mitsuba does not correlate with shadowing."""
    import drjit
    import mitsuba as mi

    from .worlds import Look

    look = Look(kind, (0.9, 0.6, 0.3), ior=0.4, absorb=2.4, roughness=0.3)
    judge = mi.load_dict(theirs._bsdf(look))
    own = _core.Bsdf(kind, look.albedo, ior=look.ior, roughness=look.roughness, absorb=look.absorb)
    wo, wi = directions(400, 2), directions(400, 3)
    wo[:, 2] = np.abs(wo[:, 2])
    if kind == "metal":
        wi[:, 2] = np.abs(wi[:, 2])
    f = own.f(wo, wi).astype(float)
    if kind == "metal":
        o, i = smith_lambda(wo, look.roughness), smith_lambda(wi, look.roughness)
        f *= ((1 + o + i) / ((1 + o) * (1 + i)))[:, None]
    for a, b, value in zip(wo.astype(float), wi.astype(float), f, strict=True):
        point = drjit.zeros(mi.SurfaceInteraction3f)
        point.wi = mi.Vector3f(*a)
        seen = np.array(judge.eval(mi.BSDFContext(), point, mi.Vector3f(*b)))
        assert seen == pytest.approx(value * abs(b[2]), rel=2e-4, abs=1e-6)
