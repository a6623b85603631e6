"""What grows: eucalyptus in the vase on the table, a fig tree in its pot, sprigs on the mantelshelf."""

from __future__ import annotations

import numpy as np

from etendue.models._fireplace_plan import AXIS, BRANCHES, BREAST, CERAMIC, LEAVES, SOIL
from etendue.models._fireplace_shapes import noise, tube, unit
from etendue.models._fireplace_table import TOP, VASE_AT
from etendue.models._fireplace_things import curve, vessel
from etendue.models.mesh import Floats, Mesh, lathe, surface
from etendue.models.model import Model

FIG_AT = (0.30, -3.02)


def add(model: Model) -> None:
    """Adds the plants."""
    _eucalyptus(model)
    _fig(model)
    _sprigs(model)


def leaf(
    length: float, width: float, widest: float, cup: float, droop: float, nu: int = 6, nv: int = 10
) -> Mesh:
    """A leaf that grows along +y from the origin and faces +z: folded along its midrib, its tip drooping."""

    def f(u: Floats, v: Floats) -> Floats:
        s = 2 * u - 1
        half = width / 2 * np.sin(np.pi * np.clip(v, 0.0, 1) ** widest) ** 0.8 + 0.0012
        along = v * length
        wave = 0.025 * width * np.sin(9 * v + 2 * s) * np.abs(s)
        z = cup * half * np.abs(s) ** 1.5 - droop * length * v**2 + wave
        return np.stack([s * half, along * (1 - 0.18 * droop * v), z], 1)

    return surface(f, nu, nv)


def scattered(mesh: Mesh, origins: Floats, along: Floats, facing: Floats, sizes: Floats) -> Mesh:
    """Copies of a leaf at `origins`, its +y sent to `along`, its front towards `facing`: arrays (k, 3).

    They are scaled by `sizes` (k,).
    """
    y = unit(along)
    x = unit(np.cross(y, facing))
    z = np.cross(x, y)
    axes = np.stack([x, y, z], 1)
    assert mesh.normals is not None
    assert mesh.uvs is not None
    vertices = np.einsum("vi,kij->kvj", mesh.vertices, axes) * sizes[:, None, None] + origins[:, None]
    normals = np.einsum("vi,kij->kvj", mesh.normals, axes)
    n, k = len(mesh.vertices), len(origins)
    faces = (mesh.faces[None] + n * np.arange(k)[:, None, None]).reshape(-1, 3)
    return Mesh(vertices.reshape(-1, 3), faces, normals.reshape(-1, 3), np.tile(mesh.uvs, (k, 1)))


def _spray(
    model: Model,
    path: Floats,
    rng: np.random.Generator,
    shape: Mesh,
    start: float,
    gap: float,
    size: float,
    thick: float,
) -> None:
    """A twig with leaves in pairs, each pair across the last, smaller towards the tip."""
    model.add(BRANCHES, tube(path, np.linspace(thick, 0.0011, len(path)), 7))
    length = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(path, axis=0), axis=1))])
    tangent = unit(np.gradient(path, axis=0))
    origins, along, facing, sizes = [], [], [], []
    s, k = start * length[-1], 0
    while s < length[-1]:
        p = np.array([np.interp(s, length, path[:, i]) for i in range(3)])
        t = unit(np.array([np.interp(s, length, tangent[:, i]) for i in range(3)]))
        side = unit(np.cross(t, [0.3, 0.2, 0.9]))
        turn = k * np.pi / 2 + rng.normal(0, 0.3)
        out = side * np.cos(turn) + np.cross(t, side) * np.sin(turn)
        for sign in (1, -1):
            a = unit(sign * out + t * rng.uniform(0.35, 0.8) + rng.normal(0, 0.14, 3))
            origins.append(p)
            along.append(a)
            facing.append(unit(t + 0.4 * np.array([0, 1, 0]) + rng.normal(0, 0.25, 3)))
            sizes.append(size * (1.05 - 0.55 * s / length[-1]) * rng.uniform(0.85, 1.15))
        s += gap * rng.uniform(0.8, 1.2) * (1.1 - 0.4 * s / length[-1])
        k += 1
    origins.append(path[-1])
    along.append(tangent[-1])
    facing.append(np.array([0.3, 0.9, 0.2]))
    sizes.append(0.5 * size)
    model.add(LEAVES, scattered(shape, np.array(origins), np.array(along), np.array(facing), np.array(sizes)))


