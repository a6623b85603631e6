"""Whole windows: the splayed reveal, the glazing, the panel of light outside."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import cache

import numpy as np

from etendue.models._sibenik_glass import lancet, rose
from etendue.models._sibenik_shapes import Arch, band, circle, faceted
from etendue.models.mesh import Floats, Mesh
from etendue.models.model import Model

SPLAY = 0.16  # how much wider the window is in the wall's face than at the glass
GLASS_DEPTH = -0.36
PANEL_DEPTH = -0.78
REVEAL = ((SPLAY, 0.0), (0.145, -0.012), (0.13, -0.05), (0.03, -0.25), (0.02, -0.29), (0.03, -0.31),
          (-0.01, -0.33), (-0.01, -0.42), (0.10, PANEL_DEPTH - 0.02))  # fmt: skip

Move = Callable[[Mesh], Mesh]


def shifted(move: Move, x: float, y: float) -> Move:
    """First along the wall, then as `move` does."""
    return lambda mesh: move(mesh.moved(x, y))


def add_lancet(
    model: Model, arch: Arch, jamb: float, colours: Sequence[str], move: Move, light: str | None
) -> None:
    """A lancet whose springing is at the local origin, in a wall that faces local +z at z = 0."""
    for name, mesh in _lancet_parts(arch, jamb, tuple(colours)).items():
        model.add(name, move(mesh))
    if light:
        model.add(light, move(_panel(arch.outline(jamb, 0.12, 6))))


def add_rose(
    model: Model, radius: float, petals: int, colours: Sequence[str], move: Move, light: str | None
) -> None:
    """A round window about the local origin."""
    parts = rose(radius, petals, colours)
    for name, mesh in parts.items():
        model.add(name, move(mesh.moved(z=GLASS_DEPTH)))
    model.add("kamen_zid_parapet", move(_reveal([circle(radius + d, 48) for d, _ in REVEAL])))
    # Spokes and rings of stone stand before the glass.
    spoke = [(0.035, -0.02), (0.045, 0.0), (0.03, 0.05), (-0.03, 0.05), (-0.045, 0.0), (-0.035, -0.02)]
    for r in (0.2, 0.42, 0.78):
        ring = [circle(radius * r + d, 48) for d, _ in spoke]
        model.add(
            "kamen_zid_parapet", move(band([GLASS_DEPTH + 0.03 + z for _, z in spoke], ring, closed=True))
        )
    bar = np.array([[r, d] for d, _ in spoke for r in (radius * 0.42, radius * 1.005)]).reshape(
        len(spoke), 2, 2
    )
    depth = np.array([GLASS_DEPTH + 0.028 + z for _, z in spoke])[:, None, None].repeat(2, 1)
    spoke_mesh = faceted(_strip(np.concatenate([bar, depth], 2)))
    for k in range(petals):
        model.add("kamen_zid_parapet", move(spoke_mesh.turned("z", 360 * k / petals)))
    if light:
        model.add(light, move(_panel(circle(radius + 0.12))))


@cache
def _lancet_parts(arch: Arch, jamb: float, colours: tuple[str, ...]) -> dict[str, Mesh]:
    parts = {name: mesh.moved(z=GLASS_DEPTH) for name, mesh in lancet(arch, jamb, colours).items()}
    parts["kamen_zid_parapet"] = _reveal([arch.outline(jamb, d, 10) for d, _ in REVEAL])
    return parts


def _reveal(curves: list[Floats]) -> Mesh:
    return band([z for _, z in REVEAL], curves, closed=True, crease=25)


def _panel(outline: Floats) -> Mesh:
    """A rectangle behind an outline that shines into the church."""
    (x0, y0), (x1, y1) = outline.min(0), outline.max(0)
    corners = np.array([[x0, y0, 0], [x1, y0, 0], [x1, y1, 0], [x0, y1, 0]], float)
    return faceted(Mesh(corners, np.array([[0, 1, 2], [0, 2, 3]]))).moved(z=PANEL_DEPTH)


def _strip(rows: Floats) -> Mesh:
    """Quads between consecutive rows of two points; faces the side that `band` faces."""
    n = len(rows)
    i = 2 * np.arange(n - 1)
    faces = np.concatenate([np.stack([i, i + 1, i + 3], 1), np.stack([i, i + 3, i + 2], 1)])
    return Mesh(rows.reshape(-1, 3), faces)
