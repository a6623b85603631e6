"""The coffee table and what stands on it: books, a bowl of pears, a carafe, tumblers, a candle."""

from __future__ import annotations

import numpy as np

from etendue.models._fireplace_plan import BRASS, CERAMIC, FRUIT, GLASS, IRON, WAX, WOOD
from etendue.models._fireplace_shapes import block, tube
from etendue.models._fireplace_things import at, lying_book, vase, vessel
from etendue.models.mesh import Mesh, lathe, rounded_prism
from etendue.models.model import Model

TABLE_AT = (1.92, -0.28)
TOP = 0.40
RUG = 0.012
VASE_AT = (TABLE_AT[0] - 0.03, TABLE_AT[1] + 0.14)


def add(model: Model) -> None:
    """Adds the coffee table and its things."""
    x, z = TABLE_AT
    _table(model)
    rough = np.random.default_rng(6)
    level = TOP + 0.0005
    for thick, tall, deep, binding, turn in (
        (0.036, 0.32, 0.245, 1, 96.0),
        (0.030, 0.295, 0.225, 9, 88.0),
        (0.024, 0.25, 0.19, 16, 101.0),
    ):
        lying_book(model, at(x + 0.06, level, z - 0.36, turn), thick, tall, deep, binding)
        level += thick + 0.0008
    _spectacles(model, x + 0.07, level, z - 0.36)
    bowl = [(0.050, 0), (0.058, 0.004), (0.105, 0.026), (0.142, 0.060), (0.152, 0.082)]
    vase(model, at(x + 0.10, TOP, z + 0.44), bowl, CERAMIC)
    for k, (a, r, up) in enumerate(
        ((0.2, 0.062, 0.040), (2.2, 0.060, 0.040), (4.2, 0.064, 0.040), (1.2, 0.012, 0.080))
    ):
        tilt, spin = rough.uniform(20, 75), rough.uniform(0, 360)
        pear = _pear().moved(y=-0.032).turned("x", tilt).turned("y", spin)
        model.add(FRUIT, pear.moved(x + 0.10 + r * np.cos(a), TOP + up, z + 0.44 + r * np.sin(a)))
        model.add(
            IRON,
            tube([(0, 0.052, 0), (0.001, 0.062, 0), (0.005, 0.070, 0.001)], 0.0013, 5)
            .turned("x", tilt)
            .turned("y", spin)
            .moved(x + 0.10 + r * np.cos(a), TOP + up, z + 0.44 + r * np.sin(a)),
        )
        del k
    model.add(
        GLASS,
        vessel(
            [(0.040, 0), (0.050, 0.010), (0.056, 0.06), (0.062, 0.16), (0.078, 0.27), (0.084, 0.30)],
            0.004,
            64,
            0.014,
        ).moved(VASE_AT[0], TOP, VASE_AT[1]),
    )
    _tray(model, x - 0.17, z - 0.22)


def _table(model: Model) -> None:
    x, z = TABLE_AT
    wide, long, corner = 0.70, 1.26, 0.07

    def slab(w: float, h: float, r: float, thick: float, edge: float) -> Mesh:
        t = np.linspace(0, np.pi / 2, 7)
        signs = ((1, 1), (-1, 1), (-1, -1), (1, -1))
        outline = np.concatenate(
            [
                np.stack(
                    [
                        sx * (w / 2 - r) + r * np.cos(t + k * np.pi / 2),
                        sz * (h / 2 - r) + r * np.sin(t + k * np.pi / 2),
                    ],
                    1,
                )
                for k, (sx, sz) in enumerate(signs)
            ]
        )
        board = rounded_prism(outline, thick, edge, 3)
        p = board.vertices
        return Mesh(
            p, board.faces, board.normals, np.stack([p[:, 2] * 0.72 + 0.5, p[:, 0] * 0.85 + 0.5 + p[:, 1]], 1)
        )

    model.add(WOOD, slab(wide, long, corner, 0.030, 0.007).moved(x, TOP - 0.030, z))
    model.add(WOOD, slab(wide - 0.20, long - 0.24, 0.04, 0.016, 0.004).moved(x, 0.135, z))
    for sx in (-1, 1):
        for sz in (-1, 1):
            foot = (x + sx * (wide / 2 - 0.035), RUG - 0.004, z + sz * (long / 2 - 0.055))
            head = (x + sx * (wide / 2 - 0.085), TOP - 0.026, z + sz * (long / 2 - 0.125))
            middle = tuple((a + b) / 2 for a, b in zip(foot, head, strict=True))
            model.add(WOOD, tube([foot, middle, head], [0.0125, 0.018, 0.023], 18))
            model.add(
                BRASS,
                lathe([(0.0135, 0), (0.0145, 0.03), (0.0135, 0.031)], 20).moved(
                    foot[0] - sx * 0.002, foot[1], foot[2] - sz * 0.002
                ),
            )
    for sz in (-1, 1):
        model.add(
            WOOD, block(wide - 0.15, 0.035, 0.02, 0.003).moved(x, TOP - 0.048, z + sz * (long / 2 - 0.13))
        )
    lying_book(model, at(x - 0.02, 0.1515, z + 0.18, 84), 0.020, 0.29, 0.22, 22)
    lying_book(model, at(x - 0.01, 0.1722, z + 0.18, 92), 0.014, 0.28, 0.21, 34)


