"""Columns, piers, shafts and their bases and capitals."""

from __future__ import annotations

import numpy as np

from etendue.models._sibenik_plan import CLERESTORY, SPRING
from etendue.models._sibenik_shapes import block, cluster, grid
from etendue.models.mesh import Floats, Mesh, merged

Profile = list[tuple[float, float]]


def torus(offset: float, low: float, high: float, bulge: float, n: int = 4) -> Profile:
    """A half-round moulding of a profile."""
    angle = np.linspace(-np.pi / 2, np.pi / 2, n + 1)
    middle, half = (low + high) / 2, (high - low) / 2
    return [(float(offset + bulge * np.cos(a)), float(middle + half * np.sin(a))) for a in angle]


def hollow(start: tuple[float, float], end: tuple[float, float], n: int = 4) -> Profile:
    """A quarter hollow that leaves `start` upright and arrives at `end` lying."""
    t = np.linspace(0, np.pi / 2, n + 1)
    return [
        (
            float(start[0] + (end[0] - start[0]) * (1 - np.cos(a))),
            float(start[1] + (end[1] - start[1]) * np.sin(a)),
        )
        for a in t
    ]


def attic_base(low: float, size: float = 1.0) -> Profile:
    """Torus, hollow and torus, 0.27 m high at size 1, ending at the shaft."""
    s = size
    return [
        *torus(0.07 * s, low, low + 0.1 * s, 0.05 * s),
        (0.07 * s, low + 0.112 * s),
        *hollow((0.06 * s, low + 0.112 * s), (0.035 * s, low + 0.165 * s))[1:],
        *torus(0.02 * s, low + 0.175 * s, low + 0.235 * s, 0.03 * s),
        (0.015 * s, low + 0.25 * s),
        (0.0, low + 0.27 * s),
    ]


def bell(low: float, high: float, flare: float, ring: float = 0.022) -> Profile:
    """A necking ring and the flaring bell of a capital."""
    top = hollow((0.0, low + 0.06), (flare, high - 0.05))
    return [(0.0, low), *torus(0.0, low, low + 0.045, ring), (0.0, low + 0.06), *top[1:], (flare, high)]


def crocket(width: float, height: float, reach: float, thickness: float = 0.018) -> Mesh:
    """A leaf that climbs from the origin and curls over outwards (+z)."""
    t = np.linspace(0, 1, 10)
    curl = np.clip((t - 0.55) / 0.45, 0, 1)
    y = height * (np.sin(np.minimum(t, 0.82) / 0.82 * np.pi / 2) * 0.45 + np.minimum(t, 0.82) / 0.82 * 0.55)
    y = y - height * 0.2 * np.clip((t - 0.78) / 0.22, 0, 1) ** 1.6
    z = -0.05 + 0.07 * np.minimum(t / 0.2, 1) + reach * (0.25 * t + 0.75 * np.sin(curl * np.pi / 2) ** 1.6)
    half = width / 2 * np.array([0.62, 0.84, 1.0, 1.08, 1.08, 1.0, 0.9, 0.8, 0.66, 0.35])
    angle = np.linspace(0, 2 * np.pi, 11)
    tangent = np.stack([np.gradient(y), np.gradient(z)], 1)
    tangent /= np.linalg.norm(tangent, axis=1, keepdims=True)
    rows = []
    for k in range(len(t)):
        across = half[k] * np.cos(angle)
        # A midrib stands out and the leaf's edges turn back.
        out = (
            thickness
            * np.sin(angle)
            * (1 + 0.9 * np.exp(-((across / (0.25 * half[k])) ** 2)) * (np.sin(angle) > 0))
        )
        out -= 0.35 * half[k] * np.cos(angle) ** 2
        rows.append(np.stack([across, y[k] - out * tangent[k, 1], z[k] + out * tangent[k, 0]], 1))
    return grid(np.stack(rows), crease=70)


def leaves(
    radius: float, low: float, height: float, reach: float, count: int, turn: float = 0.0, width: float = 0.16
) -> Mesh:
    """A ring of leaves about the y axis."""
    leaf = crocket(width, height, reach).moved(0, low, radius)
    return merged(leaf.turned("y", turn + 360 * k / count) for k in range(count))


def lobes(count: int, core: float, ring: float, radius: float, turn: float = 0.0) -> Floats:
    """Circles of a clustered shaft: a core, and `count` shafts with their centres on a ring."""
    angle = np.radians(turn) + 2 * np.pi * np.arange(count) / count
    return np.array([(0, 0, core), *[(ring * np.cos(a), ring * np.sin(a), radius) for a in angle]])


