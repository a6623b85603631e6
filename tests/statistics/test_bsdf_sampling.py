"""
Every BSDF's `sample` has the density `pdf` and the weight f |cos| / pdf; what `pdf` lacks of one is how often
`sample` fails.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from bsdf_cases import ANGLES, FAST, SLOW, Case, cases, cells_of, direction, draw, measure, rows, typed_cases
from cells import chart
from scipy.stats import norm
from stats import SIGNIFICANCE, chi_square, sidak, uniformity

from etendue import _core


def check(case: Case, samples: int, depth: int, family: int, folder: Path) -> None:
    failures = []
    for angle in ANGLES:
        found = measure(case, angle, samples, depth)
        if found.agreement.p < sidak(family):
            picture = found.cells.picture(found.observed, found.expected, folder / f"{case}-{angle:g}.png")
            failures.append(
                f"{angle:g} degrees: {found.agreement}; expected, observed and difference: {picture}"
            )
        if found.lost_error > norm.isf(sidak(family) / 2):
            failures.append(
                f"{angle:g} degrees: pdf integrates to {found.integral:.6f}, {found.kept:.6f} succeed"
            )
        if found.integral > 1 + 2e-4:
            failures.append(f"{angle:g} degrees: pdf integrates to {found.integral:.6f}")
    assert not failures, "\n".join([str(case), *failures])


@pytest.mark.parametrize("case", FAST, ids=str)
def test_samples_have_the_density(case: Case, tmp_path: Path) -> None:
    check(case, 20_000, 6, len(FAST) * len(ANGLES), tmp_path)


@pytest.mark.slow
@pytest.mark.parametrize("case", SLOW, ids=str)
def test_a_million_samples_have_the_density(case: Case, tmp_path: Path) -> None:
    check(case, 1_000_000, 8, len(SLOW) * len(ANGLES), tmp_path)


@pytest.mark.parametrize("case", FAST + typed_cases(), ids=str)
def test_weight_is_f_cos_over_pdf(case: Case) -> None:
    bsdf, rng = case.make(), case.rng(1)
    for angle in ANGLES:
        wo = direction(angle)
        sample = draw(bsdf, wo, 5000, rng)
        smooth = sample["smooth"]
        wi, weight, pdf = sample["wi"][smooth], sample["weight"][smooth], sample["pdf"][smooth]
        there = rows(wo, len(wi))
        np.testing.assert_allclose(bsdf.pdf(there, wi), pdf, rtol=2e-5)
        assert (pdf > 0).all()
        by_hand = bsdf.f(there, wi).astype(float) * np.abs(wi[:, 2:].astype(float)) / pdf[:, None]
        # The Fresnel term sees the half vector of two floats, whose error matters at grazing angles and
        # next to total reflection; where there is no boundary to reflect all of it is rounding.
        np.testing.assert_allclose(
            weight, by_hand, rtol=2e-3 if angle > 85 or case.variant == "metallic" else 1e-4, atol=3e-6
        )


@pytest.mark.parametrize("case", cases(("",), (0.3,)), ids=str)
def test_p_values_are_uniform(case: Case) -> None:
    """
    A hundred small tests find what one misses: their p-values lean to 0 long before one of them is
    significant.
    """
    for angle in (30.0, 80.0):
        bsdf, wo, rng = case.make(), direction(angle), case.rng(1000)
        cells = cells_of(bsdf, wo, rng, 6)
        integrals = cells.integrate(lambda wi, bsdf=bsdf, wo=wo: bsdf.pdf(rows(wo, len(wi)), wi))
        if integrals.sum() == 0:
            continue
        p_values = []
        for _ in range(100):
            sample = draw(bsdf, wo, 4000, rng)
            observed = cells.count(chart(sample["wi"][sample["smooth"]]))
            p_values.append(chi_square(observed, integrals / integrals.sum() * observed.sum()).p)
        assert uniformity(p_values) > sidak(2 * len(cases(("",), (0.3,)))), f"{angle:g} degrees"


@pytest.mark.parametrize("case", cases(), ids=str)
def test_azimuth_does_not_matter(case: Case) -> None:
    """
    Turning both directions about the normal changes neither f nor pdf, and turned samples are samples of
    the turned wo.
    """
    bsdf, rng = case.make(), case.rng(2000)
    for angle in ANGLES[:4]:
        wo = direction(angle)
        sample = draw(bsdf, wo, 2000, rng)
        wi = sample["wi"][sample["ok"]]
        c, s = np.cos(2.5), np.sin(2.5)
        turn = np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])
        turned, turned_wo = (wi @ turn.T).astype(np.float32), direction(angle, 2.5)
        # A float's error of a direction against the width of the lobe decides how well the turned one can
        # agree.
        loose = 1e-3 + 1e-6 / max(case.roughness, 1e-3) ** 1.5
        for value in (bsdf.pdf, bsdf.f):
            there, here = value(rows(turned_wo, len(wi)), turned), value(rows(wo, len(wi)), wi)
            np.testing.assert_allclose(there, here, rtol=loose, atol=1e-4 * (here.max(initial=0) + 1e-30))
        if case.roughness >= 0.1 and len(wi) > 100:
            cells = cells_of(bsdf, wo, rng, 6)
            there = draw(bsdf, turned_wo, 20_000, rng)
            observed = cells.count(chart((there["wi"][there["smooth"]] @ turn).astype(np.float32)))
            integrals = cells.integrate(lambda w, wo=wo: bsdf.pdf(rows(wo, len(w)), w), 1e-5)
            assert chi_square(observed, integrals / integrals.sum() * observed.sum()).p > sidak(
                4 * len(cases())
            )


@pytest.mark.parametrize("name", _core.bsdfs())
def test_every_bsdf_is_sampled_or_delta(name: str) -> None:
    """
    A BSDF is in the tests above, or says that it has no density; the family's level is what it should be.
    """
    covered = {case.bsdf for case in FAST}
    assert (name in covered) != _core.Bsdf(name).is_delta
    assert 0 < SIGNIFICANCE <= 0.01
