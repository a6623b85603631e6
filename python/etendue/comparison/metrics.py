"""How far an image is from the reference, as one number.

Every function takes linear radiance, float (height, width, 3), and a smaller number is a better image.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..display import tonemap
from .extras import needed

Image = NDArray[np.floating[Any]]

# Keeps black pixels of the reference from deciding alone (Rousselle et al. 2011, section 5).
EPSILON = 0.01
# The worst pixels that the trimmed error leaves out.
TRIMMED = 0.001
FORMULAS = {
    "MSE": "mean (I − R)²",
    "relMSE": f"mean (I − R)² / (R² + {EPSILON:g})",
    "trimmed relMSE": f"relMSE without the worst {TRIMMED:.1%} of pixels",
    "FLIP": "mean of FLIP (Andersson et al. 2020) between the exposed sRGB images",
}
LUMINANCE = np.array([0.2126, 0.7152, 0.0722])


def squared_error(image: Image, reference: Image) -> NDArray[np.float64]:
    """float64 (height, width): (I − R)², mean of the channels."""
    return np.square(image.astype(np.float64) - reference).mean(axis=2)


def relative_squared_error(image: Image, reference: Image) -> NDArray[np.float64]:
    """float64 (height, width): (I − R)² / (R² + 0.01), mean of the channels."""
    error = np.square(image.astype(np.float64) - reference)
    return (error / (np.square(reference, dtype=np.float64) + EPSILON)).mean(axis=2)


def trimmed_mean(values: NDArray[np.float64]) -> float:
    """The mean without the largest `TRIMMED` of all values, but for one at least."""
    kept = values.size - max(1, round(values.size * TRIMMED)) if values.size > 1 else 1
    return float(np.partition(values.ravel(), kept - 1)[:kept].mean())


def flip_map(image: Image, reference: Image, exposure: float) -> NDArray[np.float32]:
    """float32 (height, width), 0..1: the difference that is seen when one image replaces the other.

    FLIP 1.7 at its 67 pixels per degree, on the images as they are displayed: times `exposure`, clipped, sRGB.
    """
    flip = needed("flip_evaluator")
    shown = [tonemap(pixels, exposure).astype(np.float32) / 255 for pixels in (reference, image)]
    found, _, _ = flip.evaluate(*shown, "LDR", True, False, False)
    return np.asarray(found, np.float32)[..., 0]


def quick(image: Image, reference: Image) -> dict[str, float]:
    """The errors that take milliseconds: those along a curve."""
    relative = relative_squared_error(image, reference)
    return {
        "MSE": float(squared_error(image, reference).mean()),
        "relMSE": float(relative.mean()),
        "trimmed relMSE": trimmed_mean(relative),
    }


def sums(values: NDArray[np.float64], tile: int) -> NDArray[np.float64]:
    """float64 (rows, columns): sums of `values` (height, width) over square tiles; those at the edges are smaller."""
    rows = np.add.reduceat(values, np.arange(0, values.shape[0], tile), axis=0)
    return np.asarray(np.add.reduceat(rows, np.arange(0, values.shape[1], tile), axis=1))
