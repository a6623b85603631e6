"""How far a film still is from the picture that more samples would make of it."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from . import Film

# Width and height of a tile in pixels.
TILE = 16


class FilmError(NamedTuple):
    """The relative standard error that 95% of a film's tiles do not exceed.

    low, high: a 95% confidence interval of it. tiles: float64 (rows, columns), the error of each tile of 16 x 16
    pixels: the root mean square, over pixels and channels, of the standard error of the mean, over the tile's
    mean radiance or a hundredth of the image's, if that is more. Infinite where there are too few samples.
    """

    value: float
    low: float
    high: float
    tiles: NDArray[np.float64]


def error_of(film: Film) -> FilmError:
    """The error of `film`, estimated from the two halves of each pixel's samples."""
    from .. import _core

    return FilmError(*_core.film_error(*sums_of(film), film.sharing))


def sums_of(
    film: Film,
) -> tuple[
    NDArray[np.float64],
    NDArray[np.float64],
    NDArray[np.float64],
    NDArray[np.uint64],
    NDArray[np.uint64],
    NDArray[np.uint64],
]:
    """What the core takes as a film."""
    return (
        film.sum,
        film.sum_squares,
        film.half_sum,
        film.sample_count,
        film.invalid_per_pixel,
        film.half_count,
    )
