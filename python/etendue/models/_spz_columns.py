"""The atrium's columns: bases, shafts, capitals with leaves and volutes; balusters and piers."""

from __future__ import annotations

import numpy as np

from etendue.models._spz_kit import block, moulding, planar, spun, welded
from etendue.models.mesh import Floats, Mesh, box, extruded, merged, sphere, surface


def column(height: float, radius: float, flutes: int = 0, tile: float = 1.3) -> Mesh:
    """A column standing on the origin: plinth, base, shaft, capital and abacus."""
    r = radius
    plinth = block(2.75 * r, 0.42 * r, 2.75 * r, 0.012, tile)
    base_top, capital = 0.42 * r + 0.62 * r, 2.1 * r
    base = [(1.30, 0.42), (1.36, 0.47), (1.38, 0.54), (1.36, 0.61), (1.30, 0.66), (1.23, 0.67), (1.23, 0.70),
            (1.17, 0.73), (1.13, 0.78), (1.14, 0.83), (1.18, 0.86), (1.18, 0.88), (1.22, 0.89), (1.24, 0.93),
            (1.22, 0.97), (1.17, 0.98), (1.10, 0.98), (1.06, 1.01), (1.0, 1.06)]  # fmt: skip
    top = height - capital
    mesh = [plinth, spun(np.array(base) * r, 26, tile), _shaft(base_top, top, r, flutes, tile)]
    neck = [(0.86, -0.16), (0.90, -0.15), (0.93, -0.11), (0.93, -0.07), (0.90, -0.03), (0.86, -0.02)]
    mesh.append(spun(np.array(neck) * r + [0, top], 32, tile))
    mesh.append(leafy_capital(r).moved(y=top - 0.03 * r))
    return merged(mesh)


def _shaft(bottom: float, top: float, radius: float, flutes: int, tile: float) -> Mesh:
    around = 32 if not flutes else flutes * 4

    def f(u: Floats, v: Floats) -> Floats:
        taper = 1 - 0.145 * np.clip(v - 0.25, 0, 1) ** 1.6 / 0.75**1.6
        phi = -2 * np.pi * u
        r = radius * taper
        if flutes:
            inside = np.clip(np.minimum(v - 0.03, 0.97 - v) / 0.03, 0, 1) ** 0.5
            r = r * (1 - 0.08 * inside * np.clip((np.abs(np.sin(phi * flutes / 2)) - 0.2) / 0.8, 0, 1))
        return np.stack([r * np.cos(phi), bottom + v * (top - bottom), r * np.sin(phi)], 1)

    v = (
        np.array([0, 0.03, 0.04, 0.06, 0.25, 0.5, 0.75, 0.94, 0.96, 0.97, 1])
        if flutes
        else np.linspace(0, 1, 10)
    )
    mesh = surface(lambda a, b: f(a, np.interp(b, np.linspace(0, 1, len(v)), v)), around, len(v) - 1)
    turns = max(round(2 * np.pi * radius / tile), 1)
    assert mesh.uvs is not None
    return Mesh(
        mesh.vertices, mesh.faces, mesh.normals, np.c_[mesh.uvs[:, 0] * turns, mesh.vertices[:, 1] / tile]
    )


def leafy_capital(r: float) -> Mesh:
    """A capital on a shaft of upper radius 0.86 r: two rows of leaves, four volutes, an abacus."""
    bell = spun(np.array([(0.8, 0), (0.82, 0.6), (0.88, 1.1), (1.0, 1.45), (1.22, 1.72)]) * r, 24, 1.3, 60)
    parts = [bell]
    for ring, (height, width) in enumerate(((0.85, 0.66), (1.45, 0.62))):
        leaf = _leaf(r, height * r, width * r)
        parts += [leaf.turned("y", 45 * k + 22.5 * ring) for k in range(8)]
    volute = _volute(r)
    abacus = _abacus(r)
    rose = sphere(0.13 * r, 8, 6).scaled(1, 1, 0.6).moved(y=1.9 * r, z=1.27 * r)
    for k in range(4):
        parts += [volute.turned("y", 45 + 90 * k), rose.turned("y", 90 * k)]
    return merged([*parts, abacus])


def _leaf(r: float, height: float, width: float) -> Mesh:
    """An acanthus-like leaf growing at +z up the bell, its tip curled outwards."""
    s = np.linspace(0, 1, 64)
    # The angle from the vertical along the leaf; its integral is the leaf's middle line.
    angle = 0.05 + 0.25 * s + 2.55 * np.clip((s - 0.62) / 0.38, 0, 1) ** 1.3
    out = 0.87 * r + np.concatenate([[0], np.cumsum(np.sin(angle[:-1]))]) / 63 * height * 1.22
    up = np.concatenate([[0], np.cumsum(np.cos(angle[:-1]))]) / 63 * height * 1.22

    def f(u: Floats, v: Floats) -> Floats:
        v = 1 - (1 - v) ** 1.5  # more rows where the leaf curls
        side = 2 * u - 1
        half = (
            0.5 * width * (0.72 + 0.38 * np.sin(np.pi * v**0.9)) * np.clip(1 - v**5, 0, 1) ** 0.6
            + 0.02 * width
        )
        half = half * (0.86 + 0.14 * np.abs(np.cos(4.5 * np.pi * v)))
        x = side * half
        ridge = 0.05 * r * (np.exp(-((side / 0.16) ** 2)) + 0.45 * np.cos(4.7 * side) ** 2) * (1 - 0.4 * v)
        radial = np.interp(v, s, out) + ridge - 0.30 * x**2 / r
        a = np.interp(v, s, angle)
        return np.stack([x, np.interp(v, s, up) + ridge * np.sin(a) * 0.5, radial], 1)

    def back(u: Floats, v: Floats) -> Floats:
        v = 0.45 + 0.55 * v
        a = np.interp(1 - (1 - v) ** 1.5, s, angle)
        return f(1 - u, v) - 0.045 * r * np.stack([0 * a, -np.sin(a), np.cos(a)], 1)

    return merged([surface(f, 6, 9, (0.3, 0.5)), surface(back, 4, 3, (0.3, 0.2))])


