"""The teapot that Martin Newell measured at the University of Utah in 1975: 32 bicubic Bezier patches.

Rim, body, lid and bottom are turned: each of their patches is a quarter turn of a profile.  Handle and spout
are mirrored halves.  Numbers are Newell's, with z up, the handle towards -x and the spout towards +x.
"""

from __future__ import annotations

import numpy as np

from etendue.models.mesh import Floats, Mesh, bezier, lathe, merged

# Share of the radius at which the two middle control points of a quarter turn stand beside their ends.
QUARTER = 0.56

# Profiles of four control points (radius, height), the outside of the pot always on the left hand.
TURNED = {
    "rim": [(1.4, 2.4), (1.3375, 2.53125), (1.4375, 2.53125), (1.5, 2.4)],
    "upper body": [(1.5, 2.4), (1.75, 1.875), (2.0, 1.35), (2.0, 0.9)],
    "lower body": [(2.0, 0.9), (2.0, 0.45), (1.5, 0.225), (1.5, 0.15)],
    "bottom": [(1.5, 0.15), (1.5, 0.075), (1.425, 0.0), (0.0, 0.0)],
    "knob": [(0.0, 3.15), (0.8, 3.15), (0.0, 2.85), (0.2, 2.7)],
    "lid": [(0.2, 2.7), (0.4, 2.55), (1.3, 2.55), (1.3, 2.4)],
}

# Rows of (x, z, half width, x, z): where the section's edges lie in the plane of symmetry, and how far the
# control points beside each are off it.  Four rows are a patch; patches share their end rows.
HANDLE = [
    (-1.6, 2.025, 0.3, -1.5, 2.25),
    (-2.3, 2.025, 0.3, -2.5, 2.25),
    (-2.7, 2.025, 0.3, -3.0, 2.25),
    (-2.7, 1.8, 0.3, -3.0, 1.8),
    (-2.7, 1.575, 0.3, -3.0, 1.35),
    (-2.5, 1.125, 0.3, -2.65, 0.9375),
    (-2.0, 0.9, 0.3, -1.9, 0.6),
]
SPOUT = [
    (1.7, 1.425, 0.66, 1.7, 0.6),
    (2.6, 1.425, 0.66, 3.1, 0.825),
    (2.3, 2.1, 0.25, 2.4, 2.025),
    (2.7, 2.4, 0.25, 3.3, 2.4),
    (2.8, 2.475, 0.25, 3.525, 2.49375),
    (2.9, 2.475, 0.15, 3.45, 2.5125),
    (2.8, 2.4, 0.15, 3.2, 2.4),
]


def patches() -> Floats:
    """All control points, (32, 4, 4, 3), every patch with its front outside of the pot.

    Newell's list has 306 points; some lie at one place, which leaves 290.
    """
    quarters = []
    for profile in TURNED.values():
        turn = np.array([_quarter(radius, height) for radius, height in profile])
        quarters += [_about_z(turn, k) for k in range(4)]
    halves = []
    for rows in (HANDLE, SPOUT):
        for first in (0, 3):
            half = np.array([_half_section(*row) for row in rows[first : first + 4]])
            halves += [half, half[:, ::-1] * [1, -1, 1]]
    return np.array(quarters + halves)


def teapot(n: int = 16) -> Mesh:
    """The teapot standing on the origin, +y up, 3.15 high, its spout towards +x; patches in n x n quads.

    The slit that Newell left between lid and rim is closed by a ledge below.
    """
    pot = merged([bezier(p, n).flat() for p in patches()]).smooth()
    upright = pot.turned("x", -90)
    ledge = lathe([(1.4, 2.4), (1.36, 2.34), (1.2, 2.33)], 4 * n, crease_degrees=180)
    return merged([upright, ledge])


def _quarter(radius: float, height: float) -> Floats:
    """The four control points of a quarter turn from +x to -y."""
    # Newell rounded the knob's widest ring to two decimals.
    beside = 0.45 if radius == 0.8 else QUARTER * radius
    plane = np.array([[radius, 0], [radius, -beside], [beside, -radius], [0, -radius]])
    return np.concatenate([plane, np.full((4, 1), height)], 1)


def _about_z(points: Floats, quarters: int) -> Floats:
    c, s = [(1, 0), (0, -1), (-1, 0), (0, 1)][quarters]
    return points @ np.array([[c, s, 0], [-s, c, 0], [0, 0, 1.0]])


def _half_section(x: float, z: float, half: float, x2: float, z2: float) -> Floats:
    return np.array([[x, 0, z], [x, -half, z], [x2, -half, z2], [x2, 0, z2]])
