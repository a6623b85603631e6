"""The lamps: a floor lamp, a table lamp, a pendant, and lights let into the ceiling."""

from __future__ import annotations

import numpy as np

from etendue.models._fireplace_joinery import COUNTER
from etendue.models._fireplace_plan import BRASS, CERAMIC, HEIGHT, IRON, LAMPS, STEEL
from etendue.models._fireplace_shapes import circle, tube
from etendue.models._fireplace_things import vessel
from etendue.models.mesh import Mesh, disc, lathe, sphere
from etendue.models.model import Model

FLOOR_LAMP = (0.13, 3.12)
TABLE_LAMP = (-0.325, -1.52)
PENDANT = (1.92, -0.28)


def add(model: Model) -> None:
    """Adds the lamps."""
    x, z = FLOOR_LAMP
    foot = [
        (0, 0),
        (0.135, 0),
        (0.138, 0.004),
        (0.136, 0.014),
        (0.120, 0.020),
        (0.016, 0.026),
        (0.011, 0.034),
        (0, 0.034),
    ]
    model.add(
        BRASS,
        lathe(foot, 64, 30).moved(x, 0.0008, z),
        tube([(x, 0.02, z), (x, 0.8, z), (x, 1.40, z)], 0.0095, 14),
    )
    _shade(model, x, 1.34, z, 0.225, 0.185, 0.29, 0.045)
    x, z = TABLE_LAMP
    body = [
        (0.062, 0),
        (0.070, 0.006),
        (0.094, 0.06),
        (0.098, 0.11),
        (0.078, 0.18),
        (0.040, 0.232),
        (0.024, 0.252),
        (0.020, 0.268),
    ]
    model.add(CERAMIC, vessel(body, 0.008, 56).moved(x, COUNTER + 0.0006, z))
    model.add(
        BRASS,
        lathe([(0, 0), (0.024, 0), (0.024, 0.010), (0.010, 0.016), (0.008, 0.07), (0, 0.07)], 28).moved(
            x, COUNTER + 0.266, z
        ),
    )
    _shade(model, x, COUNTER + 0.29, z, 0.165, 0.125, 0.21, 0.035)
    _pendant(model)
    for px in (0.75, 2.3, 3.85):
        for pz in (-2.6, -0.2, 2.2):
            if abs(px - 2.3) < 0.1 and abs(pz + 0.2) < 0.1:
                continue
            rim = [
                (0.041, 0.0),
                (0.041, -0.006),
                (0.046, -0.009),
                (0.054, -0.006),
                (0.057, 0.004),
                (0.041, 0.004),
            ]
            model.add(STEEL, lathe(rim[::-1], 48, 30).moved(px, HEIGHT, pz))
            model.add(LAMPS, _inside(disc(0.0415, 40)).turned("x", 180).moved(px, HEIGHT - 0.0035, pz))


def _inside(mesh: Mesh) -> Mesh:
    """The mesh glowing like the inside of a shade."""
    return Mesh(mesh.vertices, mesh.faces, mesh.normals, np.full((len(mesh.vertices), 2), [0.75, 0.5]))


def _lit_shade(low: float, high: float, tall: float, segments: int) -> list[Mesh]:
    """A cloth shade standing on y = 0, from radius `low` below to `high` above; it glows outside and within.

    The cloth itself shines: light that had to find a bulb in its shade would be noise for everyone else.
    """
    steps = np.linspace(0, 1, 7)
    outside = lathe([(low + (high - low) * t, tall * t) for t in steps], segments)
    uvs = np.stack([np.full(len(outside.vertices), 0.25), 0.02 + 0.96 * outside.vertices[:, 1] / tall], 1)
    inside = lathe([(low - 0.0016 + (high - low) * t, tall * t) for t in steps[::3]], segments).flipped()
    return [Mesh(outside.vertices, outside.faces, outside.normals, uvs), _inside(inside)]


