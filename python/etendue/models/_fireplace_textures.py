"""The fireplace room's textures, made of noise: woods, cloth, books, leaves, fire, the garden outside.

Every function gives float64 (h, w, 3 or 4) in display values 0..1, row 0 at the top.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike

from etendue.models.mesh import Floats

BOOK_CELLS = (64, 1)
CUSHION_CELLS = (4, 1)
FLOOR_STRIPS = 16
# The painting and three small pictures share a texture: (left, bottom, right, top) of each.
PICTURES = {
    "painting": (0.0, 0.0, 0.625, 1.0),
    "tall": (0.63, 0.0, 0.815, 0.49),
    "dark": (0.82, 0.0, 1.0, 0.49),
    "wide": (0.63, 0.51, 1.0, 1.0),
}


def noise_image(
    height: int, width: int, rows: int, columns: int, rng: np.random.Generator, wrap: bool = True
) -> Floats:
    """Smooth noise in 0..1 with about `rows` x `columns` cells; it repeats at the borders where `wrap`."""

    def weights(n: int, cells: int) -> Floats:
        t = (np.arange(n) + 0.5) / n * cells
        i = np.floor(t).astype(int)
        f = t - i
        w = np.zeros((n, cells + 4))
        # Uniform cubic B-spline: soft, and without the lattice's straight lines.
        for k, value in enumerate(
            ((1 - f) ** 3, 3 * f**3 - 6 * f**2 + 4, -3 * f**3 + 3 * f**2 + 3 * f + 1, f**3)
        ):
            w[np.arange(n), i + k] += value / 6
        if wrap:
            w[:, :4] += w[:, cells : cells + 4]
            return w[:, :cells]
        return w

    a, b = weights(height, max(rows, 4)), weights(width, max(columns, 4))
    image = a @ rng.standard_normal((a.shape[1], b.shape[1])) @ b.T
    return np.asarray(0.5 + 0.5 * np.tanh(0.9 * image / image.std()))


def cloudy(
    height: int, width: int, rows: int, columns: int, rng: np.random.Generator, octaves: int = 5
) -> Floats:
    """Noise with detail at many scales in 0..1."""
    layers = [noise_image(height, width, rows << k, columns << k, rng) * 0.5**k for k in range(octaves)]
    return np.asarray(sum(layers) / sum(0.5**k for k in range(octaves)))


def ramp(t: Floats, stops: ArrayLike) -> Floats:
    """Colours (..., 3) along evenly spaced stops (n, 3)."""
    table = np.asarray(stops, float)
    at = np.linspace(0, 1, len(table))
    return np.stack([np.interp(t, at, table[:, k]) for k in range(3)], -1)


def wood(height: int, width: int, rng: np.random.Generator, stops: ArrayLike, rings: float = 5.0) -> Floats:
    """A board with its grain along the width."""
    warp = noise_image(height, width, 5, 4, rng, wrap=False) + 0.3 * noise_image(
        height, width, 12, 9, rng, wrap=False
    )
    across = np.linspace(0, 1, height)[:, None] + 0.45 * warp
    ring = 0.5 + 0.5 * np.sin(2 * np.pi * rings * across)
    streaks = noise_image(height, width, max(8, height // 2), 14, rng)
    pores = noise_image(height, width, height, 60, rng)
    tone = 0.55 * ring**1.6 + 0.45 * streaks + 0.25 * (warp - 0.5)
    image = ramp(np.clip(tone, 0, 1), stops)
    image *= 1 - 0.13 * np.clip((pores[..., None] - 0.74) / 0.2, 0, 1)
    return np.asarray(np.clip(image, 0, 1))


def floor(rng: np.random.Generator) -> Floats:
    """Oak boards, one above the other; a block of parquet takes its piece from one of them."""
    boards = []
    for _ in range(FLOOR_STRIPS):
        dark = np.array([0.53, 0.43, 0.335]) + rng.normal(0, 0.042) * np.array([1, 0.95, 0.85])
        pale = dark + np.array([0.15, 0.14, 0.125]) + rng.normal(0, 0.018)
        boards.append(
            wood(96, 1024, rng, [dark, 0.45 * dark + 0.55 * pale, pale], rings=float(rng.uniform(1.5, 4.5)))
        )
    return np.concatenate(boards)


def table_wood(rng: np.random.Generator) -> Floats:
    """Walnut."""
    return wood(640, 1024, rng, [[0.235, 0.155, 0.11], [0.37, 0.255, 0.18], [0.47, 0.34, 0.245]], rings=9)


def heather(rng: np.random.Generator, base: ArrayLike, size: int = 512, depth: float = 0.16) -> Floats:
    """Woven wool in a mixed yarn, repeating."""
    warp = noise_image(size, size, size // 2, size // 12, rng)
    weft = noise_image(size, size, size // 12, size // 2, rng)
    y, x = np.mgrid[:size, :size]
    over = ((x // 3 + y // 3) % 2).astype(float)
    tone = np.where(over > 0, warp, weft) - 0.5 + 0.35 * (cloudy(size, size, 4, 4, rng, 4) - 0.5)
    return np.asarray(np.clip(np.asarray(base, float) * (1 + 2 * depth * tone[..., None]), 0, 1))


def cushions(rng: np.random.Generator) -> Floats:
    """Four cloths side by side: ochre, slate blue, ivory with fine stripes, and a grey herringbone."""
    ochre = heather(rng, [0.72, 0.50, 0.22], 512, 0.12)
    blue = heather(rng, [0.27, 0.35, 0.41], 512, 0.14)
    ivory = heather(rng, [0.83, 0.80, 0.745], 512, 0.07)
    x = np.arange(512)
    stripe = (((x // 8) % 8 == 0) | ((x // 8) % 8 == 2)).astype(float)[None, :, None]
    ivory = ivory * (1 - stripe) + stripe * np.array([0.33, 0.345, 0.36])
    grey = heather(rng, [0.60, 0.60, 0.595], 512, 0.1)
    y, x = np.mgrid[:512, :512]
    bone = ((np.where((x // 32) % 2 > 0, x, -x) + y) // 8 % 2).astype(float)[..., None]
    grey = grey * (1 - 0.38 * bone)
    return np.concatenate([ochre, blue, ivory, grey], axis=1)


def rug(rng: np.random.Generator) -> Floats:
    """An ivory rug with lozenges drawn by an unsteady hand."""
    height, width = 1400, 960
    y, x = np.mgrid[:height, :width].astype(float)
    x = x / width * 2.8 + 0.035 * (noise_image(height, width, 16, 11, rng) - 0.5) * 2
    y = y / height * 4.0 + 0.035 * (noise_image(height, width, 16, 11, rng) - 0.5) * 2

    def line(a: Floats) -> Floats:
        return np.asarray(np.clip(1.25 - np.abs((a + 0.5) % 1 - 0.5) / 0.026, 0, 1))

    lines = np.maximum(line(x / 0.7 + y / 1.0), line(x / 0.7 - y / 1.0))
    ivory = ramp(cloudy(height, width, 10, 7, rng), [[0.74, 0.715, 0.665], [0.86, 0.84, 0.795]])
    ivory *= 0.93 + 0.14 * noise_image(height, width, height // 3, width // 3, rng)[..., None]
    yarn = ramp(noise_image(height, width, 90, 60, rng), [[0.20, 0.205, 0.215], [0.36, 0.36, 0.37]])
    return np.asarray(np.clip(ivory + (yarn - ivory) * lines[..., None], 0, 1))


def books(rng: np.random.Generator) -> Floats:
    """64 bindings side by side; in each the left half is the spine, the right half the plain boards."""
    height, width = 512, 32
    cloths = np.array(
        [
            [0.83, 0.81, 0.76],
            [0.74, 0.72, 0.68],
            [0.88, 0.87, 0.85],
            [0.52, 0.52, 0.52],
            [0.33, 0.34, 0.36],
            [0.20, 0.21, 0.23],
            [0.25, 0.32, 0.39],
            [0.40, 0.48, 0.53],
            [0.55, 0.61, 0.62],
            [0.62, 0.42, 0.24],
            [0.71, 0.55, 0.30],
            [0.47, 0.22, 0.17],
            [0.34, 0.38, 0.30],
            [0.52, 0.55, 0.45],
            [0.66, 0.60, 0.52],
            [0.14, 0.16, 0.20],
        ]
    )
    columns = []
    for k in range(BOOK_CELLS[0]):
        cloth = np.clip(cloths[k % 16] + rng.normal(0, 0.025, 3), 0.05, 0.93)
        ink = np.array([0.90, 0.88, 0.82]) if cloth.mean() < 0.5 else np.array([0.17, 0.17, 0.18])
        if cloth.mean() < 0.5 and rng.random() < 0.4:
            ink = np.array([0.80, 0.66, 0.36])
        column = np.ones((height, 2 * width, 3)) * cloth
        top = int(rng.uniform(0.1, 0.3) * height)
        length = int(rng.uniform(0.2, 0.42) * height)
        if rng.random() < 0.45:
            band = np.clip(cloth * 0.55 if rng.random() < 0.5 else cloth * 0.4 + 0.55, 0, 1)
            column[top - 16 : top + length + 16, :width] = band
            ink = np.array([0.9, 0.88, 0.83]) if band.mean() < 0.5 else np.array([0.15, 0.15, 0.17])
        # Lettering runs along the spine: words of upright strokes.
        y = top
        while y < top + length:
            word = int(rng.integers(26, 62))
            strokes = np.repeat(rng.random(word // 3 + 1) < 0.62, 3)[:word]
            rows = np.arange(y, min(y + word, top + length))
            column[rows, 11:21] = np.where(strokes[: len(rows), None, None], ink, column[rows, 11:21])
            y += word + 9
        for edge in (18, 30, height - 70, height - 30):
            if rng.random() < 0.5:
                column[edge : edge + 4, :width] = ink
        column *= 0.93 + 0.14 * noise_image(height, 2 * width, 128, 16, rng)[..., None]
        columns.append(column)
    return np.clip(np.concatenate(columns, axis=1), 0, 1)


def leaf(rng: np.random.Generator) -> Floats:
    """A leaf's green with its veins; the tip is at the top."""
    size = 256
    y, x = np.mgrid[:size, :size] / size
    across = np.abs(x - 0.5) * 2
    vein = np.abs(((1 - y) * 7 - across * 2.2) % 1 - 0.5) * 2
    tone = cloudy(size, size, 4, 4, rng, 4)
    image = ramp(tone, [[0.165, 0.27, 0.135], [0.30, 0.42, 0.22]])
    light = np.maximum(np.clip(1 - across / 0.05, 0, 1), 0.45 * np.clip((vein - 0.86) / 0.12, 0, 1))
    return np.asarray(image + (np.array([0.50, 0.58, 0.36]) - image) * 0.7 * light[..., None])


