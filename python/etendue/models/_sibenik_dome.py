"""The light dome: an octagonal drum with panes of light in its windows, the dome and its lantern."""

from __future__ import annotations

import numpy as np

from etendue.models._sibenik_nave import STRING, moulding, symmetric
from etendue.models._sibenik_plan import CROSSING, DRUM_BASE, DRUM_TOP, WEST_WALL, WEST_WINDOW_HEIGHT
from etendue.models._sibenik_shapes import Arch, band, circle, facing, grid, pierced, wall
from etendue.models._sibenik_vaults import RIB
from etendue.models.mesh import Floats, Mesh, sweep
from etendue.models.model import Model

APOTHEM, LANTERN = 3.0, 0.7  # of the drum's octagon and the lantern's
TANGENT = float(np.tan(np.pi / 8))
WINDOW, JAMB, WINDOW_SPRING = Arch(0.22), 0.48, DRUM_BASE + 1.6
DRUM_WALL = 0.45
DOME_RISE = 3.1
EYE = DRUM_TOP + 0.1 + DOME_RISE  # where the lantern begins
LANTERN_TOP = EYE + 1.1
REVEAL = ((0.08, 0.0), (0.06, -0.03), (0.03, -0.035), (0.0, -0.07), (0.0, -0.12))

# The windows that hold a pane of light, of the drum's faces counted from north by west, south and east,
# and the scale of the pane; the other windows are blind.
LIT = {3: 0.65, 4: 0.65, 5: 0.95, 6: 1.0, 7: 1.0}
# A pane stands in front of its wall in a frame, so that nothing close by is lit: a bright reveal that paths
# find by chance would be the noise of the picture.
PROUD = 0.04
LANTERN_PANE, WEST_PANE = 0.24, 0.34  # radii


def on_face(mesh: Mesh, face: int) -> Mesh:
    """A wall piece that faces +z put on a face of the drum, facing its axis."""
    return mesh.moved(z=-APOTHEM).turned("y", 45 * face).moved(CROSSING)


def add_dome(model: Model) -> None:
    """Drum, dome and lantern."""
    half = APOTHEM * TANGENT
    hole = WINDOW.outline(JAMB, REVEAL[0][0]) + [0, WINDOW_SPRING]
    side = pierced(-half, half, DRUM_BASE - 0.05, DRUM_TOP + 0.1, hole)
    through = symmetric(REVEAL, DRUM_WALL)
    trim = [
        band(
            [z for _, z in through], [WINDOW.outline(JAMB, d) for d, _ in through], closed=True, crease=30
        ).moved(y=WINDOW_SPRING),
        moulding(STRING, -half, half).moved(y=DRUM_TOP + 0.05),
    ]
    stone = [
        side,
        wall(-0.6, 0.6, WINDOW_SPRING - JAMB - 0.2, WINDOW_SPRING + 0.6).moved(z=-DRUM_WALL + 0.02),
    ]
    gore, rib = _gore().moved(z=APOTHEM), sweep(np.array(RIB) * 0.8, _rib_path())
    collar = moulding(STRING, -LANTERN * TANGENT, LANTERN * TANGENT).moved(y=EYE, z=APOTHEM - LANTERN)
    for face in range(8):
        model.add("kamen_zid", *(on_face(m, face) for m in stone))
        model.add("kamen_zid_parapet", *(on_face(m, face) for m in trim))
        if face in LIT:
            curves = [_opening(LIT[face], d) for d in (0.0, 0.0, 0.1, 0.1)]
            model.add("sprljci", on_face(_frame(curves), face))
        model.add("kamen_svod", on_face(gore, face))
        model.add("kamen_zid_parapet", rib.turned("y", 45 * face).moved(CROSSING))
        pane = wall(-LANTERN * TANGENT, LANTERN * TANGENT, EYE - 0.05, LANTERN_TOP).moved(z=APOTHEM - LANTERN)
        model.add("kamen_svod", on_face(pane, face))
        model.add("kamen_zid_parapet", on_face(collar, face))

    top = wall(-1, 1, -1, 1).turned("x", 90).moved(CROSSING, LANTERN_TOP)
    model.add("kamen_svod", top)
    model.add("sprljci", _round_frame(LANTERN_PANE).turned("x", 90).moved(CROSSING, LANTERN_TOP))
    model.add("sprljci", _west(_round_frame(WEST_PANE)))


def add_lamps(model: Model, name: str) -> None:
    """The panes of light: in the drum, at the top of the lantern, and in the west front."""
    model.add(name, *(on_face(_pane(_opening(scale, 0.004)), face) for face, scale in LIT.items()))
    model.add(name, _pane(circle(LANTERN_PANE)).turned("x", 90).moved(CROSSING, LANTERN_TOP))
    model.add(name, _west(_pane(circle(WEST_PANE))))


def _opening(scale: float, offset: float) -> Floats:
    """The outline of a pane in the drum."""
    return Arch(WINDOW.half * scale).outline(JAMB * scale, offset) + [0, WINDOW_SPRING]


def _west(mesh: Mesh) -> Mesh:
    return facing(mesh, "+x").moved(WEST_WALL, WEST_WINDOW_HEIGHT)


def _pane(outline: Floats) -> Mesh:
    """A convex outline filled, facing +z."""
    n = len(outline)
    vertices = np.concatenate([outline, [outline.mean(0)]])
    i = np.arange(n)
    return Mesh(np.c_[vertices, np.full(n + 1, PROUD)], np.stack([i, np.roll(i, -1), np.full(n, n)], 1))


def _frame(curves: list[Floats]) -> Mesh:
    """A flat iron frame around a pane, from the pane's edge outwards and back to the wall."""
    return band([-0.01, PROUD - 0.004, PROUD - 0.004, -0.01], curves, closed=True).flipped()


def _round_frame(radius: float) -> Mesh:
    return _frame([circle(radius + d) for d in (0.0, 0.0, 0.06, 0.06)])


def _gore(n: int = 20) -> Mesh:
    """One face of the dome, as it stands north of the axis."""
    t = np.linspace(0, np.pi / 2, n + 1)[:, None]
    u = np.linspace(-1, 1, 9)[None, :]
    reach = LANTERN + (APOTHEM - LANTERN) * np.cos(t)
    y = DRUM_TOP + 0.1 + DOME_RISE * np.sin(t)
    points = np.stack(np.broadcast_arrays(reach * TANGENT * u, y, -reach), 2)
    return grid(points, crease=60)


def _rib_path(n: int = 20) -> Floats:
    t = np.linspace(0, np.pi / 2, n + 1)
    reach = (LANTERN + (APOTHEM - LANTERN) * np.cos(t)) / np.cos(np.pi / 8)
    angle = np.pi / 8
    return np.stack(
        [reach * np.sin(angle), DRUM_TOP + 0.1 + DOME_RISE * np.sin(t), -reach * np.cos(angle)], 1
    )
