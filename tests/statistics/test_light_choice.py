"""Lights are chosen with the probability that light_source_pdf says, which is their share of the power."""

from __future__ import annotations

import numpy as np
import pytest
from light_scenes import GREY, SCENES, lamp, sky, square
from stats import chi_square, sidak

from etendue import _core


def many_lamps() -> _core.Scene:
    """Forty lamps of powers over six orders of magnitude, two of them dark, and a sky."""
    strengths = np.geomspace(1e-3, 1e3, 38)
    materials = [lamp(emissive_strength=float(s)) for s in strengths] + [lamp(albedo=(0, 0, 0))] * 2
    meshes = [square(2 + i, 1.0 / (1 + i), i) for i in range(40)]
    return _core.Scene(meshes, materials, sky=_core.Sky(None, 0.5))


ALL = SCENES | {"many_lamps": many_lamps}


@pytest.mark.parametrize("name", ALL)
def test_frequencies(name: str) -> None:
    scene = ALL[name]()
    probabilities = np.array([scene.light_source_pdf(i) for i in range(len(scene.lights))], dtype=float)
    powers = np.array([light.power for light in scene.lights], dtype=float)
    np.testing.assert_allclose(probabilities, powers / powers.sum(), rtol=1e-5)
    assert probabilities.sum() == pytest.approx(1, abs=1e-6)
    u = np.random.default_rng(1).random(200_000, dtype=np.float32)
    index, pdf = scene.sample_light_source(u)
    counts = np.bincount(index, minlength=len(powers))
    assert chi_square(counts, probabilities * len(u)).p > sidak(len(ALL))
    np.testing.assert_allclose(pdf, probabilities[index], rtol=1e-6)
    # Numbers that fill [0, 1) evenly choose each light as often as they can, to one.
    index, _ = scene.sample_light_source(((np.arange(2**16) + 0.5) / 2**16).astype(np.float32))
    assert np.abs(np.bincount(index, minlength=len(powers)) - probabilities * 2**16).max() <= 1
    ends = np.array([0, 1e-30, 1 - 2**-24], dtype=np.float32)
    index, pdf = scene.sample_light_source(ends)
    assert (probabilities[index] > 0).all()
    assert (pdf > 0).all()


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
        index, pdf = scene.sample_light_source(np.array([0, 0.5, 0.99], np.float32))
        assert (index == -1).all()
        assert not pdf.any()
