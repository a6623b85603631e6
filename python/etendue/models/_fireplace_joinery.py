"""What is built into the alcoves: cabinets, bookshelves full of books, and what stands and hangs there."""

from __future__ import annotations

import numpy as np

from etendue.models._fireplace_plan import (
    BRASS,
    BREAST_NORTH,
    BREAST_SOUTH,
    CERAMIC,
    EAST,
    FRUIT,
    IRON,
    NORTH,
    PANELING,
    SOUTH,
    STEEL,
    WEST,
    WOOD,
)
from etendue.models._fireplace_shapes import block, block_between, faces_east, faces_south, faces_west
from etendue.models._fireplace_textures import BOOK_CELLS
from etendue.models._fireplace_things import add_book, at, facing, lying_book, picture, vase
from etendue.models.mesh import Mesh, lathe, sphere
from etendue.models.model import Model

FRONT = -0.165
COUNTER = 0.80
SHELF_FRONT = -0.215
LEVELS = (COUNTER, 1.135, 1.465, 1.795, 2.125, 2.42)


def add(model: Model) -> None:
    """Adds cabinets, shelves, books and pictures."""
    _cabinet(model, SOUTH + 0.012, BREAST_SOUTH - 0.002, 4)
    _cabinet(model, BREAST_NORTH + 0.002, NORTH - 0.012, 4)
    _shelves(model)
    _south_alcove(model)
    _walls(model)


def _cabinet(model: Model, low: float, high: float, doors: int) -> None:
    model.add(
        PANELING, block_between((WEST + 0.002, 0.09, low), (FRONT - 0.02, COUNTER - 0.028, high), 0.002)
    )
    model.add(PANELING, block_between((WEST + 0.002, -0.01, low), (FRONT - 0.075, 0.088, high), 0.002))
    model.add(
        WOOD,
        block_between(
            (WEST + 0.001, COUNTER - 0.028, low - 0.008), (FRONT + 0.022, COUNTER, high + 0.0005), 0.004, 0.8
        ),
    )
    step = (high - low) / doors
    for k in range(doors):
        a, b = low + k * step + 0.0025, low + (k + 1) * step - 0.0025
        y0, y1 = 0.10, COUNTER - 0.034
        rail = 0.072
        model.add(
            PANELING,
            block_between((FRONT - 0.019, y0 + 0.03, a + 0.03), (FRONT - 0.006, y1 - 0.03, b - 0.03), 0.001),
        )
        for z0, z1 in ((a, a + rail), (b - rail, b)):
            model.add(PANELING, block_between((FRONT - 0.0195, y0, z0), (FRONT + 0.003, y1, z1), 0.0025))
        for v0, v1 in ((y0, y0 + rail), (y1 - rail, y1)):
            model.add(
                PANELING,
                block_between((FRONT - 0.0195, v0, a + rail), (FRONT + 0.0027, v1, b - rail), 0.0025),
            )
        knob = lathe(
            [(0, 0), (0.007, 0), (0.005, 0.012), (0.013, 0.020), (0.0145, 0.026), (0.011, 0.031), (0, 0.032)],
            24,
            35,
        )
        z = b - 0.036 if k % 2 == 0 else a + 0.036
        model.add(BRASS, knob.turned("z", -90).moved(FRONT + 0.003, y1 - 0.12, z))


def _shelves(model: Model) -> None:
    low, high = BREAST_NORTH + 0.004, NORTH - 0.014
    bays = np.linspace(low, high, 4)
    board = 0.026
    model.add(PANELING, block_between((WEST + 0.001, COUNTER, low), (WEST + 0.016, LEVELS[-1], high), 0.001))
    for k, z in enumerate(bays):
        a, b = (z, z + board) if k == 0 else (z - board, z) if k == 3 else (z - board / 2, z + board / 2)
        model.add(
            PANELING,
            block_between(
                (WEST + 0.014, COUNTER - 0.001, a), (SHELF_FRONT + 0.004, LEVELS[-1] + 0.001, b), 0.002
            ),
        )
    for k in range(3):
        a = bays[k] + (board if k == 0 else board / 2)
        b = bays[k + 1] - (board if k == 2 else board / 2)
        for y in LEVELS[1:-1]:
            model.add(
                PANELING,
                block_between((WEST + 0.014, y - board, a - 0.001), (SHELF_FRONT, y, b + 0.001), 0.002),
            )
        for row, y in enumerate(LEVELS[:-1]):
            _fill(model, a + 0.004, b - 0.004, y, LEVELS[row + 1] - board - y, 100 + 10 * k + row)
    top = LEVELS[-1]
    model.add(
        PANELING, block_between((WEST + 0.001, top, low), (SHELF_FRONT + 0.008, top + 0.07, high), 0.003)
    )
    model.add(
        PANELING,
        block_between(
            (WEST + 0.001, LEVELS[-1] + 0.068, low), (SHELF_FRONT + 0.022, LEVELS[-1] + 0.09, high), 0.006
        ),
    )


