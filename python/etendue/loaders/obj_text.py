"""The text of an OBJ file as arrays of numbers, with the line that each came from.

Read by our own code because no library passed: assimp-py refuses vertices such as ".5 0 0" and names outside
UTF-8, tinyobjloader cuts names at spaces and has no wheel for current Pythons, trimesh takes twice the time
allowed.
All lines of one kind are converted in one call; Python touches single lines only where one is wrong.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from .geometry import FARTHEST
from .numbers import parse, words
from .obj_faces import Corners, read_faces
from .obj_lines import HASH, SPACE, TAB, Ints, Lines, blocks, decode, per_line

# Statements of the format that change no surface here: groups, smoothing, points, lines, free-form geometry.
_IGNORED = frozenset(
    b"# o g s l p vp mg lod bevel c_interp d_interp shadow_obj trace_obj maplib usemap cstype deg bmat step "
    b"curv curv2 surf parm trim hole scrv sp end con res bsp bzp cdc cdp call csh stech ctech".split()
)


@dataclass
class ObjText:
    """Numbers and names of an OBJ file; positions and normals are float64, lines count from 1."""

    path: Path
    v: NDArray[np.float64]
    vt: NDArray[np.float64]
    vn: NDArray[np.float64]
    corners: Corners
    #: (line, argument) in the order of the file
    usemtl: list[tuple[int, str]]
    mtllib: list[tuple[int, str]]
    #: the first line whose keyword no OBJ file has, and how many there are
    unknown: tuple[int, str, int] | None


def read(path: Path) -> ObjText:
    """Read the OBJ file `path`; raises EtendueError with the line that cannot be understood."""
    return _Reader(Lines(path)).read()


class _Reader:
    def __init__(self, lines: Lines) -> None:
        self.lines = lines

    def read(self) -> ObjText:
        # The last lines are the padding, too short to look three bytes into.
        starts = self.lines.starts[:-3]
        first, second, third = (self.lines.buffer[starts + offset] for offset in range(3))
        plain = (second == SPACE) | (second == TAB)
        double = (third == SPACE) | (third == TAB)
        is_v = first == ord("v")
        kinds = {
            "v": np.flatnonzero(is_v & plain),
            "vt": np.flatnonzero(is_v & (second == ord("t")) & double),
            "vn": np.flatnonzero(is_v & (second == ord("n")) & double),
            "f": np.flatnonzero((first == ord("f")) & plain),
        }
        # An empty line starts with its own line end.
        other = (first > SPACE) & (first != HASH)
        for lines in kinds.values():
            other[lines] = False
        usemtl, mtllib, unknown = self._names(np.flatnonzero(other))
        v = self._numbers(kinds["v"], 3, "a vertex needs 3 numbers")
        vt = self._numbers(kinds["vt"], 2, "a texture coordinate needs 2 numbers", least=1)
        vn = self._numbers(kinds["vn"], 3, "a normal needs 3 numbers")
        # Written so that NaN counts as wrong.
        bad = np.flatnonzero(~(np.abs(v) <= FARTHEST).all(1))
        if len(bad):
            what = "too far away" if np.isfinite(v[bad[0]]).all() else "not finite"
            self.lines.fail(kinds["v"][bad[0]], f"a vertex that is {what}")
        corners = read_faces(self.lines, kinds["f"], kinds)
        return ObjText(self.lines.path, v, vt, vn, corners, usemtl, mtllib, unknown)

    def _names(
        self, lines: Ints
    ) -> tuple[list[tuple[int, str]], list[tuple[int, str]], tuple[int, str, int] | None]:
        usemtl: list[tuple[int, str]] = []
        mtllib: list[tuple[int, str]] = []
        unknown: tuple[int, str, int] | None = None
        for line in lines.tolist():
            keyword, *rest = self.lines[line].split(None, 1)
            name = decode(rest[0].strip()) if rest else ""
            if keyword == b"usemtl":
                usemtl.append((line + 1, name))
            elif keyword == b"mtllib":
                mtllib.append((line + 1, name))
            elif keyword not in _IGNORED and not keyword.startswith(b"#"):
                first = unknown or (line + 1, decode(keyword[:40]), 0)
                unknown = (first[0], first[1], first[2] + 1)
        return usemtl, mtllib, unknown

    def _numbers(self, lines: Ints, width: int, what: str, least: int | None = None) -> NDArray[np.float64]:
        """The first `width` numbers of each of `lines`, (n, width); missing ones, beyond `least`, are 0."""
        parts = [self._some_numbers(block, width, what, least) for block in blocks(lines)]
        return np.concatenate([np.zeros((0, width)), *parts])

    def _some_numbers(self, lines: Ints, width: int, what: str, least: int | None) -> NDArray[np.float64]:
        text = self.lines.joined(lines)
        starts, ends = words(text)
        counts = per_line(starts, text)
        short = np.flatnonzero(counts < (width if least is None else least))
        if len(short):
            self.lines.fail(lines[short[0]], what)
        numbers = parse(text, starts, ends)
        if numbers is None:
            self.lines.fail(self._first_unreadable(lines), "not a number")
        if len(counts) and (counts == counts[0]).all():
            table = numbers.reshape(-1, counts[0])
            if counts[0] >= width:
                return np.ascontiguousarray(table[:, :width])
            return np.pad(table, ((0, 0), (0, width - counts[0])))
        table = np.zeros((len(lines), width))
        offsets = np.cumsum(counts) - counts
        for column in range(width):
            has = counts > column
            table[has, column] = numbers[offsets[has] + column]
        return table

    def _first_unreadable(self, lines: Ints) -> int:
        for line in lines.tolist():
            # Parsed like the whole file was, so that the two agree on what a number is.
            text = self.lines.joined(np.array([line]))
            if parse(text, *words(text)) is None:
                return line
        return int(lines[0])
