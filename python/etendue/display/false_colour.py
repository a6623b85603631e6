"""One number a pixel as a colour, with a scale beside the image that says which is which."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..errors import EtendueError
from ..film import Film
from ..film.error import TILE
from . import linear_to_srgb

QUANTITIES = ("variance", "relative-error", "tile-error", "samples")
_LUMINANCE = np.array([0.2126, 0.7152, 0.0722])
_UNDEFINED = 0.25
# From dark to light in even steps of lightness, apart for all kinds of colour vision (viridis).
_STOPS = np.array(
    [
        *((68, 1, 84), (72, 40, 120), (62, 73, 137), (49, 104, 142), (38, 130, 142)),
        *((31, 158, 137), (53, 183, 121), (110, 206, 88), (181, 222, 43), (253, 231, 37)),
    ],
    np.float64,
)


def quantity(film: Film, name: str) -> NDArray[np.float64]:
    """float64 (height, width): NaN where the film does not know.

    "variance" is the mean of the three channels' estimated variance of the pixel's mean, "relative-error" the
    standard error of the pixel's luminance over that luminance, taking the channels' errors to go together,
    "tile-error" that of the tile, which beauty renders go by (`Film.error`), "samples" the number of samples taken.
    """
    if name not in QUANTITIES:
        raise EtendueError(f'there is no quantity "{name}" to show (allowed: {", ".join(QUANTITIES)})')
    valid = (film.sample_count - film.invalid_per_pixel).astype(np.float64)
    if name == "samples":
        return film.sample_count.astype(np.float64)
    if name == "tile-error":
        height, width = film.sample_count.shape
        tiles = film.error.tiles.repeat(TILE, axis=0).repeat(TILE, axis=1)[:height, :width]
        return np.where(np.isfinite(tiles), tiles, np.nan)
    count = np.where(valid > 1, valid, np.nan)[..., None]
    of_mean = np.maximum(film.sum_squares - film.sum**2 / count, 0) / (count - 1) / count
    if name == "variance":
        return of_mean.mean(axis=2)
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.sqrt(of_mean) @ _LUMINANCE / (film.sum / count @ _LUMINANCE)


def picture(
    values: NDArray[np.float64], title: str, limits: tuple[float, float] | None = None
) -> NDArray[np.uint8]:
    """uint8 (height', width', 3): `values` in colours, logarithmic, with the scale at the right.

    limits: values of the darkest and the lightest colour, by default those between which 98% of the values
    above 0 lie. Grey is where there is no number; below and above the limits, the last colours go on.
    """
    limits = limits or limits_of(values)
    return np.concatenate([coloured(values, limits), _scale(values.shape[0], *limits, title)], axis=1)


def coloured(values: NDArray[np.float64], limits: tuple[float, float]) -> NDArray[np.uint8]:
    """uint8 (..., 3): `values` in the colours of `picture`, without the scale."""
    low, high = limits
    with np.errstate(divide="ignore", invalid="ignore"):
        position = (
            np.log(values / low) / math.log(high / low) if high > low else np.where(values < low, 0.0, 1.0)
        )
    return _coloured(np.where(np.isnan(values), np.nan, position))


def limits_of(values: NDArray[np.float64]) -> tuple[float, float]:
    """The values between which 98% of those above 0 lie."""
    usable = values[np.isfinite(values) & (values > 0)]
    if usable.size == 0:
        return 1.0, 1.0
    low, high = np.percentile(usable, [1, 99])
    return float(low), float(high)


def _coloured(position: NDArray[np.float64]) -> NDArray[np.uint8]:
    place = np.clip(np.nan_to_num(position, nan=0.0, posinf=1.0, neginf=0.0), 0, 1) * (len(_STOPS) - 1)
    steps = np.arange(len(_STOPS))
    colours = np.stack([np.interp(place, steps, _STOPS[:, channel]) for channel in range(3)], axis=-1)
    grey = 255 * float(linear_to_srgb(np.array([_UNDEFINED]))[0])
    return np.rint(np.where(np.isnan(position)[..., None], grey, colours)).astype(np.uint8)


def _scale(height: int, low: float, high: float, title: str) -> NDArray[np.uint8]:
    """A bar with its values, as high as the image; text only where there is room for it."""
    size = max(8, min(24, height // 20))
    bar, width = size, size * 7
    margin = min(2 * size, height // 4)
    column = np.linspace(1, 0, max(1, height - 2 * margin))
    panel = np.zeros((height, bar + width, 3), np.uint8)
    panel[margin : margin + len(column), size // 2 : size // 2 + bar] = _coloured(column)[:, None]
    if height < 4 * size:
        return panel
    ticks = [low, math.sqrt(low * high), high] if high > low else [low]
    lines = [(title, size, size // 2)]
    for index, tick in enumerate(ticks):
        along = 1 - index / (len(ticks) - 1) if len(ticks) > 1 else 0.0
        y = margin + along * (len(column) - 1) + size * 0.35
        lines.append((f"{tick:.3g}", round(y), 2 * size + size // 4))
    return _with_text(panel, lines, size)


def _with_text(panel: NDArray[np.uint8], lines: list[tuple[str, int, int]], size: int) -> NDArray[np.uint8]:
    import OpenImageIO as oiio

    image = oiio.ImageBuf(np.ascontiguousarray(panel, np.float32) / 255)
    for text, y, x in lines:
        # Without a font, the panel has no text.
        if not oiio.ImageBufAlgo.render_text(image, x, y, text, size, "", (1.0, 1.0, 1.0)):
            oiio.geterror()
    pixels: Any = image.get_pixels(oiio.FLOAT)
    return np.rint(np.clip(pixels, 0, 1) * 255).astype(np.uint8)
