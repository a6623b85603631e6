"""The walls of the nave: arcade, triforium, clerestory, and the vaults over nave and aisles."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from etendue.models._sibenik_columns import colonnette, nave_column, respond, vault_shaft
from etendue.models._sibenik_glass import BLUE, CLEAR, GREEN, RED, YELLOW
from etendue.models._sibenik_plan import (
    AISLE_IN,
    AISLE_OUT,
    ARCADE,
    BAY,
    CHOIR_BAY,
    CHOIR_END,
    CLERESTORY,
    EAST_PIER,
    GALLERY,
    NAVE_BAYS,
    NAVE_COLUMNS,
    NAVE_HALF,
    NAVE_TOP,
    SPRING,
    WALL,
    WEST_PIER,
    WEST_WALL,
)
from etendue.models._sibenik_shapes import (
    Arch,
    arch_band,
    arched,
    band,
    block,
    facing,
    grid,
    pierced,
    wall,
    welded,
)
from etendue.models._sibenik_vaults import ribs, transverse, webs
from etendue.models._sibenik_windows import SPLAY, add_lancet, shifted
from etendue.models.mesh import Mesh, lathe, merged
from etendue.models.model import Model

ARCADE_ARCH = Arch(1.72, 0.3)
TRIFORIUM_ARCH, TRIFORIUM_AT, TRIFORIUM_SPRING = Arch(0.46, 0.12), (-1.2, 0.0, 1.2), 7.36
CLERESTORY_ARCH, AISLE_ARCH = Arch(0.37, 0.25), Arch(0.4, 0.3)
AISLE_MIDDLE, AISLE_HALF = (AISLE_IN + AISLE_OUT) / 2, (AISLE_OUT - AISLE_IN) / 2
NAVE_RISE, AISLE_RISE = 3.4, 1.9
HALF_BAY = BAY / 2

# From the face of the wall to its middle, (offset, depth): hood, roll, rebate, chamfered order.
ORDERS = ((0.335, 0.0), (0.30, -0.035), (0.25, -0.035), (0.225, -0.05), (0.213, -0.08), (0.225, -0.11),
          (0.25, -0.125), (0.245, -0.145), (0.12, -0.145), (0.12, -0.22), (0.095, -0.235),
          (0.09, -0.26), (0.065, -0.30), (0.0, -0.31))  # fmt: skip
HOOD = ((0.42, 0.0), (0.42, 0.03), (0.405, 0.05), (0.38, 0.055), (0.36, 0.03), (0.345, 0.025), (0.335, 0.0))

COLOURS: tuple[tuple[str, ...], ...] = (
    (YELLOW, BLUE, RED, BLUE),
    (RED, CLEAR, BLUE, GREEN),
    (BLUE, YELLOW, GREEN, RED),
    (CLEAR, RED, BLUE, YELLOW),
)


def symmetric(half: Sequence[tuple[float, float]], thickness: float) -> list[tuple[float, float]]:
    """A moulding through a wall, the same from both faces."""
    return [*half, *[(d, -thickness - z) for d, z in reversed(half)]]


def moulding(profile: Sequence[tuple[float, float]], x0: float, x1: float) -> Mesh:
    """A string course along x on a wall that faces +z; the profile is (z, y) from bottom to top."""
    rows = [[(x0, y, z), (x1, y, z)] for z, y in profile]
    return grid(np.array(rows), crease=30)


STRING = (
    (0.0, -0.12),
    (0.02, -0.11),
    (0.03, -0.06),
    (0.075, -0.03),
    (0.10, -0.02),
    (0.105, 0.0),
    (0.10, 0.03),
    (0.0, 0.05),
)


def bay_parts() -> dict[str, Mesh]:
    """One bay of the nave's wall about x = 0, its inner face in z = 0 and facing +z, without glass."""
    h = HALF_BAY
    head = ARCADE_ARCH.curve(ORDERS[0][0]) + [0, SPRING]
    stone = [
        arched(-h, h, SPRING, GALLERY, head),
        facing(arched(-h, h, SPRING, GALLERY, head), "-z").moved(z=-WALL),
    ]
    trim = [
        arch_band(ARCADE_ARCH, symmetric(ORDERS, WALL)).moved(y=SPRING),
        arch_band(ARCADE_ARCH, HOOD).moved(y=SPRING),
        moulding(STRING, -h, h).moved(y=GALLERY - 0.04),
        moulding(STRING, -h, h).moved(y=CLERESTORY - 0.03),
    ]
    sill = GALLERY
    soft = ((0.07, 0.0), (0.05, -0.03), (0.03, -0.035), (0.005, -0.07), (0.0, -0.1))
    through = symmetric(soft, WALL)
    outlines = [TRIFORIUM_ARCH.outline(TRIFORIUM_SPRING - sill - 0.06, d, 8) for d, _ in through]
    wide = TRIFORIUM_ARCH.outline(TRIFORIUM_SPRING - sill - 0.06, 0.07, 8) + [0, TRIFORIUM_SPRING]
    edges = [-h, -1.8, -0.6, 0.6, 1.8, h]
    for x in TRIFORIUM_AT:
        cell = pierced(-0.6, 0.6, sill - 0.02, CLERESTORY, wide)
        stone += [cell.moved(x), facing(cell, "-z").moved(x, 0, -WALL)]
        trim.append(
            band([z for _, z in through], outlines, closed=True, crease=30).moved(x, TRIFORIUM_SPRING)
        )
    for x0, x1 in ((edges[0], edges[1]), (edges[4], edges[5])):
        stone += [wall(x0, x1, sill, CLERESTORY), facing(wall(x0, x1, sill, CLERESTORY), "-z").moved(z=-WALL)]
    slender = colonnette(sill + 0.02, TRIFORIUM_SPRING + 0.02)
    trim += [slender.moved(x, 0, -0.035) for x in (-1.78, -0.6, 0.6, 1.78)]
    trim += [m.moved(x) for m in balustrade() for x in TRIFORIUM_AT]
    window = CLERESTORY_ARCH.outline(1.15, SPLAY, 10) + [0, 9.85]
    for x0, x1, at in ((-1.15, 0, -0.56), (0, 1.15, 0.56)):
        stone.append(pierced(x0 - at, x1 - at, CLERESTORY, NAVE_TOP, window).moved(at))
    stone += [wall(-h, -1.15, CLERESTORY, NAVE_TOP), wall(1.15, h, CLERESTORY, NAVE_TOP)]
    return {"kamen_zid": merged(stone), "kamen_zid_parapet": merged(trim)}


