"""The chimney breast: mantelpiece, hearth, the glass before the fire, the mirror above, firewood beside."""

from __future__ import annotations

import numpy as np

from etendue.models._fireplace_fire import BASE, HALF, TOP
from etendue.models._fireplace_plan import (
    AXIS,
    BASKET,
    BRASS,
    BREAST,
    BREAST_NORTH,
    BREAST_SOUTH,
    CERAMIC,
    FIRE_GLASS,
    HEIGHT,
    IRON,
    MIRROR,
    PANELING,
    SLATE,
    STEEL,
    WALLS,
    WEST,
)
from etendue.models._fireplace_shapes import (
    block_between,
    circle,
    faces_east,
    faceted,
    frame,
    panel_moulding,
    tube,
)
from etendue.models._fireplace_things import at, candle, log, picture, vase
from etendue.models.mesh import box, lathe, merged, quad, sphere, sweep
from etendue.models.model import Model


def add(model: Model) -> None:
    """Adds the chimney breast and what belongs to it."""
    _breast(model)
    _surround(model)
    _mirror(model)
    _mantel_things(model)
    _beside(model)


def _breast(model: Model) -> None:
    columns = [BREAST_SOUTH, AXIS - HALF, AXIS + HALF, BREAST_NORTH]
    rows = [-0.02, BASE, TOP, HEIGHT]
    quads = []
    for k in range(3):
        for low, high in zip(rows[:-1], rows[1:], strict=True):
            if k == 1 and low == BASE:
                continue
            a, b = columns[k], columns[k + 1]
            quads.append(quad((BREAST, low, b), (BREAST, low, a), (BREAST, high, a), (BREAST, high, b)))
    for z, sign in ((BREAST_SOUTH, -1), (BREAST_NORTH, 1)):
        side = quad((WEST, -0.02, z), (BREAST, -0.02, z), (BREAST, HEIGHT, z), (WEST, HEIGHT, z))
        quads.append(side if sign > 0 else side.flipped())
    model.add(WALLS, faceted(merged(quads)))
    model.add(PANELING, faces_east(panel_moulding(1.46, 1.14, 0.036)).moved(BREAST, 1.87, AXIS))
    for sign in (-1, 1):
        z = AXIS + sign * 0.86
        model.add(
            PANELING, block_between((BREAST - 0.01, 0, z - 0.098), (BREAST + 0.018, 0.14, z + 0.09), 0.004)
        )


