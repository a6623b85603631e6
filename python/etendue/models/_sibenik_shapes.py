"""Stone shapes: arches, walls with openings, mouldings carried along curves, clustered shafts."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from etendue.models.mesh import Floats, Mesh, box, merged, surface

# Textures of stone repeat after this many metres.
STONE_METRES = 4.0


@dataclass(frozen=True)
class Arch:
    """An arch in the xy plane with its springing on y = 0.

    Attributes:
        half: half of the clear span.
        lean: how far beyond the axis the arcs have their centres; 0 is a round arch, more is more pointed.
    """

    half: float
    lean: float = 0.0

    @property
    def rise(self) -> float:
        """Height of the crown."""
        return float(np.sqrt((self.half + self.lean) ** 2 - self.lean**2))

    def curve(self, offset: float = 0.0, n: int = 12) -> Floats:
        """The arch widened by `offset`: (2 n + 1, 2) points from the right over the crown to the left."""
        radius = self.half + self.lean + offset
        angle = np.linspace(0, np.arccos(self.lean / radius), n + 1)
        right = np.stack([radius * np.cos(angle) - self.lean, radius * np.sin(angle)], 1)
        right[-1, 0] = 0
        return np.concatenate([right, right[-2::-1] * [-1, 1]])

    def outline(
        self, jamb: float, offset: float = 0.0, n: int = 12, jamb_steps: int = 1, sill_steps: int = 1
    ) -> Floats:
        """A window with its sill `jamb` below the springing, counter-clockwise from the right springing."""
        head = self.curve(offset, n)
        left = np.linspace(head[-1], [head[-1, 0], -jamb - offset], jamb_steps + 1)[1:]
        sill = np.linspace(left[-1], [head[0, 0], -jamb - offset], sill_steps + 1)[1:]
        right = np.linspace(sill[-1], head[0], jamb_steps + 1)[1:-1]
        return np.concatenate([head, left, sill, right])


def circle(radius: float, n: int = 32) -> Floats:
    """Points of a circle, counter-clockwise."""
    angle = 2 * np.pi * np.arange(n) / n
    return np.stack([radius * np.cos(angle), radius * np.sin(angle)], 1)


def faceted(mesh: Mesh) -> Mesh:
    """The mesh with every face flat, and uvs in metres of stone by the axis that the face looks along."""
    p = mesh.vertices[mesh.faces]
    n = np.cross(p[:, 1] - p[:, 0], p[:, 2] - p[:, 0])
    length = np.linalg.norm(n, axis=1)
    p, n = p[length > 1e-12], n[length > 1e-12] / length[length > 1e-12, None]
    axis = np.abs(n + [1e-6, 0, 0]).argmax(1)
    u = np.where(axis == 0, 2, 0)
    v = np.where(axis == 1, 2, 1)
    rows = np.arange(len(p))
    uv = np.stack([p[rows, :, u], p[rows, :, v]], 2) / STONE_METRES
    return welded(
        Mesh(p.reshape(-1, 3), np.arange(3 * len(p)).reshape(-1, 3), np.repeat(n, 3, 0), uv.reshape(-1, 2))
    )


def block(x0: float, x1: float, y0: float, y1: float, z0: float, z1: float, bevel: float = 0.0) -> Mesh:
    """A box between two corners, its edges cut off by `bevel`."""
    size = np.array([x1 - x0, y1 - y0, z1 - z0])
    centre = (x0 + x1) / 2, (y0 + y1) / 2, (z0 + z1) / 2
    if bevel <= 0:
        return faceted(box(*size).moved(*centre))
    signs = np.array([[i, j, k] for i in (-1, 1) for j in (-1, 1) for k in (-1, 1)], float)
    # Every corner becomes a triangle, every edge a strip: the hull of three boxes, each shrunk on two axes.
    corner = {axis: signs * (size / 2 - np.where(np.arange(3) == axis, 0, bevel)) for axis in range(3)}
    vertices = np.concatenate([corner[axis] for axis in range(3)])
    faces: list[list[int]] = []

    def at(axis: int, s: Sequence[int]) -> int:
        return axis * 8 + (s[0] > 0) * 4 + (s[1] > 0) * 2 + (s[2] > 0)

    def face(ids: list[int]) -> None:
        points = vertices[ids]
        if np.cross(points[1] - points[0], points[2] - points[0]) @ points.mean(0) < 0:
            ids = ids[::-1]
        faces.extend([ids[0], ids[k], ids[k + 1]] for k in range(1, len(ids) - 1))

    for axis in range(3):
        i, j = (axis + 1) % 3, (axis + 2) % 3
        for s in (-1, 1):
            ring = []
            for si, sj in ((-1, -1), (1, -1), (1, 1), (-1, 1)):
                t = [0, 0, 0]
                t[axis], t[i], t[j] = s, si, sj
                ring.append(at(axis, t))
            face(ring)
            for s2 in (-1, 1):
                ends = []
                for along in (-1, 1):
                    t = [0, 0, 0]
                    t[axis], t[i], t[j] = along, s, s2
                    ends.append((at(i, t), at(j, t)))
                face([ends[0][0], ends[0][1], ends[1][1], ends[1][0]])
    for s3 in signs.astype(int):
        face([at(axis, s3) for axis in range(3)])
    return faceted(Mesh(vertices, np.array(faces)).moved(*centre))


def grid(
    points: Floats, crease: float = 40.0, metres: float = STONE_METRES, uvs: Floats | None = None
) -> Mesh:
    """A patch over (rows, columns, 3) points; its front is dP/dcolumn x dP/drow.

    Without `uvs` (rows, columns, 2) they are arc lengths, 1 per `metres`.
    """
    rows, columns = points.shape[:2]

    def at(u: Floats, v: Floats) -> Floats:
        return points[np.round(v * (rows - 1)).astype(int), np.round(u * (columns - 1)).astype(int)]

    mesh = surface(at, columns - 1, rows - 1)
    if uvs is not None:
        return welded(Mesh(mesh.vertices, mesh.faces, None, uvs.reshape(-1, 2)).smooth(crease))
    steps = np.linalg.norm(np.diff(points, axis=1), axis=2).mean(0)
    rises = np.linalg.norm(np.diff(points, axis=0), axis=2).mean(1)
    s, t = np.r_[0, np.cumsum(steps)], np.r_[0, np.cumsum(rises)]
    uv = np.stack(np.broadcast_arrays(s[None, :], t[:, None]), 2).reshape(-1, 2) / metres
    return welded(Mesh(mesh.vertices, mesh.faces, None, uv).smooth(crease))


def welded(mesh: Mesh) -> Mesh:
    """The mesh with vertices of the same place, normal and uv made one."""
    columns = [c for c in (mesh.vertices, mesh.normals, mesh.uvs) if c is not None]
    keys = np.round(np.concatenate(columns, 1), 6) + 0.0
    _, first, number = np.unique(keys, axis=0, return_index=True, return_inverse=True)
    normals = None if mesh.normals is None else mesh.normals[first]
    uvs = None if mesh.uvs is None else mesh.uvs[first]
    return Mesh(mesh.vertices[first], number.reshape(-1)[mesh.faces], normals, uvs)


def bare(mesh: Mesh) -> Mesh:
    """The mesh as its faces alone, flat and without uvs."""
    return Mesh(mesh.vertices, mesh.faces)


def band(profile: ArrayLike, curves: Sequence[Floats], closed: bool = False, crease: float = 40.0) -> Mesh:
    """A moulding along a curve in the xy plane.

    `curves[i]` is the curve at the profile's i-th point, whose depth z is `profile[i]`; the moulding faces
    the inside of a counter-clockwise curve when the profile runs from the front (+z) to the back.
    """
    z = np.asarray(profile, float)
    rows = [np.c_[c, np.full(len(c), depth)] for c, depth in zip(curves, z, strict=True)]
    if closed:
        rows = [np.concatenate([r, r[:1]]) for r in rows]
    return grid(np.stack(rows), crease)


def arch_band(arch: Arch, profile: ArrayLike, n: int = 12, crease: float = 40.0) -> Mesh:
    """A moulding of (offset, depth) points along an arch, facing into the opening."""
    p = np.asarray(profile, float)
    return band(p[:, 1], [arch.curve(offset, n) for offset in p[:, 0]], crease=crease)


def pierced(x0: float, x1: float, y0: float, y1: float, hole: Floats) -> Mesh:
    """A rectangle in the xy plane facing +z, with a hole that its mean point sees all of."""
    centre = np.array([hole[:, 0].mean(), (hole[:, 1].min() + hole[:, 1].max()) / 2])
    corners = np.array([[x1, y0], [x1, y1], [x0, y1], [x0, y0]])
    return between(hole, corners, centre, closed=True)


def arched(x0: float, x1: float, y0: float, y1: float, curve: Floats) -> Mesh:
    """A rectangle in the xy plane facing +z, open at the bottom under a curve that starts and ends on y0."""
    centre = np.array([curve[:, 0].mean(), y0])
    corners = np.array([[x1, y0], [x1, y1], [x0, y1], [x0, y0]])
    return between(curve, corners, centre, closed=False)


def between(inner: Floats, outer: Floats, centre: Floats, closed: bool) -> Mesh:
    """Triangles between two star-shaped polylines, both counter-clockwise about the centre."""

    def angles(p: Floats) -> Floats:
        return np.unwrap(np.arctan2(p[:, 1] - centre[1], p[:, 0] - centre[0]))

    a, b = angles(inner), angles(outer)
    if closed:
        start = int(np.argmin(np.mod(b - a[0], 2 * np.pi)))
        outer = np.roll(outer, -start, 0)
        inner = np.concatenate([inner, inner[:1]])
        outer = np.concatenate([outer, outer[:1]])
        a = np.r_[a, a[0] + 2 * np.pi]
        turns = np.mod(np.diff(np.r_[np.roll(b, -start), b[start]]), 2 * np.pi)
        b = a[0] + np.mod(b[start] - a[0], 2 * np.pi) + np.r_[0, np.cumsum(turns)]
    outer, b = _with_rays(outer, b, centre, a)
    vertices = np.concatenate([inner, outer])
    faces = []
    i, j, n = 0, 0, len(inner)
    while i < len(inner) - 1 or j < len(outer) - 1:
        if j == len(outer) - 1 or (i < len(inner) - 1 and a[i + 1] <= b[j + 1]):
            faces.append([i, n + j, i + 1])
            i += 1
        else:
            faces.append([i, n + j, n + j + 1])
            j += 1
    return faceted(Mesh(np.c_[vertices, np.zeros(len(vertices))], np.array(faces)))


def _with_rays(line: Floats, angles: Floats, centre: Floats, rays: Floats) -> tuple[Floats, Floats]:
    """A polyline with points added where rays from the centre meet it, and the angles of all its points.

    Triangles between two polylines stay outside the inner one when every inner point has its outer one.
    """
    points, at = [line[0]], [angles[0]]
    for p, q, low, high in zip(line[:-1], line[1:], angles[:-1], angles[1:], strict=True):
        for ray in rays[(rays > low + 1e-9) & (rays < high - 1e-9)]:
            d = np.array([-np.sin(ray), np.cos(ray)])
            t = d @ (centre - p) / (d @ (q - p))
            points.append(p + t * (q - p))
            at.append(ray)
        points.append(q)
        at.append(high)
    return np.array(points), np.array(at)


def wall(x0: float, x1: float, y0: float, y1: float) -> Mesh:
    """A plain rectangle in the xy plane, facing +z."""
    corners = np.array([[x0, y0, 0], [x1, y0, 0], [x1, y1, 0], [x0, y1, 0]], float)
    return faceted(Mesh(corners, np.array([[0, 1, 2], [0, 2, 3]])))


def cluster(circles: ArrayLike, profile: ArrayLike, per_lobe: int = 10, crease: float = 35.0) -> Mesh:
    """Shafts grown together: the union of (x, z, radius) circles about the y axis, widened along a profile.

    The profile is (offset, height) points from bottom to top; offsets widen every circle alike.
    """
    c, p = np.asarray(circles, float), np.asarray(profile, float)
    dense = np.linspace(0, 2 * np.pi, 1441)
    owner = _reach(c, dense, 0.0)[1]
    change = dense[np.flatnonzero(np.diff(owner)) + 1]
    if len(change):
        stops = np.r_[change, change[0] + 2 * np.pi]
        theta = np.concatenate(
            [np.linspace(a, b, per_lobe, endpoint=False) for a, b in zip(stops[:-1], stops[1:], strict=True)]
        )
        theta = np.r_[theta, theta[0] + 2 * np.pi]
    else:
        theta = np.linspace(0, 2 * np.pi, 3 * per_lobe + 1)
    rows = []
    for offset, height in p:
        reach = _reach(c, theta, offset)[0]
        rows.append(np.stack([reach * np.cos(theta), np.full(len(theta), height), -reach * np.sin(theta)], 1))
    return grid(np.stack(rows), crease)


def _reach(circles: Floats, theta: Floats, offset: float) -> tuple[Floats, Floats]:
    """How far the union reaches in each direction, and which circle does."""
    d = np.stack([np.cos(theta), -np.sin(theta)], 1)
    along = d @ circles[:, :2].T
    squared = along**2 - (circles[:, :2] ** 2).sum(1) + (circles[:, 2] + offset) ** 2
    reach = np.where((squared > 0) & (along >= -1e-9), along + np.sqrt(np.maximum(squared, 0)), 0)
    return reach.max(1), reach.argmax(1)


def facing(mesh: Mesh, towards: str) -> Mesh:
    """A wall piece that faces +z turned to face "+z", "-z", "+x" or "-x"."""
    return mesh.turned("y", {"+z": 0, "+x": 90, "-z": 180, "-x": -90}[towards])


def both_sides(*meshes: Mesh) -> Mesh:
    """The meshes and their mirror images in the plane z = 0."""
    one = merged(meshes)
    return merged([one, one.scaled(1, 1, -1)])
