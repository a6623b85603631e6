"""Hypothesis tests with the corrections that keep a whole suite at one error rate."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy import stats

# Chance that a suite of right code fails, once for each family of tests. Seeds are fixed: a suite that has
# passed keeps passing.
SIGNIFICANCE = 0.01
# Fewer counts than these are not normal enough for chi-square; such cells are pooled.
LEAST_EXPECTED = 5.0


def sidak(tests: int, significance: float = SIGNIFICANCE) -> float:
    """The level of each of `tests` independent tests that gives their family the level `significance`."""
    return float(-np.expm1(np.log1p(-significance) / tests))


def holm(p_values: ArrayLike, significance: float = SIGNIFICANCE) -> NDArray[np.bool_]:
    """Which of the hypotheses fall at a family-wise level, whatever the dependence between the tests."""
    p = np.asarray(p_values, dtype=float)
    order = np.argsort(p)
    falls = p[order] <= significance / (len(p) - np.arange(len(p)))
    rejected = np.zeros(len(p), dtype=bool)
    rejected[order] = np.cumprod(falls).astype(bool)
    return rejected


class ChiSquare(NamedTuple):
    """What chi_square found."""

    p: float
    statistic: float
    freedom: int


def chi_square(observed: ArrayLike, expected: ArrayLike) -> ChiSquare:
    """
    Pearson's test of counts against expectations of the same total, one cell per outcome.

    Cells are pooled from the smallest expectation up until each pool expects LEAST_EXPECTED. Counts where
    next to nothing can be expected fail outright: pooling would drown them.
    """
    o, e = np.asarray(observed, dtype=float).ravel(), np.asarray(expected, dtype=float).ravel()
    if not (np.isfinite(e).all() and (e >= -1e-6 * max(e.sum(), 1)).all()):
        return ChiSquare(0.0, np.inf, 0)
    e = np.maximum(e, 0)
    order = np.argsort(e)
    o, e = o[order], e[order]
    rare = int(np.searchsorted(np.cumsum(e), 1e-3))
    if o[:rare].sum() > 2:
        return ChiSquare(0.0, np.inf, 0)
    pools, pool = [], np.zeros(2)
    for cell in zip(o, e, strict=True):
        pool += cell
        if pool[1] >= LEAST_EXPECTED:
            pools.append(pool)
            pool = np.zeros(2)
    if pools:
        pools[-1] += pool
    o, e = np.array(pools).reshape(-1, 2).T
    if len(e) < 2:
        return ChiSquare(1.0, 0.0, 0)
    statistic = float(((o - e) ** 2 / e).sum())
    return ChiSquare(float(stats.chi2.sf(statistic, len(e) - 1)), statistic, len(e) - 1)


def welch(a: ArrayLike, b: ArrayLike) -> float:
    """p-value of equal means of two samples of unequal variances."""
    a, b = np.asarray(a, dtype=float), np.asarray(b, dtype=float)
    if np.ptp(a) == 0 and np.ptp(b) == 0:
        return 1.0 if np.isclose(a[0], b[0], rtol=1e-5) else 0.0
    moments = (f(x) for x in (a, b) for f in (np.mean, lambda x: np.std(x, ddof=1), len))
    return float(stats.ttest_ind_from_stats(*moments, equal_var=False).pvalue)


def mean_is(sample: ArrayLike, value: float, tolerance: float = 0.0) -> float:
    """p-value of the mean of a sample being `value`, known to within `tolerance`."""
    x = np.asarray(sample, dtype=float)
    error = np.sqrt(x.var(ddof=1) / len(x) + tolerance**2)
    # Below this all that differs is how single precision was rounded.
    floor = 2e-6 * max(abs(value), 1e-3)
    return float(2 * stats.norm.sf(max(abs(x.mean() - value) - floor, 0) / max(error, 1e-12)))


def uniformity(p_values: ArrayLike) -> float:
    """
    p-value of p-values being uniform, which they are where all null hypotheses hold (Kolmogorov and
    Smirnov).
    """
    return float(stats.kstest(np.asarray(p_values, dtype=float), "uniform").pvalue)
