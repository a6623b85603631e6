"""Lights, and triangles of them, are chosen with the probability that light_source_pdf says."""

from __future__ import annotations

import itertools

import numpy as np
import pytest
from light_scenes import GREY, LIGHT_CHOICES, REFERENCES, SCENES, choosing, lamp, mesh, rows, sky, square
from numpy.typing import NDArray
from stats import chi_square, sidak

from etendue import _core


def many_lamps() -> _core.Scene:
    """Forty lamps of powers over six orders of magnitude, two of them dark, and a sky."""
    strengths = np.geomspace(1e-3, 1e3, 38)
    materials = [lamp(emissive_strength=float(s)) for s in strengths] + [lamp(albedo=(0, 0, 0))] * 2
    meshes = [square(2 + i, 1.0 / (1 + i), i) for i in range(40)]
    return _core.Scene(meshes, materials, sky=_core.Sky(None, 0.5))


def sphere_of_lamps() -> _core.Scene:
    """500 triangles that face everywhere, in clusters of all sizes, areas and strengths."""
    rng = np.random.default_rng(12)
    meshes, strengths = [], np.geomspace(0.1, 100, 10)
    for i in range(10):
        centre = rng.normal(0, 4, 3)
        corners = (
            centre + rng.normal(0, 0.5, (50, 1, 3)) + rng.normal(0, 10 ** rng.uniform(-2, -0.5), (50, 3, 3))
        )
        meshes.append(mesh(corners.reshape(-1, 3), np.arange(150).reshape(-1, 3), material=i))
    return _core.Scene(meshes, [lamp(emissive_strength=float(s)) for s in strengths])


def lamps_and_hardly_a_sky(strength: float) -> _core.Scene:
    """Of a sky that is so much less than the lamps that shares of both round to 0 and 1."""
    materials = [lamp(emissive_strength=1e15), lamp(emissive_strength=3e15)]
    return _core.Scene([square(2, 1, 0), square(3, 1, 1)], materials, sky=_core.Sky(None, strength))


ALL = SCENES | {
    "many_lamps": many_lamps,
    "sphere_of_lamps": sphere_of_lamps,
}
# Of these, shares of power are no numbers to compare with.
EXTREME = {
    "hardly_a_sky": lambda: lamps_and_hardly_a_sky(0.01),
    "less_of_a_sky": lambda: lamps_and_hardly_a_sky(1e-8),
    "black_sky": lambda: lamps_and_hardly_a_sky(0),
}


def triangles(scene: _core.Scene) -> list[tuple[int, int]]:
    """(light, triangle) of all; what has no mesh has one, of number 0."""
    return [(i, t) for i, light in enumerate(scene.lights) for t in range(light.triangle_count)]


def probabilities(scene: _core.Scene, reference: NDArray[np.float32], kind: str) -> NDArray[np.float64]:
    choice = choosing(scene, kind)
    return np.array(
        [scene.light_source_pdf(reference[None], i, t, **choice)[0] for i, t in triangles(scene)], dtype=float
    )


@pytest.mark.parametrize("kind", LIGHT_CHOICES)
@pytest.mark.parametrize("name", ALL | EXTREME)
def test_frequencies(name: str, kind: str) -> None:
    scene = (ALL | EXTREME)[name]()
    number = {which: n for n, which in enumerate(triangles(scene))}
    for reference in REFERENCES:
        expected = probabilities(scene, reference, kind)
        # The tree may lead to where no light can come from, and then chooses none.
        failed = 1 - expected.sum()
        assert failed > -1e-5
        assert kind != "power" or failed < 1e-5
        n = 100_000
        u = np.random.default_rng(1).random(n, dtype=np.float32)
        index, triangle, pdf = scene.sample_light_source(rows(reference, n), u, **choosing(scene, kind))
        chosen = np.array(
            [number.get(which, -1) for which in zip(index.tolist(), triangle.tolist(), strict=True)]
        )
        counts = np.bincount(chosen + 1, minlength=len(number) + 1)
        all_of_them = np.concatenate([[max(failed, 0)], expected])
        assert chi_square(counts, all_of_them * n).p > sidak(
            len(ALL | EXTREME) * len(LIGHT_CHOICES) * len(REFERENCES)
        )
        np.testing.assert_allclose(pdf[chosen >= 0], expected[chosen[chosen >= 0]], rtol=1e-5)
        assert not pdf[chosen < 0].any()


