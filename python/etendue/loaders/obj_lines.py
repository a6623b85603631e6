"""The lines of an OBJ file."""

from __future__ import annotations

import os
import re
from collections.abc import Iterator
from pathlib import Path
from typing import NoReturn

import numpy as np
from numpy.typing import NDArray

from ..errors import EtendueError

Ints = NDArray[np.int64]
Bytes = NDArray[np.uint8]

TAB, NEWLINE, RETURN, SPACE, HASH, SLASH = b"\t\n\r #/"
_BYTE_ORDER_MARK = b"\xef\xbb\xbf"
_BLOCK = 1 << 15


def decode(name: bytes) -> str:
    """A name in UTF-8, or in Latin-1 where it is not UTF-8: the same bytes give the same name everywhere."""
    try:
        return name.decode("utf-8")
    except UnicodeDecodeError:
        return name.decode("latin-1")


class Lines:
    """A file's bytes and where its lines start and end; lines count from 0 here.

    Every line can be looked three bytes into: the last three are empty. Raises EtendueError.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        try:
            with path.open("rb") as file:
                size = os.fstat(file.fileno()).st_size
                buffer = np.full(size + 4, NEWLINE, np.uint8)
                file.readinto(buffer[:size].data)
        except OSError as error:
            raise EtendueError(f"{path}: cannot be read: {error.strerror or error}") from None
        newlines = np.flatnonzero(buffer == NEWLINE)
        unfolded = _unfolded(buffer, newlines)
        if unfolded is not None:
            buffer, newlines = unfolded, np.flatnonzero(unfolded == NEWLINE)
        self.buffer = buffer
        self.ends = newlines
        self.starts = np.concatenate([[0], newlines[:-1] + 1])

    def __getitem__(self, line: int) -> bytes:
        return self.buffer[self.starts[line] : self.ends[line]].tobytes()

    def fail(self, line: int, what: str) -> NoReturn:
        """Raise an EtendueError that names the line."""
        text = decode(self[line]).strip()
        text = text if len(text) <= 60 else text[:56] + " ..."
        raise EtendueError(f"{self.path}:{line + 1}: {what}: {text}")

    def joined(self, lines: Ints) -> Bytes:
        """A copy of `lines`, one after the other, each with its line end, without keywords and comments."""
        if len(lines) == 0:
            return np.zeros(0, np.uint8)
        breaks = np.flatnonzero(np.diff(lines) != 1) + 1
        run_starts = self.starts[lines[np.concatenate([[0], breaks])]].tolist()
        run_ends = (self.ends[lines[np.concatenate([breaks - 1, [len(lines) - 1]])]] + 1).tolist()
        pieces = [self.buffer[start:end] for start, end in zip(run_starts, run_ends, strict=True)]
        text = np.concatenate(pieces)
        lengths = self.ends[lines] + 1 - self.starts[lines]
        ends = np.cumsum(lengths)
        begins = ends - lengths
        text[begins] = SPACE
        text[begins + 1] = SPACE
        hashes = np.flatnonzero(text == HASH)
        for begin, end in zip(hashes.tolist(), ends[np.searchsorted(ends, hashes)].tolist(), strict=True):
            text[begin : end - 1] = SPACE
        return text


def _unfolded(buffer: Bytes, newlines: Ints) -> Bytes | None:
    """One statement a line, no indentation, Unix line ends, line numbers as before; None where it is so."""
    first = newlines[:-1] + 1
    indented = (buffer[:1] <= SPACE).any() or ((buffer[first] == SPACE) | (buffer[first] == TAB)).any()
    odd_ends = (buffer[newlines[1:] - 1] == ord("\\")).any() or (buffer == RETURN).any()
    if not indented and not odd_ends and buffer[0] != _BYTE_ORDER_MARK[0]:
        return None
    data = buffer.tobytes().removeprefix(_BYTE_ORDER_MARK).replace(b"\r\n", b"\n").replace(b"\r", b"\n")
    data = re.sub(
        rb"(?:[^\n]*\\\n)+[^\n]*",
        lambda match: match[0].replace(b"\\\n", b" ") + b"\n" * match[0].count(b"\n"),
        data,
    )
    return np.frombuffer(re.sub(rb"\n[ \t]+", b"\n", b"\n" + data)[1:], np.uint8)


def blocks(lines: Ints) -> Iterator[Ints]:
    """`lines` in pieces whose text and numbers fit a cache, which is twice as fast as all at once."""
    for begin in range(0, len(lines), _BLOCK):
        yield lines[begin : begin + _BLOCK]


def per_line(positions: Ints, text: Bytes) -> Ints:
    """How many of `positions`, sorted, lie in each line of `text`."""
    return np.diff(np.searchsorted(positions, np.flatnonzero(text == NEWLINE)), prepend=0)
