"""Images packed for a page: small enough for ten of them, and exact enough to read pixels from.

A value becomes a half float of 8 bits of mantissa (right to 0.25%) after a scale that makes the largest fit. Red and
blue are stored as differences of their bits from green's, bytes of one kind together, then deflated.
The page's script undoes it: page/report.js, unpack.
"""

from __future__ import annotations

import base64
import zlib
from typing import Any

import numpy as np
from numpy.typing import NDArray

_DROPPED_BITS = 2
_LARGEST = 2.0**15


def packed(image: NDArray[Any]) -> dict[str, Any]:
    """The image (height, width) or (height, width, 3), of finite values, as plain data for JSON."""
    values = np.atleast_3d(np.asarray(image, np.float64))
    top = float(np.abs(values).max(initial=0))
    scale = 2.0 ** np.floor(np.log2(_LARGEST / top)) if top > 0 else 1.0
    half = (values * scale).astype(np.float16).view(np.uint16).astype(np.uint32)
    bits = ((half + (1 << _DROPPED_BITS >> 1)) >> _DROPPED_BITS).astype(np.uint16)
    if bits.shape[2] == 3:
        bits[..., 0] -= bits[..., 1]
        bits[..., 2] -= bits[..., 1]
    planes = np.ascontiguousarray(np.moveaxis(bits, 2, 0)).astype("<u2")
    data = planes.view(np.uint8).reshape(-1, 2).T.tobytes()
    return {
        "channels": int(bits.shape[2]),
        "scale": float(1 / scale),
        "data": base64.b64encode(zlib.compress(data, 3)).decode(),
    }
