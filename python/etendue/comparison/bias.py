"""Does an estimator converge to the reference? Tests tile by tile, and the answer in words.

The mean of a tile is tested by Welch's t-test against the reference. Its variance comes from how the repeats
scatter in each of its pixels: pixels have random numbers of their own, so the variances of a tile's pixels add
up, and eight repeats give hundreds of degrees of freedom instead of seven.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from . import statistics
from .metrics import LUMINANCE
from .reference import Reference
from .statistics import Estimate
from .tally import Tally

# Chance of calling an unbiased estimator biased.
LEVEL = 0.001
# Three tests share it: the worst tile (Holm), all tiles together (Fisher), and the image's mean.
_SHARE = LEVEL / 3
# Samples that a tile's mean must rest on for a t-test to be trusted that far out in its tails.
LEAST_WEIGHT = 200.0
# Tiles across the image at most, and pixels across a tile at least.
_MOST_TILES, _LEAST_TILE = 16, 8


@dataclass(frozen=True)
class Bias:
    """The verdict on one estimator.

    tile: its width and height in pixels. p_values, relative: float64 (rows, columns), of the test and the relative
    difference of each tile; NaN where there are too few samples to tell. ratio: mean of the image over that of
    the reference, both over the tiles that are judged. p_tiles, p_worst, p_mean: of all tiles together, of the
    worst tile (adjusted for their number), and of the ratio. judged: share of the tiles that are.
    """

    tile: int
    p_values: NDArray[np.float64]
    relative: NDArray[np.float64]
    rejected: NDArray[np.bool_]
    ratio: Estimate
    p_tiles: float
    p_worst: float
    p_mean: float
    uniformity: float
    judged: float

    @property
    def is_biased(self) -> bool | None:
        """None: too few samples to tell."""
        if self.judged == 0:
            return None
        return min(self.p_tiles, self.p_worst, self.p_mean) <= _SHARE

    @property
    def words(self) -> str:
        """The verdict as a sentence."""
        if self.is_biased is None:
            return "cannot tell: too few samples carry the light"
        shift, half = self.ratio.value - 1, (self.ratio.high - self.ratio.low) / 2
        interval = f"{shift:+.{_digits(half)}%} ± {half:.{_digits(half)}%}"
        if self.is_biased:
            where = f", {int(self.rejected.sum())} of {int(np.isfinite(self.p_values).sum())} tiles differ"
            text = f"biased: {interval}{where}, see map"
        else:
            text = f"no bias detectable at {LEVEL:.1%} (mean {interval})"
        if self.judged < 1:
            text += f"; {1 - self.judged:.0%} of the image has too few samples to tell"
        return text


def judge(tally: Tally, reference: Reference) -> Bias:
    """The verdict; it needs two repeats at least."""
    difference = tally.luminance - reference.image.astype(np.float64) @ LUMINANCE
    ours, theirs = tally.luminance_variance, reference.luminance_variance
    tile = _tile(tally, reference)
    judged = _can_be_judged(tally, reference, tile)
    pixels = sums(np.ones_like(difference), tile)
    mean_difference = sums(difference, tile) / pixels
    variances = sums(ours, tile) / pixels**2, sums(theirs, tile) / pixels**2
    freedoms = _freedom(ours, tile, tally.repeats), 1e6
    p = np.where(judged, statistics.welch(mean_difference, variances, freedoms), np.nan)
    tested = p[judged]
    brightness = sums(reference.image.astype(np.float64) @ LUMINANCE, tile) / pixels
    relative = np.divide(
        mean_difference, brightness, out=np.full_like(brightness, np.nan), where=judged & (brightness > 0)
    )
    rejected = np.zeros_like(judged)
    rejected[judged] = statistics.holm(tested, _SHARE)
    ratio, p_mean = _ratio(judged * pixels, brightness, mean_difference, variances, freedoms[0])
    return Bias(
        tile,
        p,
        relative,
        rejected,
        ratio,
        statistics.fisher(tested),
        float(min(tested.min() * tested.size, 1.0)) if tested.size else 1.0,
        p_mean,
        statistics.uniformity(tested) if tested.size > 1 else 1.0,
        float(judged.mean()),
    )


def sums(values: NDArray[np.float64], tile: int) -> NDArray[np.float64]:
    """float64 (rows, columns): sums of `values` (height, width) over square tiles; those at the edges are smaller."""
    rows = np.add.reduceat(values, np.arange(0, values.shape[0], tile), axis=0)
    return np.asarray(np.add.reduceat(rows, np.arange(0, values.shape[1], tile), axis=1))


def _tile(tally: Tally, reference: Reference) -> int:
    """Pixels across a tile: few, but enough for the means of most tiles to be normal; else of as many as can be."""
    largest = max(tally.valid.shape)
    sizes = [max(_LEAST_TILE, -(-largest // _MOST_TILES))]
    while sizes[-1] < largest:
        sizes.append(2 * sizes[-1])
    shares = [float(_can_be_judged(tally, reference, size).mean()) for size in sizes]
    enough = [size for size, share in zip(sizes, shares, strict=True) if share >= 0.9]
    return enough[0] if enough else sizes[int(np.argmax(shares))]


def _can_be_judged(tally: Tally, reference: Reference, tile: int) -> NDArray[np.bool_]:
    """Which tiles rest on enough samples: on `LEAST_WEIGHT` or more in the sense of (sum x)² / sum x² (Kish 1965).

    Where a tile's light comes from a few samples, its mean is skewed: most sets of repeats miss the rare bright
    ones, look too dark, and seem to agree on it. Black in both images is fine.
    """
    total = sums(tally.sum.sum(axis=2), tile)
    squares = sums(tally.sum_squares.sum(axis=2), tile) * 3
    weight = np.divide(total**2, squares, out=np.zeros_like(total), where=squares > 0)
    black = (squares == 0) & (sums(reference.image.astype(np.float64) @ LUMINANCE, tile) == 0)
    return np.asarray((weight >= LEAST_WEIGHT) | black)


def _freedom(variances: NDArray[np.float64], tile: int, repeats: int) -> NDArray[np.float64]:
    """Satterthwaite's degrees of freedom of a tile's variance, the sum of those of its pixels."""
    squares = sums(variances**2, tile) / max(repeats - 1, 1)
    total = sums(variances, tile) ** 2
    return np.divide(total, squares, out=np.full_like(total, 1e6), where=squares > 0)


def _ratio(
    weights: NDArray[np.float64],
    brightness: NDArray[np.float64],
    difference: NDArray[np.float64],
    variances: tuple[NDArray[np.float64], NDArray[np.float64]],
    freedom: NDArray[np.float64],
) -> tuple[Estimate, float]:
    """Mean of the judged tiles over the reference's, with its interval, and the p-value of its being 1."""
    reference = float((weights * brightness).sum())
    if reference <= 0:
        return Estimate(np.nan, np.nan, np.nan), 1.0
    shift = float((weights * difference).sum()) / reference
    ours, theirs = ((weights**2 * variance) / reference**2 for variance in variances)
    freedoms = float(ours.sum() ** 2 / max((ours**2 / freedom).sum(), 1e-300)), 1e6
    pair = np.array(ours.sum()), np.array(theirs.sum())
    p = float(statistics.welch(np.array(shift), pair, (max(freedoms[0], 1.0), freedoms[1])))
    half = statistics.student(statistics.CONFIDENCE, max(freedoms[0], 1.0)) * float(np.sqrt(sum(pair)))
    return Estimate(1 + shift, 1 + shift - half, 1 + shift + half), p


def _digits(half: float) -> int:
    """Decimals of a percentage whose uncertainty is `half`."""
    return 1 if half >= 0.001 else 2 if half >= 0.0001 else 3
