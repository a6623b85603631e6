"""Rib vaults over rectangular bays."""

from __future__ import annotations

from functools import cache

import numpy as np

from etendue.models._sibenik_shapes import grid, welded
from etendue.models.mesh import Floats, Mesh, lathe, merged, sweep

LEAN = 0.12  # of the vault's arches, as a share of half their span
BOMBE = 0.12  # how far the crown stands above the wall arches

# Sections of ribs, (right, up), counter-clockwise for someone who walks along the rib.
RIB = ((-0.09, 0.08), (-0.09, -0.05), (-0.055, -0.075), (-0.07, -0.11), (-0.06, -0.145),
       (-0.025, -0.155), (0.0, -0.19), (0.025, -0.155), (0.06, -0.145), (0.07, -0.11), (0.055, -0.075),
       (0.09, -0.05), (0.09, 0.08))  # fmt: skip
TRANSVERSE = ((-0.24, 0.08), (-0.24, -0.06), (-0.20, -0.06), (-0.185, -0.10), (-0.155, -0.115),
              (-0.125, -0.10), (-0.115, -0.16), (-0.09, -0.20), (-0.055, -0.22), (0.0, -0.225),
              (0.055, -0.22), (0.09, -0.20), (0.115, -0.16), (0.125, -0.10), (0.155, -0.115),
              (0.185, -0.10), (0.20, -0.06), (0.24, -0.06), (0.24, 0.08))  # fmt: skip


def profile(s: Floats) -> Floats:
    """Height of the vault's arch, 1 at s = 0 (crown) and 0 at s = 1 (springing)."""
    e = LEAN
    return np.sqrt(np.maximum((1 + e) ** 2 - (np.abs(s) + e) ** 2, 0) / ((1 + e) ** 2 - e**2))


@cache
def webs(half_x: float, half_z: float, spring: float, rise: float, n: int = 12) -> Mesh:
    """The four cells of a bay about the y axis, facing down.  They reach 4 cm into the walls around."""
    u, w = np.linspace(-1, 1, 2 * n + 1), np.linspace(0, 1, n + 1)
    across, out = np.meshgrid(u, w)
    y = spring + rise * profile(np.abs(across) * out) + BOMBE * (1 - out**2)
    cells = []
    for turned in (False, True):
        a, b = (half_x, half_z) if not turned else (half_z, half_x)
        points = np.stack([a * across * out, y, b * out], 2)
        points[-1, :, 2] += 0.04
        for sign in (1, -1):
            cell = grid(points, crease=20).scaled(1, 1, sign)
            cells.append(cell.turned("y", 90) if turned else cell)
    return merged(cells)


def arch_path(start: Floats, end: Floats, spring: float, rise: float, bombe: float, n: int = 11) -> Floats:
    """A vault's arch over the line between two (x, z) points, with short vertical feet."""
    t = np.sin(np.linspace(-np.pi / 2, np.pi / 2, 2 * n + 1))
    plan = (start + end) / 2 + t[:, None] * (end - start) / 2
    y = spring + rise * profile(np.abs(t)) + bombe * (1 - t**2)
    path = np.stack([plan[:, 0], y, plan[:, 1]], 1)
    # The feet go on straight down, into what carries them.
    foot = np.array([0, 0.15, 0])
    return np.concatenate([path[:1] - foot, path, path[-1:] - foot])


@cache
def ribs(half_x: float, half_z: float, spring: float, rise: float) -> Mesh:
    """Diagonal and wall ribs of a bay, and the boss where the diagonals meet."""
    corner = np.array([half_x, half_z])
    parts = [sweep(RIB, arch_path(-corner * s, corner * s, spring, rise, BOMBE)) for s in ([1, 1], [1, -1])]
    for a, b in (((-1, 1), (1, 1)), ((-1, -1), (1, -1))):
        parts.append(sweep(RIB, arch_path(np.array(a) * corner, np.array(b) * corner, spring, rise, 0)))
    top = spring + rise + BOMBE
    boss = [
        (0, -0.28),
        (0.06, -0.275),
        (0.09, -0.25),
        (0.1, -0.235),
        (0.16, -0.235),
        (0.2, -0.21),
        (0.2, -0.17),
        (0.17, -0.15),
        (0.17, 0),
    ]
    parts.append(lathe(boss, 24, 35).moved(y=top))
    return welded(merged(parts))


@cache
def transverse(half_z: float, spring: float, rise: float) -> Mesh:
    """The heavier rib between two bays, across z at x = 0."""
    return welded(
        sweep(TRANSVERSE, arch_path(np.array([0, -half_z]), np.array([0, half_z]), spring, rise, 0))
    )
