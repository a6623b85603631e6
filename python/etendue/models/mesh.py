"""Triangle meshes as values: primitives that are born at the origin, and moves that return new meshes.

Right-handed, +Y up, metres.  Every primitive's triangles are counter-clockwise seen from outside, so that
normals, and the light of lamps, point outwards.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]


@dataclass(frozen=True)
class Mesh:
    """A triangle soup with shared vertices.

    Attributes:
        vertices: float64 (n, 3).
        faces: int64 (m, 3), counter-clockwise seen from the front.
        normals: float64 (n, 3) of unit length, or None for flat shading.
        uvs: float64 (n, 2), v = 0 at the bottom of the image, or None.
    """

    vertices: Floats
    faces: Ints
    normals: Floats | None = None
    uvs: Floats | None = None

    def moved(self, x: float = 0, y: float = 0, z: float = 0) -> Mesh:
        """The mesh translated."""
        return Mesh(self.vertices + np.array([x, y, z], float), self.faces, self.normals, self.uvs)

    def scaled(self, x: float, y: float | None = None, z: float | None = None) -> Mesh:
        """The mesh scaled about the origin, by one number or three. Mirroring keeps the front outside."""
        factors = np.array([x, x if y is None else y, x if z is None else z], float)
        return self.transformed(np.diag(factors))

    def turned(self, axis: str, degrees: float) -> Mesh:
        """The mesh rotated about a coordinate axis ("x", "y" or "z") by the right-hand rule."""
        i = "xyz".index(axis)
        j, k = (i + 1) % 3, (i + 2) % 3
        c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
        matrix = np.eye(3)
        matrix[j, j], matrix[j, k], matrix[k, j], matrix[k, k] = c, -s, s, c
        return self.transformed(matrix)

    def transformed(self, matrix: ArrayLike) -> Mesh:
        """The mesh under a 3 x 3 linear map; normals follow by the inverse transpose."""
        m = np.asarray(matrix, float)
        normals = None
        if self.normals is not None:
            normals = _unit(self.normals @ np.linalg.inv(m))
        faces = self.faces if np.linalg.det(m) > 0 else self.faces[:, ::-1]
        return Mesh(self.vertices @ m.T, faces, normals, self.uvs)

    def bent(self, f: Callable[[Floats], Floats]) -> Mesh:
        """The mesh with its vertices sent through `f`, (n, 3) to (n, 3); smooth normals are computed anew."""
        bent = Mesh(np.asarray(f(self.vertices), float), self.faces, None, self.uvs)
        return bent if self.normals is None else bent.smooth()

    def flipped(self) -> Mesh:
        """The mesh inside out."""
        return Mesh(
            self.vertices, self.faces[:, ::-1], None if self.normals is None else -self.normals, self.uvs
        )

    def flat(self) -> Mesh:
        """The mesh without shading normals."""
        return Mesh(self.vertices, self.faces, None, self.uvs)

    def smooth(self, crease_degrees: float = 180) -> Mesh:
        """The mesh with normals averaged by area over the faces at a place, across edges flatter than a crease.

        Vertices at one place count as one, whatever their uvs.  With a crease angle below 180 the faces no
        longer share vertices.
        """
        corners = self.vertices[self.faces]
        area_normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        scale = max(float(np.ptp(self.vertices, axis=0).max()), 1e-12)
        _, place = np.unique(np.round(self.vertices / scale, 7), axis=0, return_inverse=True)
        place = place.reshape(-1)
        if crease_degrees >= 180:
            sums = np.zeros((place.max() + 1, 3))
            for corner in range(3):
                np.add.at(sums, place[self.faces[:, corner]], area_normals)
            return Mesh(self.vertices, self.faces, _unit(sums[place]), self.uvs)
        face_normals = _unit(area_normals)
        corner_place = place[self.faces].reshape(-1)
        order = np.argsort(corner_place, kind="stable")
        starts = np.flatnonzero(np.r_[True, np.diff(corner_place[order]) > 0, True])
        limit = np.cos(np.radians(crease_degrees))
        normals = np.zeros((len(corner_place), 3))
        for a, b in zip(starts[:-1], starts[1:], strict=True):
            around = order[a:b]
            n = face_normals[around // 3]
            normals[around] = ((n @ n.T) >= limit).astype(float) @ area_normals[around // 3]
        flat = self.faces.reshape(-1)
        return Mesh(
            self.vertices[flat],
            np.arange(len(flat)).reshape(-1, 3),
            _unit(normals),
            None if self.uvs is None else self.uvs[flat],
        )


def merged(meshes: Iterable[Mesh]) -> Mesh:
    """One mesh of many; where any has normals or uvs, the others get flat normals and zero uvs."""
    parts = list(meshes)
    with_normals = any(p.normals is not None for p in parts)
    with_uvs = any(p.uvs is not None for p in parts)
    if with_normals:
        parts = [p if p.normals is not None else p.smooth(crease_degrees=0.01) for p in parts]
    offsets = np.cumsum([0] + [len(p.vertices) for p in parts])
    return Mesh(
        np.concatenate([p.vertices for p in parts]),
        np.concatenate([p.faces + o for p, o in zip(parts, offsets, strict=False)]),
        np.concatenate([p.normals for p in parts if p.normals is not None]) if with_normals else None,
        np.concatenate([p.uvs if p.uvs is not None else np.zeros((len(p.vertices), 2)) for p in parts])
        if with_uvs
        else None,
    )


def surface(
    f: Callable[[Floats, Floats], Floats], nu: int, nv: int, uv_scale: tuple[float, float] = (1, 1)
) -> Mesh:
    """A smooth patch: `f(u, v)` over the unit square, arrays (n,) to positions (n, 3), in nu x nv quads.

    The front is the side of dP/du x dP/dv.
    """
    v, u = (
        t.ravel() for t in np.meshgrid(np.linspace(0, 1, nv + 1), np.linspace(0, 1, nu + 1), indexing="ij")
    )
    i = (np.arange(nv)[:, None] * (nu + 1) + np.arange(nu)).ravel()
    a, b, c, d = i, i + 1, i + nu + 2, i + nu + 1
    faces = np.concatenate([np.stack([a, b, c], 1), np.stack([a, c, d], 1)])
    mesh = Mesh(np.asarray(f(u, v), float), faces, None, np.stack([u * uv_scale[0], v * uv_scale[1]], 1))
    p = mesh.vertices[mesh.faces]
    area = np.linalg.norm(np.cross(p[:, 1] - p[:, 0], p[:, 2] - p[:, 0]), axis=1)
    return Mesh(mesh.vertices, mesh.faces[area > 1e-14], None, mesh.uvs).smooth()


def quad(
    a: ArrayLike, b: ArrayLike, c: ArrayLike, d: ArrayLike, uv_scale: tuple[float, float] = (1, 1)
) -> Mesh:
    """A flat quadrilateral, counter-clockwise seen from its front; a is at uv (0, 0), c at `uv_scale`."""
    s, t = uv_scale
    return Mesh(
        np.array([a, b, c, d], float),
        np.array([[0, 1, 2], [0, 2, 3]]),
        None,
        np.array([[0, 0], [s, 0], [s, t], [0, t]], float),
    )


def box(x: float, y: float, z: float, uv_scale: float = 1) -> Mesh:
    """A box of these edge lengths centred at the origin, its uvs in metres times `uv_scale`."""
    h = np.array([x, y, z]) / 2
    sides = []
    for axis in range(3):
        u, v = (axis + 1) % 3, (axis + 2) % 3
        for sign in (1, -1):
            corners = np.zeros((4, 3))
            corners[:, axis] = sign * h[axis]
            corners[:, u] = np.array([-1, 1, 1, -1]) * h[u] * sign
            corners[:, v] = np.array([-1, -1, 1, 1]) * h[v]
            a, b, c, d = corners
            sides.append(quad(a, b, c, d, uv_scale=(2 * h[u] * uv_scale, 2 * h[v] * uv_scale)))
    return merged(sides)


def rounded_prism(footprint: ArrayLike, height: float, radius: float, steps: int = 3) -> Mesh:
    """A convex polygon of (x, z) points extruded from y = 0 to `height`, every edge rounded by `radius`.

    The points may run either way round; the solid is closed, its flat sides stay flat and its extent is that
    of the sharp prism.
    """
    p = np.asarray(footprint, float)
    area = np.sum(p[:, 0] * np.roll(p[:, 1], -1) - p[:, 1] * np.roll(p[:, 0], -1))
    p = p if area > 0 else p[::-1]
    edge = _unit(np.roll(p, -1, 0) - p)
    out = np.stack([edge[:, 1], -edge[:, 0]], 1)
    before = np.roll(out, 1, 0)
    # The centre of a corner's arc lies `radius` inside of both sides that meet there.
    centre = p - radius * (before + out) / (1 + np.sum(before * out, 1))[:, None]
    first, last = np.arctan2(before[:, 1], before[:, 0]), np.arctan2(out[:, 1], out[:, 0])
    share = np.linspace(0, 1, steps + 1)
    theta = first[:, None] + np.mod(last - first, 2 * np.pi)[:, None] * share
    side = np.stack([np.cos(theta), np.sin(theta)], 2).reshape(-1, 2)
    core = np.repeat(centre, steps + 1, 0)
    tilt = np.pi / 2 * np.r_[share - 1, share]
    level = np.r_[np.full(steps + 1, radius), np.full(steps + 1, height - radius)]
    n, rings = len(side), len(tilt)
    flat = core + radius * np.cos(tilt)[:, None, None] * side
    y = np.broadcast_to((level + radius * np.sin(tilt))[:, None], flat.shape[:2])
    vertices = np.stack([flat[..., 0], y, flat[..., 1]], 2).reshape(-1, 3)
    cos, sin = np.cos(tilt)[:, None], np.sin(tilt)[:, None]
    normals = np.stack([cos * side[:, 0], sin + 0 * side[:, 0], cos * side[:, 1]], 2).reshape(-1, 3)
    i = (np.arange(rings - 1)[:, None] * n + np.arange(n)).ravel()
    j = i - i % n + (i + 1) % n
    fan = np.stack([np.zeros(n - 2, int), np.arange(1, n - 1), np.arange(2, n)], 1)
    # At both caps the corners' arcs have shrunk to points.
    fan = fan[(fan[:, 1] // (steps + 1) != fan[:, 2] // (steps + 1)) & (fan[:, 1] > steps)]
    faces = np.concatenate(
        [np.stack([i, i + n, j], 1), np.stack([j, i + n, j + n], 1), fan, fan[:, ::-1] + (rings - 1) * n]
    )
    q = vertices[faces]
    keep = np.linalg.norm(np.cross(q[:, 1] - q[:, 0], q[:, 2] - q[:, 0]), axis=1) > 1e-14
    return Mesh(vertices, faces[keep], normals)


def sphere(radius: float, nu: int = 48, nv: int = 24) -> Mesh:
    """A sphere with its poles on the y axis."""

    def f(u: Floats, v: Floats) -> Floats:
        theta, phi = np.pi * (1 - v), -2 * np.pi * u
        return radius * np.stack([np.sin(theta) * np.cos(phi), np.cos(theta), np.sin(theta) * np.sin(phi)], 1)

    return surface(f, nu, nv)


def lathe(profile: ArrayLike, segments: int = 48, crease_degrees: float = 40) -> Mesh:
    """A profile of (radius, height) points, from bottom to top on the outside, turned about the y axis.

    Edges of the profile sharper than the crease stay sharp.
    """
    points = np.asarray(profile, float)

    def f(u: Floats, v: Floats) -> Floats:
        at = np.clip(np.round(v * (len(points) - 1)).astype(int), 0, len(points) - 1)
        phi = -2 * np.pi * u
        return np.stack([points[at, 0] * np.cos(phi), points[at, 1], points[at, 0] * np.sin(phi)], 1)

    return surface(f, segments, len(points) - 1).smooth(crease_degrees)


def cylinder(radius: float, height: float, segments: int = 48, capped: bool = True) -> Mesh:
    """A cylinder standing on the origin along +y."""
    rim = [(radius, 0), (radius, height)]
    return lathe([(0, 0), *rim, (0, height)] if capped else rim, segments)


def disc(radius: float, segments: int = 48) -> Mesh:
    """A disc in the xz plane, facing +y."""
    phi = -2 * np.pi * np.arange(segments) / segments
    ring = np.stack([np.cos(phi), np.zeros(segments), np.sin(phi)], 1)
    i = np.arange(segments)
    return Mesh(
        np.concatenate([[[0, 0, 0]], radius * ring]),
        np.stack([np.zeros(segments, int), 1 + i, 1 + (i + 1) % segments], 1),
        None,
        np.concatenate([[[0.5, 0.5]], 0.5 + 0.5 * ring[:, [0, 2]]]),
    )


def sweep(section: ArrayLike, path: ArrayLike, closed_section: bool = True, closed_path: bool = False,
          up: ArrayLike = (0, 1, 0), crease_degrees: float = 40) -> Mesh:  # fmt: skip
    """A flat section of (right, up) points carried along a path of (n, 3) points.

    The section should run counter-clockwise seen by someone walking the path, for the front to be outside.
    `up` keeps the section upright; open ends of a closed section are not capped.
    """
    s, p = np.asarray(section, float), np.asarray(path, float)
    if closed_section:
        s = np.concatenate([s, s[:1]])
    ahead = np.roll(p, -1, 0) if closed_path else np.concatenate([p[1:], 2 * p[-1:] - p[-2:-1]])
    behind = np.roll(p, 1, 0) if closed_path else np.concatenate([2 * p[:1] - p[1:2], p[:-1]])
    tangent = _unit(_unit(ahead - p) + _unit(p - behind))
    right = _unit(np.cross(tangent, np.asarray(up, float)))
    over = np.cross(right, tangent)
    # A mitred corner is wider than the section by 1 / cos of half the turn.
    half_turn = np.clip(np.einsum("ij,ij->i", tangent, _unit(p - behind)), 0.3, 1)
    rows = (
        p[:, None] + s[None, :, :1] * (right / half_turn[:, None])[:, None] + s[None, :, 1:] * over[:, None]
    )
    if closed_path:
        rows = np.concatenate([rows, rows[:1]])
    n, m = rows.shape[:2]

    def f(u: Floats, v: Floats) -> Floats:
        return rows[np.round(v * (n - 1)).astype(int), np.round(u * (m - 1)).astype(int)]

    # Along the section, then along the path: that patch faces inwards.
    return surface(f, m - 1, n - 1).smooth(crease_degrees).flipped()


def extruded(outline: ArrayLike, depth: float) -> Mesh:
    """A simple polygon of (x, y) points, counter-clockwise, from z = 0 to z = depth, with both ends."""
    p = np.asarray(outline, float)
    n = len(p)
    tri = _ear_clip(p)
    front = np.c_[p, np.full(n, depth)]
    back = np.c_[p, np.zeros(n)]
    i = np.arange(n)
    j = (i + 1) % n
    sides = merged(quad(back[a], back[b], front[b], front[a]) for a, b in zip(i, j, strict=True))
    return merged([Mesh(front, tri, None, p.copy()), Mesh(back, tri[:, ::-1], None, p.copy()), sides])


def bezier(control: ArrayLike, n: int = 8) -> Mesh:
    """A bicubic Bezier patch of control points (4, 4, 3), rows along v, columns along u, in n x n quads."""
    c = np.asarray(control, float)

    def bernstein(t: Floats) -> Floats:
        return np.stack([(1 - t) ** 3, 3 * t * (1 - t) ** 2, 3 * t**2 * (1 - t), t**3], 1)

    return surface(lambda u, v: np.einsum("ni,nj,jik->nk", bernstein(u), bernstein(v), c), n, n)


def _unit(v: Floats) -> Floats:
    length = np.linalg.norm(v, axis=-1, keepdims=True)
    return np.asarray(v / np.where(length > 0, length, 1))


def _ear_clip(p: Floats) -> Ints:
    """Triangles of a simple counter-clockwise polygon."""
    left = list(range(len(p)))
    out: list[Sequence[int]] = []

    def cross(a: Floats, b: Floats, c: Floats) -> float:
        return float((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]))

    while len(left) > 3:
        for k in range(len(left)):
            i, j, m = left[k - 1], left[k], left[(k + 1) % len(left)]
            if cross(p[i], p[j], p[m]) <= 1e-15:
                continue
            rest = [q for q in left if q not in (i, j, m)]
            if not any(
                cross(p[i], p[j], p[q]) >= 0 and cross(p[j], p[m], p[q]) >= 0 and cross(p[m], p[i], p[q]) >= 0
                for q in rest
            ):
                out.append((i, j, m))
                del left[k]
                break
        else:
            raise ValueError("the outline crosses itself or runs clockwise")
    return np.array([*out, left], int)
