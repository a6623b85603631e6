"""What a render looks like on the way: the image, or what is known about it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .. import _core
from ..display import false_colour, tonemap
from ..film import Film

MOST_COARSE = 16


@dataclass(frozen=True)
class Look:
    """How a render is to be shown: one of `MODES`, and for the image exposure and one of `display.VIEWS`."""

    mode: str = "image"
    exposure: float = 1.0
    view: str = "srgb"


@dataclass(frozen=True)
class Picture:
    """Something to show.

    pixels: uint8 (h, w, 3), sRGB, of every stride-th pixel. scale: what the darkest and the lightest of the
    false colours stand for. number: another one for every picture.
    """

    pixels: NDArray[np.uint8]
    stride: int
    scale: tuple[float, float] | None
    number: int


@dataclass(frozen=True)
class Source:
    """A render to make pictures of: whose coarsest finished pass took every `stride`-th pixel."""

    renderer: _core.Renderer
    stride: int
    film: Callable[[], Film]


@dataclass(frozen=True)
class Mode:
    """A kind of picture: its name in the menu, what it shows, and the false_colour quantity, if it is one."""

    title: str
    summary: str
    quantity: str | None = None


MODES: dict[str, Mode] = {
    "image": Mode("Image", "The image as it converges."),
    "convergence": Mode(
        "Convergence heat map",
        "Standard error of each pixel's luminance, relative to it: bright is noisy.",
        "relative-error",
    ),
    "samples": Mode("Samples per pixel", "How many samples each pixel has.", "samples"),
    "variance": Mode("Variance", "Estimated variance of each pixel's mean.", "variance"),
}


def develop(source: Source, look: Look, number: int) -> Picture:
    """A picture of the render as it is at this moment."""
    quantity = MODES[look.mode].quantity
    if quantity is None:
        pixels = tonemap(source.renderer.picture(source.stride), look.exposure, look.view)
        return Picture(pixels, source.stride, None, number)
    values: Any = false_colour.quantity(source.film(), quantity)
    scale = false_colour.limits_of(values)
    return Picture(false_colour.coloured(values, scale), 1, scale, number)
