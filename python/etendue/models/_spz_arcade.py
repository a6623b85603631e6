"""The arcades: columns and arches around the court, vaulted corridors, balustrade and cornices."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from etendue.models._spz_columns import baluster, column, pier
from etendue.models._spz_kit import arch_panel, block, moulding, planar, sheet, shifted, spun, welded
from etendue.models._spz_plan import (
    ATTIC_TOP,
    BAY,
    CENTRE_X,
    CORRIDOR,
    GROUND,
    HALF_X,
    HALF_Z,
    PIER,
    RAIL_TOP,
    SIDES,
    STOREYS,
    THICK,
    UPPER,
    Side,
    Storey,
)  # fmt: skip
from etendue.models.mesh import Floats, Mesh, box, merged, surface

Parts = Iterator[tuple[str, Mesh]]


def columns() -> Parts:
    """Columns with the blocks above them, and the piers of the corners."""
    for storey, name, radius, flutes in (
        (GROUND, "column_a.001", 0.2, 0),
        (UPPER, "column_b.001", 0.165, 20),
    ):
        shaft = column(storey.column, radius, flutes)
        impost = _impost(storey)
        for side in SIDES:
            for k, x in enumerate(side.columns()):
                yield name, side.place(shaft.turned("y", 90 * (k % 4)).moved(x, storey.foot))
                yield "stone.001", side.place(impost.moved(x, storey.foot + storey.column))
        corner = pier(PIER, storey.floor - 0.05, storey.spring + 0.02)
        rest = block(PIER, storey.top - storey.spring, PIER, 0.015).moved(y=storey.spring)
        for sx in (-1, 1):
            for sz in (-1, 1):
                yield "stone.001", corner.moved(CENTRE_X + sx * HALF_X, 0, sz * HALF_Z)
                yield "stone.001", rest.moved(CENTRE_X + sx * HALF_X, 0, sz * HALF_Z)


def _impost(storey: Storey) -> Mesh:
    """The block between a capital and the feet of its arches, a little wider at its top."""
    h = storey.spring - storey.foot - storey.column
    return merged([block(0.56, h - 0.05, 0.58, 0.01), block(0.64, 0.06, 0.66, 0.012).moved(y=h - 0.06)])


def arches(rng: np.random.Generator) -> Parts:
    """The arcades' walls with archivolts, keystones and roundels, and the arches across the corridors."""
    roundel = _roundel()
    for storey in STOREYS:
        r = storey.radius
        archivolt = _archivolt(r, storey.spring, _MOULDED)
        plain = _archivolt(r, storey.spring, _PLAIN).turned("y", 180)
        key = _keystone().moved(y=storey.spring + r)
        wall = arch_panel(BAY / 2, r, r, storey.spring, storey.top, THICK, 4.0)
        for side in SIDES:
            for x in side.centres():
                yield "plaster.001", side.place(shifted(wall, rng).moved(x))
                for face in (archivolt, plain):
                    yield "arch.001", side.place(face.moved(x))
                yield "arch.001", side.place(key.moved(x, z=THICK / 2))
            for x in side.columns():
                yield "details.001", side.place(roundel.moved(x, storey.spring + 0.93, THICK / 2))
    yield from _cross_arches()


_MOULDED = [(-0.012, -0.05), (0.25, -0.05), (0.25, 0.055), (0.235, 0.075), (0.20, 0.082), (0.185, 0.065),
            (0.175, 0.045), (0.085, 0.045), (0.075, 0.03), (0.012, 0.03), (-0.012, 0.02)]  # fmt: skip
_PLAIN = [
    (-0.012, -0.05),
    (0.25, -0.05),
    (0.25, 0.06),
    (0.235, 0.075),
    (0.19, 0.075),
    (0.18, 0.03),
    (-0.012, 0.03),
]


def _archivolt(r: float, spring: float, section: list[tuple[float, float]]) -> Mesh:
    """The band of mouldings around an arch, on the front of its wall."""
    theta = np.linspace(0, np.pi, 25)
    path = np.stack([r * np.cos(theta), spring + r * np.sin(theta), np.full(25, THICK / 2)], 1)
    return moulding(section, path, 2.0, up=(0, 0, 1))


def _keystone() -> Mesh:
    """A wedge with a scroll on its face, over the crown of an arch."""
    wedge = block(0.26, 0.36, 0.26, 0.012).bent(
        lambda p: p * np.c_[0.72 + 0.75 * p[:, 1:2], np.ones((len(p), 1)), np.ones((len(p), 1))]
    )

    def scroll(u: Floats, v: Floats) -> Floats:
        z = (
            0.13
            + 0.07 * np.sin(np.pi * v) ** 0.7 * (0.35 + 0.65 * v)
            + 0.02 * np.cos(3 * np.pi * (2 * u - 1))
        )
        return np.stack([(u - 0.5) * (0.14 + 0.11 * v), 0.03 + 0.30 * v, z], 1)

    return merged([wedge, surface(scroll, 10, 8)]).moved(y=-0.02)


