"""Images packed for a page: small enough for ten of them, and exact enough to read pixels from.

A value becomes a half float with some bits of its mantissa (8: right to 0.25%) after a scale that makes the largest
fit. Red and blue are stored as differences of their bits from green's, bytes of one kind together, then deflated.
The page's script undoes it: page/report.js, unpack.
"""

from __future__ import annotations

import base64
import zlib
from typing import Any

import numpy as np
from numpy.typing import NDArray

_MANTISSA = 10
_LARGEST = 2.0**15


def packed(image: NDArray[Any], bits: int = 8) -> dict[str, Any]:
    """The image (height, width) or (height, width, 3), of finite values, as plain data for JSON.

    bits: of the mantissa that are kept, 0 to 9.
    """
    dropped = _MANTISSA - bits
    values = np.atleast_3d(np.asarray(image, np.float64))
    top = float(np.abs(values).max(initial=0))
    scale = 2.0 ** np.floor(np.log2(_LARGEST / top)) if top > 0 else 1.0
    half = (values * scale).astype(np.float16).view(np.uint16).astype(np.uint32)
    words = ((half + (1 << dropped >> 1)) >> dropped).astype(np.uint16)
    if words.shape[2] == 3:
        words[..., 0] -= words[..., 1]
        words[..., 2] -= words[..., 1]
    planes = np.ascontiguousarray(np.moveaxis(words, 2, 0)).astype("<u2")
    data = planes.view(np.uint8).reshape(-1, 2).T.tobytes()
    return {
        "channels": int(words.shape[2]),
        "dropped": dropped,
        "scale": float(1 / scale),
        "data": base64.b64encode(_deflated(data)).decode(),
    }


def _deflated(data: bytes) -> bytes:
    """By whichever is smaller: matches, for what is smooth, or runs alone, for noise."""
    runs = zlib.compressobj(1, zlib.DEFLATED, zlib.MAX_WBITS, 9, zlib.Z_RLE)
    return min(zlib.compress(data, 3), runs.compress(data) + runs.flush(), key=len)
