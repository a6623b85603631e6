"""Pictures of the atrium's masonry: brick, plaster, stone, marble, paving, wood and roof tiles."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from etendue.models._spz_noise import Field, cloud, grid, mix, normals, save, step
from etendue.models._spz_plan import CORRIDOR, HALF_X, HALF_Z

CREAM, ROSSO, SLATE = (0.60, 0.54, 0.45), (0.34, 0.155, 0.115), (0.17, 0.165, 0.165)


def paint(folder: Path) -> None:
    """Writes every picture of the masonry into `folder`."""
    bricks(folder)
    plaster(folder)
    stones(folder)
    tiles(folder)
    paving(folder)
    wood(folder)


def bricks(folder: Path, size: int = 1024) -> None:
    """Thin Roman bricks in running bond, 4 m to a side: 16 to a course, 56 courses."""
    u, v = grid((size, size))
    rough = cloud((size, size), 11, 1.2, 24, 400)
    slow = cloud((size, size), 12, 1.6, 1, 40)
    y = v * 56 + 0.03 * rough
    row = np.floor(y).astype(int)
    x = u * 16 + 0.5 * (row % 2) + 0.008 * np.roll(rough, 99, 0)
    column = np.floor(x).astype(int) % 16
    fx, fy = x - np.floor(x), y - np.floor(y)
    rng = np.random.default_rng(13)
    tone = rng.normal(0, 1, (56, 16)).astype(np.float32)[row % 56, column]
    burnt = rng.random((56, 16)).astype(np.float32)[row % 56, column]
    edge = np.minimum(np.minimum(fx, 1 - fx) * 0.25, np.minimum(fy, 1 - fy) * 4 / 56)  # metres
    face = step(0.003, 0.0075, edge + 0.0012 * rough)
    colour = mix((0.40, 0.205, 0.13), (0.50, 0.31, 0.20), step(-1.6, 1.8, tone))
    colour = mix(colour, (0.22, 0.115, 0.09), step(0.88, 0.93, burnt) * 0.75)
    colour *= (1 + 0.07 * rough + 0.08 * slow)[..., None]
    mortar = np.array([0.50, 0.45, 0.375], np.float32) * (1 + 0.06 * rough + 0.07 * slow)[..., None]
    colour = mix(mortar, colour, face)
    bleached = step(0.7, 2.2, slow + 0.25 * rough)
    save(folder / "bricks.png", mix(colour, (0.56, 0.49, 0.40), 0.45 * bleached))
    height = 0.75 * face + 0.10 * rough * face + 0.12 * tone * face
    save(folder / "bricks_normal.png", normals(height, 0.9), linear=True)


def plaster(folder: Path, size: int = 1024) -> None:
    """Lime wash in worn ochre for the walls, and in pale cream for the vaults, 4 m to a side."""
    fine, slow = cloud((size, size), 21, 1.1, 30, 500), cloud((size, size), 22, 1.9, 1, 60)
    streaks = cloud((size, size), 23, 1.5, 4, 300, stretch=(7, 1))
    strokes = cloud((size, size), 24, 1.2, 8, 200, stretch=(1, 2.5))
    wear = step(0.5, 2.4, slow + 0.35 * fine)
    ochre = mix((0.67, 0.535, 0.36), (0.74, 0.62, 0.455), step(-1.5, 1.8, slow))
    ochre = mix(ochre, (0.70, 0.66, 0.58), 0.75 * wear)
    ochre = mix(ochre, (0.46, 0.365, 0.26), 0.35 * step(0.4, 2.6, streaks - 0.4 * slow))
    save(folder / "plaster.png", ochre * (1 + 0.022 * fine + 0.02 * strokes)[..., None])
    save(folder / "plaster_normal.png", normals(0.5 * strokes + 0.35 * fine - 0.6 * wear, 0.55), linear=True)
    pale = mix((0.66, 0.62, 0.54), (0.73, 0.70, 0.63), step(-1.6, 1.6, np.roll(slow, 300, 1)))
    pale = mix(pale, (0.54, 0.48, 0.38), 0.3 * step(0.9, 2.6, np.roll(slow, 400, 0) + 0.3 * fine))
    save(folder / "ceiling.png", pale * (1 + 0.02 * fine + 0.015 * strokes)[..., None])


def stones(folder: Path, size: int = 1024) -> None:
    """Travertine, grey sandstone and two marbles, 1.3 to 2 m to a side."""
    fine, slow = cloud((size, size), 31, 1.0, 20, 500), cloud((size, size), 32, 1.8, 1, 80)
    bands = cloud((size, size), 33, 1.25, 1, 300, stretch=(1, 8))
    pits = step(1.55, 2.3, cloud((size, size), 34, 0.9, 12, 260, stretch=(1, 3)) + 0.45 * bands)
    travertine = mix((0.50, 0.445, 0.36), (0.66, 0.61, 0.53), step(-2, 2, 0.8 * bands + 0.6 * slow))
    travertine = mix(travertine, (0.30, 0.255, 0.20), 0.7 * pits) * (1 + 0.03 * fine)[..., None]
    save(folder / "stone.png", travertine)
    save(folder / "stone_normal.png", normals(-1.2 * pits + 0.18 * fine, 0.9), linear=True)
    serena = (
        mix((0.40, 0.385, 0.355), (0.51, 0.49, 0.45), step(-2, 2, slow + 0.35 * bands))
        * (1 + 0.045 * fine)[..., None]
    )
    save(folder / "arch.png", serena)
    save(folder / "details.png", mix(serena, (0.60, 0.575, 0.53), np.full((size, size), 0.6, np.float32)))
    warp = cloud((size, size), 35, 1.6, 1, 60)
    ridge = np.exp(-np.abs(np.roll(warp, 211, 1) + 0.4 * slow) / 0.05) * step(-0.4, 1.4, slow)
    thin = np.exp(-np.abs(warp - 0.5 * np.roll(slow, 77, 0)) / 0.025) * step(-0.8, 1.0, -slow)
    for name, base, light, vein in (
        ("column_a", (0.56, 0.49, 0.40), (0.68, 0.625, 0.55), (0.36, 0.25, 0.18)),
        ("column_b", (0.58, 0.555, 0.51), (0.70, 0.68, 0.64), (0.36, 0.34, 0.33)),
    ):
        marble = mix(base, light, step(-1.8, 1.8, warp + 0.3 * bands))
        marble = mix(marble, vein, np.clip(0.5 * ridge + 0.35 * thin, 0, 0.7))
        save(folder / f"{name}.png", marble * (1 + 0.018 * fine)[..., None])


def tiles(folder: Path, size: int = 1024) -> None:
    """Diagonal terracotta floor tiles, 2.4 m to a side, and the tones of roof tiles."""
    u, v = grid((size, size))
    fine, slow = cloud((size, size), 41, 1.1, 16, 400), cloud((size, size), 42, 1.8, 1, 60)
    a, b = (u + v) * 8 + 0.01 * fine, (u - v) * 8 + 0.01 * np.roll(fine, 50, 0)
    i, j = np.floor(a).astype(int), np.floor(b).astype(int)
    tone = np.random.default_rng(43).normal(0, 1, (16, 16)).astype(np.float32)[(i + j) % 16, (i - j) % 16]
    fa, fb = a - np.floor(a), b - np.floor(b)
    face = step(0.012, 0.035, np.minimum(np.minimum(fa, 1 - fa), np.minimum(fb, 1 - fb)))
    clay = (
        mix((0.40, 0.20, 0.13), (0.53, 0.32, 0.22), step(-1.8, 1.8, tone + 0.5 * slow))
        * (1 + 0.06 * fine)[..., None]
    )
    save(folder / "tiles.png", mix((0.36, 0.32, 0.27), clay, face))
    save(folder / "tiles_normal.png", normals(face + 0.08 * fine + 0.2 * tone * face, 1.0), linear=True)
    half = size // 2
    tone = cloud((half, half), 44, 1.5, 1, 30, stretch=(1, 0.35)) + 0.3 * cloud(
        (half, half), 45, 0.9, 10, 200
    )
    clay = mix((0.30, 0.135, 0.08), (0.52, 0.285, 0.18), step(-1.8, 1.8, tone))
    lichen = step(1.2, 2.2, cloud((half, half), 46, 1.4, 4, 120))
    save(folder / "roof.png", mix(clay, (0.40, 0.37, 0.27), 0.6 * lichen))


def paving(folder: Path, height: int = 1280) -> None:
    """The whole ground floor in one picture: squares and lozenges in the court, chequers in the corridors."""
    reach_x, reach_z = HALF_X + CORRIDOR, HALF_Z + CORRIDOR
    width = int(height * reach_x / reach_z) // 64 * 64
    u, v = grid((height, width))
    x, z = (2 * u - 1) * np.float32(reach_x), (1 - 2 * v) * np.float32(reach_z)
    fine = np.tile(cloud((640, 640), 51, 1.0, 15, 300), (2, 5))[:height, :width]
    slow = cloud((height, width), 52, 1.7, 2, 120)
    ring = np.maximum(np.abs(x) - HALF_X, np.abs(z) - HALF_Z)  # negative in the court
    # The field inside is 30 by 10 squares of 0.85 m.
    band = ((ring > -0.85) & (ring < 0.5)) | (np.abs(ring - 0.78) < 0.1)
    dark, court, corridor = band & (ring < -0.6), ring <= -0.85, ~band & (ring > 0)
    turned = np.float32(np.sqrt(0.5))
    colour = np.empty((height, width, 3), np.float32)
    colour[court] = _squares(x[court], z[court], 0.85, 53, lozenges=True)
    p, q = x[corridor], z[corridor]
    colour[corridor] = _squares((p + q) * turned, (p - q) * turned, 0.46, 54, lozenges=False)
    colour[band] = _squares(
        x[band], z[band], 1.7, 55, lozenges=False, pair=((0.50, 0.465, 0.41), (0.53, 0.49, 0.43))
    )
    colour[dark] *= np.array([0.42, 0.42, 0.43], np.float32)
    worn = step(-0.5, 2.2, slow + 0.2 * fine)
    colour *= (1 - 0.38 * 0.55 * worn + 0.035 * fine + 0.05 * slow)[..., None]
    damp = step(-0.55, 0.0, ring) * (ring < 0) * np.float32(0.25)
    save(folder / "floor.png", colour * (1 - 0.4 * damp)[..., None])


def _squares(x: Field, z: Field, size: float, seed: int, lozenges: bool,
             pair: tuple[tuple[float, float, float], ...] = (CREAM, ROSSO)) -> Field:  # fmt: skip
    """Squares of two stones in turn with dark joints, each slab of its own tone; lozenges set in or not."""
    a, b = x / size, z / size
    i, j = np.floor(a).astype(int), np.floor(b).astype(int)
    fa, fb = a - np.floor(a), b - np.floor(b)
    rng = np.random.default_rng(seed)
    tone = rng.normal(1, 0.085, (64, 64)).astype(np.float32)
    odd = ((i + j) % 2).astype(np.float32)
    edge = np.minimum(np.minimum(fa, 1 - fa), np.minimum(fb, 1 - fb)) * size
    colour = mix(pair[0], pair[1], odd)
    if lozenges:
        diamond = (0.34 - np.abs(fa - 0.5) - np.abs(fb - 0.5)) * size
        set_in = step(-0.004, 0.004, diamond)
        colour = mix(
            colour,
            np.where(odd[..., None] > 0.5, np.array(CREAM, np.float32), np.array(SLATE, np.float32)),
            set_in,
        )
        edge = np.minimum(edge, np.abs(diamond) * 1.4)
    colour *= tone[i % 64, j % 64][..., None]
    return mix((0.12, 0.105, 0.09), colour, step(0.002, 0.010, edge))


def wood(folder: Path, size: int = 512) -> None:
    """Old chestnut boards with their grain along v, 1.2 m to a side."""
    u, _ = grid((size, size))
    grain = cloud((size, size), 61, 1.2, 2, 250, stretch=(14, 1))
    slow = cloud((size, size), 62, 1.8, 1, 30)
    board = np.floor(u * 6)
    joint = step(0.0, 0.03, np.minimum(u * 6 - board, 1 - (u * 6 - board)))
    tone = np.random.default_rng(63).normal(0, 0.5, 6).astype(np.float32)[board.astype(int) % 6]
    colour = mix((0.075, 0.042, 0.024), (0.20, 0.115, 0.062), step(-2, 2, grain + 0.4 * slow + tone))
    save(folder / "wood.png", mix((0.02, 0.013, 0.009), colour, joint))