def _fill(model: Model, low: float, high: float, y: float, room: float, seed: int) -> None:
    """Fills a shelf from `low` to `high` along z: runs, leaning ends, piles, now and then a thing."""
    rng = np.random.default_rng(seed)
    z = low if rng.random() < 0.7 else low + rng.uniform(0.02, 0.10)
    while z < high - 0.05:
        left = high - z
        kind = rng.random()
        if kind < 0.60 or left < 0.16:
            run = min(left, rng.uniform(0.18, 0.5))
            z = _upright(model, rng, z, z + run, y, room, high)
        elif kind < 0.78 and left > 0.26:
            z = _pile(model, rng, z, y, room) + rng.uniform(0.02, 0.05)
        else:
            z = _thing(model, rng, z + 0.02, y, room, left - 0.03) + rng.uniform(0.03, 0.08)


def _upright(
    model: Model, rng: np.random.Generator, z: float, end: float, y: float, room: float, limit: float
) -> float:
    tall, deep = rng.uniform(0.19, min(0.275, room - 0.025)), rng.uniform(0.14, 0.19)
    series = rng.integers(BOOK_CELLS[0]) if rng.random() < 0.25 else None
    while z < end - 0.012:
        thick = float(np.clip(rng.lognormal(np.log(0.026), 0.38), 0.011, 0.055))
        if z + thick > limit:
            break
        height = min(room - 0.02, tall if series is not None else tall + rng.normal(0, 0.016))
        depth = min(0.22, max(0.11, deep + rng.normal(0, 0.009)))
        binding = int(series) if series is not None else int(rng.integers(BOOK_CELLS[0]))
        back = SHELF_FRONT - 0.012 - abs(rng.normal(0, 0.006))
        add_book(model, facing(faces_east, back, y, z + thick / 2), thick, height, depth, binding)
        z += thick + 0.0012
    # The last one leans on the others where there is room for it.
    lean = rng.uniform(7, 15)
    thick, height = rng.uniform(0.014, 0.03), min(tall, room - 0.03)
    wide = height * np.sin(np.radians(lean)) + thick * np.cos(np.radians(lean))
    if limit - z > wide + 0.01 and rng.random() < 0.7:
        # Turned about its foot so that its head rests on the run to the south.
        def settle(m: Mesh, z: float = z, t: float = thick, a: float = lean, h: float = height) -> Mesh:
            tilted = m.moved(x=t / 2).turned("z", -a)
            shift = float(h * np.sin(np.radians(a)))
            east = faces_east(tilted)
            return east.moved(
                SHELF_FRONT - 0.02, y + 0.0005 + t * np.sin(np.radians(a)), z + 0.002 + shift + t
            )

        add_book(model, settle, thick, height, 0.15, int(rng.integers(BOOK_CELLS[0])))
        z += wide + 0.012
    return z


def _pile(model: Model, rng: np.random.Generator, z: float, y: float, room: float) -> float:
    height, level = rng.uniform(0.20, 0.235), y
    for _ in range(int(rng.integers(3, 6))):
        thick = rng.uniform(0.016, 0.036)
        if level + thick > y + room - 0.08:
            break
        turn, binding = rng.normal(0, 2.5), int(rng.integers(BOOK_CELLS[0]))
        size = height * rng.uniform(0.88, 1.0)
        place = facing(faces_east, SHELF_FRONT - 0.10, level + 0.0006, z + 0.125, turn)
        lying_book(model, place, thick, size, 0.155, binding)
        level += thick + 0.0008
    if rng.random() < 0.6 and level < y + room - 0.12:
        model.add(CERAMIC, sphere(0.036, 24, 14).moved(SHELF_FRONT - 0.09, level + 0.0365, z + 0.12))
    return z + 0.245


