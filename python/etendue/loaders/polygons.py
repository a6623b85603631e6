"""Polygons into triangles."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Ints = NDArray[np.int64]
Floats = NDArray[np.float64]


def triangulate(points: Floats, corners: Ints, first: Ints) -> tuple[Ints, Ints]:
    """Triangles of polygons, convex or not.

    points: (p, 3). corners: (c,) indices into `points`. first: (n + 1,), where each polygon's corners start.
    Returns triangles (t, 3) as indices into `corners`, and the polygon of each, (t,), in order of the
    polygons. Polygons of fewer than three corners give none.
    """
    sizes = np.diff(first)
    triangles: list[Ints] = []
    owners: list[Ints] = []
    for size in np.unique(sizes[sizes >= 3]).tolist():
        polygons = np.flatnonzero(sizes == size)
        slots = first[polygons][:, None] + np.arange(size)
        if size == 3:
            local = np.broadcast_to(np.arange(3), (len(polygons), 1, 3))
        elif size == 4:
            local = _quads(points[corners[slots]])
        else:
            local = _many_sided(points[corners[slots]])
        count = local.shape[1]
        triangles.append(np.take_along_axis(slots, local.reshape(len(slots), -1), axis=1).reshape(-1, 3))
        owners.append(np.repeat(polygons, count))
    if not triangles:
        return np.zeros((0, 3), np.int64), np.zeros(0, np.int64)
    if len(triangles) == 1:
        return triangles[0], owners[0]
    owner = np.concatenate(owners)
    order = np.argsort(owner, kind="stable")
    return np.concatenate(triangles)[order], owner[order]


def _quads(points: Floats) -> Ints:
    """Two triangles for each quadrilateral, (n, 2, 3), along the diagonal that lies inside."""
    a, b, c, d = points.transpose(1, 0, 2)
    diagonal_ac = np.einsum("ij,ij->i", np.cross(b - a, c - a), np.cross(c - a, d - a))
    diagonal_bd = np.einsum("ij,ij->i", np.cross(c - b, d - b), np.cross(d - b, a - b))
    use_bd = (diagonal_ac <= 0) & (diagonal_bd > diagonal_ac)
    along_ac, along_bd = np.array([[0, 1, 2], [0, 2, 3]]), np.array([[1, 2, 3], [1, 3, 0]])
    return np.where(use_bd[:, None, None], along_bd, along_ac)


def _many_sided(points: Floats) -> Ints:
    """size - 2 triangles for each polygon, (n, size - 2, 3)."""
    size = points.shape[1]
    after = np.roll(points, -1, axis=1)
    normal = np.cross(points, after).sum(axis=1)
    edges = after - points
    turns = np.einsum("ijk,ik->ij", np.cross(np.roll(edges, 1, axis=1), edges), normal)
    concave = np.flatnonzero((turns < 0).any(axis=1))
    fan = np.stack([np.zeros(size - 2, np.int64), np.arange(1, size - 1), np.arange(2, size)], axis=1)
    result = np.repeat(fan[None], len(points), axis=0)
    for index in concave.tolist():
        ears = _earcut(points[index], normal[index])
        if ears is not None:
            result[index] = ears
    return result


def _earcut(points: Floats, normal: Floats) -> Ints | None:
    """Triangles of one concave polygon, (size - 2, 3); None where it crosses itself and has no inside."""
    import mapbox_earcut

    # The projection along the largest axis of the normal; swapped so that its orientation is kept.
    axis = int(np.abs(normal).argmax())
    others = [(axis + 1) % 3, (axis + 2) % 3]
    flat = np.ascontiguousarray(points[:, others] if normal[axis] > 0 else points[:, others[::-1]])
    indices = mapbox_earcut.triangulate_float64(flat, np.array([len(flat)], np.uint32))
    triangles = np.asarray(indices, np.int64).reshape(-1, 3)
    if len(triangles) != len(points) - 2:
        return None
    a, b, c = (flat[triangles[:, corner]] for corner in range(3))
    area = (b[:, 0] - a[:, 0]) * (c[:, 1] - a[:, 1]) - (b[:, 1] - a[:, 1]) * (c[:, 0] - a[:, 0])
    # Ears come in either orientation; the front is where the polygon's is.
    triangles[area < 0] = triangles[area < 0][:, ::-1]
    return triangles
