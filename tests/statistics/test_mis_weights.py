"""The weights of light and BSDF sampling add up to 1, and both see the same two densities."""

from __future__ import annotations

import itertools

import numpy as np
import pytest
from bsdf_cases import cases
from light_scenes import LIGHT_CHOICES, REFERENCES, SCENES, choosing, rows, seen
from numpy.typing import NDArray

from etendue import _core

HEURISTICS = next(p.choices for a in _core.algorithms() for p in a.parameters if p.name == "mis")
SURFACES = [case for case in cases(("",), (0.01, 0.1, 0.6)) if case.bsdf != "light"]

# The surface at the reference point faces up: local (x, y, z) is world (x, z, y), mirrored to stay
# right-handed.
TO_LOCAL = np.array([[1, 0, 0], [0, 0, -1], [0, 1, 0]], dtype=np.float32)
WO = np.array([0.6, 0.0, 0.8], dtype=np.float32)


def test_there_are_heuristics() -> None:
    assert {"power", "balance", "none"} <= set(HEURISTICS)


@pytest.mark.parametrize("mis", HEURISTICS)
def test_weights_of_any_pair(mis: str) -> None:
    """
    Whatever two positive densities are: from the least normal float to the largest, and where a product
    would overflow.
    """
    values = np.concatenate([np.geomspace(1.2e-38, 3e38, 400), [1.0, 1e-20, 1e20]]).astype(np.float32)
    a, b = (np.ascontiguousarray(grid.ravel()) for grid in np.meshgrid(values, values))
    light, bsdf = _core.light_sampling_weight(mis, a, b), _core.bsdf_sampling_weight(mis, b, a)
    np.testing.assert_allclose(light.astype(float) + bsdf, 1, atol=2e-7)
    for weight in (light, bsdf):
        assert ((weight >= 0) & (weight <= 1)).all()
    # What the other technique cannot find counts in full.
    zero = np.zeros_like(values)
    assert (_core.light_sampling_weight(mis, values, zero) == 1).all()
    assert (_core.bsdf_sampling_weight(mis, values, zero) == 1).all()
    if mis != "none":
        # A balance of a : b, or of its square.
        x, y = a.astype(float), b.astype(float)
        ratio = np.exp(np.clip((np.log(y) - np.log(x)) * (2 if mis == "power" else 1), -700, 700))
        np.testing.assert_allclose(light, 1 / (1 + ratio), rtol=1e-5, atol=1e-37)


def recorded(
    name: str, which: int, case_index: int, from_light: bool, light_choice: str
) -> tuple[
    NDArray[np.float32], NDArray[np.float32], NDArray[np.float32], NDArray[np.float32], NDArray[np.float32]
]:
    """
    Directions that one technique draws at a vertex and that show a light, with the light's index, the
    density of the technique that drew them as it reports it, and those of both as they are looked up, light
    selection included.
    """
    scene, bsdf, reference = SCENES[name](), SURFACES[case_index].make(), REFERENCES[which]
    n, rng = 3000, np.random.default_rng([which, case_index, from_light])
    there = rows(reference, n)
    own = np.zeros(n, dtype=np.float32)
    if from_light:
        sample = scene.sample_light(
            there, rng.random((n, 2), dtype=np.float32), **choosing(scene, light_choice)
        )
        chosen = sample["index"]
        wi = np.zeros((n, 3), dtype=np.float32)
        for i, light in enumerate(scene.lights):
            # What hides the point that was drawn, another part of the same light even, keeps its light away.
            visible = (chosen == i) & seen(scene, light, reference, sample)
            wi[visible], own[visible] = sample["wi"][visible], sample["pdf"][visible]
    else:
        sample = bsdf.sample(rows(WO, n), rng.random((n, 3), dtype=np.float32))
        wi, own = sample["wi"] @ TO_LOCAL, np.where(sample["type"] > 0, sample["pdf"], 0)
        chosen = np.full(n, -1)
    wi = np.ascontiguousarray(wi)
    good = own > 0
    wi[~good] = [0, 1, 0]
    found, light_pdf = scene.light_pdf(there, wi, **choosing(scene, light_choice))
    found = np.where(light_pdf > 0, found, -1)
    bsdf_pdf = bsdf.pdf(rows(WO, n), np.ascontiguousarray(wi @ TO_LOCAL.T))
    good &= (found == chosen) & (found >= 0) if from_light else found >= 0
    return wi[good], found[good], own[good], light_pdf[good], bsdf_pdf[good]


@pytest.mark.parametrize("name", SCENES)
@pytest.mark.parametrize("mis", [m for m in HEURISTICS if m != "none"])
@pytest.mark.parametrize("light_choice", LIGHT_CHOICES)
def test_recorded_pairs(name: str, mis: str, light_choice: str) -> None:
    """
    At a vertex under each light, of each BSDF: what light sampling weights a direction with and what BSDF
    sampling weights the same direction with add up to 1, though each learns its own density by drawing and
    the other's by looking it up.
    """
    pairs = 0
    for which, case_index in itertools.product((0, 1), range(0, len(SURFACES), 2)):
        for from_light in (True, False):
            _, _, own, light_pdf, bsdf_pdf = recorded(name, which, case_index, from_light, light_choice)
            looked_up = light_pdf if from_light else bsdf_pdf
            same = np.isclose(own, looked_up, rtol=1e-2)
            assert (~same).sum() <= 5 + 0.005 * len(same)  # rays that just miss an edge
            own, light_pdf, bsdf_pdf = own[same], light_pdf[same], bsdf_pdf[same]
            both = bsdf_pdf > 0
            if from_light:
                light, bsdf = (
                    _core.light_sampling_weight(mis, own[both], bsdf_pdf[both]),
                    _core.bsdf_sampling_weight(mis, bsdf_pdf[both], light_pdf[both]),
                )
            else:
                light, bsdf = (
                    _core.light_sampling_weight(mis, light_pdf[both], bsdf_pdf[both]),
                    _core.bsdf_sampling_weight(mis, own[both], light_pdf[both]),
                )
            np.testing.assert_allclose(light.astype(float) + bsdf, 1, atol=6e-3)
            assert np.abs(np.median(light.astype(float) + bsdf) - 1) < 1e-5 if both.any() else True
            pairs += int(both.sum())
    assert pairs > 100
