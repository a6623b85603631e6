"""The checker texture of the floor: polished stone slabs in two tones."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from etendue.models.mesh import Floats

SQUARES = 16  # along an edge of the texture; even, so that it repeats
PIXELS = 128  # along an edge of a square
LIGHT, DARK, GROUT = (0.70, 0.655, 0.575), (0.052, 0.056, 0.066), (0.20, 0.185, 0.165)  # linear


def write_checker(path: Path) -> None:
    """Writes the texture as an 8-bit sRGB PNG."""
    import OpenImageIO as oiio

    path.parent.mkdir(parents=True, exist_ok=True)
    # Encoded by a table: fine enough for 8 bits from 0.003 up, below which the slabs never go.
    levels = np.linspace(0, 1, 16384)
    encoded = np.where(levels <= 0.0031308, 12.92 * levels, 1.055 * levels ** (1 / 2.4) - 0.055)
    table = np.round(255 * encoded).astype(np.uint8)
    pixels = table[np.clip(16383 * checker() + 0.5, 0, 16383).astype(np.int32)]
    n = SQUARES * PIXELS
    spec = oiio.ImageSpec(n, n, 3, "uint8")
    spec.attribute("png:compressionLevel", 3)
    image = oiio.ImageBuf(spec)
    image.set_pixels(oiio.ROI(0, n, 0, n), pixels)
    if not image.write(str(path)):
        raise OSError(f"{path}: {image.geterror()}")


def checker() -> Floats:
    """Linear reflectance, (2048, 2048, 3), repeating in both directions."""
    rng = np.random.default_rng(3)
    n = SQUARES * PIXELS
    clouds = _noise(rng, 512, 1.5)
    veins = np.exp(-np.square(_noise(rng, 512, 1.95) / 0.06))
    veins *= np.clip(0.3 + 0.6 * _noise(rng, 512, 1.7), 0, 1)
    out = np.empty((n, n, 3))
    for row in range(SQUARES):
        for column in range(SQUARES):
            # Every slab is cut from elsewhere, and laid one of four ways round.
            y, x = rng.integers(0, 512 - PIXELS, 2)
            turn = int(rng.integers(0, 4))
            cut = (slice(y, y + PIXELS), slice(x, x + PIXELS))
            cloud, vein = (np.rot90(a[cut], turn)[:, :, None] for a in (clouds, veins))
            tone = 1 + 0.05 * rng.normal()
            if (row + column) % 2:
                slab = np.array(DARK) * tone * (1 + 0.22 * cloud) + 0.10 * vein * np.array([1.0, 0.95, 0.85])
            else:
                slab = np.array(LIGHT) * (1 + 0.4 * (tone - 1)) * (1 + 0.06 * cloud)
                slab *= 1 - 0.30 * vein * [0.75, 0.9, 1.0]
            out[row * PIXELS : (row + 1) * PIXELS, column * PIXELS : (column + 1) * PIXELS] = slab
    edge = np.abs(np.mod(np.arange(n) + 0.5 + PIXELS / 2, PIXELS) - PIXELS / 2)
    joint = np.clip(1.6 - np.minimum(edge[:, None], edge[None]), 0, 1)[:, :, None]
    return out + joint * (np.array(GROUT) - out)


def _noise(rng: np.random.Generator, n: int, slope: float) -> Floats:
    """Repeating clouds of mean 0 and deviation 1; amplitudes fall with frequency to the power of `slope`."""
    f = np.hypot(*np.meshgrid(np.fft.fftfreq(n, 1 / n), np.fft.rfftfreq(n, 1 / n), indexing="ij"))
    spectrum = np.exp(2j * np.pi * rng.random(f.shape)) * np.where(f > 1.5, np.maximum(f, 1) ** -slope, 0)
    wave = np.fft.irfft2(spectrum, (n, n))
    return np.asarray(wave / wave.std())
