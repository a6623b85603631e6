"""Cloth that lies and hangs: the rug with its fringe, curtains on their rods, a throw over the sofa's arm."""

from __future__ import annotations

import numpy as np

from etendue.models._fireplace_plan import (
    DRAPES,
    EAST,
    EAST_WINDOWS,
    HEAD,
    NORTH,
    NORTH_WINDOW,
    RUG,
    SHEER,
    SILL,
    STEEL,
    THROW,
)
from etendue.models._fireplace_seating import SOFA_AT
from etendue.models._fireplace_shapes import faces_south, faces_west, noise, tube
from etendue.models._fireplace_things import Place, curve, facing
from etendue.models.mesh import Floats, Mesh, lathe, merged, sphere, surface
from etendue.models.model import Model

RUG_AT, RUG_SIZE = (1.95, -0.50), (2.8, 4.0)
ROD = HEAD + 0.17


def add(model: Model) -> None:
    """Adds rug, curtains and throw."""
    _rug(model)
    low, high = NORTH_WINDOW
    _curtains(model, facing(faces_south, (low + high) / 2, 0, NORTH), high - low, True, 5)
    for k, (low, high) in enumerate(EAST_WINDOWS):
        _curtains(model, facing(faces_west, EAST, 0, (low + high) / 2), high - low, False, 30 + 7 * k)
    _throw(model)


def _rug(model: Model) -> None:
    wide, long = RUG_SIZE
    (cx, cz), pile = RUG_AT, 0.013

    def f(u: Floats, v: Floats) -> Floats:
        z, x = (u - 0.5) * long, (v - 0.5) * wide
        border = np.minimum(long / 2 - np.abs(z), wide / 2 - np.abs(x))
        tuft = noise(np.stack([x * 50, z * 50, 0 * x], 1), 3, 2)
        wave = noise(np.stack([x * 1.6, z * 1.6, 0 * x], 1), 4, 2)
        y = (pile + 0.0022 * tuft + 0.0012 * wave) * np.sqrt(np.clip(border / 0.014, 0, 1))
        drift = 0.010 * noise(np.stack([x * 1.1, z * 1.1, 0 * x + 9], 1), 6)
        return np.stack([cx + x + drift, y + 0.0006, cz + z + drift], 1)

    mesh = surface(f, 264, 184)
    uvs = mesh.uvs if mesh.uvs is not None else np.zeros((len(mesh.vertices), 2))
    model.add(RUG, Mesh(mesh.vertices, mesh.faces, mesh.normals, np.stack([uvs[:, 1], uvs[:, 0]], 1)))
    rng = np.random.default_rng(9)
    threads = []
    for end in (-1, 1):
        for x in np.arange(-wide / 2 + 0.01, wide / 2, 0.018):
            drift = 0.010 * float(noise(np.array([[x * 1.1, end * long / 2 * 1.1, 9]]), 6)[0])
            foot = np.array([cx + x + drift, 0.007, cz + end * long / 2 + drift])
            for _ in range(3):
                reach, aside = rng.uniform(0.045, 0.065), rng.normal(0, 0.006)
                steps = np.array(
                    [
                        [0, 0, -0.012],
                        [aside * 0.2, 0.0015, 0.012],
                        [aside * 0.7, -0.002, 0.6 * reach],
                        [aside * 1.5, -0.0045, reach],
                    ]
                )
                steps[:, 2] *= end
                threads.append(
                    tube(
                        foot + steps + [rng.normal(0, 0.002), rng.uniform(0, 0.0015), 0],
                        [0.0024, 0.0024, 0.0019, 0.0014],
                        4,
                    )
                )
    fringe = merged(threads)
    model.add(
        RUG, Mesh(fringe.vertices, fringe.faces, fringe.normals, np.full((len(fringe.vertices), 2), 0.052))
    )


def curtain(
    width: float, height: float, folds: float, depth: float, seed: int, nu: int = 120, nv: int = 36
) -> Mesh:
    """Cloth hanging from y = `height` to just above the floor, in folds that open downwards; it faces +z."""

    def f(u: Floats, v: Floats) -> Floats:
        down = 1 - v
        wander = 0.16 * noise(np.stack([u * folds * 0.55, down * 0.5, 0 * u], 1) + seed, seed) * (0.3 + down)
        phase = 2 * np.pi * folds * (u + wander / folds * 0.9)
        deep = (
            depth
            * (0.55 + 0.35 * down)
            * (1 + 0.3 * noise(np.stack([u * folds * 0.5, down * 0.7, 0 * u + 3], 1) + seed, seed + 1))
        )
        z = deep * (np.sin(phase) + 0.22 * np.sin(2 * phase + 1.0 + seed) * down)
        z += 0.012 * noise(np.stack([u * 5, down * 2.2, 0 * u], 1) + seed, seed + 2) * down
        x = (u - 0.5) * width * (0.94 + 0.08 * down) + 0.35 * deep * np.cos(phase) * 0.5
        return np.stack([x, 0.018 + v * (height - 0.018), z], 1)

    return surface(f, nu, nv, (width * 2, height))


