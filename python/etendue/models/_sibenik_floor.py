"""The polished floor of separate slabs, the steps of the choir and the red carpet."""

from __future__ import annotations

import numpy as np

from etendue.models._sibenik_plan import AISLE_OUT, ARCADE, CHOIR_END, EAST_WALL, NAVE_HALF, WEST_WALL
from etendue.models._sibenik_shapes import block, grid, welded
from etendue.models.mesh import Floats, Ints, Mesh, merged
from etendue.models.model import Model

JOINT, BEVEL, DEPTH = 0.0015, 0.0035, 0.0025
TEXTURE_METRES = 4.0
STEPS = ((8.55, 0.15), (8.9, 0.30), (9.25, 0.45))  # x of the riser, height of the tread
CARPET_HALF = 0.9
DARK, LIGHT = 1, 0  # halves of the floor's texture


class Paving:
    """Slabs in one mesh; every slab shows its own part of the marble and lies a hair out of level."""

    def __init__(self, seed: int = 7) -> None:
        self._random = np.random.default_rng(seed)
        self._slabs: dict[int, tuple[list[Floats], list[int]]] = {}

    def slab(self, outline: Floats, tone: int) -> None:
        """A convex slab of (x, z) points that run so that its top faces up, of the texture's half `tone`."""
        outlines, tones = self._slabs.setdefault(len(outline), ([], []))
        outlines.append(outline)
        tones.append(tone)

    def mesh(self) -> Mesh:
        """All slabs."""
        return welded(merged(self._same(np.array(o), np.array(t)) for o, t in self._slabs.values()))

    def _same(self, outline: Floats, tone: Ints) -> Mesh:
        """Slabs with the same number of corners: (slabs, corners, 2), (slabs,)."""
        count, n = outline.shape[:2]
        middle = outline.mean(1, keepdims=True)
        outward = outline - middle
        edge = np.roll(outline, -1, 1) - outline
        across = outward[..., 0] * edge[..., 1] - outward[..., 1] * edge[..., 0]
        apothem = np.abs(across / np.linalg.norm(edge, axis=2)).min(1)[:, None, None]
        # Shrunk about the middle, so that the joint is JOINT wide at the nearest side.
        rim = outward * (1 - JOINT / apothem)
        top = outward * (1 - (JOINT + BEVEL) / apothem)
        tilt, level = (
            self._random.normal(0, 0.0007, (count, 2, 1)),
            self._random.normal(0, 0.0001, (count, 1)),
        )
        low = np.stack([rim[..., 0], np.full((count, n), -DEPTH), rim[..., 1]], 2)
        high = np.stack([top[..., 0], (top @ tilt)[..., 0] + level, top[..., 1]], 2)
        j = np.roll(np.arange(n), -1)
        triangles = [np.stack([high[:, [0] * (n - 2)], high[:, 1:-1], high[:, 2:]], 2)]
        triangles += [np.stack([low, low[:, j], high[:, j]], 2), np.stack([low, high[:, j], high], 2)]
        soup = np.concatenate(triangles, 1)
        normals = np.cross(soup[:, :, 1] - soup[:, :, 0], soup[:, :, 2] - soup[:, :, 0])
        area = np.linalg.norm(normals, axis=2)
        normals = np.repeat((normals / np.maximum(area, 1e-12)[..., None])[:, :, None], 3, 2)

        angle = self._random.integers(4, size=count) * np.pi / 2
        matrix = np.stack([np.cos(angle), -np.sin(angle), np.sin(angle), np.cos(angle)], 1).reshape(
            -1, 1, 2, 2
        )
        local = soup[..., [0, 2]] @ matrix
        reach = np.abs(local[..., 0]).reshape(count, -1).max(1) + 0.02
        half = TEXTURE_METRES / 2
        at = self._random.uniform(0, (half, TEXTURE_METRES), (count, 2))
        at[:, 0] = tone * half + np.clip(at[:, 0], reach, half - reach)
        uvs = (local + at[:, None, None]) / TEXTURE_METRES
        soup[..., [0, 2]] += middle[:, None]
        keep = area > 1e-9
        vertices = soup[keep].reshape(-1, 3)
        faces = np.arange(len(vertices)).reshape(-1, 3)
        return Mesh(vertices, faces, normals[keep].reshape(-1, 3), uvs[keep].reshape(-1, 2))


def _rectangle(x0: float, x1: float, z0: float, z1: float) -> Floats:
    return np.array([[x0, z0], [x0, z1], [x1, z1], [x1, z0]])


def add_floor(model: Model) -> None:
    """Slabs everywhere, on a bed of mortar that shows in the joints."""
    paving = Paving()
    west, east = WEST_WALL - 0.2, EAST_WALL + 0.2
    _octagons(paving, west, CHOIR_END, -NAVE_HALF + 0.07, NAVE_HALF - 0.07, 0.64)
    for side in (-1, 1):
        _strip(paving, west, east, side * ARCADE, 0.52)
        near, far = sorted((side * (ARCADE + 0.52), side * (AISLE_OUT + 0.05)))
        _checks(paving, west, east, near, far, 0.52)
    model.add("pod", paving.mesh())
    model.add("fuga", block(west, east, -0.2, -DEPTH + 0.0006, -AISLE_OUT - 0.1, AISLE_OUT + 0.1))
    for (x, top), (nxt, _) in zip(STEPS, (*STEPS[1:], (EAST_WALL + 4.0, 0)), strict=True):
        model.add("kamen_zid_parapet", block(x, max(nxt, x + 0.3) + 0.05, -0.01, top, -2.9, 2.9, 0.012))
    model.add("pod_tepih", _carpet())


