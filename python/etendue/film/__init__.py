"""What a render gives: the image, the sums behind it, how it came about, and files of it."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from .. import outputs
from ..display import tonemap
from ..errors import EtendueError, nearest_name
from .sample_ranges import Range, count, hull

if TYPE_CHECKING:
    from .error import FilmError
    from .origin import Origin

_LINEAR, _DISPLAY = (".exr", ".hdr"), (".png", ".jpg", ".jpeg")
_JPEG_QUALITY = 95
MOST_INVALID_LISTED = 1000
Attribute = str | int | float


def mean_of(
    total: NDArray[np.float64], sample_count: NDArray[np.uint64], invalid: NDArray[np.uint64]
) -> NDArray[np.float32]:
    """float32 (height, width, 3): the mean of the valid samples; 0 where there is none."""
    valid = (sample_count - invalid)[..., None].astype(np.float64)
    return np.divide(total, valid, out=np.zeros_like(total), where=valid > 0).astype(np.float32)


def _nothing() -> NDArray[Any]:
    return np.zeros((0, 0, 3))


def _no_counts() -> NDArray[Any]:
    return np.zeros((0, 0), np.uint64)


@dataclass
class Film:
    """The result of `Scene.render`, of `read_film` and of `merge`.

    image: float32 (height, width, 3), mean linear radiance, row 0 at the top; 0 where there is no sample yet.
    sample_count: uint64 (height, width), samples taken in each pixel.
    sum, sum_squares: float64 (height, width, 3), of the valid samples.
    rays: rays traced, shadow rays included. seconds: time spent rendering.
    invalid: (x, y, sample) of samples that were no finite radiance, the first thousand; invalid_count: all.
    complete: whether every pixel has the samples asked for, or the bound is kept. interrupted: whether Ctrl-C is
    why it is not.
    exposure: factor for display, by default that of the scene file.
    attributes: how the image was made, written into EXR files.
    half_sum, half_count: float64 (height, width, 3) and uint64 (height, width), sum and number of the valid
    samples of one half: the first 8 of 16, and the first half of each further octave [2^k, 2^(k + 1)).
    invalid_per_pixel: uint64 (height, width), samples that are counted and not in the sums.
    ranges: the [first, end) of sample indices that every pixel has. partial: a range behind one of them that
    only some pixels have, each from its beginning on. goal: the range that the render was to fill.
    bound: the error that a beauty render is to reach, and its goal is what it has; None for all other films.
    origin: the scene and the settings; None for a film that no render gave.
    contributions: float64 (height, width, 2, 2, 3), the sums of what BSDF sampling and light sampling found over
    at most two edges and over more, which add up to `sum`; None where they were not kept apart.
    aovs: what else is known of each pixel, by the names of `aovs.AOVS`; layers of the EXR that `save` writes, and
    in no film file.
    """

    image: NDArray[np.float32]
    sample_count: NDArray[np.uint64]
    sum: NDArray[np.float64]
    sum_squares: NDArray[np.float64]
    rays: int = 0
    seconds: float = 0.0
    invalid: list[tuple[int, int, int]] = field(default_factory=list)
    invalid_count: int = 0
    complete: bool = True
    interrupted: bool = False
    exposure: float = 1.0
    attributes: dict[str, Attribute] = field(default_factory=dict)
    half_sum: NDArray[np.float64] = field(default_factory=_nothing)
    invalid_per_pixel: NDArray[np.uint64] = field(default_factory=_no_counts)
    half_count: NDArray[np.uint64] = field(default_factory=_no_counts)
    ranges: list[Range] = field(default_factory=list)
    partial: Range | None = None
    goal: Range = (0, 0)
    bound: float | None = None
    origin: Origin | None = None
    contributions: NDArray[np.float64] | None = None
    aovs: dict[str, NDArray[Any]] = field(default_factory=dict)

    @classmethod
    def empty(cls, width: int, height: int, **how: Any) -> Film:
        """A film without samples."""
        return cls(
            np.zeros((height, width, 3), np.float32),
            np.zeros((height, width), np.uint64),
            np.zeros((height, width, 3)),
            np.zeros((height, width, 3)),
            half_sum=np.zeros((height, width, 3)),
            invalid_per_pixel=np.zeros((height, width), np.uint64),
            half_count=np.zeros((height, width), np.uint64),
            **how,
        )

    @property
    def samples(self) -> int:
        """Samples taken in all pixels together."""
        return int(self.sample_count.sum())

    @property
    def spp(self) -> float:
        """Samples per pixel, the mean over the image where pixels differ."""
        return self.samples / self.sample_count.size

    @property
    def held(self) -> list[Range]:
        """All samples that the film has something of: `ranges` and `partial`."""
        return [*self.ranges, *([self.partial] if self.partial else [])]

    @property
    def missing(self) -> int:
        """Samples per pixel that the goal asks for and not every pixel has."""
        return self.goal[1] - self.goal[0] - count(self.ranges)

    def towards(self, goal: Range) -> Range:
        """`goal`, made large enough for what the film has already.

        Not for all that some pixels of a beauty render have, which may be more than anybody wants of all.
        """
        return hull([goal, *(self.held if self.bound is None else self.ranges)])

    @property
    def sharing(self) -> int:
        """How many pixels at most, all in one tile of 16 x 16, shared what their paths found, so that their noise is
        not independent; 1: none, or unknown, as of a film without an origin.
        """
        from .. import _core

        if self.origin is None:
            return 1
        try:
            return _core.sharing(self.origin.settings["algorithm"], self.origin.parameters)
        except ValueError:
            # Of another version, with other algorithms.
            return 1

    @property
    def error(self) -> FilmError:
        """How far the image is from what more samples would make of it: docs/beauty-render.md."""
        from .error import error_of

        return error_of(self)

    @property
    def variance(self) -> NDArray[np.float32]:
        """float32 (height, width, 3): estimated variance of one sample of each pixel; NaN below two samples.

        Divided by `sample_count` it is the variance of `image`.
        """
        count = self.sample_count[..., None].astype(np.float64)
        with np.errstate(divide="ignore", invalid="ignore"):
            spread = (self.sum_squares - self.sum**2 / count) / (count - 1)
        return np.where(count > 1, np.maximum(spread, 0), np.nan).astype(np.float32)

    def tonemapped(self, exposure: float | None = None, view: str = "srgb") -> NDArray[np.uint8]:
        """uint8 (height, width, 3): the exposed image through a view of `display.VIEWS`, in sRGB."""
        return tonemap(self.image, self.exposure if exposure is None else exposure, view)

    def write(self, path: str | PathLike[str]) -> None:
        """Write the film file: an EXR image, and all that it takes to go on from it and to merge it.

        A file that is there before is replaced once the new one is whole. Raises EtendueError for whatever
        keeps the file from being written.
        """
        from . import file as film_file

        film_file.write(self, Path(path))

    def save(
        self,
        path: str | PathLike[str],
        exposure: float | None = None,
        attributes: Mapping[str, Attribute] | None = None,
        view: str = "srgb",
    ) -> None:
        """Write the image: .exr (float32) and .hdr linear, .png and .jpg exposed, through `view`, in sRGB.

        EXR files carry `self.aovs` as further layers, `self.attributes` and the given ones. A file that is there
        before is replaced once the new one is whole. Raises EtendueError for an unknown extension and for
        whatever keeps the file from being written.
        """
        file = Path(path)
        suffix = file.suffix.lower()
        if suffix not in (*_LINEAR, *_DISPLAY):
            near = nearest_name(suffix, (*_LINEAR, *_DISPLAY)) if suffix else None
            hint = f'did you mean "{near}"? ' if near else ""
            allowed = ", ".join((*_LINEAR, *_DISPLAY))
            raise EtendueError(f'{file}: unknown kind of image "{file.suffix}" ({hint}allowed: {allowed})')
        pixels = self.image if suffix in _LINEAR else self.tonemapped(exposure, view)
        notes = {**self.attributes, **(attributes or {})}
        if suffix != ".exr":
            # Of an image that is only to be looked at, whether it is to be trusted.
            notes = {key: notes[key] for key in ("denoised", "biased") if key in notes}
        channels: list[str] = []
        if suffix == ".exr" and self.aovs:
            from . import aovs

            channels, values = aovs.layers(self.aovs)
            pixels = np.concatenate([self.image, *values], axis=2)
        save_pixels(file, pixels, notes, channels)


def save_pixels(
    file: Path,
    pixels: NDArray[np.float32] | NDArray[np.uint8],
    attributes: Mapping[str, Attribute],
    more_channels: Sequence[str] = (),
) -> None:
    """Write (height, width, 3) pixels, float32 as linear and uint8 as sRGB; raises EtendueError.

    more_channels: of EXR files, the names of those behind R, G and B.
    """
    data = encoded(file, pixels, attributes, more_channels)
    outputs.write(file, lambda temporary: _store(temporary, data))


def _store(path: Path, data: bytes) -> None:
    path.write_bytes(data)


def encoded(
    path: Path, pixels: NDArray[Any], attributes: Mapping[str, Attribute], more_channels: Sequence[str] = ()
) -> bytes:
    """The content of the image file `path`.

    Encoded in memory, because on a full disk the libraries behind OpenImageIO leave half a PNG file without a
    word, and end the process over a JPEG file.
    """
    name = path.suffix.lower()
    try:
        if not hasattr(os, "memfd_create"):
            with tempfile.TemporaryDirectory() as folder:
                place = Path(folder, f"image{name}")
                _encode(place, name, pixels, attributes, more_channels)
                return place.read_bytes()
        with open(os.memfd_create("image"), "rb") as memory:
            _encode(Path(f"/proc/self/fd/{memory.fileno()}"), name, pixels, attributes, more_channels)
            return memory.read()
    except OSError as error:
        raise EtendueError(f"{path}: cannot be written: {error.strerror or error}") from error


def _encode(
    path: Path,
    suffix: str,
    pixels: NDArray[Any],
    attributes: Mapping[str, Attribute],
    more_channels: Sequence[str],
) -> None:
    import OpenImageIO as oiio

    height, width, channels = pixels.shape
    is_linear = pixels.dtype == np.float32
    spec = oiio.ImageSpec(width, height, channels, oiio.FLOAT if is_linear else oiio.UINT8)
    spec.attribute("oiio:ColorSpace", "lin_rec709_scene" if is_linear else "srgb_rec709_scene")
    spec.attribute("Software", "Étendue")
    if more_channels:
        spec.channelnames = ("R", "G", "B", *more_channels)
    if suffix == ".exr":
        spec.attribute("compression", "zip")
    if suffix in (".jpg", ".jpeg"):
        spec.attribute("Compression", f"jpeg:{_JPEG_QUALITY}")
        spec.attribute("jpeg:subsampling", "4:4:4")
    if "denoised" in attributes:
        spec.attribute("ImageDescription", f"denoised by {attributes['denoised']}: biased")
    for name, value in attributes.items():
        # Integers of OpenEXR have 32 bits.
        is_long = isinstance(value, int) and abs(value) >= 2**31
        spec.attribute(f"etendue:{name}", str(value) if is_long else value)
    target = oiio.ImageOutput.create(suffix[1:])
    if target is None:
        raise OSError(_reason(oiio.geterror()))
    written = target.open(str(path), spec) and target.write_image(np.ascontiguousarray(pixels))
    reason = target.geterror()
    # What fails may not show before the file is closed.
    if not target.close() or not written:
        raise OSError(_reason(reason or target.geterror()))


def _reason(text: str) -> str:
    return text.strip().split("\n")[0] or "the image library gives no reason"
