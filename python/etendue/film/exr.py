"""OpenEXR files of 32-bit words: floats and unsigned integers side by side, and attributes.

OpenImageIO writes and reads them. From Python it takes pixels of one type only, so all channels are given to
it as floats, whose bits it leaves alone, and those that are integers are then named so in the file's header;
the two types are stored alike.
"""

from __future__ import annotations

import os
import struct
import tempfile
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any, BinaryIO

import numpy as np
from numpy.typing import NDArray

from ..errors import EtendueError

_PREFIX = "etendue:"
_UINT = struct.pack("<i", 0)


@contextmanager
def encoded(
    words: NDArray[np.uint32],
    channels: Sequence[str],
    integers: Collection[str],
    attributes: Mapping[str, str | int | float],
    compression: str,
) -> Iterator[BinaryIO]:
    """An open file, in memory where the system has such, with the EXR of `words` (height, width, channel).

    Encoded apart from its place, because OpenImageIO does not tell of every write that fails. OSError where
    that fails here.
    """
    with _scratch() as (path, file):
        import OpenImageIO as oiio

        height, width, _ = words.shape
        spec = oiio.ImageSpec(width, height, len(channels), oiio.FLOAT)
        spec.channelnames = tuple(channels)
        spec.attribute("oiio:ColorSpace", "lin_rec709_scene")
        spec.attribute("Software", "Étendue")
        spec.attribute("compression", compression)
        for name, value in attributes.items():
            # Integers of OpenEXR have 32 bits.
            is_long = isinstance(value, int) and abs(value) >= 2**31
            spec.attribute(f"{_PREFIX}{name}", str(value) if is_long else value)
        target = oiio.ImageOutput.create("exr")
        if target is None:
            raise OSError(_first_line(oiio.geterror()))
        written = target.open(str(path), spec) and target.write_image(words.view(np.float32))
        reason = target.geterror()
        if not target.close() or not written:
            raise OSError(_first_line(reason or target.geterror()))
        _declare(file, integers)
        file.seek(0)
        yield file


def decoded(
    path: Path,
    channels_of: Callable[[dict[str, Any]], Sequence[str]],
    integers: Collection[str],
    refuse_others: Callable[[Path, dict[str, Any]], None],
) -> tuple[dict[str, Any], NDArray[np.uint32]]:
    """The attributes and words of an EXR file that `encoded` made; which channels it has follows from the former.

    `refuse_others` sees the attributes first and refuses what is something else. EtendueError for whatever
    keeps the file from being read.
    """
    import OpenImageIO as oiio

    source, notes = _opened(path, refuse_others)
    try:
        spec, channels = source.spec(), channels_of(notes)
        names = list(spec.channelnames)
        if sorted(names) != sorted(channels):
            raise EtendueError(f"{path}: the film is damaged (its channels are not those of a film)")
        # Channels of one type are neighbours, those of colours first; each run is read as what it is.
        runs = [name in integers for name in names]
        if runs != sorted(runs):
            raise EtendueError(f"{path}: the film is damaged (its channels are out of order)")
        split = runs.index(True)
        parts = []
        for first, end, kind in ((0, split, oiio.FLOAT), (split, len(names), oiio.UINT)):
            pixels = source.read_image(0, 0, first, end, kind)
            if pixels is None or source.has_error:
                raise EtendueError(f"{path}: cannot be read: {_first_line(source.geterror())}")
            parts.append(np.ascontiguousarray(pixels).view(np.uint32))
    finally:
        source.close()
    words = np.concatenate(parts, axis=2)
    order = [names.index(name) for name in channels]
    return notes, np.ascontiguousarray(words[..., order])


def attributes(path: Path, refuse_others: Callable[[Path, dict[str, Any]], None]) -> dict[str, Any]:
    """The attributes of a file, as `decoded` gives them."""
    source, notes = _opened(path, refuse_others)
    source.close()
    return notes


def _opened(path: Path, refuse_others: Callable[[Path, dict[str, Any]], None]) -> tuple[Any, dict[str, Any]]:
    import OpenImageIO as oiio

    try:
        with path.open("rb"):
            pass
    except OSError as error:
        raise EtendueError(f"{path}: cannot be read: {error.strerror or error}") from None
    source = oiio.ImageInput.open(str(path))
    if source is None:
        raise EtendueError(f"{path}: cannot be read: {_first_line(oiio.geterror())}")
    found = source.spec().extra_attribs
    notes = {item.name.removeprefix(_PREFIX): item.value for item in found if item.name.startswith(_PREFIX)}
    try:
        refuse_others(path, notes)
    except EtendueError:
        source.close()
        raise
    return source, notes


@contextmanager
def _scratch() -> Iterator[tuple[Path, BinaryIO]]:
    if hasattr(os, "memfd_create"):
        with open(os.memfd_create("film"), "r+b") as memory:
            yield Path(f"/proc/self/fd/{memory.fileno()}"), memory
        return
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder, "film.exr")
        path.touch()
        with path.open("r+b") as file:
            yield path, file


def _declare(file: BinaryIO, integers: Collection[str]) -> None:
    """Sets the type of the channels `integers` in the header: a list of name, type, and six more numbers."""
    file.seek(8)
    while name := _text(file):
        _text(file)
        (size,) = struct.unpack("<i", file.read(4))
        if name != "channels":
            file.seek(size, os.SEEK_CUR)
            continue
        while channel := _text(file):
            if channel in integers:
                file.write(_UINT)
                file.seek(12, os.SEEK_CUR)
            else:
                file.seek(16, os.SEEK_CUR)


def _text(file: BinaryIO) -> str:
    """A text up to its zero byte."""
    found = bytearray()
    while (byte := file.read(1)) not in (b"\0", b""):
        found += byte
    return found.decode()


def _first_line(text: str) -> str:
    return text.strip().split("\n")[0] or "the image library gives no reason"