def bark(rng: np.random.Generator) -> Floats:
    """Bark along the width in the upper half, the rings of a sawn end in the lower."""
    size = 512
    ridge = np.abs(noise_image(256, size, 40, 14, rng) - 0.5) * 2
    rough = ramp(
        np.clip(ridge + 0.3 * (cloudy(256, size, 12, 12, rng) - 0.5), 0, 1),
        [[0.16, 0.125, 0.10], [0.31, 0.25, 0.20], [0.42, 0.36, 0.30]],
    )
    y, x = np.mgrid[:256, :size]
    away = np.hypot((x / size - 0.5) * 2, (y / 256 - 0.5) * 2) + 0.07 * (cloudy(256, size, 4, 4, rng) - 0.5)
    sawn = ramp(
        0.5 + 0.5 * np.sin(away * 62) * 0.6 + 0.3 * (cloudy(256, size, 30, 30, rng) - 0.5),
        [[0.52, 0.39, 0.25], [0.76, 0.62, 0.44]],
    )
    return np.concatenate([rough, np.clip(sawn, 0, 1)])


def brick(rng: np.random.Generator) -> Floats:
    """Fired clay that has seen smoke."""
    tone = 0.6 * cloudy(512, 512, 6, 6, rng, 6) + 0.4 * noise_image(512, 512, 200, 200, rng)
    return ramp(tone, [[0.17, 0.13, 0.115], [0.34, 0.25, 0.21], [0.44, 0.36, 0.31]])


