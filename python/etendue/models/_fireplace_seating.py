"""The sofa and the armchairs: upholstery with crowned cushions, piping and slight wrinkles."""

from __future__ import annotations

import numpy as np

from etendue.models._fireplace_plan import ARMCHAIR, CUSHIONS, SOFA, WOOD
from etendue.models._fireplace_shapes import cell, displaced, faces_west, noise, soft_block, tube, unit
from etendue.models._fireplace_textures import CUSHION_CELLS
from etendue.models._fireplace_things import Place, curve
from etendue.models.mesh import Floats, Mesh, lathe, merged, surface
from etendue.models.model import Model

CLOTH_SCALE = 2.2
SOFA_AT = (3.52, 0.0, -0.22)


def add(model: Model) -> None:
    """Adds the sofa and two armchairs."""
    _sofa(model, lambda m: faces_west(m).moved(*SOFA_AT))
    _armchair(model, lambda m: m.turned("y", -28).moved(1.62, 0.0, -2.42), 1)
    _armchair(model, lambda m: m.turned("y", 158).moved(1.28, 0.0, 2.32), 2)


def worn(mesh: Mesh, seed: int, depth: float = 0.004, pull: float = 0.0) -> Mesh:
    """Upholstery that has been sat on: hollows, fine creases, and folds pulled across by `pull` metres."""
    p = mesh.vertices
    amount = depth * noise(p * 5.5 + seed, seed, 2)
    crease = 1 - np.abs(noise(p * [9, 14, 9] + 5 * seed, seed + 1, 2))
    amount -= 0.5 * depth * np.clip(crease - 0.75, 0, 1) / 0.25
    amount += pull * noise(p * [4, 26, 4] + seed, seed + 2)
    return displaced(mesh, amount)


def crowned(mesh: Mesh, x: float, z: float, rise: float, axis: int = 1) -> Mesh:
    """A cushion of plan x by z whose two broad faces, across `axis`, swell by `rise` in the middle."""
    p = mesh.vertices.copy()
    a, b = (k for k in range(3) if k != axis)
    swell = np.clip(1 - (2 * p[:, a] / x) ** 4, 0, 1) * np.clip(1 - (2 * p[:, b] / z) ** 4, 0, 1)
    half = np.abs(p[:, axis]).max()
    p[:, axis] += rise * swell * p[:, axis] / half
    return Mesh(p, mesh.faces, None, mesh.uvs).smooth()


def piping(x: float, z: float, y: float, corner: float, radius: float = 0.0045) -> Mesh:
    """A cord around a rounded rectangle x by z at height y."""
    angle = np.linspace(0, np.pi / 2, 7)
    points = []
    for k, (sx, sz) in enumerate(((1, 1), (-1, 1), (-1, -1), (1, -1))):
        t = angle + k * np.pi / 2
        points.append(
            np.stack(
                [
                    sx * (x / 2 - corner) + corner * np.cos(t),
                    np.full(7, y),
                    sz * (z / 2 - corner) + corner * np.sin(t),
                ],
                1,
            )
        )
    ring = np.concatenate(points)
    dense = []
    for a, b in zip(ring, np.roll(ring, -1, 0), strict=True):
        steps = max(1, int(np.linalg.norm(b - a) / 0.05))
        dense.append(a + (b - a) * np.linspace(0, 1, steps, endpoint=False)[:, None])
    return tube(np.concatenate(dense), radius, 6, closed=True)


def box_cushion(
    x: float, y: float, z: float, seed: int, rise: float = 0.02, round_edge: float = 0.035
) -> list[Mesh]:
    """A cushion with a boxed border and piping along both seams, centred at the origin."""
    body = crowned(soft_block(x, y, z, round_edge, 7, 4, CLOTH_SCALE), x, z, rise)
    body = worn(body, seed, 0.0035)
    inset = round_edge * (1 - np.sqrt(0.5))
    cords = [
        piping(x - 2 * inset + 0.004, z - 2 * inset + 0.004, s * (y / 2 - inset + 0.002), round_edge)
        for s in (-1, 1)
    ]
    return [body, *cords]


