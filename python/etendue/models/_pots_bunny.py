"""A sitting rabbit as an implicit surface: rounded limbs that melt into each other, with a short fur.

It faces +x, stands on y = 0 and is about 1.5 high to the tips of its ears.
"""

from __future__ import annotations

import numpy as np

from etendue.models._pots_polygonise import polygonised
from etendue.models.mesh import Floats, Mesh


def bunny(head_turn: float = 18, ear_spread: float = 0.0, cell: float = 0.017, seed: int = 1) -> Mesh:
    """The rabbit, closed and smooth; its head turned to its left by `head_turn` degrees."""
    fur = _Fur(seed)

    def field(p: Floats) -> Floats:
        skull = (_turned_head(p, head_turn) - HEAD) / HEAD_SCALE + HEAD_MODELLED
        head = HEAD_SCALE * _head(skull, ear_spread)
        return _melt(_body(p), head, 0.09) + fur(p) * np.clip(p[:, 1] / 0.1, 0, 1)

    return polygonised(field, (-0.92, -0.08, -0.56), (0.86, 1.72, 0.56), cell)


# Where the head is modelled, where it goes, and how much larger.
HEAD_MODELLED, HEAD, HEAD_SCALE = np.array([0.42, 0.95, 0.0]), np.array([0.37, 0.875, 0.0]), 1.16


def _body(p: Floats) -> Floats:
    """Trunk, limbs and tail; left and right alike."""
    q = np.stack([p[:, 0], p[:, 1], np.abs(p[:, 2])], 1)
    d = _ellipsoid(p, (-0.25, 0.46, 0), (0.42, 0.43, 0.37), -6)
    d = _melt(d, _ellipsoid(p, (0.12, 0.46, 0), (0.31, 0.37, 0.28), 24), 0.18)
    d = _melt(d, _limb(p, (0.12, 0.60, 0), (0.30, 0.84, 0), 0.25, 0.19), 0.14)
    d = _melt(d, _ellipsoid(q, (-0.22, 0.31, 0.255), (0.31, 0.265, 0.15), 14), 0.045)
    d = _melt(d, _ellipsoid(q, (-0.20, 0.15, 0.265), (0.30, 0.13, 0.125), 4), 0.05)
    d = _melt(d, _limb(q, (-0.36, 0.075, 0.285), (0.10, 0.062, 0.325), 0.085, 0.064), 0.05)
    d = _melt(d, _ellipsoid(q, (0.155, 0.060, 0.332), (0.115, 0.058, 0.080), 0), 0.03)
    d = _melt(d, _limb(q, (0.20, 0.40, 0.140), (0.305, 0.10, 0.130), 0.130, 0.072), 0.07)
    d = _melt(d, _ellipsoid(q, (0.355, 0.058, 0.130), (0.110, 0.056, 0.074), 0), 0.03)
    for paw, toes in ((0.405, (0.092, 0.130, 0.168)), (0.215, (0.292, 0.332, 0.372))):
        for z in toes:
            d = _melt(d, _limb(q, (paw, 0.046, z), (paw + 0.045, 0.038, z), 0.036, 0.030), 0.012)
    return _melt(d, _ellipsoid(p, (-0.68, 0.36, 0), (0.135, 0.145, 0.14), 0), 0.04)


def _head(p: Floats, ear_spread: float) -> Floats:
    """Skull, muzzle, eyes and ears; left and right alike."""
    q = np.stack([p[:, 0], p[:, 1], np.abs(p[:, 2])], 1)
    d = _ellipsoid(p, (0.42, 0.985, 0), (0.225, 0.185, 0.170), -22)
    d = _melt(d, _ellipsoid(p, (0.565, 0.905, 0), (0.130, 0.110, 0.110), -26), 0.09)
    d = _melt(d, _ellipsoid(q, (0.455, 0.895, 0.090), (0.13, 0.120, 0.095), -20), 0.07)
    d = _melt(d, _ellipsoid(q, (0.642, 0.868, 0.040), (0.058, 0.052, 0.048), -10), 0.025)
    d = _melt(d, _ellipsoid(p, (0.620, 0.818, 0), (0.050, 0.032, 0.042), 0), 0.02)
    d = _melt(d, _ellipsoid(p, (0.690, 0.908, 0), (0.022, 0.020, 0.030), -20), 0.012)
    # Sockets first, then the eyes in them, held by an edge.
    d = -_melt(-d, _ball(q, (0.520, 1.005, 0.190), 0.052), 0.02)
    d = _melt(d, _ball(q, (0.512, 1.002, 0.138), 0.044), 0.006)
    d = _melt(d, _limb(q, (0.455, 1.056, 0.125), (0.560, 1.050, 0.108), 0.034, 0.024), 0.035)
    return _melt(d, _ear(q, ear_spread), 0.045)