def nave_column() -> dict[str, Mesh]:
    """An arcade column at the origin: eight shafts about a core, from the floor to the springing."""
    profile = [*attic_base(0.24, 1.15), *bell(2.95, 3.46, 0.13)]
    shaft = cluster(lobes(8, 0.29, 0.3, 0.098), profile, per_lobe=7)
    plinth = [
        block(-0.57, 0.57, 0.0, 0.11, -0.57, 0.57, 0.015),
        block(-0.54, 0.54, 0.11, 0.245, -0.54, 0.54, 0.03),
    ]
    abacus = [
        block(-0.54, 0.54, 3.445, 3.53, -0.54, 0.54, 0.02),
        block(-0.58, 0.58, 3.53, SPRING, -0.58, 0.58, 0.035),
    ]
    # Brackets for the ribs of the aisle, which stand out beyond the abacus.
    abacus += [block(-0.31, 0.31, 3.5, SPRING - 0.004, s * 0.6 - 0.15, s * 0.6 + 0.15, 0.03) for s in (-1, 1)]
    foliage = [leaves(0.4, 3.03, 0.26, 0.09, 16, 11.25, 0.13), leaves(0.39, 3.08, 0.36, 0.2, 8, 22.5, 0.2)]
    return {"stup": merged([shaft]), "kamen_zid_parapet": merged([*plinth, *abacus, *foliage])}


def crossing_pier() -> dict[str, Mesh]:
    """A pier of the crossing at the origin, with half-shafts for its arches, up to their springing."""
    circles = np.concatenate([lobes(4, 0.6, 0.5, 0.27), lobes(4, 0.1, 0.62, 0.14, 45)[1:]])
    profile = [
        *attic_base(0.34, 1.5),
        *[(o, y) for o, y in torus(0, SPRING - 0.13, SPRING - 0.03, 0.05)],
        *bell(CLERESTORY - 0.72, CLERESTORY - 0.2, 0.1, 0.03),
    ]
    shaft = cluster(circles, profile, per_lobe=7)
    top = CLERESTORY
    plinth = [
        block(-0.98, 0.98, 0, 0.15, -0.98, 0.98, 0.02),
        block(-0.93, 0.93, 0.15, 0.345, -0.93, 0.93, 0.035),
    ]
    abacus = [
        block(-0.86, 0.86, top - 0.21, top - 0.11, -0.86, 0.86, 0.03),
        block(-0.92, 0.92, top - 0.11, top + 0.02, -0.92, 0.92, 0.04),
    ]
    foliage = [
        leaves(0.7, top - 0.6, 0.38, 0.2, 12, 15, 0.26),
        leaves(0.7, top - 0.64, 0.26, 0.1, 24, 7.5, 0.2),
    ]
    return {"stup": shaft, "kamen_zid_parapet": merged([*plinth, *abacus, *foliage])}


def respond(height: float = SPRING) -> dict[str, Mesh]:
    """Three shafts against a wall behind them (-z), from the floor to a springing."""
    circles = [(0, 0.03, 0.13), (0.19, -0.06, 0.1), (-0.19, -0.06, 0.1)]
    shaft = cluster(circles, [*attic_base(0.2, 0.8), *bell(height - 0.56, height - 0.16, 0.07)], per_lobe=7)
    plinth = block(-0.4, 0.4, 0, 0.205, -0.25, 0.27, 0.02)
    abacus = block(-0.4, 0.4, height - 0.165, height, -0.25, 0.27, 0.03)
    foliage = [leaves(0.14, height - 0.5, 0.3, 0.1, 6, 0, 0.11).moved(0, 0, 0.03)]
    return {"stup": shaft, "kamen_zid_parapet": merged([plinth, abacus, *foliage])}


def vault_shaft(low: float = 4.55, high: float = CLERESTORY) -> dict[str, Mesh]:
    """Three thin shafts on a corbel against a wall (-z), up to the springing of a high vault."""
    circles = [(0, 0.02, 0.1), (0.15, -0.04, 0.075), (-0.15, -0.04, 0.075)]
    corbel: Profile = [
        (-0.07, low),
        (-0.02, low + 0.05),
        (0.0, low + 0.14),
        (0.045, low + 0.3),
        (0.06, low + 0.36),
        (0.06, low + 0.42),
    ]
    profile = [*corbel, *attic_base(low + 0.42, 0.5), *bell(high - 0.46, high - 0.12, 0.06)]
    shaft = cluster(circles, profile, per_lobe=8)
    abacus = block(-0.34, 0.34, high - 0.125, high + 0.01, -0.2, 0.22, 0.03)
    foliage = leaves(0.11, high - 0.42, 0.27, 0.09, 6, 0, 0.1)
    return {"stup": shaft, "kamen_zid_parapet": merged([abacus, foliage])}


def colonnette(low: float, high: float, radius: float = 0.055) -> Mesh:
    """A slender column of the triforium with base and capital."""
    base = [(o * 0.55, y) for o, y in attic_base(0.0, 1.0)]
    profile = [*[(o, low + y * 0.6) for o, y in base], *bell(high - 0.2, high, 0.045, 0.015)]
    return cluster([(0, 0, radius)], profile, per_lobe=5)
