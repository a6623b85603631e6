"""What took long to read from a file, kept as plain arrays in the user's cache.

An entry belongs to one file as it was: with another size, time stamp or inode it is read anew. Entries are written
whole or not at all and carry a checksum; whatever is wrong with one means that there is none. Where nothing can be
written, nothing is kept.
"""

from __future__ import annotations

import contextlib
import functools
import hashlib
import json
import math
import os
import tempfile
import time
import zlib
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..errors import EtendueError
from ..models import cache_folder

Stamp = list[int]
Arrays = list[NDArray[Any]]

VARIABLE = "ETENDUE_FILE_CACHE"
_MEGABYTES = 2048
# An entry: the checksum of what follows and the length of the JSON after it, eight digits each, that JSON, and arrays,
# each where a line of the processor's cache begins.
_ALIGNMENT = 64
# Two changes within so many nanoseconds may leave the same time stamp: FAT counts in steps of two seconds.
_UNSURE = 2_000_000_000


def folder() -> Path:
    """Where the entries are."""
    return cache_folder() / "files"


def size() -> int:
    """The bytes that all entries take."""
    return sum(info.st_size for _, info in _entries())


def limit() -> int:
    """The most bytes that all entries may take; 0 turns the cache off. Raises EtendueError."""
    text = os.environ.get(VARIABLE) or str(_MEGABYTES)
    if not (text.isascii() and text.isdigit()):
        raise EtendueError(f'{VARIABLE}: a number of megabytes is needed (0: no cache), not "{text}"')
    return int(text) << 20


def stamp_of(path: Path, least: int = 0) -> Stamp | None:
    """What will differ once the file has changed.

    None where that is not sure, or there is no cache, or the file has less than `least` bytes.
    """
    if limit() == 0:
        return None
    try:
        info = path.stat()
    except OSError:
        return None
    if info.st_size < least or time.time_ns() - max(info.st_mtime_ns, info.st_ctime_ns) < _UNSURE:
        return None
    return [info.st_size, info.st_mtime_ns, info.st_ctime_ns, info.st_ino]


def find(path: Path, stamp: Stamp, kind: str = "") -> tuple[Any, Arrays] | None:
    """What `keep` was given with this stamp."""
    entry = _place(path, kind)
    try:
        # Read, not mapped: on a network another machine may remove what is mapped here, which would be fatal.
        data = np.fromfile(entry, np.uint8)
        if int(bytes(data[:8]), 16) != zlib.crc32(data[8:].data):
            return None
        at = 16 + int(bytes(data[8:16]), 16)
        header = json.loads(bytes(data[16:at]))
        if header["stamp"] != stamp:
            return None
        arrays = []
        for number, shape in header["arrays"]:
            arrays.append(np.frombuffer(data, number, math.prod(shape), at).reshape(shape))
            at += arrays[-1].nbytes + -arrays[-1].nbytes % _ALIGNMENT
    except (OSError, ValueError):
        return None
    with contextlib.suppress(OSError):
        # What was used last is the last to go.
        os.utime(entry)
    return header["about"], arrays


def keep(path: Path, stamp: Stamp, about: Any, arrays: Sequence[NDArray[Any]], kind: str = "") -> None:
    """Keeps `about`, plain data, and arrays for the file, if it still is what it was when `stamp` was taken.

    kind: as what the file was read, where there are several.
    """
    table = [(array.dtype.str, array.shape) for array in arrays]
    header = json.dumps({"stamp": stamp, "arrays": table, "about": about}).encode()
    header += b" " * (-(16 + len(header)) % _ALIGNMENT)
    parts = [b"%08x" % len(header), header]
    for array in arrays:
        parts += [np.ascontiguousarray(array).tobytes(), bytes(-array.nbytes % _ALIGNMENT)]
    most = limit()
    if sum(map(len, parts)) > most or stamp_of(path) != stamp:
        return
    with contextlib.suppress(OSError):
        folder().mkdir(parents=True, exist_ok=True)
        checksum = functools.reduce(lambda crc, part: zlib.crc32(part, crc), parts, 0)
        _write(_place(path, kind), [b"%08x" % checksum, *parts])
        _make_room(most)


def _write(entry: Path, parts: Sequence[bytes]) -> None:
    file, name = tempfile.mkstemp(dir=entry.parent, prefix=".")
    try:
        with open(file, "wb") as stream:
            stream.writelines(parts)
        os.replace(name, entry)
    except BaseException:
        os.unlink(name)
        raise


def _place(path: Path, kind: str) -> Path:
    name = "\0".join((_version(), kind, os.path.realpath(path)))
    return folder() / hashlib.sha256(os.fsencode(name)).hexdigest()[:32]


@functools.cache
def _version() -> str:
    """Other loaders may read the same file otherwise."""
    from .. import __version__

    sources = sorted(Path(__file__).parent.glob("*.py"))
    return __version__ + hashlib.sha256(b"".join(source.read_bytes() for source in sources)).hexdigest()


def _entries() -> list[tuple[Path, os.stat_result]]:
    """Those used last come last."""
    found = []
    with contextlib.suppress(OSError):
        for path in folder().iterdir():
            with contextlib.suppress(OSError):
                found.append((path, path.stat()))
    return sorted(found, key=lambda entry: entry[1].st_mtime_ns)


def _make_room(most: int) -> None:
    excess = size() - most
    for path, info in _entries():
        if excess <= 0:
            return
        path.unlink(missing_ok=True)
        excess -= info.st_size