def _roundel() -> Mesh:
    """A moulded ring with a rosette, for the spandrels."""
    ring = spun(
        [
            (0.30, 0),
            (0.30, 0.04),
            (0.28, 0.06),
            (0.25, 0.06),
            (0.235, 0.035),
            (0.21, 0.03),
            (0.20, 0.012),
            (0, 0.012),
        ],
        28,
    )

    def flower(u: Floats, v: Floats) -> Floats:
        phi, r = -2 * np.pi * u, 0.185 * v * (1 - 0.12 * np.abs(np.sin(4 * 2 * np.pi * u / 2)) ** 6)
        y = (
            0.012
            + 0.05 * (1 - v) ** 0.5 * v**0.3
            + 0.018 * np.abs(np.cos(4 * phi)) * np.sin(np.pi * np.clip(v, 0, 1))
        )
        y = np.where(v < 0.25, np.maximum(y, 0.075 * np.sqrt(np.clip(1 - (v / 0.25) ** 2, 0, 1))), y)
        return np.stack([r * np.cos(phi), y, r * np.sin(phi)], 1)

    petal = surface(flower, 32, 6).flipped()
    return merged([ring, petal]).turned("x", 90)


def _cross_arches() -> Parts:
    """Arches across the corridors at every column, resting on corbels at the wall."""
    depth = CORRIDOR - THICK / 2
    middle = -(THICK / 2 + depth / 2)
    for storey in STOREYS:
        cross = arch_panel(
            depth / 2 + 0.02, 1.22, storey.vault_rise - 0.2, storey.spring, storey.top - 0.02, 0.34, 4.0
        )
        shaft = _wall_shaft(storey)
        for side in SIDES:
            ends = (-side.bays * BAY / 2, side.bays * BAY / 2)
            for x in [*side.columns(), *ends]:
                yield "arch.001", side.place(cross.turned("y", 90).moved(x, z=middle))
                yield "column_c.001", side.place(shaft.moved(x, z=-CORRIDOR))


def _wall_shaft(storey: Storey) -> Mesh:
    """A flat pilaster on the wall, for an arch across the corridor to stand on."""
    h = storey.spring - storey.floor
    parts = [block(0.44, h - 0.05, 0.24, 0.012).moved(y=storey.floor - 0.03)]
    for y, rise, grow in (
        (0.0, 0.2, 0.1),
        (0.2, 0.05, 0.06),
        (h - 0.32, 0.04, 0.05),
        (h - 0.16, 0.08, 0.06),
        (h - 0.09, 0.1, 0.12),
    ):
        parts.append(block(0.44 + grow, rise, 0.24 + grow, 0.01).moved(y=storey.floor - 0.03 + y))
    return merged(parts)


def vaults() -> Parts:
    """Groin vaults over every bay of the corridors and over their corners."""
    depth = CORRIDOR - THICK / 2
    for storey in STOREYS:
        for side in SIDES:
            vault = _groin(BAY / 2, depth / 2, storey.vault_rise)
            for x in side.centres():
                yield "ceiling.001", side.place(vault.moved(x, storey.spring, -(THICK / 2 + depth / 2)))
        half = CORRIDOR / 2
        corner = _groin(half, half, storey.vault_rise)
        for sx in (-1, 1):
            for sz in (-1, 1):
                yield (
                    "ceiling.001",
                    corner.moved(CENTRE_X + sx * (HALF_X + half), storey.spring, sz * (HALF_Z + half)),
                )


def _groin(a: float, b: float, rise: float) -> Mesh:
    """Two crossing half-elliptic barrels of half-widths a (x) and b (z), seen from below."""
    parts = []
    for swap in (False, True):
        for sign in (1, -1):

            def web(u: Floats, v: Floats, swap: bool = swap, sign: int = sign) -> Floats:
                t = np.maximum(v, 1e-3)
                across = t * np.sin(np.pi / 2 * (2 * u - 1))
                y = rise * np.sqrt(np.clip(1 - across**2, 0, 1))
                along = sign * t
                x, z = (along, across) if swap else (across, along)
                return np.stack([a * x, y, b * z], 1)

            mesh = surface(web, 10, 7)
            assert mesh.normals is not None
            parts.append(mesh if mesh.normals[:, 1].mean() < 0 else mesh.flipped())
    whole = merged(parts)
    return welded(Mesh(whole.vertices, whole.faces, whole.normals, whole.vertices[:, [0, 2]] / 4.0))


