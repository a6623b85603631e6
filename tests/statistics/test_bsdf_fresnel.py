"""
Reflectances of Fresnel against independent formulas and known values, Snell's law, and the choice between
delta lobes.
"""

from __future__ import annotations

import numpy as np
import pytest
from bsdf_cases import ANGLES, Case, direction, draw, rows
from numpy.typing import NDArray
from scipy.stats import binomtest
from stats import sidak

from etendue import _core

INDICES = (1.0, 1.01, 1.3, 1.33, 1.52, 2.42, 0.75, 1 / 1.5, 0.15)
DELTA = [name for name in _core.bsdfs() if _core.Bsdf(name).is_delta]


def fresnel(cosine: NDArray[np.float64] | float, index: complex) -> NDArray[np.float64]:
    """
    Unpolarised reflectance from the amplitudes of Born and Wolf 1.5.2 in complex numbers, index relative to
    this side.
    """
    c = np.asarray(cosine, dtype=complex)
    t = np.sqrt(index**2 - 1 + c**2)  # index times the cosine in there
    across, along = (c - t) / (c + t), (index**2 * c - t) / (index**2 * c + t)
    return (np.abs(across) ** 2 + np.abs(along) ** 2) / 2


def dielectric(angle: float, ior: float) -> float:
    """What the core makes of it: the weight of the mirror."""
    mirror = _core.Bsdf("specular", albedo=(1, 1, 1), ior=ior)
    return float(mirror.sample(direction(angle)[None], np.zeros((1, 3), np.float32))["weight"][0, 0])


def conductor(angle: float, ior: float, absorb: float) -> float:
    """
    The core's reflectance of a facet: what metal reflects to the mirror direction, over what the same lobe
    does for certain.
    """
    # An index of 1e-3 is past its critical angle anywhere but at the normal, so that everything is reflected.
    metal, whole = (
        _core.Bsdf(name, albedo=(1, 1, 1), ior=n, absorb=absorb, roughness=0.5)
        for name, n in (("metal", ior), ("microfacet", 1e-3))
    )
    wo = direction(angle)[None]
    wi = wo * np.array([-1, -1, 1], dtype=np.float32)
    return float(metal.f(wo, wi)[0, 0] / whole.f(wo, wi)[0, 0])


@pytest.mark.parametrize("ior", INDICES)
def test_dielectric(ior: float) -> None:
    for angle in np.linspace(0, 89.9, 300):
        cosine = float(direction(angle)[2])
        # Next to the critical angle the slope is infinite.
        slack = 2e-3 if ior < 1 and abs(np.sqrt(1 - cosine**2) - ior) < 1e-3 else 2e-6
        assert dielectric(angle, ior) == pytest.approx(float(fresnel(cosine, ior)), abs=slack)


def test_known_values() -> None:
    assert dielectric(0, 1.5) == pytest.approx(0.04, abs=1e-6)
    assert dielectric(0, 1.33) == pytest.approx((0.33 / 2.33) ** 2, abs=1e-6)
    # At Brewster's angle light polarised in the plane is all let through.
    assert dielectric(np.degrees(np.arctan(1.5)), 1.5) == pytest.approx(
        ((1.5**2 - 1) / (1.5**2 + 1)) ** 2 / 2, abs=1e-6
    )
    # The critical angle from glass to air is 41.81 degrees.
    assert dielectric(41.82, 1 / 1.5) == 1
    assert dielectric(41.70, 1 / 1.5) < 0.9
    assert dielectric(89.9999, 1.5) == pytest.approx(1, abs=1e-4)
    # Gold as the table has it, at the normal: ((n - 1)^2 + k^2) / ((n + 1)^2 + k^2).
    assert conductor(0.1, 0.75, 2.12) == pytest.approx((0.25**2 + 2.12**2) / (1.75**2 + 2.12**2), abs=2e-5)