def _ear(q: Floats, spread: float) -> Floats:
    """A long bowl, open to the front and the side, on a short stalk."""
    root, tip = np.array([0.335, 1.115, 0.080]), np.array([0.150, 1.600, 0.190 + spread])
    along = (tip - root) / np.linalg.norm(tip - root)
    face = np.array([0.72, 0.0, 0.69])
    face = face - along * (face @ along)
    face /= np.linalg.norm(face)
    middle = root + 0.56 * (tip - root)
    local = (q - middle) @ np.stack([along, face, np.cross(along, face)], 1)
    half = 0.31
    # Narrower to both ends, and bent back a little at the tip.
    local[:, 1] += 0.35 * np.square(np.maximum(local[:, 0], 0))
    shell = _radii(local, (half, 0.052, 0.108))
    bowl = _radii(local - [0.015, 0.060, 0.0], (half * 0.86, 0.058, 0.078))
    ear = -_melt(-shell, bowl, 0.018)
    return _melt(ear, _limb(q, tuple(root - 0.06 * along), tuple(root + 0.10 * along), 0.062, 0.044), 0.05)


def _turned_head(p: Floats, degrees: float) -> Floats:
    """Space turned about the neck's upright axis, the more the higher."""
    share = np.clip((p[:, 1] - 0.62) / 0.28, 0, 1)
    angle = np.radians(degrees) * share * share * (3 - 2 * share)
    x, z = p[:, 0] - 0.26, p[:, 2]
    c, s = np.cos(angle), np.sin(angle)
    return np.stack([0.26 + c * x - s * z, p[:, 1], s * x + c * z], 1)


class _Fur:
    """Tufts and strands: sums of plane waves in random directions, the finer the weaker."""

    def __init__(self, seed: int) -> None:
        rng = np.random.default_rng(seed)
        waves = []
        for length, height, count in ((0.20, 0.0026, 9), (0.075, 0.0013, 14)):
            direction = rng.normal(size=(count, 3)) * [0.8, 1.0, 1.0]
            direction *= 2 * np.pi / length / np.linalg.norm(direction, axis=1, keepdims=True)
            waves.append((direction, rng.uniform(0, 2 * np.pi, count), height * np.sqrt(2 / count)))
        self._waves = waves

    def __call__(self, p: Floats) -> Floats:
        total = np.zeros(len(p))
        for direction, phase, height in self._waves:
            total += height * np.sin(p @ direction.T + phase).sum(1)
        return total


def _melt(a: Floats, b: Floats, width: float) -> Floats:
    """The union of two solids with a fillet of about `width`."""
    h = np.maximum(width - np.abs(a - b), 0) / width
    return np.asarray(np.minimum(a, b) - h * h * h * width / 6)


def _ball(p: Floats, centre: tuple[float, float, float], radius: float) -> Floats:
    return np.asarray(np.linalg.norm(p - centre, axis=1) - radius)


def _ellipsoid(
    p: Floats, centre: tuple[float, float, float], radii: tuple[float, float, float], degrees: float
) -> Floats:
    """About the distance to an ellipsoid that is pitched up by `degrees` about z."""
    c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    return _radii((p - centre) @ np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]]), radii)


def _radii(p: Floats, radii: tuple[float, float, float]) -> Floats:
    k0 = np.linalg.norm(p / radii, axis=1)
    k1 = np.linalg.norm(p / np.square(radii), axis=1)
    return np.asarray(k0 * (k0 - 1) / np.maximum(k1, 1e-9))


def _limb(
    p: Floats, a: tuple[float, float, float], b: tuple[float, float, float], ra: float, rb: float
) -> Floats:
    """A rod from `a` to `b` whose radius goes from `ra` to `rb`."""
    start, axis = np.array(a), np.subtract(b, a)
    t = np.clip((p - start) @ axis / (axis @ axis), 0, 1)
    return np.asarray(np.linalg.norm(p - start - t[:, None] * axis, axis=1) - (ra + (rb - ra) * t))