def balustrade() -> list[Mesh]:
    """The parapet in one opening of the triforium."""
    low, high = GALLERY + 0.1, GALLERY + 0.78
    r = np.array([0.05, 0.05, 0.032, 0.045, 0.06, 0.055, 0.035, 0.025, 0.04, 0.05, 0.05])
    y = np.array([0.0, 0.06, 0.085, 0.2, 0.29, 0.36, 0.48, 0.59, 0.61, 0.63, 0.68])
    baluster = welded(lathe(np.c_[r, low + y], 8, 50))
    rails = [
        block(-0.475, 0.475, GALLERY + 0.03, low + 0.005, -0.27, -0.11, 0.012),
        block(-0.475, 0.475, high - 0.005, high + 0.1, -0.28, -0.1, 0.02),
    ]
    return [*rails, *[baluster.moved(x, 0, -0.19) for x in np.linspace(-0.36, 0.36, 5)]]


def gallery_parts(x0: float, x1: float) -> Mesh:
    """The passage behind the triforium: floor, back wall and ceiling, with z = 0 in the nave's face."""
    back = -WALL - 1.6
    floor = block(x0, x1, GALLERY - 0.3, GALLERY, back, -WALL - 0.001)
    ceiling = block(x0, x1, CLERESTORY + 0.02, CLERESTORY + 0.2, back, -WALL + 0.02)
    return merged([wall(x0, x1, GALLERY - 0.2, CLERESTORY + 0.1).moved(z=back + 0.01), floor, ceiling])


def aisle_bay_parts() -> dict[str, Mesh]:
    """One bay of an aisle's outer wall about x = 0, facing +z, without glass."""
    h = HALF_BAY
    window = AISLE_ARCH.outline(1.6, SPLAY, 10) + [0, 3.3]
    stone = [
        pierced(x0 - at, x1 - at, 0, GALLERY, window).moved(at)
        for x0, x1, at in ((-h, 0, -0.68), (0, h, 0.68))
    ]
    trim = [
        block(-h, h, -0.02, 0.42, -0.05, 0.34, 0.02),
        block(-h, h, 0.42, 0.5, -0.05, 0.38, 0.02),
        moulding(STRING, -h, h).scaled(1, 1, 0.8).moved(y=1.38),
    ]
    return {"kamen_zid": merged(stone), "kamen_zid_parapet": merged(trim)}


