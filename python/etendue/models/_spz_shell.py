"""The atrium's shell: floors, walls with doors, the attic with its shuttered windows, and the tiled roof."""

from __future__ import annotations

import numpy as np

from etendue.models._spz_arcade import Parts
from etendue.models._spz_columns import column
from etendue.models._spz_kit import arch_panel, block, faceted, planar, sheet, shifted
from etendue.models._spz_plan import (
    ATTIC_TOP,
    BAY,
    CENTRE_X,
    CORRIDOR,
    EAST,
    FAR,
    GROUND,
    HALF_X,
    HALF_Z,
    NEAR,
    SIDES,
    STOREYS,
    THICK,
    UPPER,
    Side,
    Storey,
)  # fmt: skip
from etendue.models.mesh import Floats, Mesh, box, merged

REACH_X, REACH_Z = HALF_X + CORRIDOR, HALF_Z + CORRIDOR
WINDOW = (0.50, 10.98, 12.28)  # half width, sill, head
BIFORA = (0.82, 6.1, 8.05)  # half width, sill, spring of the windows at the ends of the upper gallery
GALLERY_WINDOWS = (-HALF_Z - CORRIDOR / 2, HALF_Z + CORRIDOR / 2)
EAVE = 1.05  # of the roof, from the line of columns towards the court
OUTER = CORRIDOR + 0.4
SLOPE = float(np.tan(np.radians(17)))


def floors() -> Parts:
    """The court's paving and, a step higher, the ground floor's corridors, all in one picture."""
    yield "floor.001", _paved(-HALF_X, HALF_X, -HALF_Z, HALF_Z, 0.0)
    edge = 0.44
    for z in (-1, 1):
        near, far = sorted((z * (HALF_Z + edge), z * REACH_Z))
        yield "floor.001", _paved(-REACH_X, REACH_X, near, far, GROUND.floor)
    for x in (-1, 1):
        near, far = sorted((x * (HALF_X + edge), x * REACH_X))
        yield "floor.001", _paved(near, far, -HALF_Z - edge, HALF_Z + edge, GROUND.floor)


def _paved(x0: float, x1: float, z0: float, z1: float, y: float) -> Mesh:
    corners = np.array([(x0, y, z1), (x1, y, z1), (x1, y, z0), (x0, y, z0)])
    uvs = np.stack([(corners[:, 0] + REACH_X) / (2 * REACH_X), (REACH_Z - corners[:, 2]) / (2 * REACH_Z)], 1)
    return Mesh(
        corners + [CENTRE_X, 0, 0], np.array([[0, 1, 2], [0, 2, 3]]), np.tile([0.0, 1.0, 0.0], (4, 1)), uvs
    )


def walls(rng: np.random.Generator) -> Parts:
    """The corridors' back walls with a stone foot and doors, and the plain outside of the house."""
    doors = {storey: list(_door(storey)) for storey in STOREYS}
    for side in SIDES:
        reach = side.bays * BAY / 2 + CORRIDOR
        for storey in STOREYS:
            top, shift = storey.spring + storey.vault_rise + 0.3, tuple(rng.random(2))
            for wall in _wall(side, storey, reach, storey.floor - 0.1, top, shift):
                yield "plaster.001", side.place(wall.moved(z=-CORRIDOR))
            foot = block(2 * reach, 0.32, 0.07, 0.012).moved(y=storey.floor - 0.02)
            yield "stone.001", side.place(foot.moved(z=-CORRIDOR + 0.02))
            for k, x in enumerate(side.centres()):
                if (k + side.bays) % 2 == (storey is UPPER):
                    for name, part in doors[storey]:
                        yield name, side.place(part.moved(x, z=-CORRIDOR))
        for outer in _wall(side, UPPER, reach + 0.4, -0.2, ATTIC_TOP + 1.4, (0.0, 0.0)):
            yield "bricks.001", side.place(outer.scaled(1, 1, -1).moved(z=-OUTER))
    for x in GALLERY_WINDOWS:
        for name, part in _bifora():
            yield name, EAST.place(part.moved(x, z=-(CORRIDOR + OUTER) / 2))


def _wall(
    side: Side, storey: Storey, reach: float, low: float, high: float, shift: tuple[float, float]
) -> list[Mesh]:
    """A wall in the plane z = 0, with holes where the galleries end in windows."""
    if side is not EAST or storey is not UPPER:
        return [sheet(np.linspace(-reach, reach, 9), [low, high], 4.0, shift)]
    half, sill, _ = BIFORA
    a, b = (np.array([-half, half]) + x for x in sorted(GALLERY_WINDOWS))
    across = [sheet(xs, [low, high], 4.0, shift) for xs in ([-reach, a[0]], [a[1], b[0]], [b[1], reach])]
    holes = [(y0, y1) for y0, y1 in ((low, sill), (UPPER.spring + UPPER.vault_rise + 0.3, high)) if y1 > y0]
    return across + [sheet(xs, ys, 4.0, shift) for xs in (a, b) for ys in holes]


