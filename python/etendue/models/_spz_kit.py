"""Helpers of the atrium's masonry: chamfered blocks, turned stone, mouldings, uvs in metres."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from etendue.models.mesh import Floats, Mesh, lathe, merged, sweep


def faceted(mesh: Mesh) -> Mesh:
    """The mesh with its own corners, and so its own flat normals, for every face."""
    flat = mesh.faces.reshape(-1)
    p = mesh.vertices[mesh.faces]
    n = np.cross(p[:, 1] - p[:, 0], p[:, 2] - p[:, 0])
    n /= np.maximum(np.linalg.norm(n, axis=1, keepdims=True), 1e-20)
    uvs = None if mesh.uvs is None else mesh.uvs[flat]
    return Mesh(mesh.vertices[flat], np.arange(len(flat)).reshape(-1, 3), np.repeat(n, 3, axis=0), uvs)


def welded(mesh: Mesh) -> Mesh:
    """The mesh with corners of equal place, normal and uv shared, and without triangles that have no area."""
    parts = [a for a in (mesh.vertices, mesh.normals, mesh.uvs) if a is not None]
    rows = np.round(np.concatenate(parts, axis=1) + 0.0, 6)
    _, first, inverse = np.unique(rows, axis=0, return_index=True, return_inverse=True)
    faces = inverse.reshape(-1)[mesh.faces]
    p = mesh.vertices[first][faces]
    area = np.linalg.norm(np.cross(p[:, 1] - p[:, 0], p[:, 2] - p[:, 0]), axis=1)
    return Mesh(
        mesh.vertices[first],
        faces[area > 1e-10],
        None if mesh.normals is None else mesh.normals[first],
        None if mesh.uvs is None else mesh.uvs[first],
    )


def planar(mesh: Mesh, tile: float, offset: tuple[float, float] = (0, 0)) -> Mesh:
    """The mesh with uvs by projection along each face's main axis, `tile` metres a texture, unmirrored."""
    flat = mesh.faces.reshape(-1)
    corners = mesh.vertices[mesh.faces]
    n = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    axis = np.repeat(np.abs(n).argmax(1), 3)
    sign = np.repeat(np.sign(np.take_along_axis(n, np.abs(n).argmax(1)[:, None], 1)[:, 0]), 3)
    x, y, z = mesh.vertices[flat].T
    u = np.where(axis == 0, -z * sign, np.where(axis == 1, x, x * sign))
    v = np.where(axis == 1, -z * sign, y)
    normals = mesh.normals[flat] if mesh.normals is not None else faceted(mesh).normals
    return welded(
        Mesh(
            mesh.vertices[flat],
            np.arange(len(flat)).reshape(-1, 3),
            normals,
            np.stack([u / tile + offset[0], v / tile + offset[1]], 1),
        )
    )


def shifted(mesh: Mesh, rng: np.random.Generator, steps: int = 8) -> Mesh:
    """The mesh with its uvs moved at random by `steps`-ths of the texture, so that neighbours differ."""
    assert mesh.uvs is not None
    return Mesh(mesh.vertices, mesh.faces, mesh.normals, mesh.uvs + rng.integers(steps, size=2) / steps)


def block(x: float, y: float, z: float, chamfer: float = 0.012, tile: float = 2.0) -> Mesh:
    """A box with chamfered edges standing on the origin, uvs in metres."""
    h = np.array([x, y, z]) / 2
    corners, faces = [], []
    signs = [np.array([a, b, c]) for a in (-1, 1) for b in (-1, 1) for c in (-1, 1)]
    for s in signs:
        for axis in range(3):
            corners.append(s * np.where(np.arange(3) == axis, h, h - chamfer))

    def at(s: Floats, axis: int) -> int:
        return 3 * next(k for k, t in enumerate(signs) if (t == s).all()) + axis

    for axis in range(3):
        j, k = (axis + 1) % 3, (axis + 2) % 3
        e = np.eye(3, dtype=int)
        for a in (-1, 1):
            ring = [
                at(a * e[axis] + b * e[j] + c * e[k], axis) for b, c in ((-1, -1), (1, -1), (1, 1), (-1, 1))
            ]
            faces += [ring[:3], [ring[0], ring[2], ring[3]]]
            for b in (-1, 1):  # the edge between faces j and k, along `axis`
                p = [at(d * e[axis] + a * e[j] + b * e[k], m) for d, m in ((-1, j), (1, j), (1, k), (-1, k))]
                faces += [p[:3], [p[0], p[2], p[3]]]
    faces += [[at(s, 0), at(s, 1), at(s, 2)] for s in signs]
    v, f = np.array(corners), np.array(faces)
    t = v[f]
    inwards = np.einsum("ij,ij->i", np.cross(t[:, 1] - t[:, 0], t[:, 2] - t[:, 0]), t.mean(1)) < 0
    f[inwards] = f[inwards][:, ::-1]
    return planar(Mesh(v, f), tile).moved(y=y / 2)


