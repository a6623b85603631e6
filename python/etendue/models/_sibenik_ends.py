"""The west front from within, the east ends of the aisles, and the apse."""

from __future__ import annotations

import numpy as np

from etendue.models._sibenik_glass import BLUE, GREEN, RED, YELLOW
from etendue.models._sibenik_nave import AISLE_MIDDLE, STRING, moulding, symmetric
from etendue.models._sibenik_plan import (
    AISLE_IN,
    AISLE_OUT,
    EAST_WALL,
    GALLERY,
    NAVE_TOP,
    WEST_WALL,
    WEST_WINDOW_HEIGHT,
)
from etendue.models._sibenik_shapes import (
    Arch,
    arch_band,
    arched,
    band,
    block,
    circle,
    facing,
    grid,
    pierced,
    wall,
)
from etendue.models._sibenik_windows import SPLAY, add_lancet, shifted
from etendue.models.mesh import Floats, Mesh, merged
from etendue.models.model import Model

APSE, APSE_SPRING, APSE_BACK = (
    2.62,
    6.4,
    0.5,
)  # half width, springing, where its walls begin behind the east wall
APSE_ORDERS = (
    (0.1, 0.0),
    (0.07, -0.03),
    (0.07, -0.08),
    (0.04, -0.1),
    (0.02, -0.13),
    (0.04, -0.16),
    (0.0, -0.18),
)


def add_ends(model: Model, lights: dict[str, str]) -> None:
    """All three; `lights` as for the nave, with "east" for the panels behind the windows there."""
    _add_west(model)
    for side in (-1, 1):
        _add_aisle_end(model, side, lights["east"])
    _add_apse(model, lights["east"])


def _add_west(model: Model) -> None:
    def place(mesh: Mesh) -> Mesh:
        return facing(mesh, "+x").moved(WEST_WALL)

    stone = [wall(-AISLE_IN, AISLE_IN, 0, NAVE_TOP)]
    stone += [wall(a, b, 0, GALLERY) for a, b in ((-AISLE_OUT, -AISLE_IN), (AISLE_IN, AISLE_OUT))]
    model.add("kamen_zid", place(merged(stone)))
    rim = [(0.57, 0.0), (0.57, 0.04), (0.53, 0.07), (0.47, 0.07), (0.45, 0.03), (0.44, 0.0)]
    model.add(
        "kamen_zid_parapet",
        place(
            band([z for _, z in rim], [circle(r, 48) for r, _ in rim], closed=True).moved(
                y=WEST_WINDOW_HEIGHT
            )
        ),
    )
    model.add("kamen_zid_parapet", place(moulding(STRING, -AISLE_IN, AISLE_IN).moved(y=5.9)))
    # The portal: two leaves of boards and rails in a moulded frame, standing in front of the wall.
    arch = Arch(1.15, 0.2)
    frame = [
        (0.34, 0.0),
        (0.34, 0.10),
        (0.30, 0.14),
        (0.24, 0.14),
        (0.22, 0.10),
        (0.16, 0.12),
        (0.12, 0.09),
        (0.1, 0.05),
        (0.02, 0.04),
        (0.0, 0.0),
    ]
    rows = [np.c_[c, np.full(len(c), z)] for z, c in ((z, _open_outline(arch, 2.6, d)) for d, z in frame)]
    model.add("kamen_zid_parapet", place(grid(np.stack(rows)).moved(y=2.6)))
    boards = []
    for k in range(12):
        x0 = -1.14 + 0.19 * k
        top = 2.6 + float(
            np.interp(abs(x0 + 0.095), arch.curve(0)[:13, 0][::-1], arch.curve(0)[:13, 1][::-1])
        )
        boards.append(block(x0 + 0.002, x0 + 0.188, 0.012, top - 0.06, -0.02, 0.045, 0.006))
    rails = [
        block(s * 0.57 - 0.54, s * 0.57 + 0.54, y, y + 0.16, 0.0, 0.075, 0.012)
        for s in (-1, 1)
        for y in (0.15, 1.3, 2.45)
    ]
    model.add("drvo", place(merged(boards + rails)))