def balustrade() -> Parts:
    """The upper gallery's balustrade, with pedestals under the columns."""
    low, rail = 0.14, 0.13
    height = RAIL_TOP - UPPER.floor - low - rail
    one = baluster(height)
    section = [(-0.15, 0), (0.15, 0), (0.15, 0.03), (0.165, 0.045), (0.165, 0.085), (0.15, 0.11),
               (0.13, rail), (-0.13, rail), (-0.15, 0.11), (-0.165, 0.085), (-0.165, 0.045),
               (-0.15, 0.03)]  # fmt: skip
    span = BAY / 2 - 0.24
    count = 9
    pedestal = _pedestal()
    xs = (np.arange(count) - (count - 1) / 2) * 2 * span / count
    for side in SIDES:
        half = side.bays * BAY / 2
        base = block(2 * half - PIER + 0.04, low, 0.32, 0.012).moved(y=UPPER.floor - 0.01)
        top = moulding(section, [(-half + 0.3, RAIL_TOP - rail, 0), (half - 0.3, RAIL_TOP - rail, 0)])
        yield "stone.001", side.place(base)
        yield "stone.001", side.place(top)
        for centre in side.centres():
            for x in xs:
                yield "stone.001", side.place(one.moved(centre + x, UPPER.floor + low - 0.01))
        for x in side.columns():
            yield "stone.001", side.place(pedestal.moved(x))


def _pedestal() -> Mesh:
    h = RAIL_TOP - UPPER.floor
    panel = block(0.30, h - 0.46, 0.02, 0.009).moved(y=UPPER.floor + 0.24)
    return merged(
        [
            block(0.52, 0.17, 0.52, 0.014).moved(y=UPPER.floor - 0.008),
            block(0.44, h - 0.05, 0.44, 0.012).moved(y=UPPER.floor),
            block(0.54, 0.07, 0.54, 0.014).moved(y=RAIL_TOP - 0.14),
            block(0.50, 0.075, 0.50, 0.012).moved(y=RAIL_TOP - 0.072),
            panel.moved(z=0.222),
            panel.moved(z=-0.222),
        ]
    )


def cornices() -> Parts:
    """Mouldings that run around the court: between the storeys, under the attic and under the eaves."""
    string = [(-0.06, -0.06), (0.03, -0.06), (0.03, 0.04), (0.06, 0.05), (0.06, 0.15), (0.09, 0.17),
              (0.15, 0.24), (0.17, 0.25), (0.27, 0.26), (0.27, 0.36), (0.30, 0.38), (0.31, 0.42),
              (0.27, 0.45), (-0.06, 0.47)]  # fmt: skip
    yield "stone.001", _around(string, 4.62)
    yield "stone.001", _around(string, 10.02)
    eaves = [
        (-0.06, -0.10),
        (0.03, -0.10),
        (0.03, 0.0),
        (0.07, 0.03),
        (0.12, 0.10),
        (0.14, 0.11),
        (0.14, 0.24),
        (-0.06, 0.24),
    ]
    yield "stone.001", _around(eaves, ATTIC_TOP - 0.34)
    dentil = planar(box(0.11, 0.1, 0.1), 2.0).moved(y=0.05)
    for y, reach in ((4.79, 0.10), (10.19, 0.10)):
        for side in SIDES:
            half = side.bays * BAY / 2 - PIER / 2
            n = int(2 * half / 0.2)
            for x in np.linspace(-half, half, n):
                yield "stone.001", side.place(dentil.moved(float(x), y, THICK / 2 + reach))


def _around(section: list[tuple[float, float]], y: float) -> Mesh:
    """A section swept around the court's inner faces, its right towards the court."""
    x, z = HALF_X - THICK / 2, HALF_Z - THICK / 2
    return moulding(
        section,
        [(CENTRE_X + sx * x, y, sz * z) for sx, sz in ((-1, -1), (1, -1), (1, 1), (-1, 1))],
        closed=True,
    )


def gallery_floor() -> Parts:
    """The upper corridors' floor and the edge of the ground floor's: slabs with a worn stone nosing."""
    for side in SIDES:
        half = side.bays * BAY / 2
        top = sheet([-half, half + CORRIDOR], [-CORRIDOR, THICK / 2], 2.4).turned("x", -90)
        # Turned down from the xy plane, the sheet's y runs towards -z.
        yield (
            "tiles.001",
            side.place(
                Mesh(top.vertices * [1, 1, -1], top.faces[:, ::-1], top.normals, top.uvs).moved(y=UPPER.floor)
            ),
        )
        edge = block(2 * half + 0.9, 0.17, 0.9, 0.02).moved(y=GROUND.floor - 0.168)
        yield "stone.001", side.place(edge)


__all__ = ["Parts", "Side", "arches", "balustrade", "columns", "cornices", "gallery_floor", "vaults"]
