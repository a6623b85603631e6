"""What stands and hangs in the church: chandeliers, pews, the altar with its cross and candles."""

from __future__ import annotations

import numpy as np

from etendue.models._sibenik_columns import hollow, torus
from etendue.models._sibenik_floor import STEPS
from etendue.models._sibenik_plan import CLERESTORY, NAVE_BAYS
from etendue.models._sibenik_shapes import block, welded
from etendue.models._sibenik_vaults import BOMBE
from etendue.models.mesh import Mesh, cylinder, extruded, lathe, merged, sphere, sweep
from etendue.models.model import Model

BRASS, WAX, WICK, WOOD = "luster_metal", "vosak", "fitilj", "drvo"
ALTAR_X = 12.3


def add_furniture(model: Model) -> None:
    """Everything movable."""
    high = CLERESTORY + 3.4 + BOMBE - 0.25
    hanging = chandelier(high)
    for x in NAVE_BAYS[1:]:
        for name, mesh in hanging.items():
            model.add(name, mesh.moved(x))
    pew = _pew()
    for x in np.arange(NAVE_BAYS[0], -7.9, 1.05):
        for z in (-1.98, 1.98):
            model.add(WOOD, pew.moved(float(x), 0, z))
    _add_altar(model)


def candle(height: float, radius: float) -> dict[str, Mesh]:
    """A candle on y = 0 that has burnt before: nobody lights it by day."""
    wax = [
        (radius * 0.96, 0.0),
        (radius, 0.006),
        (radius, height - 0.006),
        (radius * 0.8, height),
        (radius * 0.3, height - 0.006),
        (0, height - 0.008),
    ]
    return {WAX: lathe(wax, 12, 50), WICK: cylinder(0.0012, 0.02, 5).moved(y=height - 0.01)}


def chandelier(
    hung_from: float, height: float = 4.55, radius: float = 0.78, lights: int = 12
) -> dict[str, Mesh]:
    """A ring of candles on chains that meet in a rod up to the vault."""
    angle = 2 * np.pi * np.arange(72) / 72
    ring_path = np.stack([radius * np.cos(angle), np.full(72, height), radius * np.sin(angle)], 1)
    rim = [(-0.011, -0.05), (0.011, -0.05), (0.016, -0.04), (0.009, -0.03), (0.009, 0.03),
           (0.016, 0.04), (0.011, 0.05), (-0.011, 0.05), (-0.016, 0.04), (-0.009, 0.03),
           (-0.009, -0.03), (-0.016, -0.04)]  # fmt: skip
    brass = [sweep(rim, ring_path, closed_path=True)]
    small = ring_path * [0.32, 1, 0.32] + [0, 1.05, 0]
    brass.append(sweep(np.array(rim) * 0.6, small, closed_path=True))
    knop = [
        (0, 0),
        (0.02, 0.01),
        (0.05, 0.06),
        (0.055, 0.09),
        (0.03, 0.13),
        (0.018, 0.16),
        (0.03, 0.19),
        (0.035, 0.21),
        (0.015, 0.24),
        (0.008, 0.27),
    ]
    brass.append(lathe(knop, 20, 45).moved(y=height + 1.45))
    brass.append(cylinder(0.007, hung_from - height - 1.7, 8).moved(y=height + 1.7))
    brass.append(
        lathe(
            [
                (0, -0.24),
                (0.03, -0.22),
                (0.06, -0.17),
                (0.05, -0.11),
                (0.02, -0.06),
                (0.012, 0.02),
                (0.012, 0.3),
            ],
            16,
            45,
        ).moved(y=height - 0.06)
    )
    top = np.array([0, height + 1.47, 0])
    parts: dict[str, list[Mesh]] = {BRASS: brass, WAX: [], WICK: []}
    for k in range(6):
        a = 2 * np.pi * k / 6
        outward = np.array([np.cos(a), 0, np.sin(a)])
        brass += _chain(
            radius * outward + [0, height + 0.05, 0], 0.32 * radius * outward + [0, height + 1.03, 0]
        )
        brass += _chain(0.32 * radius * outward + [0, height + 1.07, 0], top)
        spoke = np.stack([radius * outward, 0.02 * outward]) + [0, height - 0.02, 0]
        brass.append(sweep([(-0.006, -0.012), (0.006, -0.012), (0.006, 0.012), (-0.006, 0.012)], spoke))
    pan = [
        (0, -0.05),
        (0.012, -0.045),
        (0.014, -0.02),
        (0.05, -0.008),
        (0.062, 0.008),
        (0.058, 0.009),
        (0.045, 0.0),
        (0.02, -0.004),
        (0.019, 0.03),
        (0.0, 0.03),
    ]
    holder = lathe(pan, 16, 45)
    for k in range(lights):
        a = 2 * np.pi * (k + 0.5) / lights
        x, z = radius * np.cos(a), radius * np.sin(a)
        brass.append(holder.moved(x, height + 0.1, z))
        for name, mesh in candle(0.15 + 0.02 * ((7 * k) % 5) / 4, 0.0145).items():
            parts[name].append(mesh.moved(x, height + 0.11, z))
    return {name: welded(merged(meshes)) for name, meshes in parts.items()}


