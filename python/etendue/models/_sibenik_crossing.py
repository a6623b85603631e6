"""The crossing: piers, arches, pendentives, and the two arms beside it."""

from __future__ import annotations

import numpy as np

from etendue.models._sibenik_columns import crossing_pier
from etendue.models._sibenik_glass import BLUE, CLEAR, GREEN, RED, YELLOW
from etendue.models._sibenik_nave import AISLE_MIDDLE, NAVE_RISE, ORDERS, STRING, moulding, symmetric
from etendue.models._sibenik_plan import (
    AISLE_OUT,
    ARCADE,
    CLERESTORY,
    CROSSING,
    CROSSING_HALF,
    CROSSING_SPRING,
    EAST_PIER,
    GALLERY,
    NAVE_TOP,
    RING,
    SPRING,
    WALL,
    WEST_PIER,
)
from etendue.models._sibenik_shapes import Arch, arch_band, arched, band, block, facing, grid, pierced, wall
from etendue.models._sibenik_vaults import ribs, webs
from etendue.models._sibenik_windows import SPLAY, Move, add_lancet, add_rose, shifted
from etendue.models.mesh import Mesh, lathe, merged
from etendue.models.model import Model

ARCH_DEPTH = 1.1
ARM_HALF = 3.05
ARM_NEAR = CROSSING_HALF + ARCH_DEPTH  # |z| where an arm begins
DOOR_ARCH = Arch(1.4, 0.25)
# From the crossing's side of an arch to its middle.
CROSSING_ORDERS = ((0.05, 0.0), (0.0, 0.0), (-0.02, -0.03), (-0.02, -0.08), (-0.06, -0.09),
                   (-0.08, -0.12), (-0.08, -0.16), (-0.06, -0.19), (-0.02, -0.2), (-0.02, -0.24),
                   (-0.18, -0.24), (-0.18, -0.3), (-0.22, -0.31), (-0.24, -0.34), (-0.24, -0.38),
                   (-0.29, -0.42))  # fmt: skip


def add_crossing(model: Model, lights: dict[str, str]) -> None:
    """Piers, arches and pendentives, then the arms; `lights` as for the nave."""
    for name, mesh in crossing_pier().items():
        for x in (WEST_PIER, EAST_PIER):
            for side in (-1, 1):
                model.add(name, mesh.moved(x, 0, side * ARCADE))
    arch = Arch(CROSSING_HALF)
    orders = arch_band(arch, symmetric(CROSSING_ORDERS, ARCH_DEPTH), n=20)
    back = facing(arched(-3.12, 3.12, 0, NAVE_TOP - CROSSING_SPRING, arch.curve(0.05, 20)), "-z").moved(
        z=-ARCH_DEPTH
    )
    corner = pendentive()
    for quarter in range(4):

        def place(mesh: Mesh, quarter: int = quarter) -> Mesh:
            return mesh.moved(0, CROSSING_SPRING, -CROSSING_HALF).turned("y", 90 * quarter).moved(CROSSING)

        model.add("kamen_zid_parapet", place(orders))
        model.add("kamen_zid", place(back))
        model.add("kamen_svod", corner.turned("y", 90 * quarter).moved(CROSSING, CROSSING_SPRING))
    model.add("kamen_zid_parapet", ring().moved(CROSSING))
    for side, towards in ((-1, "+z"), (1, "-z")):
        _add_arm(model, side, towards, lights)


def pendentive(n: int = 16) -> Mesh:
    """The part of a sphere between two arches and the ring, in the quarter x, z > 0, facing the middle."""
    a = CROSSING_HALF
    v, u = np.meshgrid(np.linspace(0, 1, n + 1), np.linspace(0, 1, n + 1), indexing="ij")
    y = a * v
    reach = np.sqrt(2 * a**2 - y**2)
    first = np.arccos(np.clip(a / reach, -1, 1))
    phi = first + (np.pi / 2 - 2 * first) * u
    return grid(np.stack([reach * np.cos(phi), y, reach * np.sin(phi)], 2), crease=60)


def ring() -> Mesh:
    """The cornice on the pendentives, facing inwards."""
    a = RING
    profile = [(3.5, a + 0.36), (2.72, a + 0.36), (2.70, a + 0.34), (2.70, a + 0.29), (2.74, a + 0.27),
               (2.80, a + 0.25), (2.84, a + 0.2), (2.84, a + 0.15), (2.87, a + 0.14), (2.90, a + 0.11),
               (2.90, a + 0.07), (2.87, a + 0.04), (2.90, a + 0.01), (2.97, a - 0.02)]  # fmt: skip
    return lathe(profile, 64, 35)


