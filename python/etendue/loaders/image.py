"""Image files: textures and environment maps."""

from __future__ import annotations

from os import PathLike
from pathlib import Path
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from ..display import srgb_to_linear
from ..errors import EtendueError
from . import cache
from .types import Image

Kind = Literal["colour", "linear", "normal", "environment"]

# Channels that differ by no more than what JPEG does to grey are equal: the image holds heights.
_GREY = 8  # of 255
# A header may claim any size. Pixels that take more than this as floats must be borne out by the file's own size;
# the best that PNG's and EXR's compression can do is a factor of 4128.
_LARGE, _BEST_COMPRESSION = 1 << 28, 5000
# Smaller files are read in a moment.
_LARGE_FILE = 1 << 18
# Slope of a surface whose height rises from black to white over one texel.
_HEIGHT = 4.0


def load_image(path: str | PathLike[str], kind: Kind = "colour", warnings: list[str] | None = None) -> Image:
    """The pixels of an image file, row 0 at the top.

    kind:
        "colour": 8-bit files stay uint8 and sRGB; all others become float32 and linear.
        "linear": data rather than colour (opacity); 8-bit files stay uint8, nothing is converted.
        "normal": as "linear", (h, w, 3); an image whose channels are equal is a height map and is converted.
        "environment": float32 (h, w, 3), linear, without negative or infinite pixels (`warnings` says so).
    Raises EtendueError for a file that is missing, broken, or of a kind that is not known.
    """
    file, notes = Path(path), list[str]()
    stamp = cache.stamp_of(file, _LARGE_FILE)
    image = None if stamp is None else _kept(file, kind, stamp, notes)
    if image is None:
        image = _image(file, kind, notes)
        if stamp is not None:
            from ..film.fingerprint import of_image

            image.digest = of_image(image)
            about = {
                "srgb": image.srgb,
                "digest": image.digest,
                "notes": [note.removeprefix(str(file)) for note in notes],
            }
            cache.keep(file, stamp, about, [image.pixels], kind)
    if warnings is not None:
        warnings += notes
    return image


def _kept(file: Path, kind: Kind, stamp: cache.Stamp, notes: list[str]) -> Image | None:
    found = cache.find(file, stamp, kind)
    if found is None:
        return None
    about, (pixels,) = found
    notes += [f"{file}{note}" for note in about["notes"]]
    return Image(pixels, about["srgb"], str(file), about["digest"])


def _image(file: Path, kind: Kind, warnings: list[str]) -> Image:
    pixels, colour_space = _read(file)
    is_srgb = pixels.dtype != np.float32 if colour_space is None else colour_space == "srgb"
    if kind == "environment":
        return Image(_environment(file, _linear(_colour(pixels), is_srgb), warnings), False, str(file))
    if kind == "normal":
        return Image(_normal_map(pixels), False, str(file))
    if kind == "linear":
        return Image(pixels if pixels.dtype == np.uint8 else _as_float(pixels), False, str(file))
    if pixels.dtype == np.uint8 and is_srgb:
        return Image(pixels, True, str(file))
    return Image(_linear(pixels, is_srgb), False, str(file))


def _open(file: Path) -> Any:
    import OpenImageIO as oiio

    if not file.is_file():
        raise EtendueError(f"{file}: no such file")
    # Colours stay as they are in the file where alpha is 0, and files that lie about their size are refused.
    wish = oiio.ImageSpec()
    wish["oiio:UnassociatedAlpha"] = 1
    oiio.attribute("limits:imagesize_MB", 8192)
    source = oiio.ImageInput.open(str(file), wish)
    if source is None:
        raise EtendueError(f"{file}: not an image that can be read: {_first_line(oiio.geterror())}")
    spec = source.spec()
    needed = spec.width * spec.height * max(spec.depth, 1) * spec.nchannels * 4
    if needed > max(_LARGE, _BEST_COMPRESSION * file.stat().st_size):
        source.close()
        size = f"{spec.width} x {spec.height} pixels of {spec.nchannels} channels"
        raise EtendueError(
            f"{file}: the image is damaged: its {file.stat().st_size} bytes cannot hold {size}"
        )
    return source


def _read(file: Path) -> tuple[NDArray[Any], str | None]:
    """Pixels (h, w, 1|3|4) as uint8, uint16 or float32, and the colour space where the file tells one."""
    try:
        return _decoded(file)
    except UnicodeDecodeError:
        # The library passes on names, and messages about them, whose bytes are no text.
        raise EtendueError(
            f"{file}: not an image that can be read: it holds text that is not UTF-8"
        ) from None


