"""What is kept of the repeats of one estimator: sums, so that no repeat's film stays in memory."""

from __future__ import annotations

from dataclasses import asdict, dataclass, field
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..film import Film
from ..film.error import TILE
from . import metrics
from .estimators import Estimator
from .metrics import LUMINANCE
from .techniques import Row


@dataclass(frozen=True)
class Point:
    """One repeat at one moment: what it had cost, and how far it was from the reference."""

    spp: float
    seconds: float
    cpu_seconds: float
    rays: int
    errors: dict[str, float]

    def as_dict(self) -> dict[str, Any]:
        """For JSON."""
        return asdict(self)


class Invalid(NamedTuple):
    """A sample that was no finite radiance, and the seed of its repeat."""

    x: int
    y: int
    sample: int
    seed: int


Curve = list[Point]


class Repeat(NamedTuple):
    """One finished image. flip: its FLIP map; None where it was read from a file."""

    film: Film
    curve: Curve
    flip: NDArray[np.float32] | None = None


@dataclass
class Tally:
    """The repeats of one estimator.

    curves: for each repeat, its errors from the first sample on. first: the first repeat, which is shown.
    techniques: the rows of its pyramid. cell: width and height of the squares of pixels that are independent of each
    other, 1 where pixels are.
    """

    estimator: Estimator
    curves: list[Curve] = field(default_factory=list)
    seeds: list[int] = field(default_factory=list)
    invalid: list[Invalid] = field(default_factory=list)
    invalid_count: int = 0
    first: Repeat | None = None
    techniques: list[Row] = field(default_factory=list)
    cell: int = 1
    sum: NDArray[np.float64] = field(default_factory=lambda: np.zeros((0, 0, 3)))
    sum_squares: NDArray[np.float64] = field(default_factory=lambda: np.zeros((0, 0, 3)))
    valid: NDArray[np.float64] = field(default_factory=lambda: np.zeros((0, 0)))
    _luminance: NDArray[np.float64] = field(default_factory=lambda: np.zeros((0, 0)))
    _cells: NDArray[np.float64] = field(default_factory=lambda: np.zeros((0, 0)))
    _cell_squares: NDArray[np.float64] = field(default_factory=lambda: np.zeros((0, 0)))

    def add(self, repeat: Repeat, seed: int) -> None:
        """One more repeat."""
        film = repeat.film
        valid = (film.sample_count - film.invalid_per_pixel).astype(np.float64)
        luminance = film.image.astype(np.float64) @ LUMINANCE
        if self.first is None:
            self.first = repeat
            self.sum, self.sum_squares, self.valid = film.sum.copy(), film.sum_squares.copy(), valid
            self.cell = 1 if film.sharing == 1 else TILE
            cells = metrics.sums(luminance, self.cell)
            self._luminance, self._cells, self._cell_squares = luminance, cells, cells**2
        else:
            self.sum += film.sum
            self.sum_squares += film.sum_squares
            self.valid += valid
            cells = metrics.sums(luminance, self.cell)
            self._luminance += luminance
            self._cells += cells
            self._cell_squares += cells**2
        self.curves.append(repeat.curve)
        self.seeds.append(seed)
        self.invalid += [Invalid(x, y, sample, seed) for x, y, sample in film.invalid]
        self.invalid_count += film.invalid_count

    @property
    def film(self) -> Film:
        """That of the first repeat."""
        assert self.first is not None
        return self.first.film

    def flip_map(self, reference: NDArray[np.float32], exposure: float) -> NDArray[np.float32]:
        """Of the first repeat, see `metrics.flip_map`."""
        assert self.first is not None
        if self.first.flip is None:
            self.first = self.first._replace(flip=metrics.flip_map(self.film.image, reference, exposure))
        assert self.first.flip is not None
        return self.first.flip

    @property
    def repeats(self) -> int:
        """How many there are."""
        return len(self.curves)

    @property
    def last(self) -> list[Point]:
        """Each repeat at its end."""
        return [curve[-1] for curve in self.curves]

    def errors(self, metric: str) -> NDArray[np.float64]:
        """float64 (repeats,): the error of each repeat at its end."""
        return np.array([point.errors[metric] for point in self.last])

    def costs(self, name: str) -> NDArray[np.float64]:
        """float64 (repeats,): a field of `Point`, such as "seconds"."""
        return np.array([getattr(point, name) for point in self.last], np.float64)

    @property
    def luminance(self) -> NDArray[np.float64]:
        """float64 (height, width): the mean of the repeats' images."""
        return self._luminance / self.repeats

    @property
    def cell_variance(self) -> NDArray[np.float64]:
        """float64 (rows, columns): estimated variance of the sum of `luminance` over each cell, from how the repeats
        scatter.
        """
        n = self.repeats
        spread = np.maximum(self._cell_squares - self._cells**2 / n, 0)
        # Of equal numbers, what is left is how they were rounded.
        spread[spread < 1e-13 * self._cell_squares] = 0
        return spread / max(n - 1, 1) / n

    @property
    def sample_variance(self) -> NDArray[np.float32]:
        """float32 (height, width): variance of one sample, mean of the channels, from all repeats."""
        count = np.maximum(self.valid, 2)[..., None]
        variance = np.maximum(self.sum_squares - self.sum**2 / count, 0) / (count - 1)
        return variance.mean(axis=2).astype(np.float32)