def _bifora() -> Parts:
    """A window of two arches on a small column, about z = 0, that fills the hole that `_wall` leaves."""
    half, sill, spring = BIFORA
    thick = OUTER - CORRIDOR
    arch = arch_panel(half / 2, 0.36, 0.40, spring, UPPER.spring + UPPER.vault_rise + 0.3, thick, 4.0)
    yield "plaster.001", merged([arch.moved(s * half / 2) for s in (-1, 1)])
    jambs = [
        block(0.10, spring - sill + 0.02, thick + 0.08, 0.01).moved(s * (half - 0.03), sill - 0.01)
        for s in (-1, 1)
    ]
    frame = [*jambs, block(2 * half + 0.3, 0.10, thick + 0.26, 0.015).moved(y=sill - 0.09)]
    frame.append(block(0.15, 0.12, thick + 0.05, 0.01).moved(y=spring - 0.11))
    yield "details.001", merged(frame)
    yield "column_b.001", column(spring - 0.11 - sill, 0.055).moved(y=sill)


def _door(storey: Storey) -> Parts:
    """A panelled door of two leaves in a stone frame with a cornice, against a wall at z = 0."""
    w, h, y = 1.15, 2.15, storey.floor - 0.02
    frame = [block(0.2, h, 0.16, 0.015).moved(s * (w / 2 + 0.1), y) for s in (-1, 1)]
    frame += [
        block(w + 0.4, 0.22, 0.16, 0.015).moved(y=y + h),
        block(w + 0.36, 0.16, 0.11, 0.01).moved(y=y + h + 0.22),
        block(w + 0.66, 0.07, 0.34, 0.015).moved(y=y + h + 0.38),
        block(w + 0.52, 0.05, 0.24, 0.012).moved(y=y + h + 0.335),
    ]
    yield "details.001", merged(frame)
    leaves = [block(w / 2 - 0.006, h, 0.07, 0.008, 1.2).moved(s * w / 4, y) for s in (-1, 1)]
    for s in (-1, 1):
        for low, tall in ((0.14, 0.5), (0.74, 0.62), (1.46, 0.55)):
            leaves.append(block(w / 2 - 0.16, tall, 0.03, 0.014, 1.2).moved(s * w / 4, y + low, 0.036))
    yield "wood.001", merged(leaves)


def attic(rng: np.random.Generator) -> Parts:
    """The brick attic above the upper arches, a window to every bay; the bay of the shield has none."""
    low, high = UPPER.top - 0.06, ATTIC_TOP
    half, sill, head = WINDOW
    windows = {opened: list(_window(opened)) for opened in (False, True)}
    for side in SIDES:
        for k, x in enumerate(side.centres()):
            shift = (float(rng.integers(16)) / 16, float(rng.integers(8)) / 8)
            if side is EAST and k == 1:
                yield (
                    "bricks.001",
                    side.place(sheet([-BAY / 2, BAY / 2], [low, high], 4.0, shift).moved(x, z=THICK / 2)),
                )
                continue
            strips = [
                sheet([-BAY / 2, -half], [low, high], 4.0, shift),
                sheet([half, BAY / 2], [low, high], 4.0, shift),
                sheet([-half, half], [low, sill], 4.0, shift),
                sheet([-half, half], [head, high], 4.0, shift),
            ]
            yield "bricks.001", side.place(merged(strips).moved(x, z=THICK / 2))
            for name, part in windows[bool(rng.random() < 0.35)]:
                yield name, side.place(part.moved(x, z=THICK / 2))


def _window(open_shutters: bool) -> Parts:
    half, sill, head = WINDOW
    h = head - sill
    bars = [block(0.16, h + 0.04, 0.34, 0.012).moved(s * (half + 0.05), sill - 0.02, -0.10) for s in (-1, 1)]
    bars += [
        block(2 * half + 0.30, 0.17, 0.34, 0.012).moved(y=head - 0.01, z=-0.10),
        block(2 * half + 0.44, 0.06, 0.46, 0.012).moved(y=head + 0.16, z=-0.09),
        block(2 * half + 0.46, 0.10, 0.46, 0.016).moved(y=sill - 0.09, z=-0.08),
    ]
    yield "details.001", merged(bars)
    leaf = _shutter(half - 0.04, h - 0.04)
    if open_shutters:
        for s in (-1, 1):
            swung = (
                leaf.moved(s * (half - 0.04) / 2)
                .turned("y", s * 164)
                .moved(s * (half - 0.01), sill + 0.02, 0.10)
            )
            yield "shutter.001", swung
        pane = sheet([-half, half], [sill, head], 1.0).moved(z=-0.24)
        yield "window_pane.001", pane
        cross = [block(0.05, h, 0.04, 0.006).moved(0, sill, -0.225)]
        cross += [block(2 * half, 0.035, 0.035, 0.005).moved(0, sill + t * h, -0.226) for t in (0.34, 0.67)]
        yield "wood.001", merged(cross)
    else:
        for s in (-1, 1):
            yield "shutter.001", leaf.moved(s * (half - 0.028) / 2, sill + 0.02, -0.03)
        yield "shutter.001", sheet([-half, half], [sill, head], 1.0).moved(z=-0.12)