def flame(rng: np.random.Generator) -> Floats:
    """The fire on a tongue-shaped sheet: its foot at the bottom, its edges left and right."""
    height, width = 512, 192
    y, x = np.mgrid[:height, :width]
    up = 1 - (y + 0.5) / height
    edge = 1 - np.abs((x + 0.5) / width - 0.5) * 2
    threads = noise_image(height, width, 7, 14, rng)
    heat = (
        np.clip(edge, 0, 1) ** 0.65 * (1.10 - 0.85 * up) * (0.62 + 0.7 * threads) * np.clip(up / 0.06, 0, 1)
    )
    return ramp(
        np.clip(heat, 0, 1),
        [[0.02, 0.0, 0.0], [0.62, 0.17, 0.03], [0.95, 0.45, 0.10], [1.0, 0.72, 0.30], [1, 0.9, 0.62]],
    )


def glow(rng: np.random.Generator) -> Floats:
    """What lit lamp shades give off, over 30: outside, fading up and down, on the left; inside on the right.

    A texture, so that it holds whatever colour a scene file gives the lamps.
    """
    warm = np.array([1.0, 0.76, 0.47])
    up = np.linspace(1, 0, 64)[:, None]
    outside = (0.55 + 0.45 * np.exp(-(((up - 0.48) / 0.30) ** 2))) * np.ones((1, 8))
    radiance = np.concatenate([1.5 * outside, np.full((64, 8), 3.6)], axis=1)
    linear = radiance[..., None] / 30 * warm * (1 + 0.02 * rng.standard_normal((64, 16, 1)))
    return np.asarray(np.where(linear < 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055))