def _open_outline(arch: Arch, jamb: float, offset: float) -> Floats:
    head = arch.curve(offset)
    return np.concatenate([[[head[0, 0], -jamb]], head, [[head[-1, 0], -jamb]]])


def _add_aisle_end(model: Model, side: int, light: str) -> None:
    def place(mesh: Mesh) -> Mesh:
        return facing(mesh, "-x").moved(EAST_WALL, 0, side * AISLE_MIDDLE)

    half = (AISLE_OUT - AISLE_IN) / 2 + 0.3
    arch, spring, jamb = Arch(0.62, 0.4), 3.4, 1.7
    model.add(
        "kamen_zid", place(pierced(-half, half, 0, GALLERY, arch.outline(jamb, SPLAY, 10) + [0, spring]))
    )
    model.add("kamen_zid_parapet", place(moulding(STRING, -half, half).moved(y=1.38)))
    add_lancet(model, arch, jamb, (YELLOW, RED, BLUE, BLUE), shifted(place, 0, spring), light)
    # A side altar.
    model.add(
        "kamen_zid_parapet",
        place(block(-0.8, 0.8, 0, 0.93, 0.05, 0.7, 0.02)),
        place(block(-0.9, 0.9, 0.93, 1.03, 0.02, 0.78, 0.02)),
    )


def _add_apse(model: Model, light: str) -> None:
    def place(mesh: Mesh) -> Mesh:
        return facing(mesh, "-x").moved(EAST_WALL)

    arch = Arch(APSE)
    depth = APSE_BACK
    model.add(
        "kamen_zid",
        place(arched(-AISLE_IN, AISLE_IN, APSE_SPRING, NAVE_TOP, arch.curve(0.1, 20) + [0, APSE_SPRING])),
    )
    model.add(
        "kamen_zid_parapet", place(arch_band(arch, symmetric(APSE_ORDERS, depth), n=20).moved(y=APSE_SPRING))
    )
    for s in (-1, 1):
        a, b = sorted((s * APSE, s * AISLE_IN))
        model.add("kamen_zid", place(block(a, b, 0, APSE_SPRING, -depth, 0, 0.02)))
        a, b = sorted((s * (APSE - 0.06), s * AISLE_IN))
        model.add(
            "kamen_zid_parapet",
            place(block(a, b, APSE_SPRING - 0.2, APSE_SPRING + 0.01, -depth - 0.05, 0.06, 0.03)),
        )
    # Five sides of a regular decagon, each with a lancet, under gores that meet over the arch.
    apothem = 2.7
    half = apothem * float(np.tan(np.pi / 10))
    window, spring, jamb = Arch(0.4, 0.3), 5.0, 2.6
    face = pierced(-half, half, 0, APSE_SPRING, window.outline(jamb, SPLAY, 10) + [0, spring])
    t = np.linspace(0, np.pi / 2, 15)[:, None]
    u = np.linspace(-1, 1, 7)[None, :]
    gore_points = np.broadcast_arrays(
        half * u * np.cos(t), APSE_SPRING + 2.75 * np.sin(t), apothem * (1 - np.cos(t))
    )
    gore = grid(np.stack(gore_points, 2), crease=60)
    for k in range(-2, 3):

        def side(mesh: Mesh, k: int = k) -> Mesh:
            return facing(mesh.moved(z=-apothem).turned("y", -36 * k), "-x").moved(EAST_WALL + depth - 0.02)

        model.add("kamen_zid", side(face))
        model.add("kamen_svod", side(gore))
        model.add("kamen_zid_parapet", side(moulding(STRING, -half, half).moved(y=APSE_SPRING)))
        colours = (YELLOW, BLUE, RED, BLUE) if k % 2 == 0 else (RED, YELLOW, BLUE, GREEN)
        add_lancet(model, window, jamb, colours, shifted(side, 0, spring), light)