def _shutter(w: float, h: float) -> Mesh:
    """A louvred shutter centred on x = 0, standing on the origin."""
    parts = [block(0.06, h, 0.04, 0.005).moved(s * (w / 2 - 0.03)) for s in (-1, 1)]
    parts += [block(w - 0.1, 0.07, 0.036, 0.005).moved(y=y) for y in (0.002, h / 2 - 0.035, h - 0.072)]
    slat = planar(box(w - 0.11, 0.009, 0.046), 1.0).turned("x", 38)
    for y in np.arange(0.10, h - 0.09, 0.052):
        if abs(y - h / 2) > 0.05:
            parts.append(slat.moved(y=float(y)))
    return merged(parts)


def roof() -> Parts:
    """Rows of clay tiles sloping to the court, on boards and rafters whose ends show under the eaves."""
    rng = np.random.default_rng(71)
    eave_y, end = ATTIC_TOP + 0.04, -OUTER - 0.3
    for side in SIDES:
        half = side.bays * BAY / 2
        inner, outer = half - EAVE, half + OUTER + 0.3
        rise = (EAVE + OUTER + 0.3) * SLOPE
        boards = Mesh(
            np.array([(-inner, eave_y, EAVE), (inner, eave_y, EAVE),
                      (outer, eave_y + rise, -OUTER - 0.3), (-outer, eave_y + rise, -OUTER - 0.3)]),
            np.array([[0, 2, 1], [0, 3, 2]]),
        )  # fmt: skip
        yield "wood.001", side.place(planar(boards, 1.2))
        rafter = block(0.10, 0.13, 1.15, 0.01, 1.2).moved(y=-0.135).turned("x", 17)
        n = round(2 * inner / 0.56)
        for x in np.linspace(-inner + 0.15, inner - 0.15, n):
            yield "wood.001", side.place(rafter.moved(float(x), eave_y + 0.5 * SLOPE, EAVE - 0.55))
        columns = round(2 * outer / 0.235)
        whole = [_tiles(EAVE + 0.09, end, False), _tiles(EAVE + 0.07, end, True)]
        for k in range(2 * columns):
            x = (k / 2 + 0.5 - columns / 2) * 0.235
            start = half - abs(x) + 0.06
            row = whole[k % 2] if start > EAVE else _tiles(start, end, k % 2 == 1)
            yield "roof.001", side.place(shifted(row, rng, 64).moved(x + rng.normal(0, 0.005), eave_y))


def _tiles(start: float, end: float, hollow: bool) -> Mesh:
    """A row of overlapping half-round tiles up the slope from z = start: covers or hollow pans."""
    # Two courses by the eaves are true; nobody sees how the rest of the row overlaps.
    z = (
        np.r_[start - 0.42 * np.arange(3), end]
        if start - end > 1.3 and not hollow
        else np.array([start, end])
    )
    phi = np.linspace(0, np.pi, 7)
    rows, texture = [], []
    for k, (a, b) in enumerate(zip(z[:-1], z[1:], strict=True)):
        for at, lift, r in ((a, 0.03, 0.067), (b, 0.0, 0.055)):
            bow = r * np.sin(phi) * (-0.6 if hollow else 1)
            base = (EAVE - at) * SLOPE + lift + (0.085 if hollow else 0.075)
            rows.append(np.stack([-r * np.cos(phi), base + bow, np.full(7, at)], 1))
            texture.append(np.stack([0.37 * k + phi / 12, at / 2 + 0 * phi], 1))
    grid, uv = np.array(rows), np.array(texture).reshape(-1, 2)
    under = _grid_mesh(grid[:2] - [0, 0.014, 0], uv[:14]).flipped()
    return merged(
        [_grid_mesh(grid, uv), under, _grid_mesh(np.stack([grid[0] - [0, 0.014, 0], grid[0]]), uv[:14])]
    )


def _grid_mesh(grid: Floats, uvs: Floats) -> Mesh:
    """Faceted quads between rows of points (n, m, 3); the front is along-a-row x to-the-next."""
    n, m = grid.shape[:2]
    i = (np.arange(n - 1)[:, None] * m + np.arange(m - 1)).ravel()
    faces = np.concatenate([np.stack([i, i + 1, i + m + 1], 1), np.stack([i, i + m + 1, i + m], 1)])
    return faceted(Mesh(grid.reshape(-1, 3), faces, None, uvs))


__all__ = ["FAR", "NEAR", "attic", "floors", "roof", "walls"]
