"""What a render gives: the image, how it came about, and files of it."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Mapping
from dataclasses import dataclass, field
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from . import outputs
from .display import tonemap
from .errors import EtendueError, nearest_name

if TYPE_CHECKING:
    from ._core import Renderer

_LINEAR, _DISPLAY = (".exr", ".hdr"), (".png", ".jpg", ".jpeg")
_JPEG_QUALITY = 95
Attribute = str | int | float


@dataclass
class Film:
    """The result of `Scene.render`.

    image: float32 (height, width, 3), mean linear radiance, row 0 at the top; 0 where there is no sample yet.
    sample_count: uint64 (height, width), samples taken in each pixel.
    sum, sum_squares: float64 (height, width, 3), of the valid samples.
    rays: rays traced, shadow rays included. seconds: time spent rendering.
    invalid: (x, y, sample) of samples that were no finite radiance, the first thousand; invalid_count: all.
    complete: whether every pixel has the samples asked for. interrupted: whether Ctrl-C is why not.
    exposure: factor for display, by default that of the scene file.
    attributes: how the image was made, written into EXR files.
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

    @classmethod
    def of(cls, renderer: Renderer, **how: Any) -> Film:
        """The film of a renderer as it stands; `how` gives the fields that the renderer does not know."""
        return cls(
            renderer.mean(),
            renderer.sample_count(),
            renderer.sum(),
            renderer.sum_squares(),
            renderer.rays,
            renderer.seconds,
            list(renderer.invalid),
            renderer.invalid_count,
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
    def variance(self) -> NDArray[np.float32]:
        """float32 (height, width, 3): estimated variance of one sample of each pixel; NaN below two samples.

        Divided by `sample_count` it is the variance of `image`.
        """
        count = self.sample_count[..., None].astype(np.float64)
        with np.errstate(divide="ignore", invalid="ignore"):
            spread = (self.sum_squares - self.sum**2 / count) / (count - 1)
        return np.where(count > 1, np.maximum(spread, 0), np.nan).astype(np.float32)

    def tonemapped(self, exposure: float | None = None) -> NDArray[np.uint8]:
        """uint8 (height, width, 3): the exposed image in sRGB."""
        return tonemap(self.image, self.exposure if exposure is None else exposure)

    def save(
        self,
        path: str | PathLike[str],
        exposure: float | None = None,
        attributes: Mapping[str, Attribute] | None = None,
    ) -> None:
        """Write the image: .exr (float32) and .hdr linear, .png and .jpg exposed in 8-bit sRGB.

        EXR files carry `self.attributes` and the given ones. A file that is there before is replaced once the
        new one is whole. Raises EtendueError for an unknown extension and for whatever keeps the file from
        being written.
        """
        file = Path(path)
        suffix = file.suffix.lower()
        if suffix not in (*_LINEAR, *_DISPLAY):
            near = nearest_name(suffix, (*_LINEAR, *_DISPLAY)) if suffix else None
            hint = f'did you mean "{near}"? ' if near else ""
            allowed = ", ".join((*_LINEAR, *_DISPLAY))
            raise EtendueError(f'{file}: unknown kind of image "{file.suffix}" ({hint}allowed: {allowed})')
        pixels = self.image if suffix in _LINEAR else self.tonemapped(exposure)
        notes = {**self.attributes, **(attributes or {})} if suffix == ".exr" else {}
        data = _encoded(file, pixels, notes)
        outputs.write(file, lambda temporary: _store(temporary, data))


def _store(path: Path, data: bytes) -> None:
    path.write_bytes(data)


def _encoded(path: Path, pixels: NDArray[Any], attributes: Mapping[str, Attribute]) -> bytes:
    """The content of the image file `path`.

    Encoded in memory, because on a full disk the libraries behind OpenImageIO leave half a PNG file without a
    word, and end the process over a JPEG file.
    """
    name = path.suffix.lower()
    try:
        if not hasattr(os, "memfd_create"):
            with tempfile.TemporaryDirectory() as folder:
                place = Path(folder, f"image{name}")
                _encode(place, name, pixels, attributes)
                return place.read_bytes()
        with open(os.memfd_create("image"), "rb") as memory:
            _encode(Path(f"/proc/self/fd/{memory.fileno()}"), name, pixels, attributes)
            return memory.read()
    except OSError as error:
        raise EtendueError(f"{path}: cannot be written: {error.strerror or error}") from error


def _encode(path: Path, suffix: str, pixels: NDArray[Any], attributes: Mapping[str, Attribute]) -> None:
    import OpenImageIO as oiio

    height, width, channels = pixels.shape
    is_linear = pixels.dtype == np.float32
    spec = oiio.ImageSpec(width, height, channels, oiio.FLOAT if is_linear else oiio.UINT8)
    spec.attribute("oiio:ColorSpace", "lin_rec709_scene" if is_linear else "srgb_rec709_scene")
    spec.attribute("Software", "Étendue")
    if suffix == ".exr":
        spec.attribute("compression", "zip")
    if suffix in (".jpg", ".jpeg"):
        spec.attribute("Compression", f"jpeg:{_JPEG_QUALITY}")
        spec.attribute("jpeg:subsampling", "4:4:4")
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