def _thing(model: Model, rng: np.random.Generator, z: float, y: float, room: float, left: float) -> float:
    kind = int(rng.integers(4))
    if kind == 0:
        h = min(0.24, room - 0.05)
        outline = (
            np.array([(0.030, 0), (0.048, 0.03), (0.062, 0.10), (0.050, 0.17), (0.022, 0.215), (0.027, 0.24)])
            * h
            / 0.24
        )
        vase(
            model,
            at(SHELF_FRONT - 0.10, y + 0.0005, z + 0.065),
            outline,
            CERAMIC if rng.random() < 0.6 else IRON,
        )
        return z + 0.13
    if kind == 1 and left > 0.20:
        lean = lambda m: faces_east(m.turned("x", -8)).moved(SHELF_FRONT - 0.13, y + 0.118, z + 0.085)  # noqa: E731
        picture(model, lean, "dark", 0.13, 0.20, 0.012, WOOD)
        return z + 0.17
    if kind == 2:
        model.add(BRASS, block(0.09, 0.012, 0.09, 0.002).moved(SHELF_FRONT - 0.09, y + 0.0065, z + 0.05))
        ring = lathe([(0.040, -0.006), (0.052, -0.006), (0.052, 0.006), (0.040, 0.006), (0.040, -0.006)], 48)
        model.add(BRASS, ring.turned("z", 90).moved(SHELF_FRONT - 0.09, y + 0.0625, z + 0.05))
        return z + 0.10
    bowl = [(0.030, 0), (0.036, 0.004), (0.070, 0.035), (0.082, 0.07)]
    vase(model, at(SHELF_FRONT - 0.10, y + 0.0005, z + 0.085), bowl)
    return z + 0.17


def _south_alcove(model: Model) -> None:
    y = COUNTER + 0.0005
    picture(model, facing(faces_east, WEST, 1.62, -2.20), "painting", 1.02, 1.02, 0.016, WOOD)
    for k, (thick, tall, deep, binding, turn) in enumerate(
        ((0.034, 0.30, 0.225, 3, 2.0), (0.026, 0.285, 0.21, 8, -3.0), (0.03, 0.25, 0.19, 2, 4.0))
    ):
        level = y + (0, 0.0345, 0.061)[k]
        lying_book(model, facing(faces_east, -0.315, level, -2.08, turn), thick, tall, deep, binding)
    vase(
        model,
        at(-0.31, y + 0.0915, -2.08),
        [(0.028, 0), (0.040, 0.008), (0.060, 0.035), (0.055, 0.062), (0.046, 0.07)],
    )
    vase(
        model,
        at(-0.33, y, -2.62),
        [
            (0.055, 0),
            (0.085, 0.04),
            (0.115, 0.15),
            (0.10, 0.26),
            (0.052, 0.335),
            (0.042, 0.37),
            (0.052, 0.395),
        ],
    )
    vase(
        model,
        at(-0.30, y, -2.40),
        [(0.040, 0), (0.060, 0.03), (0.074, 0.09), (0.060, 0.15), (0.034, 0.18), (0.038, 0.20)],
        IRON,
    )
    dish = [(0.05, 0), (0.06, 0.004), (0.12, 0.018), (0.15, 0.034)]
    vase(model, at(-0.30, y, -1.78), dish, CERAMIC)
    rng = np.random.default_rng(4)
    for k in range(5):
        a = 2 * np.pi * k / 5
        body = lathe(
            [
                (0, 0.0),
                (0.012, 0.001),
                (0.030, 0.016),
                (0.034, 0.034),
                (0.027, 0.054),
                (0.010, 0.064),
                (0, 0.062),
            ],
            24,
            60,
        )
        model.add(
            FRUIT,
            body.turned("x", rng.uniform(0, 60)).moved(
                -0.30 + 0.055 * np.cos(a), y + 0.032, -1.78 + 0.055 * np.sin(a)
            ),
        )


def _walls(model: Model) -> None:
    """Pictures on the north wall, and, for who turns round, on the others."""
    picture(model, facing(faces_south, 0.50, 1.88, NORTH), "wide", 0.44, 0.58, 0.02)
    picture(model, facing(faces_south, 0.50, 1.30, NORTH), "dark", 0.30, 0.40, 0.016, STEEL)
    picture(model, at(3.75, 1.6, SOUTH), "wide", 0.9, 1.19, 0.02)
    picture(model, facing(faces_west, EAST, 1.6, -2.95), "tall", 0.62, 0.87, 0.02)
