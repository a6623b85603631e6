"""Every BSDF's reciprocity and energy, and that no light is out of reach of its sampling."""

from __future__ import annotations

import numpy as np
import pytest
from bsdf_cases import ANGLES, FAST, ROUGHNESS, Case, cases, cells_of, direction, draw, rows
from numpy.typing import NDArray
from stats import mean_is, sidak, welch

from etendue import _core

# BSDFs that claim no reciprocity, with the reasons in docs/correctness.md.
NOT_RECIPROCAL = {"layered_ggx", "translucent"}
# Reflect or transmit all that arrives where the albedo is 1, so that a white furnace shows exactly 1.
LOSSLESS = {"diffuse", "translucent", "glass"}


def sphere(n: int, rng: np.random.Generator) -> NDArray[np.float32]:
    v = rng.normal(size=(n, 3))
    return (v / np.linalg.norm(v, axis=1, keepdims=True)).astype(np.float32)


@pytest.mark.parametrize("case", cases() + [Case(name, "", 0.1) for name in _core.bsdfs()], ids=str)
def test_density_covers_what_is_reflected(case: Case) -> None:
    """
    No light is out of reach of sampling, none of it is negative, and delta BSDFs have neither f nor pdf.
    """
    bsdf, rng = case.make(), case.rng(2)
    for angle in ANGLES:
        wo = direction(angle)
        near = draw(bsdf, wo, 2000, rng)["wi"]
        near = near + 0.05 * rng.normal(size=near.shape)
        wi = np.concatenate([sphere(4000, rng), near / np.linalg.norm(near, axis=1, keepdims=True)]).astype(
            np.float32
        )
        f, pdf = bsdf.f(rows(wo, len(wi)), wi), bsdf.pdf(rows(wo, len(wi)), wi)
        assert np.isfinite(f).all()
        assert np.isfinite(pdf).all()
        assert (f >= 0).all()
        assert (pdf >= 0).all()
        # Below 1e-30 an exponential has run out of numbers.
        assert (pdf[(f > 1e-30).any(axis=1)] > 0).all()
        if bsdf.is_delta:
            assert not f.any()
            assert not pdf.any()


@pytest.mark.parametrize("case", cases(("", "coated", "metallic", "dense")), ids=str)
def test_reciprocity(case: Case) -> None:
    bsdf, rng = case.make(), case.rng(3)
    a, b = sphere(20_000, rng), sphere(20_000, rng)
    # Half of the pairs about a mirror direction, where narrow lobes are.
    b[::2] = a[::2] * [-1, -1, 1] + max(case.roughness, 1e-3) * b[::2]
    b /= np.linalg.norm(b, axis=1, keepdims=True)
    a[:, 2], b[:, 2] = np.abs(a[:, 2]), np.abs(b[:, 2])
    low = np.minimum(a[:, 2], b[:, 2]) < 0.02
    a, b = a[~low], b[~low]
    there, back = bsdf.f(a, b), bsdf.f(b, a)
    if bsdf.is_reciprocal:
        # Next to total reflection the Fresnel term has an infinite slope; without a boundary it is but
        # rounding.
        agree = np.isclose(there, back, rtol=1e-4, atol=1e-30).all(axis=1)
        assert agree.mean() > 0.998
        np.testing.assert_allclose(there, back, rtol=0.02)
    else:
        assert case.bsdf in NOT_RECIPROCAL, "claims no reciprocity: is that so, and documented?"


def test_measured_non_reciprocity() -> None:
    """The coat's Fresnel mixing sees wo alone: the documented figures."""
    bsdf = _core.Bsdf("layered_ggx", albedo=(1, 1, 1), ior=1.3, roughness=0)
    assert not bsdf.is_reciprocal
    steep, flat = rows(direction(0), 1), rows(direction(80), 1)
    there, back = bsdf.f(steep, flat)[0, 0], bsdf.f(flat, steep)[0, 0]
    # The base alone is what this pair shows: (1 - F(0)) against (1 - F(80)).
    assert there / back == pytest.approx((1 - 0.017013) / (1 - 0.336118), rel=5e-3)
    thin = _core.Bsdf("translucent", albedo=(1, 1, 1))
    down = flat * np.array([1, 1, -1], dtype=np.float32)
    # Seen from the other side the frame is the other side's, so both directions are mirrored: then it is
    # reciprocal.
    flip = np.array([1, 1, -1], dtype=np.float32)
    assert thin.f(steep, down)[0, 0] == thin.f(down * flip, steep * flip)[0, 0] > 0