def _surround(model: Model) -> None:
    z = AXIS
    slab = block_between((BREAST - 0.03, -0.02, z - 0.88), (BREAST + 0.44, 0.036, z + 0.88), 0.006)
    model.add(SLATE, slab)
    for low, high in (
        ((BREAST - 0.004, 0.030, z - 0.60), (BREAST + 0.018, 0.83, z - HALF)),
        ((BREAST - 0.004, 0.030, z + HALF), (BREAST + 0.018, 0.83, z + 0.60)),
        ((BREAST - 0.004, TOP, z - HALF), (BREAST + 0.018, 0.83, z + HALF)),
        ((BREAST - 0.03, 0.030, z - HALF), (BREAST + 0.018, BASE + 0.012, z + HALF)),
    ):
        model.add(SLATE, block_between(low, high, 0.002))
    # The glazed front: a steel frame with a pane in it.
    rim = [(-0.034, -0.02), (0.006, -0.02), (0.006, 0.012), (0.003, 0.016), (-0.030, 0.016), (-0.034, 0.012)]
    height, middle = TOP - BASE - 0.012, (TOP + BASE + 0.012) / 2
    steel = frame(2 * HALF - 0.004, height - 0.004, rim)
    model.add(STEEL, faces_east(steel).moved(BREAST + 0.018, middle, z))
    model.add(
        FIRE_GLASS,
        faceted(box(0.005, height - 0.05, 2 * HALF - 0.05)).moved(BREAST + 0.014, middle, z),
    )
    grip = [
        (0, -0.05, 0),
        (0.022, -0.05, 0),
        (0.030, -0.042, 0),
        (0.030, 0.042, 0),
        (0.022, 0.05, 0),
        (0, 0.05, 0),
    ]
    model.add(STEEL, tube(grip, 0.005, 10).moved(BREAST + 0.034, middle, z - HALF + 0.014))
    # Pilasters on plinths, frieze, bed moulding, shelf.
    front = BREAST + 0.075
    for sign in (-1, 1):
        mid = z + sign * 0.675
        model.add(
            PANELING,
            block_between((BREAST - 0.01, 0.030, mid - 0.083), (front + 0.014, 0.175, mid + 0.091), 0.005),
        )
        model.add(
            PANELING, block_between((BREAST - 0.01, 0.17, mid - 0.077), (front, 1.05, mid + 0.085), 0.004)
        )
        model.add(PANELING, faces_east(panel_moulding(0.075, 0.52, 0.016)).moved(front, 0.50, mid + 0.004))
        model.add(
            PANELING,
            block_between((BREAST - 0.01, 0.815, mid - 0.083), (front + 0.012, 0.845, mid + 0.091), 0.005),
        )
        model.add(PANELING, faces_east(panel_moulding(0.075, 0.10, 0.016)).moved(front, 0.945, mid + 0.004))
    model.add(
        PANELING, block_between((BREAST - 0.01, 0.826, z - 0.60), (front - 0.018, 1.05, z + 0.60), 0.004)
    )
    model.add(PANELING, faces_east(panel_moulding(1.02, 0.12, 0.018)).moved(front - 0.018, 0.935, z))
    cyma = [
        (0.004 + 0.042 * t - 0.010 * np.sin(2 * np.pi * t), 1.052 + 0.055 * t) for t in np.linspace(0, 1, 12)
    ]
    section = [
        (-0.05, 1.035),
        (0.010, 1.035),
        (0.010, 1.047),
        (0.004, 1.047),
        *cyma,
        (0.060, 1.110),
        (0.060, 1.126),
        (-0.05, 1.126),
    ]
    w = 0.76
    path = [(BREAST - 0.01, 0, z + w), (front, 0, z + w), (front, 0, z - w), (BREAST - 0.01, 0, z - w)]
    model.add(PANELING, sweep(section, path, crease_degrees=30))
    model.add(
        PANELING,
        block_between((BREAST - 0.01, 1.122, z - w - 0.095), (front + 0.095, 1.165, z + w + 0.095), 0.008),
    )


def _mirror(model: Model) -> None:
    y, x, radius = 1.86, BREAST, 0.46
    glass = lathe(
        [(0, 0.004), (radius, 0.004), (radius, 0.014), (radius - 0.014, 0.018), (0, 0.018)], 128, 20
    )
    model.add(MIRROR, glass.turned("z", -90).moved(x, y, AXIS))
    ring = circle(radius + 0.004, 128)
    path = [(0, b, -a) for a, b in ring]
    section = [(-0.008, 0.0), (0.012, 0.0), (0.012, 0.026), (0.009, 0.030), (-0.002, 0.030), (-0.006, 0.026)]
    model.add(
        BRASS, sweep(section, path, closed_path=True, up=(1, 0, 0), crease_degrees=30).moved(x, y, AXIS)
    )