def scatter_cushion(size: float, plump: float, seed: int, cloth: int) -> list[Mesh]:
    """A square throw cushion in the xy plane facing +z, its corners drawn out, with a corded seam."""
    n = 28

    def half(sign: float) -> Mesh:
        def f(u: Floats, v: Floats) -> Floats:
            a, b = 2 * u - 1, 2 * v - 1
            fall = (1 - np.abs(a) ** 2.6) * (1 - np.abs(b) ** 2.6)
            x = size / 2 * a * (1 - 0.075 * (1 - b**2))
            y = size / 2 * b * (1 - 0.075 * (1 - a**2))
            z = plump / 2 * np.clip(fall, 0, 1) ** 0.62
            p = np.stack([x, y, np.zeros_like(x)], 1)
            radial = noise(
                np.stack([np.arctan2(b, a) * 3.2, np.hypot(a, b) * 1.2, np.full_like(a, 3.0 * sign)], 1)
                + seed,
                seed,
            )
            z = z + fall**0.5 * (0.010 * radial * np.hypot(a, b) + 0.008 * noise(p * 8 + seed, seed + 5, 2))
            # A hand's chop in the middle of the upper edge.
            z = z * (1 - 0.28 * np.exp(-((a / 0.30) ** 2)) * np.clip(b, 0, 1) ** 2)
            return np.stack([x, y, sign * np.maximum(z, 0)], 1)

        mesh = surface(f, n, n)
        return mesh if sign > 0 else Mesh(mesh.vertices, mesh.faces[:, ::-1], None, mesh.uvs)

    body = merged([half(1.0), half(-1.0)]).smooth()
    assert body.normals is not None
    # At the corners' very tips front and back cancel.
    tips = np.linalg.norm(body.normals, axis=1, keepdims=True) < 0.5
    body = Mesh(body.vertices, body.faces, np.where(tips, unit(body.vertices), body.normals), body.uvs)
    body = cell(
        (cloth, 0), CUSHION_CELLS, Mesh(body.vertices, body.faces, body.normals, body.uvs), spread=0.96
    )
    t = np.linspace(-1, 1, 25)[:-1]
    one = np.ones_like(t)
    edge = [(t, -one), (one, t), (-t, one), (-one, -t)]
    a, b = (np.concatenate([e[k] for e in edge]) for k in (0, 1))
    seam = np.stack(
        [size / 2 * a * (1 - 0.075 * (1 - b**2)), size / 2 * b * (1 - 0.075 * (1 - a**2)), np.zeros_like(a)],
        1,
    )
    cord = cell((cloth, 0), CUSHION_CELLS, tube(seam, 0.0045, 6, closed=True), spread=0.2)
    return [body, cord]


def _leg(height: float, top: float, foot: float) -> Mesh:
    return lathe(
        [(0, 0), (foot * 0.9, 0), (foot, 0.003), (top, height - 0.001), (top, height), (0, height)], 20
    )


def _sofa(model: Model, place: Place) -> None:
    """A sofa of 2.24 m with two seats; modelled to face +z with its middle at the origin."""
    width, depth, arm = 2.24, 0.96, 0.19
    inner = width - 2 * arm

    def soft(*meshes: Mesh) -> None:
        model.add(SOFA, *(place(m) for m in meshes))

    soft(
        worn(soft_block(width - 0.03, 0.17, depth - 0.04, 0.025, 5, 3, CLOTH_SCALE), 1, 0.002).moved(y=0.215)
    )
    for s in (-1, 1):
        side = soft_block(arm, 0.47, depth, 0.05, 7, 5, CLOTH_SCALE)
        side = Mesh(
            side.vertices
            + np.stack(
                [
                    0.012 * np.sin((side.vertices[:, 1] + 0.1) * 5) * s,
                    0 * side.vertices[:, 0],
                    0 * side.vertices[:, 0],
                ],
                1,
            ),
            side.faces,
            None,
            side.uvs,
        ).smooth()
        soft(worn(side, 3 + s, 0.003).moved(s * (width - arm) / 2, 0.375, 0))
        front = (
            piping(arm - 0.024, 0.44, 0, 0.042)
            .turned("x", 90)
            .moved(s * (width - arm) / 2, 0.378, depth / 2 - 0.012)
        )
        soft(front)
    back = soft_block(inner + 0.06, 0.62, 0.20, 0.05, 5, 4, CLOTH_SCALE).turned("x", -6)
    soft(worn(back, 8, 0.003).moved(0, 0.47, -depth / 2 + 0.13))
    seat, gap = inner / 2, 0.006
    for k, s in enumerate((-1, 1)):
        for mesh in box_cushion(seat - gap, 0.165, 0.72, 20 + k, 0.024):
            soft(mesh.moved(s * seat / 2, 0.385, 0.115))
        for mesh in box_cushion(seat - 0.02, 0.17, 0.44, 30 + k, 0.055, 0.055):
            upright = mesh.turned("x", 90).turned("x", -13 - 2 * k)
            soft(upright.moved(s * seat / 2, 0.685, -0.22 + 0.01 * k))
    for sx in (-1, 1):
        for sz in (-1, 1):
            model.add(
                WOOD,
                place(_leg(0.135, 0.024, 0.016).moved(sx * (width / 2 - 0.10), 0.0, sz * (depth / 2 - 0.10))),
            )
    scatter = (
        (-0.74, 0.66, -0.06, -22, 26, 0.46, 0),
        (-0.50, 0.645, 0.02, -18, 8, 0.40, 2),
        (0.72, 0.665, -0.05, -20, -24, 0.46, 1),
        (0.40, 0.63, 0.02, -24, -4, 0.38, 3),
    )
    for k, (x, y, z, tilt, turn, size, cloth) in enumerate(scatter):
        for mesh in scatter_cushion(size, 0.17, 60 + k, cloth):
            model.add(
                CUSHIONS,
                place(mesh.turned("z", 4 * (-1) ** k).turned("x", tilt).turned("y", turn).moved(x, y, z)),
            )