def add_nave(model: Model, lights: dict[str, str]) -> None:
    """Everything between the west wall and the end of the choir except the crossing and its arms.

    `lights` names the panels behind the windows: "north", "south" (aisles) and "high" (clerestory).
    """
    parts, outer = bay_parts(), aisle_bay_parts()
    bays = (*NAVE_BAYS, CHOIR_BAY)
    passage = gallery_parts(-HALF_BAY, HALF_BAY)
    for side, towards in ((-1, "+z"), (1, "-z")):
        for number, x in enumerate(bays):

            def place(mesh: Mesh, x: float = x, towards: str = towards, side: int = side) -> Mesh:
                return facing(mesh, towards).moved(x, 0, side * NAVE_HALF)

            def place_outer(mesh: Mesh, x: float = x, towards: str = towards, side: int = side) -> Mesh:
                return facing(mesh, towards).moved(x, 0, side * AISLE_OUT)

            for name, mesh in parts.items():
                model.add(name, place(mesh))
            for name, mesh in outer.items():
                model.add(name, place_outer(mesh))
            model.add("kamen_zid", place(passage))
            for at in (-0.56, 0.56):
                colours = COLOURS[(number + (at > 0)) % len(COLOURS)]
                add_lancet(
                    model,
                    CLERESTORY_ARCH,
                    1.15,
                    colours,
                    shifted(place, at, 9.85),
                    lights["high"],
                )
            for at in (-0.68, 0.68):
                colours = COLOURS[(number + (at < 0) + (side > 0) * 2) % len(COLOURS)]
                light = lights["north" if side < 0 else "south"]
                add_lancet(
                    model,
                    AISLE_ARCH,
                    1.6,
                    colours,
                    shifted(place_outer, at, 3.3),
                    light,
                )
        _add_uprights(model, side, towards)
    _add_vaults(model, bays)


def _add_uprights(model: Model, side: int, towards: str) -> None:
    """Columns, shafts under the high vault, and responds of one side."""
    column, shaft, foot = nave_column(), vault_shaft(), respond()
    for x in NAVE_COLUMNS:
        for name, mesh in column.items():
            model.add(name, mesh.moved(x, 0, side * ARCADE))
    for x in (WEST_WALL, *NAVE_COLUMNS, CHOIR_END):
        for name, mesh in shaft.items():
            model.add(name, facing(mesh, towards).moved(x, 0, side * NAVE_HALF))
        for name, mesh in foot.items():
            model.add(name, facing(mesh, towards).moved(x, 0, side * AISLE_OUT))
    for x, z in ((WEST_WALL, ARCADE), (CHOIR_END, ARCADE)):
        for name, mesh in column.items():
            model.add(name, mesh.moved(x, 0, side * z))


def _add_vaults(model: Model, bays: tuple[float, ...]) -> None:
    high = webs(HALF_BAY, NAVE_HALF, CLERESTORY, NAVE_RISE), ribs(HALF_BAY, NAVE_HALF, CLERESTORY, NAVE_RISE)
    low = webs(HALF_BAY, AISLE_HALF, SPRING, AISLE_RISE), ribs(HALF_BAY, AISLE_HALF, SPRING, AISLE_RISE)
    for x in bays:
        model.add("kamen_svod", high[0].moved(x))
        model.add("kamen_zid_parapet", high[1].moved(x))
        for side in (-1, 1):
            model.add("kamen_svod", low[0].moved(x, 0, side * AISLE_MIDDLE))
            model.add("kamen_zid_parapet", low[1].moved(x, 0, side * AISLE_MIDDLE))
    for x in (WEST_WALL, *NAVE_COLUMNS, CHOIR_END):
        model.add("kamen_zid_parapet", transverse(NAVE_HALF, CLERESTORY, NAVE_RISE).moved(x))
    for x in (WEST_WALL, *NAVE_COLUMNS, WEST_PIER, EAST_PIER, CHOIR_END):
        for side in (-1, 1):
            model.add(
                "kamen_zid_parapet",
                transverse(AISLE_HALF, SPRING, AISLE_RISE).moved(x, 0, side * AISLE_MIDDLE),
            )