@pytest.mark.parametrize("kind", LIGHT_CHOICES)
@pytest.mark.parametrize("name", ALL)
def test_even_numbers_choose_evenly(name: str, kind: str) -> None:
    """Numbers that fill [0, 1) evenly choose each triangle as often as they can, to one."""
    scene = ALL[name]()
    for reference in REFERENCES[:2]:
        u = ((np.arange(2**16) + 0.5) / 2**16).astype(np.float32)
        index, triangle, _ = scene.sample_light_source(rows(reference, len(u)), u, **choosing(scene, kind))
        for (i, t), p in zip(triangles(scene), probabilities(scene, reference, kind), strict=True):
            assert abs(((index == i) & (triangle == t)).sum() - p * 2**16) <= 1.1
        ends = np.array([0, 1e-30, 1 - 2**-24], dtype=np.float32)
        index, triangle, pdf = scene.sample_light_source(rows(reference, 3), ends, **choosing(scene, kind))
        assert (pdf[index >= 0] > 0).all()


@pytest.mark.parametrize("name", ALL)
def test_by_power(name: str) -> None:
    """A light's triangles have its share of the power, wherever they are looked at from."""
    scene = ALL[name]()
    powers = np.array([light.power for light in scene.lights], dtype=float)
    for reference in REFERENCES:
        share = np.zeros(len(powers))
        for (i, _), p in zip(triangles(scene), probabilities(scene, reference, "power"), strict=True):
            share[i] += p
        np.testing.assert_allclose(share, powers / powers.sum(), rtol=1e-4)


@pytest.mark.parametrize("name", ALL)
def test_the_tree_leaves_out_no_light(name: str) -> None:
    """What can shine on a point, as samples by power show, may be chosen there."""
    scene = ALL[name]()
    rng = np.random.default_rng(3)
    references = np.concatenate([REFERENCES, rng.normal(0, 3, (40, 3)).astype(np.float32)])
    for reference, light_index in itertools.product(references, range(len(scene.lights))):
        light = scene.lights[light_index]
        if light.power == 0:
            continue
        u = rng.random((2000, 2), dtype=np.float32)
        sample = light.sample_Li(rows(reference, len(u)), u)
        shines = (sample["pdf"] > 0) & (sample["radiance"] > 0).any(axis=1)
        assert sample["triangle"].min() >= 0
        for t in np.unique(sample["triangle"][shines]):
            assert scene.light_source_pdf(reference[None], light_index, int(t), "tree")[0] > 0


def test_the_tree_prefers_what_is_near_and_faces_the_point() -> None:
    """On a quarter of the distance 16 times as often; what shows its back never."""
    near_and_far = _core.Scene(
        [
            square(10, 0.1),
            square(40, 0.1, 1),
            mesh([(-1, 5, 0), (1, 5, 0), (0, 5, 1)], [(0, 2, 1)], material=2),
        ],
        [lamp()] * 3,
    )
    p = probabilities(near_and_far, np.zeros(3, np.float32), "tree")
    assert p[:2].sum() / p[2:4].sum() == pytest.approx(16, rel=0.01)
    assert p[4] == 0
    assert p.sum() == pytest.approx(1, abs=1e-5)


