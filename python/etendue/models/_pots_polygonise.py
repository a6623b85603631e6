"""Implicit surfaces as triangles: naive surface nets over a regular grid."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from etendue.models.mesh import Floats, Ints, Mesh

Flags = NDArray[np.bool_]
Field = Callable[[Floats], Floats]

# Cells along an edge of the blocks in which a grid is sampled.
BLOCK = 6


def polygonised(field: Field, low: Sequence[float], high: Sequence[float], cell: float) -> Mesh:
    """The surface between two corners where `field`, (n, 3) points to (n,) values, is zero.

    Inside, the field is below zero.  A cell that the surface crosses gets one vertex, moved onto it along the
    gradient, which also gives the normals.  The result is closed where the surface stays inside of the box.
    """
    start = np.asarray(low, float)
    blocks = np.ceil((np.asarray(high, float) - start) / (cell * BLOCK)).astype(int)
    value = _unambiguous(_sampled(field, start, blocks, cell))
    inside = value < 0
    vertex_of, points = _cell_vertices(value, inside)
    faces = np.concatenate([_quads(inside, vertex_of, axis) for axis in range(3)])
    points = start + cell * points
    gradient = _gradient(field, points, cell / 10)
    for _ in range(2):
        step = field(points) / np.maximum(np.sum(gradient**2, 1), 1e-6)
        points = points - np.clip(step, -cell / 2, cell / 2)[:, None] * gradient
    normals = _gradient(field, points, cell / 10)
    return Mesh(points, _triangles(points, faces), normals / np.linalg.norm(normals, axis=1, keepdims=True))


def _sampled(field: Field, start: Floats, blocks: Ints, cell: float) -> Floats:
    """The field at the grid's points; far from the surface only its value at the middle of the block."""
    size = blocks * BLOCK + 1
    index = np.stack(np.meshgrid(*[np.arange(n) for n in blocks], indexing="ij"), -1).reshape(-1, 3)
    middle = field(start + cell * BLOCK * (index + 0.5))
    value = np.empty(tuple(size))
    value[:] = np.inf
    offset = np.stack(np.meshgrid(*[np.arange(BLOCK + 1)] * 3, indexing="ij"), -1)
    # Fields may run up to half again as steep as a distance.
    near = np.abs(middle) < 1.5 * cell * BLOCK * np.sqrt(3) / 2
    for near_part, (i, j, k), m in zip(near, index * BLOCK, middle, strict=True):
        if not near_part:
            value[i : i + BLOCK + 1, j : j + BLOCK + 1, k : k + BLOCK + 1] = m
    at = (index[near] * BLOCK)[:, None, None, None] + offset
    # In portions, to keep the temporaries small.
    for part in np.array_split(at.reshape(-1, 3), max(1, len(at) // 300)):
        value[part[:, 0], part[:, 1], part[:, 2]] = field(start + cell * part)
    return value


def _unambiguous(value: Floats) -> Floats:
    """The grid without squares that are inside at two opposite corners alone, where two sheets would meet."""
    value = value.copy()
    while True:
        changed = False
        for axis in range(3):
            v = np.moveaxis(value, axis, 0)
            a, b, c, d = v[:, :-1, :-1], v[:, 1:, :-1], v[:, 1:, 1:], v[:, :-1, 1:]
            ia, ib, ic, id_ = a < 0, b < 0, c < 0, d < 0
            for one, other in ((a, c), (b, d)):
                outside = (ia == ic) & (ib == id_) & (ia != ib) & (one >= 0)
                one[outside & (one <= other)] = -1e-9
                other[outside & (other < one) & (other >= 0)] = -1e-9
                changed |= bool(outside.any())
        if not changed:
            return value


def _cell_vertices(value: Floats, inside: Flags) -> tuple[Ints, Floats]:
    """The number of each cell's vertex (-1 where it has none), and the vertices in units of cells."""
    n = np.array(value.shape) - 1
    corner = [(i, j, k) for i in (0, 1) for j in (0, 1) for k in (0, 1)]

    def at(grid: NDArray[Any], c: tuple[int, ...]) -> NDArray[Any]:
        return grid[c[0] : c[0] + n[0], c[1] : c[1] + n[1], c[2] : c[2] + n[2]]

    count = sum(at(inside, c).astype(int) for c in corner)
    crossed = (count > 0) & (count < 8)
    vertex_of = np.full(tuple(n), -1)
    vertex_of[crossed] = np.arange(np.count_nonzero(crossed))
    total = np.zeros((np.count_nonzero(crossed), 3))
    edges = np.zeros(len(total))
    for a in corner:
        for axis in range(3):
            if a[axis]:
                continue
            b = (*a[:axis], 1, *a[axis + 1 :])
            va, vb = at(value, a)[crossed], at(value, b)[crossed]
            cut = (va < 0) != (vb < 0)
            position = np.tile(np.array(a, float), (len(va), 1))
            position[:, axis] = np.where(cut, va / np.where(cut, va - vb, 1), 0)
            total += position * cut[:, None]
            edges += cut
    return vertex_of, np.argwhere(crossed) + total / edges[:, None]


def _quads(inside: Flags, vertex_of: Ints, axis: int) -> Ints:
    """The quads around grid edges along `axis` that cross the surface, their fronts outside."""
    u, v = (axis + 1) % 3, (axis + 2) % 3
    order = (axis, u, v)
    a = inside.transpose(order)
    cells = vertex_of.transpose(order)
    first, second = a[:-1, 1:-1, 1:-1], a[1:, 1:-1, 1:-1]
    ring = np.stack([cells[:, :-1, :-1], cells[:, 1:, :-1], cells[:, 1:, 1:], cells[:, :-1, 1:]], -1)
    return np.concatenate([ring[first & ~second], ring[~first & second][:, ::-1]])


def _triangles(points: Floats, quads: Ints) -> Ints:
    """Two triangles a quad, along its shorter diagonal."""
    p = points[quads]
    other = np.linalg.norm(p[:, 1] - p[:, 3], axis=1) < np.linalg.norm(p[:, 0] - p[:, 2], axis=1)
    q = np.where(other[:, None], np.roll(quads, -1, 1), quads)
    return np.concatenate([q[:, [0, 1, 2]], q[:, [0, 2, 3]]])


def _gradient(field: Field, points: Floats, step: float) -> Floats:
    """The gradient from the corners of a tetrahedron around each point."""
    corners = np.array([[1, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1]], float)
    return np.asarray(sum(field(points + step * c)[:, None] * c for c in corners) / (4 * step))
