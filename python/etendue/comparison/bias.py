"""Does an estimator converge to the reference? Tests tile by tile, and the answer in words.

The mean of a tile is tested by Welch's t-test against the reference. Its variance comes from how the repeats
scatter in each of its pixels: pixels have random numbers of their own, so the variances of a tile's pixels add
up, and eight repeats give hundreds of degrees of freedom instead of seven. Where pixels share paths, within squares
of 16 x 16, it is the variances of these cells that add up.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from . import statistics
from .metrics import EPSILON, LUMINANCE, sums
from .reference import Reference
from .statistics import Estimate
from .tally import Tally

# Chance of calling an unbiased estimator biased.
LEVEL = 0.001
# Three tests share it: the worst tile (Holm), all tiles together (Fisher), and the image's mean.
_SHARE = LEVEL / 3
# Samples' worth of light that a tile must rest on for a t-test to be trusted that far out in its tails.
LEAST_WEIGHT = 200.0
# Bright samples that may have failed to come: where this many are expected, none comes with a chance of e^-9, 0.01%.
_UNSEEN = 9
# Tiles across the image at most, and pixels across a tile at least.
_MOST_TILES, _LEAST_TILE = 16, 8


@dataclass(frozen=True)
class Bias:
    """The verdict on one estimator.

    tile: its width and height in pixels. p_values, relative: float64 (rows, columns), of the test and the relative
    difference of each tile; none (0, 0) where there are too few samples to tell. ratio: mean of the image over that of
    the reference. p_tiles, p_worst, p_mean: of all tiles together, of the
    worst tile (adjusted for their number), and of the ratio.
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

    @property
    def is_biased(self) -> bool | None:
        """None: too few samples to tell."""
        if self.p_values.size == 0:
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
            tiles = int(self.rejected.sum())
            where = f", {tiles} of {self.p_values.size} tiles differ, see map" if tiles else ""
            return f"biased: {interval}{where}"
        return f"no bias detectable at {LEVEL:.1%} (mean {interval})"


def judge(tally: Tally, reference: Reference) -> Bias:
    """The verdict; it needs two repeats at least."""
    brightness = reference.image.astype(np.float64) @ LUMINANCE
    tile = _tile(tally, brightness)
    if tile is None:
        nothing, unknown = np.zeros((0, 0)), Estimate(np.nan, np.nan, np.nan)
        return Bias(0, nothing, nothing, nothing.astype(bool), unknown, 1.0, 1.0, 1.0, 1.0)
    cells = -(-tile // tally.cell)
    tile = cells * tally.cell
    ours, theirs = tally.cell_variance, reference.luminance_variance
    pixels = sums(np.ones_like(brightness), tile)
    difference = tally.luminance - brightness
    excused = _may_be_unseen(difference, tile), _may_be_unseen(difference, max(difference.shape))
    difference = sums(difference, tile) / pixels
    brightness = sums(brightness, tile) / pixels
    variances = sums(ours, cells) / pixels**2, sums(theirs, tile) / pixels**2
    freedom = _freedom(ours, cells, tally.repeats)
    p = statistics.welch(difference, variances, (freedom, 1e6))
    relative = np.divide(difference, brightness, out=np.zeros_like(difference), where=brightness > 0)
    evidence = np.where(excused[0], 1.0, p)
    rejected = statistics.holm(evidence.ravel(), _SHARE).reshape(p.shape)
    ratio, p_mean = _ratio(pixels, brightness, difference, variances, freedom)
    return Bias(
        tile,
        p,
        relative,
        rejected,
        ratio,
        statistics.fisher(evidence.ravel()),
        float(min(evidence.min() * p.size, 1.0)),
        1.0 if excused[1].all() else p_mean,
        statistics.uniformity(p.ravel()) if p.size > 1 else 1.0,
    )


def _may_be_unseen(difference: NDArray[np.float64], tile: int) -> NDArray[np.bool_]:
    """bool (rows, columns): which tiles are too dark by no more than a few rare bright samples would bring.

    Rare samples are as bright as the brightest that was seen anywhere, which shows in its pixel's `difference` from
    the reference, (height, width). Where none has come yet, repeats agree with each other on an image that is too
    dark, and no test that looks at them alone can know.
    """
    missing = -sums(difference, tile)
    return np.asarray((missing > 0) & (missing <= _UNSEEN * max(float(difference.max()), 0.0)))


def _tile(tally: Tally, brightness: NDArray[np.float64]) -> int | None:
    """Pixels across a tile, as few as leave each with `LEAST_WEIGHT` samples' worth of light; None: there is no such.

    The worth of samples x is (sum x)² / sum x² (Kish 1965), here of x over the reference, in the whole image. Where
    light comes in a few bright samples, most sets of repeats miss some, look too dark, and seem to agree on it. A
    tile that has none yet cannot know that; and to leave out those that have one would leave the dark ones.
    """
    scale = np.square(brightness) + EPSILON
    light, squares = tally.sum.mean(axis=2) / np.sqrt(scale), tally.sum_squares.mean(axis=2) / scale
    largest = max(brightness.shape)
    if not squares.any():
        # All black is what it should be, or is not known yet.
        return None if brightness.any() else largest
    worth = float(_worth(light, squares, largest)[0, 0])
    if worth < LEAST_WEIGHT:
        return None
    enough = math.ceil(math.sqrt(brightness.size * LEAST_WEIGHT / worth))
    tile = max(_LEAST_TILE, -(-largest // _MOST_TILES), min(enough, largest))
    # Rare light may be in one part of the image: no tile may rest on less.
    while tile < largest:
        lit = sums(brightness, tile) > 0
        if (_worth(light, squares, tile)[lit] >= LEAST_WEIGHT).all():
            break
        tile *= 2
    return min(tile, largest)


def _worth(light: NDArray[np.float64], squares: NDArray[np.float64], tile: int) -> NDArray[np.float64]:
    """(sum x)² / sum x² of each tile."""
    total, of_squares = sums(light, tile), sums(squares, tile)
    return np.divide(total**2, of_squares, out=np.zeros_like(total), where=of_squares > 0)


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
    """Mean of the image over the reference's, with its interval, and the p-value of its being 1."""
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