@pytest.mark.parametrize("kind", LIGHT_CHOICES)
@pytest.mark.parametrize("strength", [1e30, 1e38, np.inf])
def test_lamps_brighter_than_numbers(kind: str, strength: float) -> None:
    """Their choice, and the points on them, stay numbers, far away and on the lamp itself."""
    world = _core.Scene([square(), square(3, 2, 1)], [lamp(emissive_strength=strength), lamp()])
    on_it = np.array([0.2, 2, 0.1], np.float32)
    rng = np.random.default_rng(8)
    for reference in (*REFERENCES, on_it):
        u = rng.random((500, 2), dtype=np.float32)
        sample = world.sample_light(rows(reference, 500), u, **choosing(world, kind))
        assert np.isfinite(sample["position"]).all()
        assert np.isfinite(sample["wi"]).all()
        assert np.isfinite(probabilities(world, reference, kind)).all()


def test_factors_keep_their_ratios() -> None:
    rng = np.random.default_rng(3)
    slots = np.exp2(rng.uniform(-7.5, 0, (17, 16))).astype(np.float32)
    slots[:, 0] = 1
    slots[1] *= 1e30
    slots[2, 1:] = 1e-30
    learned = _core.LightFactors(0.5, slots[0].tolist(), slots[1:].tolist())
    kept = np.array([learned.root, *learned.below])
    expected = slots / slots.max(axis=1, keepdims=True)
    assert kept[[0, *range(3, 17)]] == pytest.approx(expected[[0, *range(3, 17)]], rel=1 / 63)
    assert kept[1] == pytest.approx(expected[1], rel=1 / 63)
    # What is left of none at all, so that no light is left out.
    assert (kept[2, 1:] > 0).all()
    assert kept[2, 1:] == pytest.approx(2.0**-8, rel=0.05)


def test_powers() -> None:
    """
    Luminance of the radiance x pi x area; of a sky, x 4 pi x the cross-section of the sphere around the
    scene.
    """
    weights = np.array([0.2126, 0.7152, 0.0722])
    lamps = _core.Scene([square(2, 1.5)], [lamp(albedo=(1, 0.5, 0.1), emissive_strength=3)])
    assert lamps.lights[0].power == pytest.approx(3 * np.pi * 9 * (weights @ [1, 0.5, 0.1]), rel=1e-5)
    textured = SCENES["textured"]().lights[0]
    u = np.random.default_rng(2).random((200_000, 2), dtype=np.float32)
    radiance = textured.sample_Li(np.zeros((len(u), 3), np.float32), u)["radiance"]
    assert textured.power == pytest.approx(float((radiance @ weights).mean()) * np.pi * 4, rel=0.01)
    pixels = np.random.default_rng(3).random((16, 32, 3))
    shining = _core.Scene(
        [square()], [GREY], sky=_core.Sky(pixels.astype(np.float32), 2.0, radius=3.0)
    ).lights[0]
    v = np.random.default_rng(4).normal(size=(200_000, 3))
    v = (v / np.linalg.norm(v, axis=1, keepdims=True)).astype(np.float32)
    v = v[v[:, 1] < 0]
    mirrored = v * np.array([1, -1, 1], dtype=np.float32)
    from_below = np.repeat(np.array([[0, 0, 0]], np.float32), len(v), axis=0)
    from_above = np.repeat(np.array([[0, 9, 0]], np.float32), len(v), axis=0)
    mean = (shining.Le(from_below, v).mean(axis=0) + shining.Le(from_above, mirrored).mean(axis=0)) / 2
    assert shining.power == pytest.approx(float(mean @ weights) * 4 * np.pi * np.pi * 9, rel=0.02)


def test_without_light_nothing_is_chosen() -> None:
    for scene in (
        _core.Scene([square()], [GREY]),
        sky(np.zeros((2, 4, 3))),
        _core.Scene([square()], [lamp(albedo=(0, 0, 0))]),
    ):
        for kind in LIGHT_CHOICES:
            u = np.array([0, 0.5, 0.99], np.float32)
            reference = np.zeros((3, 3), np.float32)
            index, triangle, pdf = scene.sample_light_source(reference, u, **choosing(scene, kind))
            assert (index == -1).all()
            assert (triangle == -1).all()
            assert not pdf.any()