def spun(profile: ArrayLike, segments: int = 32, tile: float = 1.0, crease_degrees: float = 40) -> Mesh:
    """Turned stone: `lathe` with uvs of about `tile` metres that close around the axis."""
    mesh = lathe(profile, segments, crease_degrees)
    around = max(round(2 * np.pi * float(np.asarray(profile)[:, 0].max()) / tile), 1)
    assert mesh.uvs is not None
    uvs = np.stack([mesh.uvs[:, 0] * around, mesh.vertices[:, 1] / tile], 1)
    return welded(Mesh(mesh.vertices, mesh.faces, mesh.normals, uvs))


def moulding(section: ArrayLike, path: ArrayLike, tile: float = 2.0, closed: bool = False,
             up: ArrayLike = (0, 1, 0), crease_degrees: float = 30) -> Mesh:  # fmt: skip
    """A moulded section of (right, up) points swept along a path, uvs in metres."""
    return planar(sweep(section, path, closed_path=closed, up=up, crease_degrees=crease_degrees), tile)


def sheet(xs: ArrayLike, ys: ArrayLike, tile: float, offset: tuple[float, float] = (0, 0)) -> Mesh:
    """A flat grid in the xy plane facing +z over these sorted coordinates."""
    x, y = np.meshgrid(np.asarray(xs, float), np.asarray(ys, float))
    n, m = x.shape
    i = (np.arange(n - 1)[:, None] * m + np.arange(m - 1)).ravel()
    faces = np.concatenate([np.stack([i, i + 1, i + m + 1], 1), np.stack([i, i + m + 1, i + m], 1)])
    v = np.stack([x.ravel(), y.ravel(), np.zeros(x.size)], 1)
    return Mesh(v, faces, np.tile([0.0, 0.0, 1.0], (len(v), 1)), v[:, :2] / tile + np.array(offset))


def arch_panel(half: float, a: float, rise: float, spring: float, top: float, thickness: float,
               tile: float, steps: int = 28) -> Mesh:  # fmt: skip
    """A wall from `spring` to `top`, 2 `half` wide about x = 0, less an elliptic arch of half-width `a`.

    Front and back at z = +-thickness / 2 and the arch's soffit; ends and top are left to what adjoins.
    """
    theta = np.pi * (1 - np.arange(steps + 1) / steps)
    x = np.r_[-half, a * np.cos(theta), half]
    y = np.r_[spring, spring + rise * np.sin(theta), spring]
    x[[1, -2]] = -a, a
    low, high = np.stack([x, y], 1), np.stack([x, np.full_like(x, top)], 1)
    rows = np.concatenate([low, (low + high) / 2, high])
    m = len(x)
    i = (np.arange(2)[:, None] * m + np.arange(m - 1)).ravel()
    faces = np.concatenate([np.stack([i, i + 1, i + m + 1], 1), np.stack([i, i + m + 1, i + m], 1)])
    flat = Mesh(
        np.c_[rows, np.zeros(len(rows))], faces, np.tile([0.0, 0.0, 1.0], (len(rows), 1)), rows / tile
    )
    h = thickness / 2
    arc = np.concatenate([[0], np.cumsum(np.hypot(np.diff(x[1:-1]), np.diff(y[1:-1])))])
    n = np.stack([-np.cos(theta) / a, -np.sin(theta) / rise, 0 * theta], 1)
    n /= np.linalg.norm(n, axis=1, keepdims=True)
    k, j = steps + 1, np.arange(steps)
    soffit = Mesh(
        np.concatenate([np.c_[low[1:-1], np.full(k, h)], np.c_[low[1:-1], np.full(k, -h)]]),
        np.concatenate([np.stack([j, j + k + 1, j + 1], 1), np.stack([j, j + k, j + k + 1], 1)]),
        np.concatenate([n, n]),
        np.concatenate([np.c_[arc, np.full(k, h)], np.c_[arc, np.full(k, -h)]]) / tile,
    )
    return merged([flat.moved(z=h), flat.turned("y", 180).moved(z=-h), soffit])
