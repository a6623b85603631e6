"""Intervals and tests for a handful of independent repeats."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .extras import needed

CONFIDENCE = 0.95


@dataclass(frozen=True)
class Estimate:
    """A value with its interval; without one (NaN) where there is a single repeat."""

    value: float
    low: float
    high: float

    @property
    def is_known(self) -> bool:
        """Whether there is an interval."""
        return bool(np.isfinite(self.low) and np.isfinite(self.high))


def product_of_means(factors: Sequence[tuple[ArrayLike, float]], confidence: float = CONFIDENCE) -> Estimate:
    """The product of mean(x)^e over `factors`, pairs of positive repeats x and an exponent e, with its interval.

    Covers means (one factor), ratios (e of 1 and -1) and efficiencies 1 / (error x time). Repeats of the same
    index belong together, so that what disturbed all of them at once cancels. The interval is Student's for
    the logarithm, by the delta method: log mean(x) = log mu + sum(x_i / mu - 1) / n + ..., so positive values
    have positive limits.
    """
    columns = [(np.asarray(x, np.float64), exponent) for x, exponent in factors]
    means = [float(x.mean()) for x, _ in columns]
    if any(mean <= 0 for mean in means):
        value = (
            0.0 if all(e > 0 for (_, e), mean in zip(columns, means, strict=True) if mean <= 0) else np.nan
        )
        return Estimate(value, np.nan, np.nan)
    value = float(np.prod([mean**e for (_, e), mean in zip(columns, means, strict=True)]))
    repeats = len(columns[0][0])
    if repeats < 2:
        return Estimate(value, np.nan, np.nan)
    influence = np.sum([e * x / mean for (x, e), mean in zip(columns, means, strict=True)], axis=0)
    half = student(confidence, repeats - 1) * float(np.std(influence, ddof=1)) / np.sqrt(repeats)
    return Estimate(value, value * float(np.exp(-half)), value * float(np.exp(half)))


def student(confidence: float, freedom: float) -> float:
    """How many standard errors a two-sided interval of this confidence reaches to either side."""
    return float(needed("scipy.stats").t.ppf(0.5 + confidence / 2, freedom))


def welch(
    difference: NDArray[np.float64],
    variances: Sequence[NDArray[np.float64]],
    freedoms: Sequence[NDArray[np.float64] | float],
) -> NDArray[np.float64]:
    """Two-sided p-values of a difference of means being 0 (Welch 1947).

    variances: of the two means, each with its degrees of freedom. Where neither has any spread, equal is 1 and
    unequal, beyond what single precision rounds, 0.
    """
    total = np.sum(variances, axis=0)
    known = total > 0
    safe = np.where(known, total, 1.0)
    # Satterthwaite's degrees of freedom of the sum.
    spread = sum(np.square(v / safe) / f for v, f in zip(variances, freedoms, strict=True))
    freedom = 1 / np.maximum(spread, 1e-12)
    p: NDArray[np.float64] = 2 * needed("scipy.stats").t.sf(np.abs(difference) / np.sqrt(safe), freedom)
    return np.where(known, p, np.where(np.abs(difference) <= 1e-6, 1.0, 0.0))


def holm(p_values: ArrayLike, level: float) -> NDArray[np.bool_]:
    """Which hypotheses fall at a family-wise `level`, whatever the dependence between tests (Holm 1979)."""
    p = np.asarray(p_values, np.float64)
    order = np.argsort(p)
    falls = p[order] <= level / (len(p) - np.arange(len(p)))
    rejected = np.zeros(len(p), bool)
    rejected[order] = np.logical_and.accumulate(falls)
    return rejected


def fisher(p_values: ArrayLike) -> float:
    """p-value of all hypotheses holding, from independent tests of each: many small signs add up (Fisher 1925)."""
    p = np.maximum(np.asarray(p_values, np.float64), 1e-300)
    if p.size == 0:
        return 1.0
    return float(needed("scipy.stats").chi2.sf(-2 * np.log(p).sum(), 2 * p.size))


def uniformity(p_values: ArrayLike) -> float:
    """p-value of p-values being uniform, which they are where all hypotheses hold (Kolmogorov and Smirnov)."""
    return float(needed("scipy.stats").kstest(np.asarray(p_values, np.float64), "uniform").pvalue)
