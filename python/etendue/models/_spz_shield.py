"""The coat of arms on the end wall: a shield with a lion's mask in relief, on a scrolled cartouche."""

from __future__ import annotations

import numpy as np

from etendue.models._spz_arcade import Parts
from etendue.models._spz_kit import block, moulding
from etendue.models._spz_plan import ATTIC_TOP, EAST, THICK, UPPER
from etendue.models.mesh import Floats, Mesh, merged, sphere, surface

WIDTH, HEIGHT = 1.55, 1.95


def shield() -> Parts:
    """The arms, between the upper arch's crown and the eaves of the east front."""
    middle = (UPPER.top + ATTIC_TOP) / 2 - 0.08
    parts = [_relief(), _rim()]
    for s in (-1, 1):
        parts += [_scroll(s, 0.80, 0.70, 0.24), _scroll(s, 0.78, -0.42, 0.20)]
    shell = _shell().moved(y=HEIGHT / 2 + 0.10)
    for part in [*parts, shell]:
        yield "details.001", EAST.place(part.moved(0, middle, THICK / 2 + 0.02))
    sill = merged([block(2.3, 0.12, 0.30, 0.016), block(2.1, 0.08, 0.2, 0.012).moved(y=-0.08)])
    yield "stone.001", EAST.place(sill.moved(0, UPPER.top + 0.12, THICK / 2 + 0.05))


def _half_width(v: Floats) -> Floats:
    """Half the shield's width at height v in [0, 1]: waisted, pointed at its foot."""
    return (
        WIDTH
        / 2
        * np.clip(np.sin(np.pi / 2 * np.clip(v / 0.62, 0, 1)) ** 0.62, 0.02, 1)
        * (1 - 0.06 * np.sin(np.pi * np.clip((v - 0.5) / 0.5, 0, 1)))
    )


def _relief() -> Mesh:
    def f(u: Floats, v: Floats) -> Floats:
        x, y = (2 * u - 1) * _half_width(v), (v - 0.5) * HEIGHT
        edge = np.clip(1 - np.abs(2 * u - 1), 0, 1)
        z = (
            0.10
            + 0.14 * np.sqrt(np.clip(1 - (x / WIDTH * 1.7) ** 2, 0, 1)) * np.clip(edge / 0.06, 0, 1) ** 0.5
        )
        return np.stack([x, y, z + _lion(x / 0.62, (y - 0.13) / 0.62)], 1)

    return surface(f, 88, 104, (0.8, 1.0))


def _lion(x: Floats, y: Floats) -> Floats:
    """The height of a lion's face within the unit disc, metres."""

    def bump(cx: float, cy: float, rx: float, ry: float, height: float, power: float = 2) -> Floats:
        d = np.abs((np.abs(x) - cx) / rx) ** power + np.abs((y - cy) / ry) ** power
        return height * np.exp(-d)

    r, phi = np.hypot(x, y), np.arctan2(x, y)
    locks = 0.5 + 0.5 * np.cos(15 * phi + 5 * np.sin(3 * r * 2) + 1.5 * np.sin(3 * phi))
    mane = np.clip((r - 0.42) / 0.2, 0, 1) * np.clip((1.0 + 0.10 * np.cos(15 * phi) - r) / 0.22, 0, 1)
    z = 0.075 * mane * (0.45 + 0.55 * locks) + 0.05 * np.exp(-((r / 0.85) ** 6))
    z = z + bump(0, 0.02, 0.46, 0.60, 0.10, 3)
    z = z + bump(0, 0.10, 0.13, 0.34, 0.07) + bump(0, -0.06, 0.20, 0.09, 0.055)  # nose and its tip
    z = z + bump(0.15, -0.24, 0.16, 0.13, 0.085) + bump(0, -0.52, 0.17, 0.09, 0.06)  # muzzle and chin
    z = z + bump(0.20, 0.30, 0.17, 0.075, 0.06) + bump(0.32, -0.02, 0.13, 0.16, 0.03)  # brows and cheeks
    z = (
        z - bump(0.21, 0.17, 0.105, 0.075, 0.075) + bump(0.21, 0.165, 0.055, 0.045, 0.05)
    )  # eyes in their hollows
    z = z - bump(0, -0.385, 0.21, 0.042, 0.10, 3) - bump(0.07, -0.09, 0.03, 0.03, 0.04)  # mouth and nostrils
    z = (
        z
        - bump(0, -0.24, 0.016, 0.11, 0.03)
        + bump(0.43, 0.52, 0.12, 0.14, 0.075)
        - bump(0.43, 0.50, 0.06, 0.07, 0.05)
    )  # ears
    return z


def _rim() -> Mesh:
    v = np.concatenate([np.linspace(0, 0.12, 14), np.linspace(0.15, 1, 22)])
    right = np.stack([_half_width(v), (v - 0.5) * HEIGHT], 1)
    outline = np.concatenate([right, right[::-1] * [-1, 1]])
    path = np.c_[outline, np.full(len(outline), 0.06)]
    section = [(-0.05, -0.08), (0.05, -0.08), (0.06, 0.03), (0.03, 0.075), (-0.02, 0.075), (-0.05, 0.03)]
    return moulding(section, path, 1.0, closed=True, up=(0, 0, 1), crease_degrees=50)


def _scroll(side: int, x: float, y: float, size: float) -> Mesh:
    t = np.linspace(0, 1, 40)
    turn, r = 3.4 * np.pi * t, size * (1 - 0.8 * t)
    path = np.stack([side * (x + 0.05 + r * np.cos(turn)), y + r * np.sin(turn), 0.04 + 0.10 * t], 1)
    section = np.array([(-1, -1.6), (1, -1.6), (1, 0.6), (0.5, 1), (-0.5, 1), (-1, 0.6)]) * 0.045
    return merged(
        [
            moulding(section, path, 1.0, up=(0, 0, 1), crease_degrees=50),
            sphere(0.07, 12, 8).moved(side * (x + 0.05), y, 0.14),
        ]
    )


def _shell() -> Mesh:
    """A fluted scallop that crowns the shield."""

    def f(u: Floats, v: Floats) -> Floats:
        phi = np.pi * (u - 0.5) * 1.25
        ribs = 0.5 + 0.5 * np.cos(18 * np.pi * (u - 0.5))
        r = 0.40 * v * (1 + 0.05 * ribs * v)
        z = 0.08 + 0.16 * np.sin(np.pi * v * 0.6) - 0.05 * (1 - ribs) * v
        return np.stack([r * np.sin(phi), r * np.cos(phi) - 0.12, z], 1)

    mesh = surface(f, 72, 14)
    assert mesh.normals is not None
    return mesh if mesh.normals[:, 2].mean() > 0 else mesh.flipped()