def _curtains(model: Model, place: Place, width: float, sheers: bool, seed: int) -> None:
    """Rod, rings and drapes of a window; modelled before a wall z = 0 with the window's middle at x = 0."""
    reach, out = width / 2 + 0.30, 0.105
    rod = tube([(-reach, ROD, out), (0, ROD, out), (reach, ROD, out)], 0.011, 14)
    model.add(STEEL, place(rod))
    for s in (-1, 1):
        model.add(STEEL, place(sphere(0.021, 20, 12).moved(s * (reach + 0.012), ROD, out)))
        arm = [(s * (reach - 0.05), ROD, -0.004), (s * (reach - 0.05), ROD, out)]
        model.add(
            STEEL,
            place(tube(arm, 0.006, 10)),
            place(
                lathe([(0, 0), (0.024, 0), (0.022, 0.006), (0, 0.007)], 24)
                .turned("x", 90)
                .moved(s * (reach - 0.05), ROD, 0.0005)
            ),
        )
        # Where the window gives the room its light, the drapes hang beside it, not before it.
        panel, folds = (0.42, 5) if sheers else (0.34, 5)
        x = s * (width / 2 + (0.115 if sheers else 0.13))
        model.add(DRAPES, place(curtain(panel, ROD - 0.03, folds, 0.034, seed + s).moved(x, 0, out)))
        for k in range(folds):
            ring = [
                (
                    x + (k + 0.5 - folds / 2) * panel / folds,
                    ROD - 0.004 + 0.019 * np.sin(a),
                    out + 0.019 * np.cos(a),
                )
                for a in np.linspace(0, 2 * np.pi, 21)[:-1]
            ]
            model.add(STEEL, place(tube(ring, 0.0022, 6, closed=True)))
    if sheers:
        # Within the reveal, before the panes alone: what has no light behind it would be black.
        w, top, back = width / 2, HEAD - 0.03, -0.055
        model.add(STEEL, place(tube([(-w - 0.004, top, back), (w + 0.004, top, back)], 0.005, 10)))
        for s in (-1, 1):
            sheet = curtain(0.37, top - SILL - 0.004, 6, 0.015, seed + 11 + s, 150, 30)
            model.add(SHEER, place(sheet.moved(s * (w - 0.20), SILL, back)))


def _throw(model: Model) -> None:
    """A knitted throw over the arm of the sofa that is nearer to the camera."""
    spine = curve(
        [
            (-1.140, 0.17),
            (-1.139, 0.36),
            (-1.132, 0.54),
            (-1.098, 0.622),
            (-1.025, 0.634),
            (-0.952, 0.62),
            (-0.918, 0.55),
            (-0.885, 0.497),
            (-0.80, 0.494),
            (-0.70, 0.500),
        ],
        10,
    )
    along = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(spine, axis=0), axis=1))])
    along /= along[-1]
    slope = np.gradient(spine, axis=0)
    normal = np.stack([-slope[:, 1], slope[:, 0]], 1)
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)

    def place(m: Mesh) -> Mesh:
        return faces_west(m).moved(*SOFA_AT)

    def f(u: Floats, v: Floats) -> Floats:
        skew = 0.035 * noise(np.stack([v * 2.0, 0 * v, 0 * v + 2], 1), 5)
        wide = 0.40 + 0.04 * (v - 0.5)
        z = 0.13 + (u - 0.5) * wide + skew
        x, y = np.interp(v, along, spine[:, 0]), np.interp(v, along, spine[:, 1])
        nx, ny = np.interp(v, along, normal[:, 0]), np.interp(v, along, normal[:, 1])
        loose = 0.35 + 0.65 * np.abs(2 * v - 1)
        folds = 0.5 + 0.5 * np.sin(2 * np.pi * (3.1 * u + 0.35 * np.sin(2.4 * v + 1)) + 1.0)
        lift = 0.004 + 0.017 * folds**1.5 * loose + 0.006 * (1 + noise(np.stack([u * 5, v * 5, 0 * u], 1), 8))
        rib = 0.0016 * np.sin(2 * np.pi * u * 40)
        return np.stack([x + (lift + rib) * nx, y + (lift + rib) * ny, z], 1)

    sheet = surface(f, 180, 80)
    model.add(THROW, place(sheet))
    rng = np.random.default_rng(15)
    for end in (0.0, 1.0):
        u = np.linspace(0.004, 0.996, 52)
        feet = f(u, np.full_like(u, end))
        for p in feet:
            fall = np.array([0.0, -0.055, 0.0]) if end == 0 else np.array([0.055, -0.004, 0.0])
            sway = rng.normal(0, 0.005, 3) * [0.3 if end == 0 else 1, 0.2, 1]
            path = np.array([p - 0.1 * fall, p + 0.3 * fall, p + 0.7 * fall + 0.5 * sway, p + fall + sway])
            model.add(THROW, place(tube(path, [0.003, 0.0032, 0.0026, 0.0022], 4)))