def _shade(
    model: Model, x: float, y: float, z: float, low: float, high: float, tall: float, bulb: float
) -> None:
    """A cloth shade whose lower rim is at height y, on wire rings, with its bulb, holder and spider."""
    model.add(LAMPS, *(m.moved(x, y, z) for m in _lit_shade(low, high, tall, 96)))
    for radius, up in ((low, 0.0), (high, tall)):
        ring = circle(radius, 72)
        path = np.stack([x + ring[:, 0], np.full(72, y + up), z + ring[:, 1]], 1)
        model.add(IRON, tube(path, 0.0028, 6, closed=True))
    model.add(CERAMIC, sphere(bulb, 24, 14).moved(x, y + 0.48 * tall, z))
    model.add(
        BRASS,
        lathe([(0, 0), (0.017, 0), (0.019, 0.03), (0.015, 0.042), (0, 0.042)], 24).moved(
            x, y + 0.48 * tall - bulb - 0.036, z
        ),
    )
    model.add(BRASS, tube([(x, y + 0.06 - 0.08, z), (x, y + 0.48 * tall - bulb - 0.02, z)], 0.006, 10))
    for k in range(3):
        a = 2 * np.pi * k / 3 + 0.4
        level, foot = y + tall - 0.004, y + 0.48 * tall - bulb - 0.01
        out = high - 0.001
        wire = [
            (x + 0.016 * np.cos(a), foot, z + 0.016 * np.sin(a)),
            (x + (bulb + 0.03) * np.cos(a), foot + bulb, z + (bulb + 0.03) * np.sin(a)),
            (x + out * 0.75 * np.cos(a), level - 0.02, z + out * 0.75 * np.sin(a)),
            (x + out * np.cos(a), level, z + out * np.sin(a)),
        ]
        model.add(IRON, tube(wire, 0.0018, 5))


def _pendant(model: Model) -> None:
    """A drum of pale cloth over the coffee table, closed below, three bulbs in it, on a cord from a rose."""
    x, z = PENDANT
    y, radius, tall = 2.02, 0.29, 0.21
    model.add(LAMPS, *(m.moved(x, y, z) for m in _lit_shade(radius, radius, tall, 120)))
    model.add(LAMPS, _inside(disc(radius - 0.004, 96)).turned("x", 180).moved(x, y + 0.006, z))
    for up in (0.0, tall):
        ring = circle(radius, 96)
        model.add(
            BRASS,
            tube(np.stack([x + ring[:, 0], np.full(96, y + up), z + ring[:, 1]], 1), 0.0035, 8, closed=True),
        )
    hub = y + tall - 0.03
    model.add(
        BRASS,
        lathe(
            [(0, -0.03), (0.022, -0.03), (0.024, 0.0), (0.018, 0.035), (0.006, 0.045), (0, 0.045)], 28
        ).moved(x, hub, z),
    )
    for k in range(3):
        a = 2 * np.pi * k / 3
        c, s = np.cos(a), np.sin(a)
        model.add(
            BRASS,
            tube(
                [
                    (x + 0.018 * c, hub, z + 0.018 * s),
                    (x + 0.08 * c, hub - 0.002, z + 0.08 * s),
                    (x + 0.135 * c, hub - 0.024, z + 0.135 * s),
                ],
                0.006,
                8,
            ),
        )
        model.add(
            BRASS,
            lathe([(0, 0), (0.016, 0), (0.016, 0.03), (0, 0.03)], 20).moved(
                x + 0.135 * c, hub - 0.050, z + 0.135 * s
            ),
        )
        model.add(CERAMIC, sphere(0.04, 20, 12).moved(x + 0.135 * c, hub - 0.084, z + 0.135 * s))
        b = a + np.pi / 3
        model.add(
            BRASS,
            tube(
                [
                    (x + 0.018 * np.cos(b), hub + 0.02, z + 0.018 * np.sin(b)),
                    (x + radius * np.cos(b), y + tall, z + radius * np.sin(b)),
                ],
                0.0025,
                6,
            ),
        )
    model.add(IRON, tube([(x, hub + 0.04, z), (x, 2.5, z), (x, HEIGHT - 0.02, z)], 0.0032, 8))
    model.add(
        BRASS,
        lathe(
            [(0, -0.030), (0.008, -0.030), (0.048, -0.022), (0.055, -0.010), (0.055, 0.002), (0, 0.002)], 40
        ).moved(x, HEIGHT, z),
    )
