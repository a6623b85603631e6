"""The atrium's cloth: banners on poles, carpets over the balustrade and gathered curtains."""

from __future__ import annotations

import numpy as np

from etendue.models._spz_arcade import Parts
from etendue.models._spz_kit import spun
from etendue.models._spz_plan import BAY, EAST, FAR, GROUND, NEAR, RAIL_TOP, THICK, UPPER, WEST, Side
from etendue.models.mesh import Floats, Mesh, cylinder, merged, sphere

BANNER = (1.1, 3.2)


def cloth(rng: np.random.Generator) -> Parts:
    """Every piece of cloth with what it hangs from."""
    for side, k, letter in ((FAR, 4, "a"), (FAR, 5, "b"), (FAR, 6, "c"), (FAR, 2, "c"), (FAR, 1, "a"),
    (FAR, 3, "b"), (NEAR, 5, "c"), (WEST, 0, "b"), (WEST, 1, "a")):  # fmt: skip
        x = list(side.columns())[k]
        foot = (x, UPPER.spring + 0.36, THICK / 2)
        yield "flagpole.001", side.place(_pole().moved(*foot))
        hung = _banner(rng).moved(foot[0], foot[1] - 0.03, foot[2] + 0.72)
        yield f"fabric_{letter}.001", side.place(hung)
    # By the camera.
    yield "fabric_d.001", NEAR.place(_over_rail(rng, 1.35).moved(0.95))
    for side, bay, letter in ((FAR, 5, "d"), (FAR, 7, "e"), (EAST, 1, "d"), (NEAR, 5, "e"), (FAR, 2, "e")):
        x = list(side.centres())[bay]
        yield f"fabric_{letter}.001", side.place(_over_rail(rng).moved(x + rng.normal(0, 0.1)))
    for side, bay, letter in ((FAR, 5, "g"), (FAR, 6, "f"), (EAST, 0, "g"), (EAST, 2, "f"), (FAR, 3, "f")):
        yield from _curtains(side, list(side.centres())[bay], f"fabric_{letter}.001", rng)


def _waves(s: Floats, v: Floats, count: float, rng: np.random.Generator) -> Floats:
    """Uneven folds across a cloth: roughly `count` waves over s in [0, 1], wandering with v."""
    phase, drift = rng.random(4) * 2 * np.pi, rng.normal(0, 1, 4)
    warped = s + 0.035 * np.sin(2 * np.pi * (1.3 * s + 0.5 * v) + phase[0]) + 0.02 * drift[0] * v
    main = np.sin(2 * np.pi * count * warped + phase[1] + 0.6 * drift[1] * v)
    second = np.sin(2 * np.pi * 0.43 * count * warped + phase[2] + drift[2] * v)
    third = np.sin(2 * np.pi * 2.3 * count * warped + phase[3] + 1.5 * drift[3] * v)
    return 0.62 * main + 0.42 * second + 0.13 * third


def _laid(width: Floats, depth: Floats) -> Floats:
    """Where points at equal steps of thread lie across, rows (n, m), as `depth` takes up some width."""
    step = width[:, None] / (depth.shape[1] - 1)
    across = np.sqrt(np.maximum(step**2 - np.diff(depth, axis=1) ** 2, (0.25 * step) ** 2))
    x = np.concatenate([np.zeros((len(depth), 1)), np.cumsum(across, axis=1)], axis=1)
    return x - x[:, -1:] / 2


def _woven(rows: Floats, swap_uv: bool = False) -> Mesh:
    """A smooth sheet through points (n, m, 3), the first row at the picture's top; faces rows x columns."""
    n, m = rows.shape[:2]
    normals = np.cross(np.gradient(rows, axis=0), np.gradient(rows, axis=1)).reshape(-1, 3)
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-12)
    v, u = np.meshgrid(1 - np.arange(n) / (n - 1), np.arange(m) / (m - 1), indexing="ij")
    i = (np.arange(n - 1)[:, None] * m + np.arange(m - 1)).ravel()
    faces = np.concatenate([np.stack([i, i + m, i + m + 1], 1), np.stack([i, i + m + 1, i + 1], 1)])
    uvs = np.stack([v, u] if swap_uv else [u, v], 2).reshape(-1, 2)
    return Mesh(rows.reshape(-1, 3), faces, normals, uvs)


def _banner(rng: np.random.Generator, columns: int = 36, rows: int = 80) -> Mesh:
    """A banner that hangs below the z axis from z = 0 on, swallow-tailed, in a light draught."""
    width, height = BANNER
    s, v = np.meshgrid(np.linspace(0, 1, columns + 1), np.linspace(0, 1, rows + 1))
    grow = 0.15 + 0.85 * v**0.8
    depth = 0.045 * grow * _waves(s, v, 2.6, rng) + 0.012 * _waves(s, v, 6.5, rng) * v
    along = _laid(np.full(rows + 1, width), depth)
    sway = rng.normal(0, 0.10) * v**2 + 0.03 * np.sin(2 * np.pi * (v + rng.random())) * v
    tail = 1 - 0.14 * np.clip((v - 0.8) / 0.2, 0, 1) * (1 - np.abs(2 * s - 1))
    sag = 0.012 * np.sin(np.pi * 5 * s) ** 2 * (1 - v) ** 6
    y = -height * v * tail - sag
    points = np.stack([sway + depth, y, width / 2 - along], 2)
    mesh = _woven(points)
    assert mesh.uvs is not None
    return Mesh(
        mesh.vertices, mesh.faces, mesh.normals, np.c_[mesh.uvs[:, 0], 1 + mesh.vertices[:, 1] / height]
    ).moved(z=width / 2)