def _chain(start: np.ndarray, end: np.ndarray, link: float = 0.075) -> list[Mesh]:
    """Links between two points, every other one turned."""
    span = end - start
    length = float(np.linalg.norm(span))
    t = span / length
    side = np.cross(t, [0.3, 1, 0.2])
    side /= np.linalg.norm(side)
    other = np.cross(t, side)
    count = max(2, round(length / (link * 0.78)))
    a = 2 * np.pi * np.arange(8) / 8
    wire = [(0.004 * np.cos(b), 0.004 * np.sin(b)) for b in 2 * np.pi * np.arange(3) / 3]
    # In the frame (along, across): an oval; built once lying in xy, then laid along the chain.
    oval = np.stack([link / 2 * np.cos(a), link * 0.28 * np.sin(a), 0 * a], 1)
    ring = sweep(wire, oval, closed_path=True, up=(0, 0, 1), crease_degrees=100)
    links = []
    for k in range(count):
        across, away = (side, other) if k % 2 else (other, -side)
        turned = ring.transformed(np.stack([t, across, away], 1))
        links.append(turned.moved(*(start + span * (k + 0.5) / count)))
    return links


def _pew() -> Mesh:
    """A bench 1.7 m wide along z whose sitter looks to +x."""
    width = 1.7
    end = [(-0.30, 0.0), (0.30, 0.0), (0.30, 0.07), (0.24, 0.10), (0.23, 0.36), (0.27, 0.42),
           (0.25, 0.5), (0.05, 0.56), (-0.06, 0.66), (-0.12, 0.86), (-0.19, 0.96), (-0.27, 0.97),
           (-0.31, 0.91), (-0.26, 0.5), (-0.24, 0.1), (-0.30, 0.07)]  # fmt: skip
    side = extruded(np.array(end), 0.05)
    seat = block(-0.19, 0.25, 0.42, 0.455, -width / 2 + 0.02, width / 2 - 0.02, 0.01)
    back = (
        block(-0.025, 0.0, 0.46, 0.92, -width / 2 + 0.02, width / 2 - 0.02, 0.006)
        .turned("z", 8)
        .moved(-0.15, 0.0)
    )
    rail = block(-0.06, 0.02, 0.9, 0.96, -width / 2 + 0.02, width / 2 - 0.02, 0.015).moved(-0.25)
    kneeler = block(-0.5, -0.32, 0.16, 0.2, -width / 2 + 0.02, width / 2 - 0.02, 0.012)
    shelf = block(-0.42, -0.27, 0.72, 0.74, -width / 2 + 0.02, width / 2 - 0.02, 0.005)
    return merged(
        [side.moved(z=-width / 2 - 0.02), side.moved(z=width / 2 - 0.03), seat, back, rail, kneeler, shelf]
    )


def _add_altar(model: Model) -> None:
    floor = STEPS[-1][1]
    dais = [block(ALTAR_X - 1.3, ALTAR_X + 1.2, floor - 0.02, floor + 0.14, -2.0, 2.0, 0.015)]
    dais.append(block(ALTAR_X - 0.9, ALTAR_X + 0.9, floor + 0.13, floor + 0.28, -1.6, 1.6, 0.015))
    top = floor + 0.28
    body = [
        block(ALTAR_X - 0.4, ALTAR_X + 0.4, top, top + 0.9, -1.0, 1.0, 0.02),
        block(ALTAR_X - 0.5, ALTAR_X + 0.5, top + 0.9, top + 1.02, -1.15, 1.15, 0.025),
    ]
    model.add("kamen_zid_parapet", *dais, *body)
    table = top + 1.02
    stick = [*torus(0.05, 0.0, 0.03, 0.02), (0.05, 0.035), *hollow((0.045, 0.035), (0.014, 0.11))[1:],
             (0.014, 0.2), *torus(0.012, 0.2, 0.24, 0.014), (0.012, 0.42), (0.035, 0.45), (0.035, 0.46),
             (0.0, 0.46)]  # fmt: skip
    for z in (-0.95, -0.7, -0.45, 0.45, 0.7, 0.95):
        model.add(BRASS, lathe([(0, 0), *stick], 16, 45).moved(ALTAR_X + 0.25, table, z))
        for name, mesh in candle(0.3, 0.016).items():
            model.add(name, mesh.moved(ALTAR_X + 0.25, table + 0.455, z))
    cross = [
        block(-0.02, 0.02, 0.2, 1.1, -0.028, 0.028, 0.008),
        block(-0.018, 0.018, 0.72, 0.776, -0.27, 0.27, 0.008),
    ]
    foot = lathe(
        [(0, 0), (0.12, 0), (0.12, 0.02), (0.08, 0.05), (0.04, 0.12), (0.03, 0.22), (0, 0.22)], 24, 45
    )
    model.add(
        BRASS,
        *(m.moved(ALTAR_X + 0.25, table) for m in (*cross, foot)),
        sphere(0.045, 16, 8).moved(ALTAR_X + 0.25, table + 0.21),
    )
