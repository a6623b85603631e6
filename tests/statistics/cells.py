"""
Cells of the sphere that follow a density however narrow it is, and the density's integral over each.

The chart is the cylinder around the y axis: s = y in [-1, 1] and the longitude g from +z towards +x, in
[-pi/2, 3 pi/2). It keeps areas (ds dg is solid angle), and has its poles and its seam where nothing of
interest lies: the plane of incidence of the directions that are tested is xz, the mirrored direction is on
the equator, and the upper hemisphere is g < pi/2. Near the horizon g keeps all digits of z, near the
equator s keeps those of y, which narrow lobes at grazing angles need.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Density = Callable[[NDArray[np.float32]], NDArray[np.float32]]

WHOLE = np.array([[-1.0, 1.0], [-np.pi / 2, 3 * np.pi / 2]])
NODES, WEIGHTS = (a / 2 for a in np.polynomial.legendre.leggauss(5))
NODES = NODES + 0.5


def chart(directions: NDArray[np.float32]) -> Array:
    """(n, 3) -> (n, 2) of s and g."""
    x, y, z = directions.astype(np.float64).T
    g = np.arctan2(x, z)
    return np.stack([np.clip(y, -1, 1), np.where(g < -np.pi / 2, g + 2 * np.pi, g)], axis=1)


def directions(points: Array) -> NDArray[np.float32]:
    """The inverse of `chart`."""
    s, g = points.T
    r = np.sqrt(np.maximum(1 - s * s, 0))
    return np.stack([r * np.sin(g), s, r * np.cos(g)], axis=1).astype(np.float32)


class Cells:
    """
    A binary tree over the chart whose leaves each hold about the same share of the pilot points.

    The first cut is the horizon. Then s and g are cut in turn at the median, or halfway where a node has
    few points.
    """

    def __init__(self, pilots: Array, depth: int = 8) -> None:
        self.depth = depth
        self.axis = np.zeros(1 << depth, dtype=np.int64)
        self.cut = np.zeros(1 << depth)
        bounds = np.zeros((2 << depth, 2, 2))
        bounds[1] = WHOLE
        points: dict[int, Array] = {1: pilots}
        for node in range(1, 1 << depth):
            level = node.bit_length() - 1
            axis = 1 if level == 0 else level % 2
            low, high = bounds[node, axis]
            mine = points.pop(node)
            cut = np.pi / 2 if level == 0 else (low + high) / 2
            if level and len(mine) > 8:
                # Halfway between two points, lest the cut lie on one of the few values that a float
                # direction can have.
                values = np.sort(mine[:, axis])
                cut = (values[len(values) // 2 - 1] + values[len(values) // 2]) / 2
            cut = np.clip(cut, low, high)
            self.axis[node], self.cut[node] = axis, cut
            bounds[2 * node] = bounds[2 * node + 1] = bounds[node]
            bounds[2 * node, axis, 1] = bounds[2 * node + 1, axis, 0] = cut
            above = mine[:, axis] >= cut
            points[2 * node], points[2 * node + 1] = mine[~above], mine[above]
        self.bounds = bounds[1 << depth :]
        # Where the lobe of each half is and how wide, for the quadrature.
        self.centre, self.width = np.array([[0.0, 0.0], [0.0, np.pi]]), np.ones((2, 2))
        for half, inside in enumerate((pilots[:, 1] < np.pi / 2, pilots[:, 1] >= np.pi / 2)):
            if inside.sum() > 8:
                low, self.centre[half], high = np.quantile(pilots[inside], [0.3, 0.5, 0.7], axis=0)
                self.width[half] = np.maximum(high - low, 1e-9) / 2

    def __len__(self) -> int:
        return 1 << self.depth

    def index(self, points: Array) -> NDArray[np.int64]:
        """The leaf of each point."""
        node = np.ones(len(points), dtype=np.int64)
        rows = np.arange(len(points))
        for _ in range(self.depth):
            node = 2 * node + (points[rows, self.axis[node]] >= self.cut[node])
        return node - (1 << self.depth)

    def count(self, points: Array) -> Array:
        """How many points each leaf holds."""
        return np.bincount(self.index(points), minlength=len(self)).astype(float)

    def integrate(
        self,
        density: Density,
        tolerance: float = 1e-6,
        quarterings: int = 8,
        least: int = 2,
        seeds: Array | None = None,
    ) -> Array:
        """
        The integral over each leaf, by adaptive Gauss-Legendre quadrature with 5 x 5 nodes in coordinates
        that are linear within the lobe and logarithmic in its flanks: a lobe and its tails are smooth
        there, however narrow.

        A box is quartered until its quarters move its integral by less than `tolerance` or one in ten
        thousand, `least` to `quarterings` times, and where it holds one of the `seeds` until a node meets
        what is there: places that are known to have density, as slivers may slip between all nodes.
        """
        half = np.arange(len(self)) >= len(self) // 2
        centre, width = self.centre[half.astype(int)], self.width[half.astype(int)]
        boxes = np.arcsinh((self.bounds - centre[:, :, None]) / width[:, :, None])
        owner = np.arange(len(self))
        seeds = np.zeros((0, 2)) if seeds is None else seeds
        at_box = self.index(seeds)
        seeds = np.arcsinh((seeds - centre[at_box]) / width[at_box])
        a, b = (grid.ravel() for grid in np.meshgrid(NODES, NODES))
        unit, weights = np.stack([a, b], axis=1), np.outer(WEIGHTS, WEIGHTS).ravel()

        def quadrature(boxes: Array, owner: NDArray[np.int64]) -> Array:
            low, size = boxes[:, None, :, 0], (boxes[:, :, 1] - boxes[:, :, 0])[:, None]
            at = low + size * unit
            points = centre[owner][:, None] + width[owner][:, None] * np.sinh(at)
            jacobian = np.prod(width[owner][:, None] * np.cosh(at), axis=2)
            values = np.asarray(density(directions(points.reshape(-1, 2))), dtype=float).reshape(
                len(boxes), -1
            )
            return (values * jacobian) @ weights * np.prod(size[:, 0], axis=1)

        total = np.zeros(len(self))
        coarse = quadrature(boxes, owner)
        for quartering in range(quarterings):
            middle = boxes.mean(axis=2)
            quarters = np.repeat(boxes[None], 4, axis=0)
            for i in range(4):
                quarters[i, :, 0, 1 - i % 2] = middle[:, 0]
                quarters[i, :, 1, 1 - i // 2] = middle[:, 1]
            fine = quadrature(quarters.reshape(-1, 2, 2), np.tile(owner, 4)).reshape(4, -1)
            together = fine.sum(axis=0)
            done = np.abs(together - coarse) <= np.maximum(tolerance / 2**quartering, 1e-4 * np.abs(together))
            done &= (together > 0) | (np.bincount(at_box, minlength=len(boxes)) == 0)
            if quartering + 1 < least or quartering + 1 == quarterings:
                done[:] = quartering + 1 == quarterings
            np.add.at(total, owner[done], together[done])
            if done.all():
                break
            place = np.cumsum(~done) - 1
            quarter = (seeds >= middle[at_box]) @ [1, 2]
            seeds, quarter, at_box = (values[~done[at_box]] for values in (seeds, quarter, at_box))
            at_box = quarter * (~done).sum() + place[at_box]
            boxes, owner, coarse = (
                quarters[:, ~done].reshape(-1, 2, 2),
                np.tile(owner[~done], 4),
                fine[:, ~done].ravel(),
            )
        return total

    def picture(self, observed: Array, expected: Array, path: Path) -> Path:
        """
        Writes three panels over the part of the chart where the counts are: the counts expected (left) and
        observed (middle), per solid angle and relative to the largest, and (o - e) / sqrt(e) (right, red
        more than expected, blue less, full colour at 5).
        """
        import OpenImageIO as oiio

        held = (observed + expected) > 0.2 * (observed + expected).mean()
        boxes = self.bounds[held] if held.any() else self.bounds
        s, g = (np.linspace(boxes[:, i, 0].min(), boxes[:, i, 1].max(), 402)[1:-1] for i in range(2))
        where = self.index(
            np.stack([grid.ravel() for grid in np.meshgrid(s, g, indexing="ij")], axis=1)
        ).reshape(400, 400)
        area = np.maximum(np.prod(self.bounds[:, :, 1] - self.bounds[:, :, 0], axis=1), 1e-30)
        brightest = np.quantile((expected / area)[held], 0.99) if held.any() else 1.0
        tables = [
            np.repeat((counts / area / brightest)[where][..., None], 3, axis=2) ** 0.45
            for counts in (expected, observed)
        ]
        z = np.clip((observed - expected) / np.sqrt(np.maximum(expected, 1)) / 5, -1, 1)[where]
        tables.append(np.stack([1 + np.minimum(z, 0), 1 - np.abs(z), 1 - np.maximum(z, 0)], axis=2))
        pixels = (np.clip(np.concatenate(tables, axis=1), 0, 1) * 255).astype(np.uint8)
        image = oiio.ImageBuf(np.ascontiguousarray(pixels))
        if not image.write(str(path)):
            raise OSError(image.geterror())
        return path