def _decoded(file: Path) -> tuple[NDArray[Any], str | None]:
    import OpenImageIO as oiio

    source = _open(file)
    spec = source.spec()
    kinds = {"uint8": oiio.UINT8, "uint16": oiio.UINT16}
    try:
        pixels = source.read_image(0, 0, 0, spec.nchannels, kinds.get(str(spec.format), oiio.FLOAT))
        error = source.geterror()
    finally:
        source.close()
    if pixels is None or error:
        raise EtendueError(f"{file}: the image is damaged: {_first_line(error)}")
    if pixels.ndim != 3:
        raise EtendueError(f"{file}: the image is not flat (it has {pixels.ndim} dimensions; 2 are allowed)")
    name = spec.get_string_attribute("oiio:ColorSpace").lower()
    space = "srgb" if "srgb" in name and "lin" not in name else "linear" if "lin" in name else None
    return np.ascontiguousarray(_chosen_channels(pixels, list(spec.channelnames))), space


def _first_line(error: str) -> str:
    return error.strip().split("\n")[0] or "unknown format"


def _chosen_channels(pixels: NDArray[Any], names: list[str]) -> NDArray[Any]:
    """One, three or four of the channels; grey with alpha becomes R, G, B, A."""
    if all(name in names for name in "RGB"):
        wanted = [*"RGBA"] if "A" in names else [*"RGB"]
        if names == wanted:
            return pixels
        return pixels[:, :, [names.index(name) for name in wanted]]
    count = pixels.shape[2]
    if count == 2:
        return pixels[:, :, [0, 0, 0, 1]] if names[1] == "A" else pixels[:, :, :1]
    return pixels if count in (1, 3, 4) else pixels[:, :, :3]


def _as_float(pixels: NDArray[Any]) -> NDArray[np.float32]:
    if pixels.dtype == np.float32:
        return pixels
    return (pixels / np.float32(np.iinfo(pixels.dtype).max)).astype(np.float32)


def _linear(pixels: NDArray[Any], is_srgb: bool) -> NDArray[np.float32]:
    values = _as_float(pixels)
    if not is_srgb:
        return values
    return np.concatenate([srgb_to_linear(values[:, :, :3]), values[:, :, 3:]], axis=2)


def _colour(pixels: NDArray[Any]) -> NDArray[Any]:
    return pixels[:, :, [0, 0, 0]] if pixels.shape[2] == 1 else pixels[:, :, :3]


def _environment(file: Path, pixels: NDArray[np.float32], warnings: list[str]) -> NDArray[np.float32]:
    finite = np.isfinite(pixels)
    bad = ~finite | (pixels < 0)
    if bad.any():
        count = int(bad.any(axis=2).sum())
        warnings.append(
            f"{file}: {count} pixel(s) of the environment map are negative or not finite; "
            "infinite ones are set to the brightest finite value, all others to 0"
        )
        brightest = pixels[finite].max(initial=0)
        pixels = np.where(np.isposinf(pixels), brightest, np.where(bad, 0, pixels)).astype(np.float32)
    return np.ascontiguousarray(pixels)


def _normal_map(pixels: NDArray[Any]) -> NDArray[Any]:
    """A normal map, (h, w, 3); heights are converted, with the image repeating at its edges."""
    colour = _colour(pixels)
    whole = 1 if colour.dtype == np.float32 else np.iinfo(colour.dtype).max
    # Channel by channel, and before any becomes a float, which is twenty times as fast.
    red, green, blue = colour[..., 0], colour[..., 1], colour[..., 2]
    most = np.maximum(np.maximum(red, green), blue)
    spread = most - np.minimum(np.minimum(red, green), blue)
    if 255 * float(spread.max(initial=0)) > _GREY * whole:
        return np.ascontiguousarray(colour if colour.dtype == np.uint8 else _as_float(colour))
    height = _as_float(colour).mean(axis=2)
    along_u = (np.roll(height, -1, axis=1) - np.roll(height, 1, axis=1)) / 2
    # Rows count downwards, v upwards.
    along_v = (np.roll(height, 1, axis=0) - np.roll(height, -1, axis=0)) / 2
    normal = np.stack([-_HEIGHT * along_u, -_HEIGHT * along_v, np.ones_like(height)], axis=2)
    normal /= np.linalg.norm(normal, axis=2, keepdims=True)
    return np.rint((normal * 0.5 + 0.5) * 255).astype(np.uint8)