def albedo(case: Case, angle: float, bsdf: _core.Bsdf) -> tuple[float, NDArray[np.float64]]:
    """
    The integral of f |cos| by quadrature, and the weights of samples, failures as 0; light squeezed by
    refraction spread again.
    """
    wo, rng = direction(angle), case.rng(4, round(10 * angle))

    def reflected(wi: NDArray[np.float32]) -> NDArray[np.float32]:
        return bsdf.f(rows(wo, len(wi)), wi).mean(axis=1) * np.abs(wi[:, 2])

    sample = draw(bsdf, wo, 20_000, rng)
    weights = (
        np.where(sample["ok"][:, None], sample["weight"] * sample["eta2"][:, None], 0)
        .astype(float)
        .mean(axis=1)
    )
    if bsdf.is_delta:
        return float(weights.mean()), weights
    return float(cells_of(bsdf, wo, rng, 6).integrate(reflected, 1e-5).sum()), weights


@pytest.mark.parametrize("case", FAST + [Case(name, "", 0.1) for name in _core.bsdfs()], ids=str)
def test_white_furnace_and_albedo(case: Case) -> None:
    """
    With albedo 1 nothing shines brighter than what surrounds it, lossless BSDFs exactly as bright, and
    importance sampling finds the albedo that quadrature over all directions does.
    """
    bsdf = case.make()
    for angle in ANGLES:
        integral, weights = albedo(case, angle, bsdf)
        level = sidak(len(FAST) * len(ANGLES))
        assert mean_is(weights, integral, 2e-4) > level, (
            f"{angle:g}: {integral} by quadrature, {weights.mean()} by sampling"
        )
        assert integral <= 1 + 1e-3, f"{angle:g} degrees"
        assert weights.mean() <= 1 + 1e-3 + 4 * weights.std() / np.sqrt(len(weights)), f"{angle:g} degrees"
        if case.bsdf in LOSSLESS:
            np.testing.assert_allclose(weights, 1, rtol=2e-6)


@pytest.mark.parametrize(
    "case", cases(("", "coated", "metallic"), tuple(r for r in ROUGHNESS if r >= 0.3)), ids=str
)
def test_uniform_and_importance_sampling_agree(case: Case) -> None:
    """
    The same colours from directions that know nothing of the BSDF, of 40,000 samples each, by Welch's test.
    """
    bsdf = case.make((0.9, 0.5, 0.1))
    for angle in ANGLES[:4]:
        wo, rng = direction(angle), case.rng(5)
        wi = sphere(40_000, rng)
        uniform = bsdf.f(rows(wo, len(wi)), wi) * np.abs(wi[:, 2:]) * (4 * np.pi)
        sample = draw(bsdf, wo, 40_000, rng)
        weights = np.where(sample["ok"][:, None], sample["weight"], 0)
        for channel in range(3):
            assert welch(uniform[:, channel], weights[:, channel]) > sidak(
                12 * len(cases(("", "coated", "metallic")))
            )


@pytest.mark.parametrize("case", cases() + cases(("dense", "vacuum"), (0.1,)), ids=str)
def test_the_rest_beside_the_diffuse_part_is_not_negative(case: Case) -> None:
    """Paths that are shared take the diffuse part for other directions, and the rest for their own pixel."""
    albedo = (0.9, 0.5, 0.1)
    bsdf, rng = case.make(albedo), case.rng(5)
    wo, wi = (np.abs(sphere(4000, rng)) for _ in range(2))
    diffuse = bsdf.diffuse_share(wo[:, 2].copy())[:, None] * np.array(albedo) / np.pi
    assert (diffuse >= 0).all()
    assert (bsdf.f(wo, wi) - diffuse >= -1e-6).all()


@pytest.mark.parametrize("ior", [1.0, 1.3, 2.4])
def test_the_rest_of_a_coated_surface_is_its_coat(ior: float) -> None:
    """A smooth coat reflects next to nothing but in the direction of a mirror."""
    rng = np.random.default_rng(6)
    wo, wi = np.abs(sphere(4000, rng)), np.abs(sphere(4000, rng))
    mirror = wo * (-1, -1, 1)
    away = ((mirror * wi).sum(1) < 0.8) & (wo[:, 2] > 0.3) & (wi[:, 2] > 0.3)
    bsdf = _core.Bsdf("layered_ggx", albedo=(0.9, 0.5, 0.1), ior=ior, roughness=0.01)
    diffuse = bsdf.diffuse_share(wo[:, 2].copy())[:, None] * np.array((0.9, 0.5, 0.1)) / np.pi
    np.testing.assert_allclose(bsdf.f(wo, wi)[away], diffuse[away], rtol=0.01, atol=1e-4)