def embers(rng: np.random.Generator) -> Floats:
    """Charcoal with glowing cracks."""
    crack = 1 - np.abs(cloudy(512, 512, 6, 6, rng, 4) - 0.5) * 2
    patch = cloudy(512, 512, 3, 3, rng, 3)
    heat = np.clip((crack - 0.60) / 0.4, 0, 1) ** 1.5 * np.clip((patch - 0.30) / 0.4, 0, 1)
    return ramp(heat, [[0.012, 0.010, 0.010], [0.45, 0.07, 0.015], [0.9, 0.30, 0.05], [1.0, 0.62, 0.22]])


def sky(rng: np.random.Generator) -> Floats:
    """An overcast sky, brighter overhead; a texture, so that it holds whatever colour a scene file gives."""
    up = np.linspace(1, 0, 64)[:, None, None] * np.ones((1, 64, 1))
    linear = (0.56 + 0.24 * up) * np.array([0.965, 1.0, 1.03])
    linear = linear * (0.94 + 0.12 * noise_image(64, 64, 5, 5, rng)[..., None])
    return np.asarray(1.055 * linear ** (1 / 2.4) - 0.055)


def garden(rng: np.random.Generator) -> Floats:
    """A garden out of focus on a bright grey day: lawn, hedge, trees, and the sky between the leaves."""
    height, width = 768, 768
    y = np.linspace(1, 0, height)[:, None] * np.ones((1, width))
    above = ramp(y, [[0.90, 0.93, 0.95], [0.93, 0.95, 0.97], [0.86, 0.91, 0.97]])
    crown = cloudy(height, width, 4, 5, rng, 5)
    leaves = noise_image(height, width, 40, 44, rng)
    trees = ramp(
        0.55 * leaves + 0.45 * crown, [[0.30, 0.315, 0.295], [0.50, 0.52, 0.475], [0.76, 0.775, 0.72]]
    )
    cover = np.clip((0.30 + 0.46 * crown + 0.12 * leaves - 0.70 * y) / 0.05, 0, 1)[..., None]
    image = above + (trees - above) * cover
    hedge = ramp(
        0.7 * noise_image(height, width, 60, 60, rng) + 0.3 * crown,
        [[0.27, 0.285, 0.255], [0.44, 0.465, 0.40]],
    )
    top = 0.30 + 0.02 * (noise_image(1, width, 4, 9, rng) - 0.5)
    image = np.where((y < top)[..., None], hedge, image)
    lawn = ramp(noise_image(height, width, 90, 20, rng), [[0.54, 0.565, 0.49], [0.67, 0.69, 0.60]])
    return np.asarray(np.where((y < 0.15)[..., None], lawn, image))


def write(image: Floats, path: Path) -> None:
    """Writes display values 0..1 as an 8-bit PNG.

    Raises:
        OSError: the file cannot be written.
    """
    import OpenImageIO as oiio

    pixels = np.ascontiguousarray(np.clip(np.rint(image * 255), 0, 255).astype(np.uint8))
    path.parent.mkdir(parents=True, exist_ok=True)
    out = oiio.ImageOutput.create(str(path))
    spec = oiio.ImageSpec(pixels.shape[1], pixels.shape[0], pixels.shape[2], "uint8")
    # Speed of building counts for more than a few kilobytes.
    spec.attribute("png:compressionLevel", 3)
    if out is None or not out.open(str(path), spec) or not out.write_image(pixels) or not out.close():
        raise OSError(f"{path}: {oiio.geterror() or 'the image cannot be written'}")