def _pole() -> Mesh:
    """A gilt-tipped pole out of the wall along +z with its socket, and the rings that carry a banner."""
    pole = cylinder(0.026, 2.05, 14).turned("x", 90)
    knob = spun(
        [
            (0.026, 0),
            (0.045, 0.02),
            (0.03, 0.05),
            (0.055, 0.10),
            (0.06, 0.15),
            (0.04, 0.21),
            (0.008, 0.30),
            (0, 0.31),
        ],
        16,
    )
    socket = spun(
        [
            (0.10, -0.02),
            (0.10, 0.02),
            (0.075, 0.035),
            (0.05, 0.05),
            (0.045, 0.16),
            (0.055, 0.17),
            (0.055, 0.2),
            (0.026, 0.2),
        ],
        20,
    )
    rings = [sphere(0.034, 10, 6).scaled(1, 1, 0.35).moved(z=0.72 + t) for t in np.linspace(0.02, 1.08, 8)]
    return merged([pole, knob.turned("x", 90).moved(z=2.04), socket.turned("x", 90), *rings])


def _over_rail(rng: np.random.Generator, width: float = 2.3, columns: int = 72, rows: int = 32) -> Mesh:
    """A carpet laid over the balustrade's rail: long in front, short behind, along x about 0."""
    front, back = 0.84, 0.5
    half, top = 0.178, RAIL_TOP + 0.006
    # The way over the rail, from the front's hem up and to the back's.
    turn = np.linspace(0, np.pi / 2, 5)
    corner = np.stack([half - 0.03 + 0.03 * np.cos(turn), top - 0.03 + 0.03 * np.sin(turn)], 1)
    way = np.concatenate(
        [[[half + 0.012, top - front]], corner, corner[::-1] * [-1, 1], [[-half - 0.01, top - back]]]
    )
    length = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(way, axis=0), axis=1))])
    at = np.linspace(0, length[-1], rows + 1)
    z, y = np.interp(at, length, way[:, 0]), np.interp(at, length, way[:, 1])
    s, t = np.meshgrid(np.linspace(0, 1, columns + 1), at / length[-1])
    fall = np.clip(top - 0.05 - y, 0, 1)[:, None]
    outwards = np.where(z > 0, 1.0, -1.0)[:, None]
    waves = 0.5 + 0.5 * _waves(s, t, 7, rng)
    depth = fall * (0.055 * waves + 0.02 * (0.5 + 0.5 * _waves(s, t, 17, rng)))
    x = _laid(np.full(rows + 1, width), depth)
    points = np.stack(
        [x, np.broadcast_to(y[:, None], x.shape) - 0.02 * fall * waves, z[:, None] + outwards * depth], 2
    )
    return _woven(points, swap_uv=True).flipped()


def _curtains(side: Side, x: float, name: str, rng: np.random.Generator) -> Parts:
    """Two curtains on a rod across an arch, each tied back to its column."""
    rod_y, clear = GROUND.spring - 0.06, BAY / 2 - 0.2
    rod = merged(
        [
            cylinder(0.018, 2 * clear, 12).moved(y=-clear).turned("z", 90),
            *(sphere(0.04, 12, 8).moved(s * clear) for s in (-1, 1)),
        ]
    )
    yield "flagpole.001", side.place(rod.moved(x, rod_y, -0.02))
    for s in (-1, 1):
        half = _curtain(clear - 0.05, rod_y - GROUND.floor, rng)
        yield name, side.place((half if s > 0 else half.scaled(-1, 1, 1)).moved(x, rod_y, -0.02))
        tie_y = GROUND.floor + 1.2
        tie = spun([(0.13, -0.03), (0.14, 0), (0.13, 0.03)], 20).scaled(1, 1, 0.75).turned("z", 12)
        yield "flagpole.001", side.place(tie.moved(x + s * (clear - 0.13), tie_y, -0.02))


def _curtain(reach: float, drop: float, rng: np.random.Generator, columns: int = 88, rows: int = 44) -> Mesh:
    """One curtain hanging from (0 .. reach, 0), gathered at its outer side, then falling free."""
    cloth_width, pleats, tie = 2.5, 11.0, (drop - 1.2) / drop
    s, v = np.meshgrid(np.linspace(0, 1, columns + 1), np.linspace(0, 1, rows + 1))
    upper, lower = np.clip(v / tie, 0, 1), np.clip((v - tie) / (1 - tie), 0, 1)
    gather = np.where(v < tie, upper**1.7, 1 - 0.42 * np.sin(np.pi / 2 * lower) ** 0.8)
    width = reach * (1 - gather) + 0.22 * gather
    # Threads at the inner edge hang lower before they are pulled across: the cloth swags.
    swag = 0.20 * np.sin(np.pi * upper) * (1 - s) * (v < tie)
    depth_of = 0.045 + 0.035 * np.sin(np.pi * upper) * (v < tie)
    folds = _waves(s, v, pleats / 1.0, rng)
    narrow = np.sqrt(np.clip(1 - (width / cloth_width) ** 2, 0, 1))
    z = depth_of * folds * narrow * np.clip(0.5 + 0.5 * width / 0.5, 0.6, 1.2)
    z = z + 0.07 * np.sqrt(np.clip(1 - (2 * s - 1) ** 2, 0, 1)) * gather
    x = reach - width * (1 - s) - 0.02 * gather * (0.5 + 0.5 * np.sin(2 * np.pi * 3 * s))
    y = -drop * 0.985 * v - swag * (1 - v) + 0.012 * np.sin(2 * np.pi * pleats * s) * (v > 0.97)
    return _woven(np.stack([x, y, z], 2))
