"""Small things that stand about in the fireplace room: vessels, candles, books, framed pictures, logs."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike

from etendue.models._fireplace_plan import BARK, BOOKS, CERAMIC, IRON, PAINTING, PAPER, WAX, WOOD
from etendue.models._fireplace_shapes import block, circle, faceted, frame, noise, tube, unit
from etendue.models._fireplace_textures import BOOK_CELLS, PICTURES
from etendue.models.mesh import Floats, Mesh, lathe, merged, quad
from etendue.models.model import Model

Place = Callable[[Mesh], Mesh]


def at(x: float, y: float, z: float, turn: float = 0.0) -> Place:
    """A move that turns a thing about its upright axis and puts it at a place."""
    return lambda mesh: mesh.turned("y", turn).moved(x, y, z)


def facing(face: Place, x: float, y: float, z: float, turn: float = 0.0) -> Place:
    """A move for things that are modelled to face +z: turned by `face`, by `turn` degrees, and placed."""
    return lambda mesh: face(mesh).turned("y", turn).moved(x, y, z)


def curve(points: ArrayLike, n: int = 8) -> Floats:
    """A smooth curve through points (k, d): Catmull-Rom, n steps for every span."""
    p = np.asarray(points, float)
    p = np.concatenate([2 * p[:1] - p[1:2], p, 2 * p[-1:] - p[-2:-1]])
    t = np.linspace(0, 1, n, endpoint=False)[:, None]
    spans = []
    for a, b, c, d in zip(p[:-3], p[1:-2], p[2:-1], p[3:], strict=True):
        spans.append(
            0.5 * (2 * b + (c - a) * t + (2 * a - 5 * b + 4 * c - d) * t**2 + (3 * b - a - 3 * c + d) * t**3)
        )
    return np.concatenate([*spans, p[-2:-1]])


def vessel(outside: ArrayLike, wall: float, segments: int = 48, foot: float = 0.006) -> Mesh:
    """A closed hollow solid of revolution from an outside profile of (radius, height) points, bottom to rim.

    The first point lies on the bottom's edge; the wall's thickness is `wall`, the bottom's `foot`.
    """
    outer = curve(outside, 4)
    h = outer[:, 1]
    slope = np.gradient(outer, axis=0)
    normal = np.stack([slope[:, 1], -slope[:, 0]], 1)
    normal /= np.maximum(np.linalg.norm(normal, axis=1, keepdims=True), 1e-9)
    inner = outer - wall * normal
    inner = inner[(h > foot * 1.5) & (inner[:, 0] > wall)]
    inner = inner[inner[:, 1] > foot * 1.2]
    rim = outer[-1] + (inner[-1] - outer[-1]) / 2 + np.array([0, wall * 0.35])
    profile = [
        (0, h[0]),
        *outer.tolist(),
        rim.tolist(),
        *inner[::-1].tolist(),
        (inner[0, 0] * 0.8, foot),
        (0, foot),
    ]
    return lathe(profile, segments, crease_degrees=50)


def vase(model: Model, place: Place, outside: ArrayLike, material: str = CERAMIC) -> None:
    """A vase of pottery."""
    model.add(material, place(vessel(outside, 0.005, 36)))


def candle(model: Model, place: Place, stick: float, height: float, metal: str) -> None:
    """A candle in a turned stick of height `stick`."""
    profile = [
        (0, 0),
        (0.042, 0),
        (0.043, 0.004),
        (0.040, 0.008),
        (0.016, 0.016),
        (0.008, 0.03),
        (0.007, stick * 0.45),
        (0.012, stick * 0.5),
        (0.007, stick * 0.55),
        (0.007, stick - 0.03),
        (0.017, stick - 0.016),
        (0.018, stick - 0.002),
        (0.013, stick),
        (0, stick),
    ]
    model.add(metal, place(lathe(profile, 32, 30)))
    wax = [
        (0.0105, 0),
        (0.0105, height - 0.002),
        (0.009, height),
        (0.004, height - 0.002),
        (0, height - 0.002),
    ]
    model.add(WAX, place(lathe([(0, 0), *wax], 20).moved(y=stick - 0.004)))
    model.add(
        IRON,
        place(
            tube(
                [
                    (0, stick + height - 0.009, 0),
                    (0.0005, stick + height, 0),
                    (0.002, stick + height + 0.004, 0),
                ],
                0.0009,
                5,
            )
        ),
    )


def book(thickness: float, height: float, depth: float, binding: int) -> list[tuple[str, Mesh]]:
    """A bound book that stands on y = 0 with its spine to +z: cover and pages under their materials."""
    half, board = thickness / 2, 0.0025
    bulge = min(0.25 * thickness, 0.007)
    angle = np.linspace(np.pi, 0, 7)
    arc = np.stack([half * np.cos(angle), bulge * np.sin(angle)], 1)
    inner_arc = np.stack([(half - board) * np.cos(angle), np.full(7, -board)], 1)
    outer = np.concatenate([[[-half, -depth]], arc, [[half, -depth]]])
    inner = np.concatenate([[[-half + board, -depth]], inner_arc, [[half - board, -depth]]])
    u = np.concatenate([[0.8], np.linspace(0.02, 0.48, 7), [0.8]])
    n = len(outer)

    def ring(points: Floats, y: float) -> Floats:
        return np.stack([points[:, 0], np.full(n, y), points[:, 1]], 1)

    vertices = np.concatenate([ring(outer, 0), ring(outer, height), ring(inner, 0), ring(inner, height)])
    k = np.arange(n - 1)

    def strip(a: int, b: int, c: int, d: int) -> list[Floats]:
        return [np.stack([a + k, b + k, c + k], 1), np.stack([a + k, c + k, d + k], 1)]

    faces = (
        strip(0, 1, n + 1, n)
        + strip(3 * n, 3 * n + 1, 2 * n + 1, 2 * n)
        + strip(n, n + 1, 3 * n + 1, 3 * n)
        + strip(2 * n, 2 * n + 1, 1, 0)
    )
    m = n - 1
    ends = [[0, n, 3 * n], [0, 3 * n, 2 * n], [m + n, m, m + 2 * n], [m + n, m + 2 * n, m + 3 * n]]
    # The boards show the plain half of the binding, so they must not share corners with the spine.
    uvs = np.stack([np.concatenate([u, u, np.full(2 * n, 0.8)]), np.repeat([0.01, 0.99, 0.01, 0.99], n)], 1)
    cover = Mesh(vertices, np.concatenate([*faces, np.array(ends)]), None, (uvs + [binding, 0]) / BOOK_CELLS)
    assert cover.uvs is not None
    spine_uv = cover.uvs[cover.faces].copy()
    boards = vertices[cover.faces][:, :, 2].min(1) < -0.9 * depth
    spine_uv[boards, :, 0] = (binding + 0.8) / BOOK_CELLS[0]
    split = faceted(
        Mesh(
            vertices[cover.faces].reshape(-1, 3),
            np.arange(3 * len(cover.faces)).reshape(-1, 3),
            None,
            spine_uv.reshape(-1, 2),
        )
    )
    assert split.normals is not None
    p = split.vertices
    round_back = np.repeat(
        (p[split.faces][:, :, 2] > -1e-9).all(1) & (np.abs(split.normals[::3, 1]) < 0.5), 3
    )
    normals = split.normals.copy()
    normals[round_back] = unit(p[round_back] * [1 / half**2, 0, 1 / bulge**2])
    split = Mesh(p, split.faces, normals, split.uvs)
    pages = block(2 * (half - board) - 0.0004, height - 0.006, depth - board - 0.004, 0.0005)
    return [(BOOKS, split), (PAPER, pages.moved(y=height / 2, z=-board - (depth - board - 0.004) / 2))]


def add_book(model: Model, place: Place, thickness: float, height: float, depth: float, binding: int) -> None:
    """Adds a book under its materials."""
    for material, mesh in book(thickness, height, depth, binding):
        model.add(material, place(mesh))


def lying_book(
    model: Model, place: Place, thickness: float, height: float, depth: float, binding: int
) -> None:
    """A book on its side on y = 0, its spine to +z, centred."""
    for material, mesh in book(thickness, height, depth, binding):
        flat = mesh.turned("z", 90).moved(height / 2, thickness / 2, depth / 2)
        model.add(material, place(flat))


def picture(
    model: Model,
    place: Place,
    name: str,
    width: float,
    height: float,
    border: float = 0.018,
    material: str = IRON,
) -> None:
    """A framed picture that faces +z, its back in z = 0, its middle at the origin."""
    left, bottom, right, top = PICTURES[name]
    w, h = width / 2 + 0.002, height / 2 + 0.002
    sheet = faceted(quad((-w, -h, 0.010), (w, -h, 0.010), (w, h, 0.010), (-w, h, 0.010)))
    uvs = np.array([left, bottom]) + (sheet.uvs if sheet.uvs is not None else 0) * np.array(
        [right - left, top - bottom]
    )
    model.add(PAINTING, place(Mesh(sheet.vertices, sheet.faces, sheet.normals, uvs)))
    b = border
    section = [
        (-0.003, 0.001),
        (b, 0.001),
        (b, 0.024),
        (b - 0.002, 0.026),
        (0.003, 0.026),
        (0.0, 0.023),
        (-0.003, 0.014),
    ]
    model.add(material, place(frame(width, height, section)))
    back = block(width + b, height + b, 0.006, 0.001).moved(z=0.0045)
    model.add(WOOD, place(back))


def log(length: float, radius: float, seed: int, sides: int = 20) -> list[tuple[str, Mesh]]:
    """A piece of firewood along x, centred: bark outside, sawn ends."""
    n = 16
    x = np.linspace(-length / 2, length / 2, n)
    ring = circle(1, sides)
    p = np.stack([np.repeat(x, sides), np.tile(ring[:, 0], n), np.tile(ring[:, 1], n)], 1)
    rough = 0.10 * noise(p * [7, 1.3, 1.3] + seed, seed, 2) + 0.06 * noise(p * [16, 3.5, 3.5], seed + 7, 2)
    bow = 0.22 * radius * np.cos(np.pi * p[:, 0] / length)
    r = radius * (1 + rough)
    body = np.stack([p[:, 0], r * p[:, 1] + bow, r * p[:, 2]], 1)
    i, j = np.meshgrid(np.arange(n - 1), np.arange(sides), indexing="ij")
    a, b = i * sides + j, i * sides + (j + 1) % sides
    faces = np.concatenate(
        [
            np.stack([a, b, b + sides], -1).reshape(-1, 3),
            np.stack([a, b + sides, a + sides], -1).reshape(-1, 3),
        ]
    )
    uvs = np.stack(
        [
            p[:, 0] * 2 + seed * 0.37,
            0.52 + 0.46 * np.abs(np.linspace(-1, 1, sides))[np.tile(np.arange(sides), n)],
        ],
        1,
    )
    bark = Mesh(body, faces, None, uvs).smooth()
    ends = []
    for first, sign in ((0, -1), ((n - 1) * sides, 1)):
        rim = body[first : first + sides]
        middle = rim.mean(0)
        centre_uv = np.array([0.5, 0.25])
        k = np.arange(sides)
        fan = np.stack([np.full(sides, sides), k, (k + 1) % sides], 1)
        uv = np.concatenate([centre_uv + ring * [0.46, 0.23], [centre_uv]])
        ends.append(
            faceted(Mesh(np.concatenate([rim, [middle]]), fan if sign > 0 else fan[:, ::-1], None, uv))
        )
    return [(BARK, merged([bark, *ends]))]


def add_log(model: Model, place: Place, length: float, radius: float, seed: int) -> None:
    """Adds a piece of firewood."""
    for material, mesh in log(length, radius, seed):
        model.add(material, place(mesh))
