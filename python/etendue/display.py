"""From linear radiance to what a screen shows."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray


def linear_to_srgb(linear: NDArray[np.floating[Any]]) -> NDArray[np.float32]:
    """The sRGB transfer function (IEC 61966-2-1) of `linear`, of any shape; values below 0 count as 0."""
    values = np.maximum(np.asarray(linear, np.float32), 0)
    return np.where(values <= 0.0031308, 12.92 * values, 1.055 * values ** (1 / 2.4) - 0.055).astype(
        np.float32
    )


def srgb_to_linear(encoded: NDArray[np.floating[Any]]) -> NDArray[np.float32]:
    """The inverse of `linear_to_srgb`; `encoded` is 0..1, of any shape."""
    values = np.maximum(np.asarray(encoded, np.float32), 0)
    return np.where(values <= 0.04045, values / 12.92, ((values + 0.055) / 1.055) ** 2.4).astype(np.float32)


def tonemap(image: NDArray[np.floating[Any]], exposure: float = 1.0) -> NDArray[np.uint8]:
    """`image`, linear radiance of any shape, times `exposure`, clipped to 0..1, as 8-bit sRGB, rounded.

    Infinity is white, NaN black.
    """
    exposed = np.nan_to_num(
        np.asarray(image, np.float32) * np.float32(exposure), nan=0.0, posinf=1.0, neginf=0.0
    )
    return np.rint(linear_to_srgb(np.clip(exposed, 0, 1)) * 255).astype(np.uint8)