def _mantel_things(model: Model) -> None:
    y, x = 1.165, BREAST + 0.085
    candle(model, at(x + 0.01, y, AXIS - 0.70), 0.20, 0.22, BRASS)
    candle(model, at(x - 0.015, y, AXIS - 0.59), 0.13, 0.24, BRASS)
    candle(model, at(x + 0.015, y, AXIS - 0.48), 0.09, 0.19, BRASS)
    vase(
        model,
        at(x, y, AXIS + 0.66),
        [
            (0.030, 0),
            (0.046, 0.02),
            (0.066, 0.08),
            (0.060, 0.15),
            (0.030, 0.205),
            (0.020, 0.24),
            (0.026, 0.262),
        ],
    )
    vase(
        model,
        at(x + 0.02, y, AXIS + 0.52),
        [(0.034, 0), (0.050, 0.02), (0.058, 0.055), (0.042, 0.09), (0.032, 0.10)],
        CERAMIC,
    )
    lean = lambda m: faces_east(m.turned("x", -9)).moved(BREAST + 0.034, y + 0.138, AXIS + 0.36)  # noqa: E731
    picture(model, lean, "tall", 0.17, 0.24, 0.014)


def _beside(model: Model) -> None:
    """Firewood in a basket, and the fire irons, north of the hearth."""
    rng = np.random.default_rng(77)
    cx, cz, radius, height = 0.17, 1.10, 0.235, 0.30
    turns, per = 15, 64
    angle = 2 * np.pi * np.arange(per) / per
    for k in range(turns):
        y = 0.014 + k * height / turns
        grow = radius * (0.82 + 0.20 * (k / turns) ** 0.8)
        r = grow + 0.006 * np.sin(16 * angle + np.pi * k)
        path = np.stack([cx + r * np.cos(angle), np.full(per, y), cz - r * np.sin(angle)], 1)
        model.add(BASKET, tube(path, 0.0115, 6, closed=True))
    for k in range(32):
        a = 2 * np.pi * k / 32
        posts = [
            (
                cx + radius * (0.82 + 0.20 * t**0.8) * np.cos(a),
                0.004 + t * (height + 0.012),
                cz - radius * (0.82 + 0.20 * t**0.8) * np.sin(a),
            )
            for t in np.linspace(0, 1, 6)
        ]
        model.add(BASKET, tube(posts, 0.006, 6))
    model.add(
        BASKET,
        lathe([(0, 0.004), (radius * 0.82, 0.004), (radius * 0.82, 0.012), (0, 0.012)], 48).moved(cx, 0, cz),
    )
    for k in range(12):
        tilt, spin = rng.uniform(-14, 14), rng.uniform(-12, 12)
        x, z = cx + (k % 4 - 1.5) * 0.085 + rng.normal(0, 0.008), cz + rng.normal(0, 0.012)
        length, thick = rng.uniform(0.30, 0.36), rng.uniform(0.036, 0.045)
        for material, mesh in log(length, thick, 20 + k):
            lying = mesh.turned("y", 90).turned("x", 0.4 * tilt).turned("y", 0.4 * spin)
            model.add(material, lying.moved(x, 0.10 + k // 4 * 0.092, z))
    # The stand holds a poker and a brush.
    sx, sz = 0.13, 0.70
    model.add(
        IRON, lathe([(0, 0), (0.085, 0), (0.085, 0.006), (0.078, 0.012), (0, 0.014)], 48).moved(sx, 0.001, sz)
    )
    model.add(
        IRON, tube([(sx, 0.01, sz), (sx, 0.66, sz)], 0.006, 10), sphere(0.013, 16, 10).moved(sx, 0.668, sz)
    )
    model.add(IRON, tube([(sx - 0.05, 0.60, sz), (sx + 0.05, 0.60, sz)], 0.004, 8))
    for dx in (-0.045, 0.045):
        model.add(
            IRON,
            tube(
                [(sx + dx, 0.06, sz + 0.012), (sx + dx, 0.57, sz + 0.012), (sx + dx, 0.64, sz + 0.012)],
                [0.0035, 0.0035, 0.006],
                8,
            ),
        )
        model.add(BRASS, sphere(0.009, 14, 8).moved(sx + dx, 0.645, sz + 0.012))
    model.add(
        BASKET,
        lathe([(0, 0), (0.022, 0), (0.026, 0.09), (0.012, 0.12), (0, 0.12)], 20).moved(
            sx + 0.045, 0.045, sz + 0.012
        ),
    )