def _octagons(paving: Paving, x0: float, x1: float, z0: float, z1: float, pitch: float) -> None:
    """Light octagons with small dark squares between them, with half pieces along the sides."""
    nx, nz = round((x1 - x0) / pitch), round((z1 - z0) / pitch)
    dx, dz = (x1 - x0) / nx, (z1 - z0) / nz
    cut = 0.15
    for i in range(nx):
        for j in range(nz):
            a, b, c, d = x0 + i * dx, x0 + (i + 1) * dx, z0 + j * dz, z0 + (j + 1) * dz
            corners = [
                (a, c + cut),
                (a, d - cut),
                (a + cut, d),
                (b - cut, d),
                (b, d - cut),
                (b, c + cut),
                (b - cut, c),
                (a + cut, c),
            ]
            paving.slab(np.array(corners), LIGHT)
    for i in range(nx + 1):
        for j in range(nz + 1):
            x, z = x0 + i * dx, z0 + j * dz
            diamond = np.array([(x - cut, z), (x, z + cut), (x + cut, z), (x, z - cut)])
            diamond[:, 1] = np.clip(diamond[:, 1], z0, z1)
            diamond[:, 0] = np.clip(diamond[:, 0], x0, x1)
            keep = np.linalg.norm(diamond - np.roll(diamond, 1, 0), axis=1) > 1e-6
            paving.slab(diamond[keep], DARK)


def _checks(paving: Paving, x0: float, x1: float, z0: float, z1: float, pitch: float) -> None:
    nx, nz = round((x1 - x0) / pitch), round((z1 - z0) / pitch)
    x, z = np.linspace(x0, x1, nx + 1), np.linspace(z0, z1, nz + 1)
    for i in range(nx):
        for j in range(nz):
            paving.slab(_rectangle(x[i], x[i + 1], z[j], z[j + 1]), (i + j) % 2)


def _strip(paving: Paving, x0: float, x1: float, middle: float, half: float) -> None:
    """Long light slabs between two dark fillets, under an arcade."""
    x = np.linspace(x0, x1, round((x1 - x0) / 1.2) + 1)
    fillet = 0.12
    for a, b in zip(x[:-1], x[1:], strict=True):
        paving.slab(_rectangle(a, b, middle - half + fillet, middle + half - fillet), LIGHT)
        for z in (middle - half, middle + half - fillet):
            paving.slab(_rectangle(a, b, z, z + fillet), DARK)


def _carpet() -> Mesh:
    """A runner from the portal up the steps of the choir, its pile a little uneven."""
    random = np.random.default_rng(11)
    x = np.arange(WEST_WALL + 1.2, STEPS[0][0] - 0.06, 0.3)
    path = [(a, 0.0) for a in x]
    for (riser, top), low in zip(STEPS, (0.0, *[t for _, t in STEPS[:-1]]), strict=True):
        path += [(riser - 0.014, low + 0.0), (riser - 0.014, top - 0.012), (riser + 0.004, top)]
        path += [(riser + 0.1, top), (riser + 0.22, top)]
    path += [(a, STEPS[-1][1]) for a in np.arange(STEPS[-1][0] + 0.35, 11.4, 0.3)]
    p = np.array(path)
    across = (
        np.array([-1.0, -1.0, -0.996, -0.985, *np.linspace(-0.94, 0.94, 13), 0.985, 0.996, 1.0, 1.0])
        * CARPET_HALF
    )
    lift = np.array([-0.003, 0.004, 0.0085, 0.011, *[0.0115] * 13, 0.011, 0.0085, 0.004, -0.003])
    tangent = np.gradient(p, axis=0)
    tangent /= np.linalg.norm(tangent, axis=1, keepdims=True)
    normal = np.stack([-tangent[:, 1], tangent[:, 0]], 1)
    n = len(p)
    pile = np.convolve(random.normal(0, 1, n + 4), np.ones(5) / 5, "valid")[:, None] * 0.0012
    pile = pile + random.normal(0, 0.0003, (n, len(across)))
    height = lift + pile * (lift > 0.011)
    drift = np.convolve(random.normal(0, 0.012, n + 40), np.ones(41) / 41, "valid")
    points = np.stack(
        [p[:, :1] + normal[:, :1] * height, p[:, 1:] + normal[:, 1:] * height, across[None] + drift[:, None]],
        2,
    )
    length = np.r_[0, np.cumsum(np.linalg.norm(np.diff(p, axis=0), axis=1))]
    u, v = length[None] / (2 * CARPET_HALF), (across[::-1] / CARPET_HALF + 1)[:, None] / 2
    return grid(points.transpose(1, 0, 2)[::-1], 180, uvs=np.stack(np.broadcast_arrays(u, v), 2))
