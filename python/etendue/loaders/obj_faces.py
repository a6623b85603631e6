"""The faces of an OBJ file."""

from __future__ import annotations

import re
import warnings
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from .numbers import words
from .obj_lines import SLASH, SPACE, Bytes, Ints, Lines, blocks, per_line


@dataclass
class Corners:
    """Every corner of every face, in the order of the file.

    `indices` int64 (n, 3): v, vt, vn, from 0; -1 where missing. `first` int64 (faces + 1,): where each face's
    corners start. `lines`: the line of each face, from 1.
    """

    indices: Ints
    first: Ints
    lines: Ints


def read_faces(lines: Lines, faces: Ints, declared: Mapping[str, Ints]) -> Corners:
    """The corners of the lines `faces`; `declared` has the lines of "v", "vt" and "vn".

    Raises EtendueError with the line that is no face, or that refers to what is not there.
    """
    parts = [_some_corners(lines, block) for block in blocks(faces)]
    table = np.concatenate([np.zeros((0, 3), np.int64), *(table for table, _ in parts)])
    first = np.cumsum(np.concatenate([[0], *(per_face for _, per_face in parts)]), dtype=np.int64)
    face_of = np.repeat(np.arange(len(faces)), np.diff(first))
    for column, (kind, what) in enumerate((("v", "vertex"), ("vt", "texture coordinate"), ("vn", "normal"))):
        table[:, column] = _resolved(lines, table[:, column], what, declared[kind], faces[face_of])
    return Corners(table, first, faces + 1)


def _some_corners(lines: Lines, faces: Ints) -> tuple[Ints, Ints]:
    """The indices of the corners as they are written, (n, 3), 0 where missing, and corners per face."""
    text, array, slashes = _face_text(lines.joined(faces))
    starts, _ = words(array)
    per_face = per_line(starts, array)
    depth = _slashes_per_corner(starts, slashes)
    numbers = _integers(text.replace(b"/", b" "))
    if len(numbers) != len(starts) + len(slashes) or depth.max(initial=0) > 2:
        lines.fail(_first_bad_face(lines, faces), "a face whose corners are not v, v/vt, v//vn or v/vt/vn")
    table = np.zeros((len(starts), 3), np.int64)
    if len(depth) and (depth == depth[0]).all():
        table[:, : depth[0] + 1] = numbers.reshape(-1, depth[0] + 1)
    else:
        offsets = np.cumsum(depth + 1) - (depth + 1)
        for column in range(3):
            has = depth >= column
            table[has, column] = numbers[offsets[has] + column]
    return table, per_face


def _face_text(array: Bytes) -> tuple[bytes, Bytes, Ints]:
    """The text of the faces with 0 for every index left out, its bytes, and where the slashes are."""
    slashes = np.flatnonzero(array == SLASH)
    text = array.tobytes()
    after = array[slashes + 1]
    if ((after == SLASH) | (after <= SPACE)).any():
        text = re.sub(rb"/(?=[/\s])", b"/0", text)
        array = np.frombuffer(text, np.uint8)
        slashes = np.flatnonzero(array == SLASH)
    return text, array, slashes


def _first_bad_face(lines: Lines, faces: Ints) -> int:
    corner = re.compile(rb"[+-]?\d+(?:/(?:[+-]?\d+)?){0,2}")
    for line in faces.tolist():
        text = lines.joined(np.array([line])).tobytes()
        if any(corner.fullmatch(token) is None for token in text.split()):
            return line
    return int(faces[0])


def _resolved(lines: Lines, column: Ints, what: str, declared: Ints, line_of: Ints) -> Ints:
    """Indices from 0, from those that count from 1 or, negative, back from their own line; 0 becomes -1."""
    negative = np.flatnonzero(column < 0)
    resolved = column - 1
    if len(negative):
        resolved[negative] = column[negative] + np.searchsorted(declared, line_of[negative])
    wrong = (resolved >= len(declared)) | ((resolved < 0) & ((column < 0) | (what == "vertex")))
    bad = np.flatnonzero(wrong)
    if len(bad):
        has = f"{len(declared)}" if len(declared) else "none"
        line = int(line_of[bad[0]])
        lines.fail(line, f"a face refers to {what} {column[bad[0]]}, but the file has {has}")
    return resolved


def _slashes_per_corner(starts: Ints, slashes: Ints) -> Ints:
    """How many of `slashes` each corner has, whose text begins at `starts`."""
    if len(starts) and len(slashes) % len(starts) == 0:
        # The usual file, in which all have the same number, is told without a search.
        same = len(slashes) // len(starts)
        table = slashes.reshape(len(starts), same)
        if same == 0 or ((table[:, 0] > starts).all() and (table[:-1, -1] < starts[1:]).all()):
            return np.full(len(starts), same)
    return np.diff(np.searchsorted(slashes, starts), append=len(slashes))


def _integers(text: bytes) -> Ints:
    """The integers of `text` up to the first word that is none, which their number then tells."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", DeprecationWarning)
        try:
            return np.fromstring(text, dtype=np.int64, sep=" ")
        except ValueError:
            return np.zeros(0, np.int64)
