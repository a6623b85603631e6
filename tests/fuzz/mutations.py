"""Hypothesis strategies: valid files, changed a little."""

from __future__ import annotations

import copy
import json
import re
from typing import Any

from hypothesis import strategies as st

from . import seeds

Json = Any
JUNK: list[Json] = [
    None, True, False, 0, -1, 1, 2**31, 2**32, 2**63, 2**64, -(2**63), 10**400, 0.5, -0.0, 1e-320, 1e39, 1e308,
    float("nan"), float("inf"), float("-inf"), "", " ", "0", "a\0b", "\ud800", "../..", "/", "é" * 300, "x" * 5000,
    [], [0], [1, 2], [0, 0, 0], [1, 2, 3], [1, 2, 3, 4], ["a", "b", "c"], [[1, 2, 3]], {}, {"a": 1}, {"name": "red"},
]  # fmt: skip
NUMBERS = [
    *b"0 -1 1 2 999999999999999999999 -9223372036854775808 4294967296 1e39 -1e308 1e-320 nan -inf . - +5 1e".split(),
    *(b"0x10", b"1_0", b"1,5", b"\xc3\xa9", b"\0", b""),
]


def _places(value: Json) -> list[tuple[Any, ...]]:
    """The path of every value inside."""
    found: list[tuple[Any, ...]] = [()]
    items = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    for key, inner in items:
        found += [(key, *place) for place in _places(inner)]
    return found


def _change(value: Json, place: tuple[Any, ...], how: str, junk: Json) -> Json:
    if not place:
        return junk if how == "replace" else value
    value = copy.deepcopy(value)
    around = value
    for step in place[:-1]:
        around = around[step]
    key = place[-1]
    if how == "replace":
        around[key] = copy.deepcopy(junk)
    elif how == "remove":
        del around[key]
    elif how == "deepen":
        around[key] = [around[key]]
    elif isinstance(around, dict):
        around[junk if isinstance(junk, str) else str(key) + "x"] = around[key]
    else:
        around.extend([around[key]] * 3)
    return value


@st.composite
def changed_json(draw: st.DrawFn, valid: Json) -> Json:
    """`valid` with one to four of its values replaced, removed, wrapped or repeated."""
    value = valid
    for _ in range(draw(st.integers(1, 4))):
        place = draw(st.sampled_from(_places(value)))
        how = draw(st.sampled_from(["replace", "replace", "remove", "deepen", "repeat"]))
        value = _change(value, place, how, draw(st.sampled_from(JUNK)))
    return value


def as_bytes(value: Json) -> bytes:
    return json.dumps(value).encode()


@st.composite
def changed_text(draw: st.DrawFn, valid: bytes, words: list[bytes]) -> bytes:
    """Lines moved, dropped and doubled; words replaced by numbers and keywords where they do not belong."""
    lines = valid.split(b"\n")
    for _ in range(draw(st.integers(1, 5))):
        at = draw(st.integers(0, len(lines) - 1))
        how = draw(st.sampled_from(["word", "word", "word", "drop", "double", "move", "join", "insert"]))
        if how == "word":
            parts = re.split(rb"([ \t/]+)", lines[at])
            parts[draw(st.integers(0, len(parts) - 1))] = draw(st.sampled_from(NUMBERS + words))
            lines[at] = b"".join(parts)
        elif how == "drop" and len(lines) > 1:
            del lines[at]
        elif how == "double":
            lines[at:at] = [lines[at]] * draw(st.integers(1, 40))
        elif how == "move":
            lines.insert(draw(st.integers(0, len(lines) - 1)), lines.pop(at))
        elif how == "join" and at + 1 < len(lines):
            lines[at : at + 2] = [lines[at] + lines[at + 1]]
        else:
            lines.insert(at, draw(st.binary(max_size=12)))
    ending = draw(st.sampled_from([b"\n", b"\n", b"\r\n", b"\r"]))
    return draw(st.sampled_from([b"", b"", b"\xef\xbb\xbf", b"\xff\xfe"])) + ending.join(lines)


@st.composite
def changed_bytes(draw: st.DrawFn, valid: bytes, words: list[bytes]) -> bytes:
    """Bytes overwritten, put in, cut out, and the end cut off."""
    data = bytearray(valid)
    extremes = [
        b"\xff\xff\xff\xff",
        b"\xff\xff\xff\x7f",
        b"\0\0\0\0",
        b"\x7f\xff\xff\xff",
        b"\0\0\0\x80",
        b"\x01",
    ]
    for _ in range(draw(st.integers(1, 5))):
        at = draw(st.integers(0, len(data)))
        what = draw(st.sampled_from(extremes + words) | st.binary(min_size=1, max_size=8))
        how = draw(st.sampled_from(["over", "over", "over", "in", "out", "end"]))
        if how == "over":
            data[at : at + len(what)] = what
        elif how == "in":
            data[at:at] = what
        elif how == "out":
            del data[at : at + draw(st.integers(1, 64))]
        else:
            del data[at:]
    return bytes(data)


def files(target: str) -> st.SearchStrategy[bytes]:
    """Files for a target: by its grammar where it has one, by bytes, and nothing but bytes."""
    words = seeds.WORDS[target]
    ways = [changed_bytes(seed, words) for seed in seeds.corpus(target)]
    if target in ("obj", "mtl", "ply", "stl"):
        ways += 2 * [changed_text(seed, words) for seed in seeds.corpus(target) if seed.isascii()]
    if target == "scene":
        ways += 3 * [changed_json(seeds.CONFIG).map(as_bytes)]
    if target == "gltf":
        ways += 3 * [changed_json(seeds.gltf()).map(as_bytes)]
    if target == "glb":
        ways.append(
            changed_json(seeds.gltf(False)).map(lambda header: seeds.glb_of(header, seeds.glb()[-400:]))
        )
    return st.one_of(*ways, st.binary(max_size=300))