def _volute(r: float) -> Mesh:
    """A spiral under the abacus's corner at +z."""
    t = np.linspace(0, 1, 22)
    turn = 2.6 * np.pi * np.clip((t - 0.25) / 0.75, 0, 1)
    size = 0.25 * r * (1 - 0.78 * np.clip((t - 0.25) / 0.75, 0, 1))
    stem = np.clip(t / 0.25, 0, 1)
    z = np.where(t < 0.25, r * (0.98 + 0.34 * stem**1.4), 1.32 * r + size * np.sin(turn))
    y = np.where(t < 0.25, r * (1.05 + 0.67 * stem), 1.47 * r + size * np.cos(turn))
    path = np.stack([0 * t, y, z], 1)
    section = np.array([(-1, -0.45), (1, -0.45), (0.8, 0.3), (0, 0.5), (-0.8, 0.3)]) * 0.085 * r
    tube = _ribbon(path, section)
    eye = sphere(0.075 * r, 8, 5).scaled(1.5, 1, 1).moved(y=1.47 * r, z=1.32 * r)
    return merged([tube, eye])


def _ribbon(path: Floats, section: Floats) -> Mesh:
    """A closed section swept along a path in the plane x = 0, its first coordinate along x."""
    tangent = np.gradient(path, axis=0)
    tangent /= np.linalg.norm(tangent, axis=1, keepdims=True)
    outward = np.cross(np.array([1.0, 0, 0]), tangent)
    ring = np.concatenate([section, section[:1]])
    rows = path[:, None] + ring[None, :, :1] * np.array([1.0, 0, 0]) + ring[None, :, 1:] * outward[:, None]
    n, m = rows.shape[:2]
    mesh = surface(
        lambda u, v: rows[np.rint(v * (n - 1)).astype(int), np.rint(u * (m - 1)).astype(int)], m - 1, n - 1
    )
    a, b, c = (mesh.vertices[mesh.faces[:, k]] for k in range(3))
    volume = float((np.cross(a, b) * c).sum())
    mesh = mesh if volume > 0 else mesh.flipped()
    return welded(mesh.smooth(50))


def _abacus(r: float) -> Mesh:
    """The slab on the capital: square, hollow on its sides, cut at its corners, in two steps."""

    def outline(reach: float) -> list[tuple[float, float]]:
        t = np.linspace(-1, 1, 9)
        points: list[tuple[float, float]] = []
        for k in range(4):
            c, s = np.cos(k * np.pi / 2), np.sin(k * np.pi / 2)
            x, y = t * (reach - 0.14 * r), np.full(9, -reach) + 0.26 * r * (1 - t**2)
            points += list(zip(c * x - s * y, s * x + c * y, strict=True))
        return points

    low = extruded(outline(1.36 * r), 0.21 * r).turned("x", -90).moved(y=1.70 * r)
    high = extruded(outline(1.46 * r), 0.20 * r).turned("x", -90).moved(y=1.90 * r)
    return planar(merged([low, high]), 1.3)


def baluster(height: float, segments: int = 11) -> Mesh:
    """A vase-shaped baluster with square ends."""
    h = height
    profile = [(0.055, 0.10), (0.060, 0.115), (0.055, 0.135), (0.036, 0.15), (0.034, 0.17), (0.058, 0.24),
               (0.074, 0.33), (0.070, 0.40), (0.050, 0.52), (0.033, 0.66), (0.030, 0.74), (0.044, 0.755),
               (0.046, 0.785), (0.034, 0.80), (0.040, 0.86), (0.054, 0.90)]  # fmt: skip
    turned = spun([(r, y * h) for r, y in profile], segments, 0.6)
    end = planar(box(0.135, 0.105 * h, 0.135), 2.0).moved(y=0.0525 * h)
    return merged([end, turned, end.moved(y=0.895 * h)])


def pier(width: float, bottom: float, top: float, tile: float = 2.0) -> Mesh:
    """A square pier with a moulded base and impost."""
    path = np.array([(-1, 0, -1), (-1, 0, 1), (1, 0, 1), (1, 0, -1)]) * (width / 2)
    step = [(-0.02, 0), (0.05, 0), (0.05, 0.14), (0.035, 0.16), (0.035, 0.2), (0.012, 0.24), (-0.02, 0.24)]
    crown = [
        (-0.02, 0),
        (0.012, 0),
        (0.02, 0.03),
        (0.02, 0.05),
        (0.05, 0.09),
        (0.06, 0.12),
        (0.06, 0.17),
        (-0.02, 0.17),
    ]
    shaft = block(width, top - bottom, width, 0.015, tile)
    out = [shaft.moved(y=bottom)]
    # Walked so that the outside lies on the right.
    out.append(moulding(step, (path + [0, bottom, 0])[::-1], tile, closed=True))
    out.append(moulding(crown, (path + [0, top - 0.17, 0])[::-1], tile, closed=True))
    return merged(out)
