"""Shapes that the furnished room is built of: bevelled boxes, soft blocks, tubes, mouldings, noise."""

from __future__ import annotations

from itertools import product

import numpy as np
from numpy.typing import ArrayLike, NDArray

from etendue.models.mesh import Floats, Ints, Mesh, merged, sweep


def unit(v: Floats) -> Floats:
    """Vectors (..., 3) brought to unit length."""
    return np.asarray(v / np.maximum(np.linalg.norm(v, axis=-1, keepdims=True), 1e-12))


def faceted(mesh: Mesh) -> Mesh:
    """The mesh with the normal of each face at its own three corners."""
    corners = mesh.vertices[mesh.faces]
    normals = unit(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]))
    flat = mesh.faces.reshape(-1)
    uvs = None if mesh.uvs is None else mesh.uvs[flat]
    return Mesh(mesh.vertices[flat], np.arange(len(flat)).reshape(-1, 3), np.repeat(normals, 3, 0), uvs)


def _bevelled_topology() -> tuple[Ints, Ints, Ints]:
    """Axis and signs of the 24 corners of a bevelled box, and its 44 triangles, counter-clockwise outside."""
    octants = list(product((-1, 1), repeat=3))
    index = {(axis, o): 8 * axis + k for axis in range(3) for k, o in enumerate(octants)}
    axes = np.repeat(np.arange(3), 8)
    signs = np.array(octants * 3)
    place = signs * np.where(np.arange(3) == axes[:, None], 1.0, 0.8)
    polygons = []
    for axis, s in product(range(3), (-1, 1)):
        polygons.append([index[axis, o] for o in octants if o[axis] == s])
    for a, b in ((0, 1), (1, 2), (0, 2)):
        for s, t in product((-1, 1), repeat=2):
            ends = [o for o in octants if o[a] == s and o[b] == t]
            polygons.append([index[a, ends[0]], index[a, ends[1]], index[b, ends[0]], index[b, ends[1]]])
    polygons += [[index[axis, o] for axis in range(3)] for o in octants]
    triangles = []
    for p in polygons:
        for corners in ([p[0], p[1], p[2]], [p[1], p[3], p[2]]) if len(p) == 4 else (p,):
            q = place[corners]
            outside = np.dot(np.cross(q[1] - q[0], q[2] - q[0]), q.sum(0)) > 0
            triangles.append(corners if outside else corners[::-1])
    return axes, signs, np.array(triangles)


_AXES, _SIGNS, _TRIANGLES = _bevelled_topology()


def block(
    x: float,
    y: float,
    z: float,
    bevel: float = 0.003,
    uv_scale: float = 1.0,
    uv_shift: tuple[float, float] = (0, 0),
) -> Mesh:
    """A box centred at the origin whose bevelled edges are shaded round; uvs in metres times `uv_scale`.

    The longest edge runs along u, so that the grain of wood does.
    """
    half = np.array([x, y, z]) / 2
    bevel = min(bevel, 0.45 * min(x, y, z))
    main = np.arange(3) == _AXES[:, None]
    vertices = np.asarray(_SIGNS * np.where(main, half, half - bevel), float)
    along = int(np.argmax(half))
    uvs = np.empty((24, 2))
    for axis in range(3):
        others = [k for k in range(3) if k != axis]
        if others[1] == along:
            others.reverse()
        rows = axis == _AXES
        uvs[rows] = vertices[rows][:, others] * uv_scale + np.asarray(uv_shift) + 0.13 * axis
    return Mesh(vertices, _TRIANGLES, np.where(main, _SIGNS, 0).astype(float), uvs)


def block_between(low: ArrayLike, high: ArrayLike, bevel: float = 0.003, uv_scale: float = 1.0) -> Mesh:
    """A bevelled box between two opposite corners (3,)."""
    a, b = np.asarray(low, float), np.asarray(high, float)
    size, middle = b - a, (a + b) / 2
    shift = (float(middle @ [0.7, 1.3, 0.9]) % 1.0, float(middle @ [1.1, 0.6, 1.7]) % 1.0)
    x, y, z = (float(s) for s in size)
    return block(x, y, z, bevel, uv_scale, shift).moved(*middle)


