"""Where the estimators differ most: the parts of the image that the report enlarges."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from . import metrics

_NUMBER = 4
# One firefly decides no more than a pixel that is wholly wrong.
_MOST_WRONG = 1.0


class Crop(NamedTuple):
    """A square part of the image; its top left corner."""

    x: int
    y: int
    size: int

    def of(self, image: metrics.Image) -> metrics.Image:
        """That part of an image."""
        return image[self.y : self.y + self.size, self.x : self.x + self.size]


def chosen(images: Sequence[metrics.Image], reference: metrics.Image) -> list[Crop]:
    """Up to four squares, an eighth of the image wide and 16 pixels at least, that do not overlap.

    A square's worth is the spread between the estimators of the root of its mean relative squared error, or with
    one estimator that root.
    """
    height, width = reference.shape[:2]
    size = min(max(16, max(height, width) // 8), height, width)
    errors = [np.minimum(metrics.relative_squared_error(i, reference), _MOST_WRONG) for i in images]
    roots = np.sqrt([_box_means(error, size) for error in errors])
    worth = roots[0] if len(images) == 1 else roots.max(axis=0) - roots.min(axis=0)
    found: list[Crop] = []
    while len(found) < _NUMBER and worth.max() > 0:
        y, x = (int(i) for i in np.unravel_index(np.argmax(worth), worth.shape))
        found.append(Crop(x, y, size))
        worth[max(0, y - size + 1) : y + size, max(0, x - size + 1) : x + size] = 0
    return found


def _box_means(values: NDArray[np.float64], size: int) -> NDArray[np.float64]:
    """The mean of every square, indexed by its top left corner."""
    total = np.pad(values.cumsum(0).cumsum(1), ((1, 0), (1, 0)))
    sums = total[size:, size:] - total[:-size, size:] - total[size:, :-size] + total[:-size, :-size]
    return np.asarray(np.maximum(sums, 0) / size**2)
