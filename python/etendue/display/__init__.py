"""From linear radiance to what a screen shows."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..errors import EtendueError, nearest_name

# What counts as infinite: above all that is rendered, and far from where the curves overflow.
BRIGHTEST = 1e9


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


def tonemap(image: NDArray[np.floating[Any]], exposure: float = 1.0, view: str = "srgb") -> NDArray[np.uint8]:
    """`image`, linear radiance (..., 3), times `exposure`, through one of `VIEWS`, as 8-bit sRGB, rounded.

    Infinity is as bright as can be, NaN black. For "srgb", which is clipped to 0..1, `image` may be of any
    shape. Raises EtendueError for another view.
    """
    from . import views

    if view not in views.VIEWS:
        near = nearest_name(view, views.VIEWS)
        hint = f'did you mean "{near}"? ' if near else ""
        raise EtendueError(f'there is no view "{view}" ({hint}allowed: {", ".join(views.VIEWS)})')
    with np.errstate(over="ignore"):
        exposed = np.asarray(image, np.float32) * np.float32(exposure)
    finite = np.clip(np.nan_to_num(exposed, nan=0.0, posinf=BRIGHTEST, neginf=0.0), 0, BRIGHTEST)
    encoded = views.VIEWS[view](finite)
    return np.rint(np.clip(encoded, 0, 1) * 255).astype(np.uint8)
