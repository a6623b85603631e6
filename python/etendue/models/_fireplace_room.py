"""The shell of the fireplace room: parquet, walls, ceiling, mouldings."""

from __future__ import annotations

import numpy as np

from etendue.models._fireplace_openings import door, window
from etendue.models._fireplace_plan import (
    BREAST,
    BREAST_NORTH,
    BREAST_SOUTH,
    EAST,
    EAST_WINDOWS,
    FLOOR,
    HEAD,
    HEIGHT,
    NORTH,
    NORTH_WINDOW,
    PAINT,
    PANELING,
    SILL,
    SOUTH,
    WALLS,
    WEST,
    WOOD,
)
from etendue.models._fireplace_shapes import (
    block,
    faces_south,
    faces_west,
    faceted,
    panel_moulding,
)
from etendue.models._fireplace_textures import FLOOR_STRIPS
from etendue.models._fireplace_things import at, facing
from etendue.models.mesh import Floats, Mesh, merged, quad, sweep
from etendue.models.model import Model


def add(model: Model) -> None:
    """Adds the room's shell."""
    model.add(FLOOR, parquet())
    model.add(WOOD, quad(*_level(-0.006, 0.3)))
    model.add(PAINT, faceted(quad(*_level(HEIGHT)).flipped()))
    _walls(model)
    _mouldings(model)
    for low, high in EAST_WINDOWS:
        window(model, high - low, facing(faces_west, EAST, SILL, (low + high) / 2), True)
    low, high = NORTH_WINDOW
    window(model, high - low, facing(faces_south, (low + high) / 2, SILL, NORTH), False)
    door(model)


def parquet() -> Mesh:
    """Oak herringbone at 45 degrees to the walls, each block bevelled and cut from its own piece of board."""
    rng = np.random.default_rng(31)
    width, ratio = 0.095, 6
    length = width * ratio
    blocks = []
    reach = 60
    for a in range(-reach, reach):
        for b in range(-12, 12):
            for upright in (False, True):
                x, z = (a + ratio * b) * width, (a - ratio * b) * width
                # The two blocks of the pattern's cell, by their middles.
                cx, cz = (
                    (x + (ratio + 0.5) * width, z + (1 - ratio / 2) * width)
                    if upright
                    else (x + length / 2, z + width / 2)
                )
                px, pz = (cx - cz) * np.sqrt(0.5) + 2.2, (cx + cz) * np.sqrt(0.5) + 0.1
                margin = 0.24
                if not (WEST - margin < px < EAST + margin and SOUTH - margin < pz < NORTH + margin):
                    continue
                top = block(length - 0.0007, 0.02, width - 0.0007, bevel=0.0011)
                seen = np.any(top.vertices[top.faces][:, :, 1] > 0, axis=1)
                along, across = top.vertices[:, 0] / 1.15, top.vertices[:, 2] / width * 0.92
                if rng.random() < 0.5:
                    along = -along
                strip = int(rng.integers(FLOOR_STRIPS))
                uvs = np.stack([along + rng.random(), (strip + 0.5 + across) / FLOOR_STRIPS], 1)
                piece = Mesh(top.vertices, top.faces[seen], top.normals, uvs)
                turn = (90 if upright else 0) - 45
                blocks.append(piece.turned("y", -turn).moved(px, -0.01 + rng.normal(0, 0.00012), pz))
    return merged(blocks)


def _level(y: float, wider: float = 0.0) -> Floats:
    """The corners of the room's plan at a height, counter-clockwise seen from above."""
    w, e, s, n = WEST - wider, EAST + wider, SOUTH - wider, NORTH + wider
    return np.array([(w, y, s), (w, y, n), (e, y, n), (e, y, s)])


def _walls(model: Model) -> None:
    sides = (
        ((WEST, SOUTH), (EAST, SOUTH), ()),
        ((EAST, SOUTH), (EAST, NORTH), tuple((a - SOUTH, b - SOUTH) for a, b in EAST_WINDOWS)),
        ((EAST, NORTH), (WEST, NORTH), tuple((EAST - b, EAST - a) for a, b in (NORTH_WINDOW,))),
        ((WEST, NORTH), (WEST, SOUTH), ()),
    )
    for start, end, holes in sides:
        model.add(WALLS, faceted(_wall(np.array(start), np.array(end), sorted(holes))))


def _wall(start: Floats, end: Floats, holes: list[tuple[float, float]]) -> Mesh:
    """A wall with openings, walked with the room on the right; in a grid so that no edge meets a corner."""
    length = float(np.linalg.norm(end - start))
    ahead = (end - start) / length
    columns = [0.0, *[v for hole in holes for v in hole], length]
    rows = [-0.02, SILL, HEAD, HEIGHT]
    quads = []
    for k, (a, b) in enumerate(zip(columns[:-1], columns[1:], strict=True)):
        for low, high in zip(rows[:-1], rows[1:], strict=True):
            if k % 2 == 1 and low == SILL:
                continue
            (xa, za), (xb, zb) = start + ahead * a, start + ahead * b
            quads.append(
                quad(
                    (xb, low, zb), (xa, low, za), (xa, high, za), (xb, high, zb), (b - a, high - low)
                ).flipped()
            )
    return merged(quads)


def _mouldings(model: Model) -> None:
    around = [
        (WEST, SOUTH),
        (EAST, SOUTH),
        (EAST, NORTH),
        (WEST, NORTH),
        (WEST, BREAST_NORTH),
        (BREAST, BREAST_NORTH),
        (BREAST, BREAST_SOUTH),
        (WEST, BREAST_SOUTH),
    ]
    arc = np.linspace(0, np.pi / 2, 9)
    cove = [(0.022 + 0.062 * (1 - np.sin(t)), -0.106 + 0.084 * (1 - np.cos(t)) + 0.0) for t in arc[::-1]]
    section = [
        (-0.01, -0.128),
        (0.010, -0.128),
        (0.016, -0.122),
        (0.016, -0.112),
        (0.022, -0.106),
        *cove[::-1][1:],
        (0.092, -0.016),
        (0.100, -0.012),
        (0.100, 0.01),
        (-0.01, 0.01),
    ]
    model.add(PAINT, sweep(section, [(x, HEIGHT, z) for x, z in around], closed_path=True, crease_degrees=30))
    bead = [
        (0.012 + 0.006 * np.cos(t), 0.126 + 0.008 * np.sin(t)) for t in np.linspace(-np.pi / 2, np.pi / 2, 7)
    ]
    board = [
        (-0.01, -0.01),
        (0.018, -0.01),
        (0.018, 0.105),
        (0.015, 0.112),
        (0.012, 0.116),
        *bead,
        (0.008, 0.140),
        (-0.01, 0.140),
    ]
    skirting = [(WEST, 0, SOUTH), (EAST, 0, SOUTH), (EAST, 0, NORTH), (WEST, 0, NORTH)]
    model.add(PANELING, sweep(board, skirting, crease_degrees=30))
    for low, high in ((0.24, 0.86), (0.98, 2.44)):
        y = (low + high) / 2
        for width, place in (
            (1.02, facing(faces_south, 0.50, y, NORTH)),
            (1.90, facing(faces_south, 3.95, y, NORTH)),
            (1.30, facing(faces_west, EAST, y, -2.95)),
            (0.66, facing(faces_west, EAST, y, 0.60)),
            (1.50, at(0.55, y, SOUTH)),
            (1.40, at(2.95, y, SOUTH)),
        ):
            model.add(PANELING, place(panel_moulding(width, high - low, 0.034)))
