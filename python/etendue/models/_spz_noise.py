"""Fields of noise that repeat, and what the atrium's pictures are painted with."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike, NDArray

Field = NDArray[np.float32]

_LINEAR = np.linspace(0, 1, 4096)
_SRGB: Field = np.where(
    _LINEAR <= 0.0031308, 12.92 * _LINEAR, 1.055 * np.maximum(_LINEAR, 1e-6) ** (1 / 2.4) - 0.055
).astype(np.float32)


def cloud(shape: tuple[int, int], seed: int, slope: float = 2.0, low: float = 1.0, high: float = 1e9,
          stretch: tuple[float, float] = (1, 1)) -> Field:  # fmt: skip
    """Repeating noise (h, w) with mean 0 and deviation 1, its spectrum falling as frequency^-slope.

    `low` and `high` bound the frequencies in cycles per texture; `stretch` lengthens features along (y, x).
    """
    h, w = shape
    # Slow noise is made small and spread out.
    if high * 8 <= min(h, w) and h % 2 == w % 2 == 0:
        return _doubled(cloud((h // 2, w // 2), seed, slope, low, high, stretch))
    rng = np.random.default_rng(seed)
    fy = np.fft.fftfreq(h, 1 / h)[:, None].astype(np.float32) * np.float32(stretch[0])
    fx = np.fft.rfftfreq(w, 1 / w)[None, :].astype(np.float32) * np.float32(stretch[1])
    f = np.sqrt(fy**2 + fx**2)
    amplitude = np.where((f >= low) & (f <= high), np.maximum(f, 1e-3) ** np.float32(-slope), 0)
    spectrum = amplitude * np.exp(2j * np.pi * rng.random(f.shape, dtype=np.float32)).astype(np.complex64)
    field = np.fft.irfft2(spectrum, s=shape).astype(np.float32)
    return np.asarray((field - field.mean()) / max(float(field.std()), 1e-12), np.float32)


def _doubled(field: Field) -> Field:
    """Twice as many rows and columns, linear in between, repeating."""
    for axis in (0, 1):
        before, after = np.roll(field, 1, axis), np.roll(field, -1, axis)
        pair = np.stack([0.75 * field + 0.25 * before, 0.75 * field + 0.25 * after], axis + 1)
        field = pair.reshape([n * 2 if k == axis else n for k, n in enumerate(field.shape)])
    return field


def grid(shape: tuple[int, int]) -> tuple[Field, Field]:
    """u to the right and v upwards at pixel centres, each in [0, 1], arrays (h, w) with row 0 at the top."""
    h, w = shape
    u = (np.arange(w, dtype=np.float32) + 0.5) / w
    v = 1 - (np.arange(h, dtype=np.float32) + 0.5) / h
    return np.broadcast_to(u, shape), np.broadcast_to(v[:, None], shape)


def step(low: float, high: float, x: ArrayLike) -> Field:
    """0 below `low`, 1 above `high`, smooth between."""
    t = np.clip((np.asarray(x, np.float32) - low) / (high - low), 0, 1)
    return np.asarray(t * t * (3 - 2 * t), np.float32)


def mix(a: ArrayLike, b: ArrayLike, t: Field) -> Field:
    """Colours a to b ((3,) or (h, w, 3)) as t (h, w) goes from 0 to 1."""
    a, b = np.asarray(a, np.float32), np.asarray(b, np.float32)
    return np.asarray(a + (b - a) * t[..., None], np.float32)


def normals(height: Field, scale: float) -> Field:
    """A tangent-space normal map (h, w, 3) in [0, 1] of a repeating height; `scale` is its relief."""
    dx = (np.roll(height, -1, 1) - np.roll(height, 1, 1)) * 0.5 * scale
    dv = (np.roll(height, 1, 0) - np.roll(height, -1, 0)) * 0.5 * scale
    n = np.stack([-dx, -dv, np.ones_like(dx)], 2)
    n /= np.linalg.norm(n, axis=2, keepdims=True)
    return np.asarray(0.5 + 0.5 * n, np.float32)


def save(path: Path, pixels: Field, linear: bool = False) -> str:
    """Writes an 8-bit PNG of values in [0, 1] (h, w, 3 or 4) and gives back its name.

    Colours are linear and become sRGB, except where `linear` says that they are numbers to be kept.  A fourth
    channel is opacity and is kept.
    """
    import OpenImageIO as oiio

    p = np.clip(np.asarray(pixels, np.float32), 0, 1)
    if not linear:
        p = np.concatenate([_SRGB[np.rint(p[..., :3] * 4095).astype(np.int16)], p[..., 3:]], 2)
    h, w, channels = p.shape
    spec = oiio.ImageSpec(w, h, channels, oiio.UINT8)
    spec.attribute("png:compressionLevel", 1)
    path.parent.mkdir(parents=True, exist_ok=True)
    out = oiio.ImageOutput.create(str(path))
    if (
        out is None
        or not out.open(str(path), spec)
        or not out.write_image(np.ascontiguousarray(np.rint(255 * p), np.uint8))
    ):
        raise OSError(f"{path}: cannot be written: {oiio.geterror() if out is None else out.geterror()}")
    out.close()
    return path.name
