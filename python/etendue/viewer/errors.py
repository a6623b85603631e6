"""How far a film is from its limit, as one number."""

from __future__ import annotations

import numpy as np

from ..film import Film

_LUMINANCE = np.array([0.2126, 0.7152, 0.0722])


def relative_error(film: Film) -> float | None:
    """Root mean square of the pixels' standard errors over the image's mean, in luminance; None: unknown yet."""
    valid = (film.sample_count - film.invalid_per_pixel).astype(np.float64)[..., None]
    if not (valid > 1).all():
        return None
    of_mean = np.maximum(film.sum_squares - film.sum**2 / valid, 0) / (valid - 1) / valid
    mean = float((film.sum / valid).mean(axis=(0, 1)) @ _LUMINANCE)
    return float(np.sqrt((np.sqrt(of_mean) @ _LUMINANCE) ** 2).mean() / mean) if mean > 0 else None