def _eucalyptus(model: Model) -> None:
    rng = np.random.default_rng(21)
    shape = leaf(1.0, 0.74, 0.75, 0.22, 0.12, 6, 8)
    x, z = VASE_AT
    for k in range(9):
        a = 2 * np.pi * (k / 9) + rng.normal(0, 0.15)
        lean, tall = rng.uniform(0.10, 0.34), rng.uniform(0.50, 0.74)
        c, s = np.cos(a), np.sin(a)
        points = [
            (-0.030 * c, 0.017, -0.030 * s),
            (0.010 * c, 0.15, 0.010 * s),
            (0.052 * c, 0.29, 0.052 * s),
            (0.055 * c + lean * 0.45 * c, 0.30 + 0.5 * (tall - 0.3), 0.055 * s + lean * 0.45 * s),
            (0.07 * c + lean * c, tall, 0.07 * s + lean * s),
        ]
        path = curve(points, 7) + np.array([x, TOP, z])
        _spray(model, path, rng, shape, 0.44, 0.042, 0.062, 0.0030)
        for q in (0.55, 0.72):
            i = int(q * (len(path) - 1))
            b = a + rng.choice([-1, 1]) * rng.uniform(0.5, 1.1)
            twig = path[i] + curve(
                [
                    (0, 0, 0),
                    (0.05 * np.cos(b), 0.06, 0.05 * np.sin(b)),
                    (0.11 * np.cos(b), 0.12 + rng.uniform(-0.02, 0.03), 0.11 * np.sin(b)),
                ],
                5,
            )
            _spray(model, twig, rng, shape, 0.25, 0.036, 0.050, 0.0018)


def _fig(model: Model) -> None:
    rng = np.random.default_rng(23)
    x, z = FIG_AT
    pot = [
        (0.125, 0),
        (0.135, 0.006),
        (0.160, 0.12),
        (0.176, 0.28),
        (0.180, 0.33),
        (0.186, 0.335),
        (0.187, 0.36),
    ]
    model.add(CERAMIC, vessel(pot, 0.011, 72).moved(x, 0.001, z))
    soil = lathe([(0.170, 0.0), (0.13, 0.008), (0.07, 0.014), (0, 0.016)], 40, 60)
    lumpy = soil.vertices + np.stack(
        [0 * soil.vertices[:, 0], 0.006 * noise(soil.vertices * 40, 2, 2), 0 * soil.vertices[:, 0]], 1
    )
    model.add(SOIL, Mesh(lumpy, soil.faces).smooth().moved(x, 0.315, z))
    shape = leaf(1.0, 0.66, 0.62, 0.16, 0.30, 8, 14)
    stems = (
        [(0, 0.30, 0), (0.015, 0.7, 0.01), (-0.01, 1.1, 0.03), (0.02, 1.45, 0.02), (0.04, 1.72, 0.05)],
        [(0.01, 0.62, 0.01), (0.07, 0.85, 0.06), (0.13, 1.10, 0.12), (0.17, 1.36, 0.14)],
        [(-0.005, 0.85, 0.02), (0.05, 1.05, -0.08), (0.08, 1.28, -0.14), (0.09, 1.50, -0.16)],
        [(0.0, 0.74, 0.01), (-0.08, 0.95, 0.04), (-0.12, 1.16, 0.09), (-0.13, 1.33, 0.12)],
    )
    for k, points in enumerate(stems):
        path = curve(points, 10) + np.array([x, 0, z])
        thick = np.linspace(0.014 if k == 0 else 0.009, 0.004, len(path))
        model.add(BRANCHES, tube(path, thick, 12))
        first = 0.48 if k == 0 else 0.28
        spots = np.arange(first, 1.0, 0.040 if k == 0 else 0.062)
        origins, along, facing, sizes = [], [], [], []
        for j, q in enumerate(spots):
            p = path[min(int(q * len(path)), len(path) - 1)]
            a = 2.4 * j + k + rng.normal(0, 0.2)
            out = np.array([np.cos(a), 0, np.sin(a)])
            rise = -0.10 + 0.85 * q**2 + rng.normal(0, 0.12)
            direction = unit(out + np.array([0, rise, 0]))
            stalk = p + direction * 0.045 + np.array([0, 0.008, 0])
            model.add(BRANCHES, tube([p, (p + stalk) / 2 + [0, 0.006, 0], stalk], 0.0024, 6))
            origins.append(stalk)
            along.append(direction)
            facing.append(np.array([0, 1.0, 0]) + 0.25 * rng.normal(0, 1, 3) + 0.25 * out)
            sizes.append(rng.uniform(0.19, 0.27) * (1.0 - 0.35 * (q > 0.9)))
        model.add(
            LEAVES, scattered(shape, np.array(origins), np.array(along), np.array(facing), np.array(sizes))
        )


def _sprigs(model: Model) -> None:
    """Three dry sprigs in the tall vase on the mantelshelf."""
    rng = np.random.default_rng(29)
    shape = leaf(1.0, 0.30, 0.8, 0.2, 0.15, 4, 8)
    base = np.array([BREAST + 0.085, 1.165, AXIS + 0.66])
    for k in range(4):
        a = 1.3 + 1.7 * k + rng.normal(0, 0.2)
        c, s = np.cos(a), np.sin(a)
        points = [
            (-0.01 * c, 0.03, -0.01 * s),
            (0.006 * c, 0.25, 0.006 * s),
            (0.05 * c + 0.015, 0.40, 0.06 * s),
            (0.10 * c + 0.05, 0.53 + 0.03 * k, 0.15 * s),
        ]
        _spray(model, curve(points, 8) + base, rng, shape, 0.50, 0.030, 0.060, 0.0019)