def _armchair(model: Model, place: Place, seed: int) -> None:
    """A tub chair in pale cloth on walnut legs; modelled to face +z with its middle at the origin."""
    path_n, around = 72, 36
    low, thick = 0.17, 0.105

    def rim(t: Floats) -> Floats:
        back = np.clip(1 - np.abs(t) / 0.78, 0, 1)
        return 0.60 + 0.17 * back * back * (3 - 2 * back)

    def centre(t: Floats) -> tuple[Floats, Floats]:
        """The plan's horseshoe: half a ring behind, straight arms forward; t runs -1..1."""
        radius, arm = 0.335, 0.30
        total = np.pi * radius / 2 + arm
        s = np.abs(t) * total
        bend = np.minimum(s, np.pi * radius / 2) / radius
        x = np.sign(t) * radius * np.sin(bend)
        z = -radius * np.cos(bend) + np.maximum(s - np.pi * radius / 2, 0)
        return x, z

    def f(u: Floats, v: Floats) -> Floats:
        # The ends are round: there the section shrinks while it moves on.
        t = np.clip((v - 0.06) / 0.88, 0, 1) * 2 - 1
        end = np.clip((0.06 - v) / 0.06, 0, 1) - np.clip((v - 0.94) / 0.06, 0, 1)
        bend = np.abs(end) * np.pi / 2
        shrink, on = np.maximum(np.cos(bend), 0.02), np.sin(bend) * thick / 2
        x, z = centre(t)
        dx, dz = (
            np.subtract(*(c[k] for c in (centre(np.clip(t + 1e-4, -1, 1)), centre(np.clip(t - 1e-4, -1, 1)))))
            for k in (0, 1)
        )
        length = np.maximum(np.hypot(dx, dz), 1e-12)
        dx, dz = dx / length, dz / length
        high = rim(t)
        a = 2 * np.pi * u
        half = (high - low) / 2
        ca, sa = np.cos(a), np.sin(a)
        # A stadium: straight walls, round top and bottom.
        across = np.sign(ca) * np.abs(ca) ** 0.35 * thick / 2 * shrink
        up = np.sign(sa) * np.abs(sa) ** 0.85 * half * (1 - (1 - shrink) * thick / (2 * half))
        lean = 0.07 * (np.clip((up + half) / (2 * half), 0, 1))
        out = across + lean
        px = x + dz * -out * -1 - dx * on * np.sign(end)
        pz = z - dx * out - dz * on * np.sign(end)
        return np.stack([px, low + half + up, pz], 1)

    shell = surface(f, around, path_n, (2.4, 4.4))
    signed = np.einsum(
        "ij,ij->",
        shell.vertices[shell.faces[:, 0]],
        np.cross(shell.vertices[shell.faces[:, 1]], shell.vertices[shell.faces[:, 2]]),
    )
    shell = shell if signed > 0 else shell.flipped()
    model.add(ARMCHAIR, place(worn(shell.smooth(), 40 + seed, 0.004)))
    plan = soft_block(0.60, 0.13, 0.66, 0.045, 8, 5, CLOTH_SCALE)

    def tub(p: Floats) -> Floats:
        # The seat follows the round back.
        back = np.clip(-p[:, 2] / 0.33, 0, 1)
        q = p.copy()
        q[:, 0] *= np.sqrt(np.clip(1 - 0.72 * back**2, 0.05, 1))
        return q

    seat = Mesh(tub(plan.vertices), plan.faces, None, plan.uvs).smooth()
    seat = crowned(seat, 0.66, 0.72, 0.026)
    model.add(ARMCHAIR, place(worn(seat, 50 + seed, 0.004).moved(0, 0.405, 0.035)))
    base = soft_block(0.60, 0.17, 0.62, 0.03, 4, 3, CLOTH_SCALE)
    base = Mesh(tub(base.vertices), base.faces, None, base.uvs).smooth()
    model.add(ARMCHAIR, place(base.moved(0, 0.265, 0.02)))
    for sx in (-1, 1):
        for sz in (-1, 1):
            x, z = sx * (0.27 if sz > 0 else 0.20), 0.24 if sz > 0 else -0.24
            path = curve([(x * 1.12, 0.0, z * 1.12), (x, 0.20, z)], 2)
            model.add(WOOD, place(tube(path, [0.012, 0.016, 0.020], 14)))