def _pear() -> Mesh:
    profile = [
        (0, 0.002),
        (0.010, 0.0),
        (0.026, 0.008),
        (0.036, 0.026),
        (0.035, 0.044),
        (0.026, 0.062),
        (0.018, 0.078),
        (0.014, 0.088),
        (0.007, 0.094),
        (0, 0.093),
    ]
    return lathe(profile, 28, 70).moved(y=-0.01)


def _tray(model: Model, x: float, z: float) -> None:
    """A round iron tray with a carafe, two tumblers and a candle in a glass."""
    tray = [
        (0, 0),
        (0.185, 0),
        (0.192, 0.004),
        (0.194, 0.020),
        (0.190, 0.022),
        (0.187, 0.020),
        (0.183, 0.006),
        (0, 0.006),
    ]
    model.add(IRON, lathe(tray, 72, 35).moved(x, TOP + 0.0004, z))
    y = TOP + 0.0068
    carafe = [
        (0.040, 0),
        (0.048, 0.006),
        (0.056, 0.04),
        (0.055, 0.09),
        (0.036, 0.145),
        (0.020, 0.185),
        (0.020, 0.215),
        (0.029, 0.245),
    ]
    model.add(GLASS, vessel(carafe, 0.0028, 56, 0.008).moved(x - 0.055, y, z + 0.055))
    for dx, dz in ((0.075, 0.075), (0.095, -0.035)):
        model.add(
            GLASS,
            vessel([(0.029, 0), (0.033, 0.004), (0.035, 0.03), (0.038, 0.095)], 0.0022, 48, 0.010).moved(
                x + dx, y, z + dz
            ),
        )
    model.add(
        GLASS,
        vessel([(0.036, 0), (0.040, 0.005), (0.041, 0.03), (0.041, 0.085)], 0.003, 48, 0.008).moved(
            x - 0.05, y, z - 0.085
        ),
    )
    wax = lathe([(0, 0), (0.0362, 0), (0.0362, 0.050), (0.030, 0.0515), (0, 0.050)], 40)
    model.add(WAX, wax.moved(x - 0.05, y + 0.0085, z - 0.085))
    model.add(IRON, tube([(x - 0.05, y + 0.057, z - 0.085), (x - 0.049, y + 0.070, z - 0.085)], 0.001, 5))


def _spectacles(model: Model, x: float, y: float, z: float) -> None:
    """A pair of reading glasses, folded, with no lenses worth a caustic."""
    for s in (-1, 1):
        t = np.linspace(0, 2 * np.pi, 29)[:-1]
        rim = np.stack(
            [s * 0.033 + 0.024 * np.cos(t), 0.0185 + 0.0185 * np.sin(t) * (1 - 0.12 * np.sin(t)), 0 * t], 1
        )
        model.add(IRON, tube(rim, 0.0016, 6, closed=True).moved(x, y + 0.0018, z))
        temple = [
            (s * 0.059, 0.026, -0.002),
            (s * 0.058, 0.024, -0.008),
            (0, 0.020 + 0.004 * s, -0.013),
            (-s * 0.045, 0.018, -0.013),
            (-s * 0.058, 0.004, -0.011),
        ]
        model.add(IRON, tube(temple, 0.0015, 6).moved(x, y + 0.0018, z))
    model.add(
        IRON,
        tube([(-0.010, 0.024, 0), (0, 0.028, 0.001), (0.010, 0.024, 0)], 0.0014, 6).moved(x, y + 0.0018, z),
    )
