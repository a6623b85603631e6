"""View transforms: exposed linear radiance, as bright as it may be, to what an sRGB screen is sent.

Each takes float32 (..., 3), linear with Rec. 709 primaries, at least 0 and finite, and gives float32 of the
same shape, encoded, to be clipped to 0..1. docs/films.md has the formulas and where they are from.
"""

from __future__ import annotations

import functools
from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from . import linear_to_srgb

Pixels = NDArray[np.float32]

_LUMINANCE = np.array([0.2126, 0.7152, 0.0722], np.float32)

# John Hable's filmic curve: shoulder, linear and toe strength, and the radiance that becomes white.
_SHOULDER, _LINEAR, _LINEAR_ANGLE, _TOE, _TOE_LOW, _TOE_HIGH = 0.15, 0.50, 0.10, 0.20, 0.02, 0.30
_HABLE_EXPOSURE, _HABLE_WHITE = 2.0, 11.2

# Troy Sobotka's AgX: primaries moved towards white by this part; stops around middle grey; the curve's middle
# value, slope there, and how sudden its toe and its shoulder are; the gamma that the curve is made for.
_AGX_INSET = 0.2
_AGX_GREY, _AGX_DARKEST, _AGX_BRIGHTEST = 0.18, -10.0, 6.5
_AGX_MIDDLE, _AGX_SLOPE, _AGX_TOE, _AGX_SHOULDER = 0.5, 2.0, 3.0, 3.25
_AGX_GAMMA = 2.2
_PRIMARIES, _WHITE = np.array([[0.64, 0.33], [0.30, 0.60], [0.15, 0.06]]), np.array([0.3127, 0.3290])

_ACES_DISPLAY = "sRGB - Display"


def srgb(linear: Pixels) -> Pixels:
    """Brighter than 1 is 1."""
    return linear_to_srgb(np.minimum(linear, 1))


def reinhard(linear: Pixels) -> Pixels:
    """Luminance L becomes L / (1 + L), with the colour kept."""
    luminance = linear @ _LUMINANCE
    return srgb(linear / (1 + luminance)[..., None])


def hable(linear: Pixels) -> Pixels:
    """A film's toe and shoulder, for each channel."""
    return srgb(_hable_curve(_HABLE_EXPOSURE * linear) / _hable_curve(np.float32(_HABLE_WHITE)))


def agx(linear: Pixels) -> Pixels:
    """A sigmoid in stops, in which bright colours turn white as on film."""
    inset = _agx_inset()
    mixed = np.maximum(linear.astype(np.float64) @ inset.T, 1e-12)
    stops = np.log2(mixed / _AGX_GREY)
    position = np.clip((stops - _AGX_DARKEST) / (_AGX_BRIGHTEST - _AGX_DARKEST), 0, 1)
    shown = _agx_curve(position) @ np.linalg.inv(inset).T
    return srgb((np.clip(shown, 0, 1) ** _AGX_GAMMA).astype(np.float32))


def aces(linear: Pixels) -> Pixels:
    """The newest ACES output transform for a screen that the OpenColorIO of OpenImageIO has."""
    import OpenImageIO as oiio

    flat = np.ascontiguousarray(linear.reshape(1, -1, 3))
    shown = oiio.ImageBufAlgo.ociodisplay(
        oiio.ImageBuf(flat),
        _ACES_DISPLAY,
        _aces_view(),
        fromspace="lin_rec709_scene",
        unpremult=False,
        # Whatever $OCIO says: the same image on every machine.
        colorconfig="ocio://default",
    )
    if shown.has_error:
        raise RuntimeError(shown.geterror())
    return np.asarray(shown.get_pixels(oiio.FLOAT), np.float32).reshape(linear.shape)


VIEWS: dict[str, Callable[[Pixels], Pixels]] = {
    "srgb": srgb,
    "reinhard": reinhard,
    "hable": hable,
    "aces": aces,
    "agx": agx,
}


def _hable_curve(x: Any) -> Any:
    over = x * (_SHOULDER * x + _LINEAR_ANGLE * _LINEAR) + _TOE * _TOE_LOW
    under = x * (_SHOULDER * x + _LINEAR) + _TOE * _TOE_HIGH
    return over / under - _TOE_LOW / _TOE_HIGH


@functools.cache
def _agx_inset() -> NDArray[np.float64]:
    """Linear Rec. 709 to the same colours with less of the pure ones in them."""
    inner = _WHITE + (1 - _AGX_INSET) * (_PRIMARIES - _WHITE)
    return np.asarray(np.linalg.solve(_to_xyz(_PRIMARIES), _to_xyz(inner)), np.float64)


def _to_xyz(primaries: NDArray[np.float64]) -> NDArray[np.float64]:
    def xyz(x: Any, y: Any) -> NDArray[np.float64]:
        return np.array([x / y, np.ones_like(y), (1 - x - y) / y])

    directions = xyz(primaries[:, 0], primaries[:, 1])
    scaled: NDArray[np.float64] = directions * np.linalg.solve(directions, xyz(*_WHITE))
    return scaled


def _agx_curve(position: NDArray[np.float64]) -> NDArray[np.float64]:
    middle = -_AGX_DARKEST / (_AGX_BRIGHTEST - _AGX_DARKEST)
    toe = _branch(middle - position, middle, _AGX_MIDDLE, _AGX_TOE)
    shoulder = _branch(position - middle, 1 - middle, 1 - _AGX_MIDDLE, _AGX_SHOULDER)
    return np.where(position < middle, _AGX_MIDDLE - toe, _AGX_MIDDLE + shoulder)


def _branch(way: NDArray[np.float64], whole: float, height: float, power: float) -> NDArray[np.float64]:
    """From 0 with the slope of the middle to `height` at `whole`, ever flatter."""
    rise = _AGX_SLOPE * np.maximum(way, 0)
    scale = ((height**-power) - (_AGX_SLOPE * whole) ** -power) ** (-1 / power)
    return rise / (1 + (rise / scale) ** power) ** (1 / power)


@functools.cache
def _aces_view() -> str:
    import OpenImageIO as oiio

    names = oiio.ColorConfig("ocio://default").getViewNames(_ACES_DISPLAY)
    return next(name for name in names if name.startswith("ACES"))
