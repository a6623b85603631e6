"""Four glossy plates and four round lamps: the test picture of multiple importance sampling, after Veach.

The smaller a lamp, the brighter, so that all four send the same power; the plates run from nearly a mirror
(the upper one) to a broad gloss.  Among their reflections light sampling fails for the big lamp on the upper
plate, BSDF sampling for the small lamp on the lower one.

The set is laid out in coordinates of the camera: `across` to its right and `away` along the ground from the
point below it, with heights above the floor.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

from etendue.models.mesh import Floats, Mesh, lathe, rounded_prism, sphere, surface, sweep
from etendue.models.model import Model

EYE = np.array([-0.85342, 4.161, 2.3017])
AWAY = np.array([0.057787, 0.0, -0.998329])
ACROSS = np.array([0.998329, 0.0, 0.057787])

# Lamps: name, linear colour, strength; the radius follows from the strength.
LAMPS = (
    ("light_small", (1.0, 0.1, 0.08), 2000.0),
    ("light_mid_small", (1.0, 0.8, 0.1), 500.0),
    ("light_mid_big", (0.15, 1.0, 0.2), 100.0),
    ("light_big", (0.1, 0.3, 1.0), 50.0),
)
BIG_RADIUS = 0.24
LAMP_ROW = (8.0, 3.62)  # away, height
LAMP_SPACING = 1.75

# Plates: name, roughness, away and height of the centre.
PLATES = (
    ("microfacet_high", 0.0025, 6.8, 1.75),
    ("microfacet_mid_high", 0.01, 5.5, 1.18),
    ("microfacet_mid_low", 0.05, 4.3, 0.74),
    ("microfacet_low", 0.1, 3.2, 0.42),
)
PLATE = (5.4, 0.95, 0.05)  # width, length, thickness


def build(folder: Path) -> None:
    """Writes mis.obj and its MTL below `folder`."""
    model().write(folder / "mis.obj")


def model() -> Model:
    """The plates on their rack, the hanging lamps and the seamless backdrop."""
    scene = Model()
    scene.material("plane", kd=(0.64, 0.64, 0.64), ni=1.3, ns=6)
    scene.material("rack", kd=(0.03, 0.03, 0.032), ni=1.3, ns=20)
    scene.material("cord", kd=(0.03, 0.03, 0.032), ni=1.3, ns=2)
    scene.add("plane", _backdrop())
    for name, roughness, away, height in PLATES:
        scene.material(name, kd=(0.3, 0.3, 0.3), ni=2.42, ns=2 / roughness**2 - 2)
        scene.add(name, _plate(away, height))
    for side in (-1, 1):
        scene.add("rack", _rail(side * 0.36 * PLATE[0]))
    for i, (name, colour, strength) in enumerate(LAMPS):
        scene.material(name, kd=colour, ke=tuple(strength * c for c in colour))
        radius = lamp_radius(strength)
        at = place((i - 1.5) * LAMP_SPACING, *LAMP_ROW)
        segments = 64 if radius > 0.1 else 32
        scene.add(name, sphere(radius, segments, segments // 2).moved(*at))
        scene.add("cord", _cord(radius).moved(*at))
    return scene


def lamp_radius(strength: float) -> float:
    """The radius at which lamps of all strengths send the same power."""
    return BIG_RADIUS * float(np.sqrt(LAMPS[-1][2] / strength))


def place(across: float, away: float, height: float) -> Floats:
    """A point of the set in the scene's coordinates."""
    return np.asarray(EYE * [1, 0, 1] + across * ACROSS + away * AWAY + [0.0, height, 0.0])


def _plate(away: float, height: float) -> Mesh:
    """A plate about its centre that mirrors the row of lamps to the camera."""
    width, length, thickness = PLATE
    w, d = width / 2, length / 2
    slab = rounded_prism([(-w, -d), (w, -d), (w, d), (-w, d)], thickness, 0.012).moved(y=-thickness / 2)
    to_eye = np.array([-away, EYE[1] - height])
    to_lamps = np.array([LAMP_ROW[0] - away, LAMP_ROW[1] - height])
    normal = to_eye / np.linalg.norm(to_eye) + to_lamps / np.linalg.norm(to_lamps)
    n = normal[0] * AWAY + normal[1] * np.array([0.0, 1.0, 0.0])
    n /= np.linalg.norm(n)
    turned = slab.transformed(np.stack([ACROSS, n, np.cross(ACROSS, n)], 1))
    return turned.moved(*place(0, away, height))


def _rail(across: float) -> Mesh:
    """One of the two bent flat bars under the plates, from its front foot to its rear foot."""
    centres = np.array([(away, height - 0.06) for _, _, away, height in PLATES])[::-1]
    knots = np.concatenate([[(2.2, -0.05), (2.6, 0.2)], centres, [(7.25, 1.66), (7.5, 1.1), (7.65, -0.05)]])
    fine = _smooth_curve(knots, 12)
    path = np.array([place(across, a, h) for a, h in fine])
    w, t = 0.03, 0.02
    section = [(-w, -t), (w, -t), (w, t), (-w, t)]
    return sweep(section, path, up=np.cross(ACROSS, AWAY))


def _cord(radius: float) -> Mesh:
    """The cap and the cord above a lamp at the origin; the cord leaves the picture."""
    cap = max(0.35 * radius, 0.022)
    foot = radius * 0.97
    thin = 0.006
    shoulder = [(0.4 * cap + thin, foot + 1.6 * cap), (thin, foot + 1.7 * cap)]
    return lathe([(0, foot), (cap, foot), (cap, foot + 0.6 * cap), *shoulder, (thin, 4.0), (0, 4.0)], 24)


def _backdrop() -> Mesh:
    """A floor that bends up into a wall, wide and high enough to fill the picture."""
    near, bend, far, top, half = -9.0, 8.6, 11.6, 13.0, 16.0
    radius = far - bend
    angle = np.linspace(0, np.pi / 2, 33)
    curve = np.stack([bend + radius * np.sin(angle), radius * (1 - np.cos(angle))], 1)
    profile = np.concatenate([[(near, 0)], curve, [(far, top)]])

    def f(u: Floats, v: Floats) -> Floats:
        at = np.round(v * (len(profile) - 1)).astype(int)
        across = (2 * u - 1)[:, None] * half * ACROSS
        upright = profile[at, :1] * AWAY + profile[at, 1:] * [0.0, 1.0, 0.0]
        return np.asarray(EYE * [1, 0, 1] + across + upright)

    return surface(f, 1, len(profile) - 1)


def _smooth_curve(knots: Floats, steps: int) -> Floats:
    """A uniform Catmull-Rom curve through (n, 2) knots, `steps` points per span."""
    p = np.concatenate([2 * knots[:1] - knots[1:2], knots, 2 * knots[-1:] - knots[-2:-1]])
    t = np.linspace(0, 1, steps, endpoint=False)[:, None]
    spans = [
        0.5 * (2 * b + (c - a) * t + (2 * a - 5 * b + 4 * c - d) * t**2 + (3 * b - a - 3 * c + d) * t**3)
        for a, b, c, d in zip(p, p[1:], p[2:], p[3:], strict=False)
    ]
    return np.concatenate([*spans, knots[-1:]])