@pytest.mark.parametrize(
    ("ior", "absorb"), [(0.75, 2.12), (0.15, 2.75), (1.12, 2.5), (2.42, 0.95), (1.0, 0.1), (5.0, 10.0)]
)
def test_conductor(ior: float, absorb: float) -> None:
    for angle in np.linspace(1, 89.9, 200):
        expected = fresnel(float(direction(angle)[2]), complex(ior, absorb))
        assert conductor(angle, ior, absorb) == pytest.approx(float(expected), abs=5e-6)


@pytest.mark.parametrize("ior", [1.01, 1.5, 2.42])
def test_conductor_that_absorbs_nothing_is_a_dielectric(ior: float) -> None:
    for angle in np.linspace(1, 89.9, 100):
        assert conductor(angle, ior, 0.0) == pytest.approx(dielectric(angle, ior), abs=5e-6)


@pytest.mark.parametrize("name", DELTA)
@pytest.mark.parametrize("front", [True, False])
@pytest.mark.parametrize("ior", [1.0, 1.33, 1.52, 2.42])
def test_delta_lobes(name: str, front: bool, ior: float) -> None:
    """
    Each lobe is one direction, and is chosen as often as `pdf` says; the mirror and the refraction are
    where they must be.
    """
    bsdf = _core.Bsdf(name, albedo=(1, 1, 1), ior=ior, front=front)
    for angle in ANGLES:
        wo = direction(angle)
        sample = draw(bsdf, wo, 20_000, Case(name, "", 0.1).rng(round(ior * 100), round(10 * angle)))
        ok = sample["ok"]
        assert ((sample["type"][ok] & _core.BRDF_SPECULAR) > 0).all()
        for lobe in np.unique(sample["type"][ok]):
            mine = sample["type"] == lobe
            wi, pdf = sample["wi"][mine], sample["pdf"][mine]
            assert (wi == wi[0]).all()
            assert np.ptp(pdf) == 0
            if pdf[0] < 1 - 1e-6:
                assert binomtest(int(mine.sum()), len(ok), float(pdf[0])).pvalue > sidak(200)
            else:
                assert mine.mean() > 0.999
            eta = 1.0
            if lobe & _core.BRDF_TRANSMISSION:
                # Snell's law, and the plane of incidence.
                eta = ior if front else 1 / ior
                np.testing.assert_allclose(np.hypot(*wi[0, :2]) * eta, np.hypot(*wo[:2]), atol=1e-6)
                np.testing.assert_allclose(wi[0, :2] * eta, -wo[:2], atol=1e-6)
                assert wi[0, 2] < 0
            else:
                np.testing.assert_allclose(wi[0], wo * [-1, -1, 1], atol=1e-7)
            np.testing.assert_allclose(sample["eta2"][mine], eta**2, rtol=1e-5)


@pytest.mark.parametrize("front", [True, False])
@pytest.mark.parametrize("ior", [1.0, 1.33, 1.52, 2.42])
def test_glass_reflects_as_fresnel_says(front: bool, ior: float) -> None:
    """Share and weight of both lobes: what is reflected and, counted in energy, let through adds up to 1."""
    glass = _core.Bsdf("glass", albedo=(0.9, 0.5, 0.1), ior=ior, front=front)
    eta = ior if front else 1 / ior
    for angle in ANGLES:
        wo = direction(angle)
        expected = float(fresnel(float(wo[2]), eta))
        u = np.zeros((2, 3), dtype=np.float32)
        u[:, 0] = [0, 1 - 2**-24]
        sample = glass.sample(rows(wo, 2), u)
        if expected > 1e-6:
            assert sample["pdf"][0] == pytest.approx(expected, abs=3e-6)
            np.testing.assert_allclose(sample["weight"][0], [0.9, 0.5, 0.1], rtol=1e-6)
        if expected < 1 - 1e-6:
            assert sample["pdf"][1] == pytest.approx(1 - expected, abs=3e-6)
            np.testing.assert_allclose(sample["weight"][1], np.array([0.9, 0.5, 0.1]) / eta**2, rtol=1e-5)
        else:
            assert not sample["type"][1] & _core.BRDF_TRANSMISSION
