"""Ranges [first, end) of sample indices: which samples of every pixel a film holds."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence

from ..errors import EtendueError

Range = tuple[int, int]

# Indices are 64-bit in the core; signed ones fit every file and every other program.
LARGEST = 2**63 - 1
# Counts of one render are those of framebuffer.sppx.
MOST = 2**31 - 1


def parse(text: str) -> Range:
    """`A:B` as a range; EtendueError tells what is wrong with it."""
    match = re.fullmatch(r"\s*([0-9]+)\s*:\s*([0-9]+)\s*", text)
    if match is None:
        raise EtendueError(f'--samples: a range FIRST:END is needed, as in 0:64, not "{text}"')
    return checked((int(match[1]), int(match[2])), "--samples")


def checked(samples: Sequence[int], place: str) -> Range:
    """`samples` as a range if a render can have it."""
    first, end = (int(samples[0]), int(samples[-1]) + 1) if isinstance(samples, range) else map(int, samples)
    if not 0 <= first < end <= LARGEST:
        raise EtendueError(
            f"{place}: the first sample must be 0 or more and below the end, and the end at most 2^63 - 1 "
            f"(got {first}:{end})"
        )
    if end - first > MOST:
        raise EtendueError(f"{place}: {end - first} samples are too many for one film (at most {MOST})")
    return first, end


def union(ranges: Iterable[Range]) -> list[Range]:
    """The same samples in as few ranges as possible, in order."""
    joined: list[Range] = []
    for first, end in sorted(ranges):
        if joined and first <= joined[-1][1]:
            joined[-1] = joined[-1][0], max(end, joined[-1][1])
        elif first < end:
            joined.append((first, end))
    return joined


def overlap(some: Iterable[Range], others: Iterable[Range]) -> Range | None:
    """The first samples that are in both, or None."""
    others = list(others)
    shared = [(max(a[0], b[0]), min(a[1], b[1])) for a in some for b in others]
    return min((both for both in shared if both[0] < both[1]), default=None)


def gaps(whole: Range, ranges: Iterable[Range]) -> list[Range]:
    """What `ranges` leave of `whole`."""
    missing: list[Range] = []
    here, last = whole
    for first, end in union(ranges):
        missing.append((here, min(first, last)))
        here = max(here, end)
    missing.append((here, last))
    return [(first, end) for first, end in missing if first < end]


def hull(ranges: Iterable[Range]) -> Range:
    """From the first sample of all to the last; (0, 0) of none."""
    ranges = list(ranges)
    if not ranges:
        return 0, 0
    return min(first for first, _ in ranges), max(end for _, end in ranges)


def count(ranges: Iterable[Range]) -> int:
    """How many samples they hold; disjoint ranges."""
    return sum(end - first for first, end in ranges)


def text(ranges: Iterable[Range]) -> str:
    """0:8 and 16:24, as people read and options take them."""
    return " and ".join(f"{first}:{end}" for first, end in ranges) or "none"
