"""Intervals hold what they promise, and tests reject at their level."""

from __future__ import annotations

import numpy as np
import pytest
from scipy import stats

from etendue.comparison import statistics


@pytest.mark.parametrize("spread", [0.1, 0.5])
def test_intervals_of_means_and_ratios_cover(spread: float) -> None:
    """Of 95% intervals of log-normal repeats, between 92% and 97.5% contain the truth."""
    random = np.random.default_rng(5)
    hits = np.zeros(2)
    runs = 2000
    for _ in range(runs):
        a, b = random.lognormal(0, spread, (2, 8))
        mean = statistics.product_of_means([(a, 1)])
        ratio = statistics.product_of_means([(a, -1), (3 * b, -1)])
        truth = np.exp(spread**2 / 2)
        hits += [mean.low < truth < mean.high, ratio.low < 1 / (3 * truth**2) < ratio.high]
    assert ((hits / runs > 0.92) & (hits / runs < 0.975)).all()


def test_disturbances_of_pairs_cancel() -> None:
    slow_machine = np.array([1, 1, 3, 1, 1, 2, 1, 1.0])
    estimate = statistics.product_of_means([(2 * slow_machine, 1), (slow_machine, -1)])
    assert (estimate.value, estimate.low, estimate.high) == pytest.approx((2, 2, 2))


def test_one_repeat_has_no_interval() -> None:
    estimate = statistics.product_of_means([([4.0], 1)])
    assert estimate.value == 4
    assert not estimate.is_known


def test_nothing_but_zeros() -> None:
    assert statistics.product_of_means([([0.0, 0.0], 1)]).value == 0
    assert np.isnan(statistics.product_of_means([([0.0, 0.0], -1)]).value)


def test_welch_is_scipys() -> None:
    random = np.random.default_rng(1)
    a, b = random.normal(0, 1, 8), random.normal(0.5, 3, 20)
    variances = [np.array(x.var(ddof=1) / len(x)) for x in (a, b)]
    ours = statistics.welch(np.array(a.mean() - b.mean()), variances, (7.0, 19.0))
    assert float(ours) == pytest.approx(stats.ttest_ind(a, b, equal_var=False).pvalue)


def test_welch_without_spread() -> None:
    nothing = np.zeros(2)
    p = statistics.welch(np.array([0.0, 0.1]), [nothing, nothing], (7.0, 7.0))
    assert p.tolist() == [1, 0]


def test_families_fall_at_their_level() -> None:
    """Of 2,000 families of 30 true hypotheses, 5% fall, by either test of all of them."""
    p = np.random.default_rng(2).random((2000, 30))
    for falls in (
        [statistics.holm(each, 0.05).any() for each in p],
        [statistics.fisher(e) <= 0.05 for e in p],
    ):
        assert stats.binomtest(int(np.sum(falls)), 2000, 0.05).pvalue > 0.001


def test_holm_goes_on_after_the_first() -> None:
    # 0.02 is above 0.05 / 3, and falls once 0.001 has fallen only if it is below 0.05 / 2.
    assert statistics.holm([0.02, 0.001, 0.9], 0.05).tolist() == [True, True, False]
    assert statistics.holm([0.02, 0.03, 0.9], 0.05).tolist() == [False, False, False]


def test_fisher_adds_small_signs_up() -> None:
    assert statistics.fisher(np.full(40, 0.15)) < 1e-4
    assert not statistics.holm(np.full(40, 0.15), 0.05).any()
    assert statistics.fisher([]) == 1