def _add_arm(model: Model, side: int, towards: str, lights: dict[str, str]) -> None:
    """One arm of the crossing: its end wall, two side walls and vault."""
    middle, half = (ARM_NEAR + AISLE_OUT) / 2, (AISLE_OUT - ARM_NEAR) / 2
    model.add("kamen_svod", webs(ARM_HALF, half, CLERESTORY, NAVE_RISE).moved(CROSSING, 0, side * middle))
    model.add(
        "kamen_zid_parapet", ribs(ARM_HALF, half, CLERESTORY, NAVE_RISE).moved(CROSSING, 0, side * middle)
    )

    def end(mesh: Mesh) -> Mesh:
        return facing(mesh, towards).moved(CROSSING, 0, side * AISLE_OUT)

    _add_end_wall(model, end, lights["north" if side < 0 else "south"])
    for x, looks in ((CROSSING - ARM_HALF, "+x"), (CROSSING + ARM_HALF, "-x")):

        def place(mesh: Mesh, x: float = x, looks: str = looks) -> Mesh:
            return facing(mesh, looks).moved(x, 0, side * AISLE_MIDDLE)

        _add_side_wall(model, place, lights["high"])


def _add_end_wall(model: Model, place: Move, light: str) -> None:
    """Three lancets under a rose."""
    edge, split = ARM_HALF + 0.1, 6.55
    arch, jamb, spring = Arch(0.45, 0.3), 3.0, 5.2
    hole = arch.outline(jamb, SPLAY, 10) + [0, spring]
    stone = [pierced(-0.72, 0.72, 0, split, hole).moved(x) for x in (-1.44, 0, 1.44)]
    stone += [wall(-edge, -2.16, 0, split), wall(2.16, edge, 0, split)]
    angle = 2 * np.pi * np.arange(48) / 48
    round_hole = 9.3 * np.array([0, 1]) + (1.35 + SPLAY) * np.stack([np.cos(angle), np.sin(angle)], 1)
    stone.append(pierced(-edge, edge, split, NAVE_TOP, round_hole))
    model.add("kamen_zid", place(merged(stone)))
    model.add(
        "kamen_zid_parapet",
        place(moulding(STRING, -edge, edge).moved(y=split)),
        place(moulding(STRING, -edge, edge).moved(y=1.38)),
    )
    model.add("kamen_zid_parapet", place(block(-edge, edge, -0.02, 0.42, -0.05, 0.34, 0.02)))
    for k, x in enumerate((-1.44, 0, 1.44)):
        colours = (YELLOW, BLUE, RED, BLUE) if k % 2 else (RED, BLUE, GREEN, YELLOW)
        add_lancet(model, arch, jamb, colours, shifted(place, x, spring), light)
    add_rose(model, 1.35, 12, (YELLOW, BLUE, RED, BLUE), shifted(place, 0, 9.3), light)


def _add_side_wall(model: Model, place: Move, light: str) -> None:
    """An arch to the aisle; three lancets above the aisle's roof, the middle one taller."""
    edge, foot = 1.9, SPRING + 0.06
    lower = pierced(-edge, edge, -0.6, GALLERY, DOOR_ARCH.outline(foot, ORDERS[0][0]) + [0, SPRING])
    orders = symmetric(ORDERS, WALL)
    curves = [DOOR_ARCH.outline(foot, d) for d, _ in orders]
    stone = [lower, facing(lower, "-z").moved(z=-WALL)]
    trim = [
        band([z for _, z in orders], curves, closed=True).moved(y=SPRING),
        moulding(STRING, -edge, edge).moved(y=GALLERY),
    ]
    for k, x in enumerate((-1.1, 0, 1.1)):
        arch, spring = (Arch(0.4, 0.25), 9.45) if k == 1 else (Arch(0.38, 0.25), 8.55)
        jamb = spring - 6.7
        hole = arch.outline(jamb, SPLAY, 10) + [0, spring]
        left, right = (-edge, -0.55) if k == 0 else (-0.55, 0.55) if k == 1 else (0.55, edge)
        # The hole's middle must see the whole cell, so the cell is laid around it and then moved.
        stone.append(pierced(left - x, right - x, GALLERY, NAVE_TOP, hole).moved(x))
        colours = ((RED, BLUE, GREEN, BLUE), (YELLOW, RED, BLUE, RED), (CLEAR, GREEN, RED, BLUE))[k]
        add_lancet(model, arch, jamb, colours, shifted(place, x, spring), light)
    model.add("kamen_zid", place(merged(stone)))
    model.add("kamen_zid_parapet", place(merged(trim)))
