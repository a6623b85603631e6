"""The firebox, bricked, with a grate of burning logs: embers below, flames above."""

from __future__ import annotations

import numpy as np

from etendue.models._fireplace_plan import AXIS, BREAST, BRICK, EMBERS, FLAMES, IRON
from etendue.models._fireplace_shapes import block, faceted, noise, tube
from etendue.models._fireplace_things import add_log, at
from etendue.models.mesh import Floats, Mesh, merged, quad, sphere, surface
from etendue.models.model import Model

# The firebox: half its width in front and behind, its floor, its top, its back.
HALF, BACK_HALF, BASE, TOP, BACK = 0.46, 0.34, 0.05, 0.70, -0.465


def add(model: Model) -> None:
    """Adds the firebox and the fire."""
    _firebox(model)
    _fire(model)


def _plane(a: Floats, b: Floats) -> Mesh:
    """An upright quad from a to b, (x, z) points, whose front is on the left of the walk."""
    return quad((b[0], BASE, b[1]), (a[0], BASE, a[1]), (a[0], TOP, a[1]), (b[0], TOP, b[1])).flipped()


def _firebox(model: Model) -> None:
    ring = [
        np.array(p)
        for p in (
            (BREAST, AXIS - HALF),
            (BACK, AXIS - BACK_HALF),
            (BACK, AXIS + BACK_HALF),
            (BREAST, AXIS + HALF),
        )
    ]
    shell = [_plane(a, b).flipped() for a, b in zip(ring[:-1], ring[1:], strict=True)]
    south, south_west, north_west, north = ((x, BASE, z) for x, z in ring)
    floor = quad(south, south_west, north_west, north)
    ceiling = floor.flipped().moved(y=TOP - BASE)
    model.add(BRICK, faceted(merged([*shell, floor, ceiling])))
    rng = np.random.default_rng(8)
    bricks = []
    for a, b in zip(ring[:-1], ring[1:], strict=True):
        length = float(np.linalg.norm(b - a))
        ahead = (b - a) / length
        angle = np.degrees(np.arctan2(-ahead[1], ahead[0]))
        y, course = BASE + 0.004, 0
        while y < TOP - 0.02:
            high = min(0.062, TOP - 0.004 - y)
            s = -0.10 if course % 2 else 0.002
            while s < length - 0.01:
                lo, hi = max(s, 0.002), min(s + 0.195, length - 0.002)
                if hi - lo > 0.02:
                    one = block(hi - lo, high, 0.05, 0.004, uv_scale=1.7, uv_shift=tuple(rng.random(2)))
                    out = 0.019 - 0.025 + rng.normal(0, 0.0012)
                    spot = a + ahead * (lo + hi) / 2
                    inward = np.array([ahead[1], -ahead[0]])
                    inward = inward if inward @ (np.array([-0.25, AXIS]) - spot) > 0 else -inward
                    spot = spot + inward * out
                    bricks.append(one.turned("y", angle).moved(spot[0], y + high / 2, spot[1]))
                s += 0.203
            y += 0.070
            course += 1
    model.add(BRICK, *bricks)


def _fire(model: Model) -> None:
    rng = np.random.default_rng(12)
    middle = -0.275
    for x in (middle - 0.10, middle + 0.10):
        model.add(IRON, tube([(x, BASE + 0.085, AXIS - 0.27), (x, BASE + 0.085, AXIS + 0.27)], 0.009, 10))
        for z in (AXIS - 0.24, AXIS + 0.24):
            model.add(IRON, tube([(x, BASE - 0.005, z), (x, BASE + 0.09, z)], 0.009, 10))
    for z in np.linspace(AXIS - 0.24, AXIS + 0.24, 9):
        path = [
            (middle - 0.10, BASE + 0.16, z),
            (middle - 0.105, BASE + 0.10, z),
            (middle, BASE + 0.085, z),
            (middle + 0.105, BASE + 0.10, z),
            (middle + 0.115, BASE + 0.17, z),
        ]
        model.add(IRON, tube(path, 0.007, 8))
    logs = (
        (0.54, 0.055, -0.05, 0.155, -0.01, 84, 1),
        (0.50, 0.050, 0.055, 0.150, 0.02, 97, 2),
        (0.46, 0.044, 0.00, 0.235, -0.03, 101, 3),
        (0.34, 0.036, 0.07, 0.235, 0.06, 66, 4),
    )
    for length, radius, x, y, z, turn, seed in logs:
        add_log(model, at(middle + x, BASE + y, AXIS + z, turn), length, radius, seed)
    lumps = []
    for _ in range(170):
        size = rng.uniform(0.010, 0.026)
        lump = sphere(1, 9, 6)
        r = 1 + 0.45 * noise(lump.vertices * 1.6 + rng.uniform(-50, 50, 3), 3, 2)
        lump = Mesh(
            lump.vertices * r[:, None] * size,
            lump.faces,
            None,
            (lump.uvs if lump.uvs is not None else 0) * 0.3 + rng.random(2),
        ).smooth()
        x, z = middle + rng.normal(0, 0.05), AXIS + rng.normal(0, 0.13)
        if not (-0.41 < x < -0.155 and abs(z - AXIS) < 0.30):
            continue
        pile = 0.05 * np.exp(-(((x - middle) / 0.07) ** 2) - ((z - AXIS) / 0.16) ** 2)
        lumps.append(
            lump.turned("x", rng.uniform(0, 360)).moved(x, BASE + size * 0.4 + rng.random() * pile, z)
        )
    model.add(EMBERS, *lumps)
    tongues = (
        (-0.17, 0.27, 0.13, 0.02),
        (-0.08, 0.36, 0.16, -0.03),
        (0.02, 0.42, 0.18, 0.00),
        (0.10, 0.31, 0.15, 0.03),
        (0.19, 0.24, 0.12, -0.01),
        (-0.13, 0.20, 0.11, 0.07),
        (0.06, 0.25, 0.12, 0.075),
        (0.15, 0.17, 0.09, 0.08),
    )
    for k, (z, height, width, x) in enumerate(tongues):
        model.add(FLAMES, _flame(height, width, k).moved(middle + x, BASE + 0.15, AXIS + z))


def _flame(height: float, width: float, seed: int) -> Mesh:
    """A tongue of fire: a curled sheet that faces +x, cut out by its texture."""
    phase = seed * 1.9

    def f(u: Floats, v: Floats) -> Floats:
        s = 2 * u - 1
        half = (
            width
            / 2
            * (0.03 + np.sin(np.pi * np.clip(v * 0.97 + 0.03, 0, 1) ** 0.55) ** 0.9 * (1 - 0.55 * v))
        )
        sway = (0.09 * np.sin(4.4 * v + phase) + 0.03 * np.sin(11 * v + 2 * phase)) * v * height
        return np.stack([-0.35 * half * s**2 + 0.02 * np.sin(4 * v + phase), height * v, sway - s * half], 1)

    sheet = surface(f, 8, 28)
    assert sheet.uvs is not None
    # Every other one shows the picture mirrored.
    uvs = sheet.uvs if seed % 2 else sheet.uvs * [-1, 1] + [1, 0]
    return Mesh(sheet.vertices, sheet.faces, sheet.normals, uvs)