def soft_block(
    x: float, y: float, z: float, radius: float, flat: int = 6, round_steps: int = 4, uv_scale: float = 1.0
) -> Mesh:
    """A smooth box with round edges, centred at the origin, in a grid fine enough to be displaced.

    `flat` cells for every 0.3 m of its faces, `round_steps` across half an edge.
    """
    half = np.array([x, y, z]) / 2
    radius = min(radius, 0.98 * float(half.min()))
    inner = half - radius
    arc = np.tan(np.linspace(0, np.pi / 4, round_steps + 1))[1:]
    lines = []
    for k in range(3):
        cells = max(1, int(np.ceil(flat * inner[k] / 0.15)))
        middle = np.linspace(-inner[k], inner[k], cells + 1)
        lines.append(np.concatenate([-inner[k] - radius * arc[::-1], middle, inner[k] + radius * arc]))
    sides = []
    for axis, sign in product(range(3), (-1, 1)):
        ua, va = (axis + 1) % 3, (axis + 2) % 3
        v, u = np.meshgrid(lines[va], lines[ua], indexing="ij")
        p = np.empty((u.size, 3))
        p[:, axis], p[:, ua], p[:, va] = sign * half[axis], u.ravel(), v.ravel()
        core = np.clip(p, -inner, inner)
        rounded = core + radius * unit(p - core)
        n, m = u.shape
        i = (np.arange(n - 1)[:, None] * m + np.arange(m - 1)).ravel()
        quads = np.concatenate([np.stack([i, i + 1, i + m + 1], 1), np.stack([i, i + m + 1, i + m], 1)])
        uv = p[:, [ua, va]] if axis != 1 else p[:, [va, ua]]
        sides.append(Mesh(rounded, quads if sign > 0 else quads[:, ::-1], None, uv * uv_scale))
    return merged(sides).smooth()


def displaced(mesh: Mesh, amount: Floats) -> Mesh:
    """The smooth mesh with its vertices moved along their normals by `amount` (n,)."""
    assert mesh.normals is not None
    return Mesh(mesh.vertices + mesh.normals * amount[:, None], mesh.faces, None, mesh.uvs).smooth()


def noise(points: ArrayLike, seed: int = 0, octaves: int = 1) -> Floats:
    """Smooth value noise in about -1..1 of points (n, 3) in cells of unit size; octaves halve both."""
    p = np.asarray(points, float)
    total, height = np.zeros(len(p)), 1.0
    for octave in range(octaves):
        q = p * 2.0**octave + 17.3 * octave
        cell = np.floor(q)
        t = q - cell
        t = t * t * t * (t * (6 * t - 15) + 10)
        with np.errstate(over="ignore"):
            c = cell.astype(np.int64).view(np.uint64)
            key = (
                c[:, 0] * _PRIMES[0]
                + c[:, 1] * _PRIMES[1]
                + c[:, 2] * _PRIMES[2]
                + np.uint64((seed + 101 * octave) * 0x2545F4914F6CDD1D % 2**64)
            )
            value = np.zeros(len(p))
            for i, j, k in product((0, 1), repeat=3):
                weight = (
                    (t[:, 0] if i else 1 - t[:, 0])
                    * (t[:, 1] if j else 1 - t[:, 1])
                    * (t[:, 2] if k else 1 - t[:, 2])
                )
                shift = np.uint64((i * int(_PRIMES[0]) + j * int(_PRIMES[1]) + k * int(_PRIMES[2])) % 2**64)
                value += weight * _mixed(key + shift)
        total += height * value
        height /= 2
    return total


_PRIMES = np.array([0x9E3779B97F4A7C15, 0xC2B2AE3D27D4EB4F, 0x165667B19E3779F9], np.uint64)


def _mixed(h: NDArray[np.uint64]) -> Floats:
    """Numbers in -1..1, a fixed function of integer keys (n,)."""
    h = (h ^ (h >> np.uint64(33))) * np.uint64(0xFF51AFD7ED558CCD)
    h = (h ^ (h >> np.uint64(29))) * np.uint64(0xC4CEB9FE1A85EC53)
    return (h >> np.uint64(11)).astype(float) / 2.0**52 - 1


def circle(radius: float, n: int) -> Floats:
    """A counter-clockwise ring of n points (x, y)."""
    a = 2 * np.pi * np.arange(n) / n
    return radius * np.stack([np.cos(a), np.sin(a)], 1)


