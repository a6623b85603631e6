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
from ..scene import Scene

MOST_COARSE = 16
_SURFACE_SAMPLES = 4
_ROWS = 32


Made = tuple[NDArray[np.uint8], int, "tuple[float, float] | None"]
Make = Callable[["Source", "Look"], Made]


class Stale(Exception):
    """What is being made is of something that is no longer shown."""


@dataclass(frozen=True)
class Look:
    """How a render is to be shown: one of `MODES`, and for the image exposure, one of `display.VIEWS`, denoised."""

    mode: str = "image"
    exposure: float = 1.0
    view: str = "srgb"
    denoised: bool = False


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
    """A render to make pictures of: whose coarsest finished pass took every `stride`-th pixel.

    surfaces: what the camera rays hit, by name, once it was asked for. go_on(fraction): raises Stale where the
    picture is no longer wanted.
    """

    scene: Scene
    renderer: _core.Renderer
    stride: int
    film: Callable[[], Film]
    surfaces: dict[str, NDArray[Any]]
    go_on: Callable[[float], object]


def _quantity(name: str) -> Make:
    def make(source: Source, look: Look) -> Made:
        return _false_colours(false_colour.quantity(source.film(), name))

    return make


def _image(source: Source, look: Look) -> Made:
    if look.denoised and source.stride == 1:
        image = source.scene.denoise(source.film(), progress=source.go_on).image
        return _toned(source, look, image), 1, None
    return _toned(source, look, source.renderer.picture(source.stride)), source.stride, None


def _toned(source: Source, look: Look, image: NDArray[np.float32]) -> NDArray[np.uint8]:
    """In parts that fit into caches, and after each of which it may end."""
    pixels = np.empty(image.shape, np.uint8)
    for first in range(0, len(image), _ROWS):
        source.go_on(first / len(image))
        part = slice(first, first + _ROWS)
        pixels[part] = tonemap(image[part], look.exposure, look.view)
    return pixels


def _albedo(source: Source, look: Look) -> Made:
    return tonemap(_surfaces(source)["albedo"]), 1, None


def _normal(source: Source, look: Look) -> Made:
    normal = _surfaces(source)["normal"]
    return np.rint(np.clip(normal * 0.5 + 0.5, 0, 1) * 255).astype(np.uint8), 1, None


def _depth(source: Source, look: Look) -> Made:
    depth = _surfaces(source)["depth"].astype(np.float64)
    return _false_colours(np.where(np.isfinite(depth), depth, np.nan))


def _surfaces(source: Source) -> dict[str, NDArray[Any]]:
    if not source.surfaces:
        config = source.scene.config
        found = _core.AovPass(
            source.scene.core, source.scene.camera(), config.sampler, config.filter, config.seed
        )
        found.render(0, _SURFACE_SAMPLES, source.go_on)
        source.surfaces.update({name: getattr(found, name)() for name in ("albedo", "normal", "depth")})
    return source.surfaces


def _false_colours(values: NDArray[Any]) -> Made:
    scale = false_colour.limits_of(values)
    return false_colour.coloured(values, scale), 1, scale


@dataclass(frozen=True)
class Mode:
    """A kind of picture: its name in the menu, what it shows, and how it is made."""

    title: str
    summary: str
    make: Make


MODES: dict[str, Mode] = {
    "image": Mode("Image", "The image as it converges.", _image),
    "convergence": Mode(
        "Convergence heat map",
        "Standard error of each pixel's luminance, relative to it: bright is noisy.",
        _quantity("relative-error"),
    ),
    "samples": Mode("Samples per pixel", "How many samples each pixel has.", _quantity("samples")),
    "albedo": Mode("Albedo", "The colour of what is seen first.", _albedo),
    "normal": Mode("Normal", "The shading normal of what is seen first: (x, y, z) as colours.", _normal),
    "depth": Mode("Depth", "How far away that is, along the view.", _depth),
    "variance": Mode("Variance", "Estimated variance of each pixel's mean.", _quantity("variance")),
}


def develop(source: Source, look: Look, number: int) -> Picture:
    """A picture of the render as it is at this moment; raises Stale."""
    pixels, stride, scale = MODES[look.mode].make(source, look)
    return Picture(pixels, stride, scale, number)