def tube(path: ArrayLike, radius: ArrayLike, sides: int = 8, closed: bool = False) -> Mesh:
    """A smooth round tube along points (n, 3), its radius a number or one per point; open ends have a tip.

    The frame is carried along the path without twist, so that the path may point anywhere.
    """
    p = np.asarray(path, float)
    r = np.broadcast_to(np.asarray(radius, float), len(p)).copy()
    if closed:
        ahead, behind = np.roll(p, -1, 0), np.roll(p, 1, 0)
    else:
        ahead, behind = np.concatenate([p[1:], p[-1:]]), np.concatenate([p[:1], p[:-1]])
    tangent = unit(ahead - behind)
    first = np.cross(tangent[0], [0.31, 0.87, 0.39])
    side = np.empty_like(p)
    side[0] = unit(first)
    for k in range(1, len(p)):
        side[k] = unit(side[k - 1] - tangent[k] * (side[k - 1] @ tangent[k]))
    over = np.cross(tangent, side)
    ring = circle(1, sides)
    outward = ring[None, :, :1] * side[:, None] + ring[None, :, 1:] * over[:, None]
    rows = p[:, None] + r[:, None, None] * outward
    normals = outward.reshape(-1, 3)
    n = len(p)
    i, j = np.meshgrid(np.arange(n if closed else n - 1), np.arange(sides), indexing="ij")
    a, b = i * sides + j, i * sides + (j + 1) % sides
    c, d = (i + 1) % n * sides + (j + 1) % sides, (i + 1) % n * sides + j
    faces = np.concatenate([np.stack([a, b, c], -1).reshape(-1, 3), np.stack([a, c, d], -1).reshape(-1, 3)])
    vertices = rows.reshape(-1, 3)
    length = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(p, axis=0), axis=1))])
    uvs = np.stack([np.repeat(length, sides), np.tile(np.arange(sides) / sides, n)], 1)
    if not closed:
        around = np.arange(sides)
        following = (around + 1) % sides
        base, tip, last = len(vertices), len(vertices) + 1, (n - 1) * sides
        start = np.stack([np.full(sides, base), following, around], 1)
        end = np.stack([np.full(sides, tip), last + around, last + following], 1)
        faces = np.concatenate([faces, start, end])
        vertices = np.concatenate(
            [vertices, p[:1] - tangent[:1] * r[0] * 0.3, p[-1:] + tangent[-1:] * r[-1] * 0.3]
        )
        normals = np.concatenate([normals, -tangent[:1], tangent[-1:]])
        uvs = np.concatenate([uvs, [[0, 0], [length[-1], 0]]])
    return Mesh(vertices, faces, normals, uvs)


def frame(width: float, height: float, section: ArrayLike) -> Mesh:
    """A mitred rectangular frame standing in the xy plane, facing +z, about the origin.

    The section holds counter-clockwise points (outwards from the rectangle, towards the viewer).
    """
    w, h = width / 2, height / 2
    path = [(-w, -h, 0), (w, -h, 0), (w, h, 0), (-w, h, 0)]
    return sweep(section, path, closed_path=True, up=(0, 0, 1), crease_degrees=35)


def panel_moulding(width: float, height: float, size: float = 0.03) -> Mesh:
    """A rectangle of moulding to be planted on a wall, facing +z, the wall in the plane z = 0."""
    bead = [(-np.cos(t) * 0.22 + 0.72, 0.30 + 0.22 * np.sin(t)) for t in np.linspace(np.pi, 0, 7)]
    profile = np.array(
        [(0.0, -0.2), (1.0, -0.2), (1.0, 0.18), *bead[::-1], (0.42, 0.22), (0.18, 0.5), (0.0, 0.42)]
    )
    return frame(width, height, profile * size)


def faces_east(mesh: Mesh) -> Mesh:
    """A thing modelled to face +z turned to face +x; its right hand is then at -z."""
    return mesh.turned("y", 90)


def faces_west(mesh: Mesh) -> Mesh:
    """A thing modelled to face +z turned to face -x."""
    return mesh.turned("y", -90)


def faces_south(mesh: Mesh) -> Mesh:
    """A thing modelled to face +z turned to face -z."""
    return mesh.turned("y", 180)


def cell(uv_cell: tuple[int, int], cells: tuple[int, int], mesh: Mesh, spread: float = 0.0) -> Mesh:
    """The mesh with its uvs in one cell of a texture atlas; `spread` keeps that share of its own uvs."""
    own = np.zeros((len(mesh.vertices), 2)) if mesh.uvs is None else mesh.uvs
    inside = 0.5 + (np.clip(own, 0, 1) - 0.5) * spread
    uvs = (np.asarray(uv_cell) + inside) / np.asarray(cells)
    return Mesh(mesh.vertices, mesh.faces, mesh.normals, uvs)
