"""Rendering towards a range of samples, in steps, from whatever a film has already."""

from __future__ import annotations

import dataclasses
import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from . import MOST_INVALID_LISTED, Film, mean_of, sample_ranges
from .origin import attributes_of
from .sample_ranges import Range

if TYPE_CHECKING:
    from .._core import Renderer

# Called with the part that is done (0..1) and the samples per pixel so far.
Progress = Callable[[float, float], object]


@dataclass(frozen=True)
class Steps:
    """What happens while a film is rendered.

    progress(fraction, samples_per_pixel): called about 20 times a second. checkpoint(film): called with the
    film so far every `seconds` seconds, but not at the end. time_limit: seconds after which rendering ends.
    An exception from either ends the render and is raised, but for KeyboardInterrupt.
    """

    progress: Progress | None = None
    checkpoint: Callable[[Film], object] | None = None
    seconds: float = 30.0
    time_limit: float | None = None

    def slice(self, deadline: float | None) -> float | None:
        """Seconds until something is to be done; None: never."""
        limits = [] if deadline is None else [deadline - time.monotonic()]
        limits += [] if self.checkpoint is None else [self.seconds]
        return max(min(limits), 0.0) if limits else None


def go_on(film: Film, renderer_from: Callable[[int], Renderer], steps: Steps) -> Film:
    """`film` with the samples that its goal asks for and it has not, as far as time and Ctrl-C permit.

    `renderer_from(first)` gives a renderer whose samples begin at the index `first`.
    """
    deadline = None if steps.time_limit is None else time.monotonic() + steps.time_limit
    film = dataclasses.replace(film, complete=film.missing == 0, interrupted=False)
    for piece in _pieces(film):
        if deadline is not None and film.samples and time.monotonic() >= deadline:
            break
        film, done = _render(film, piece, renderer_from(piece[0]), steps, deadline)
        if not done:
            break
    film.attributes = attributes_of(film)
    return film


def _pieces(film: Film) -> list[Range]:
    """What is missing. First what is there in part: a film can have one such range, not two."""
    pieces = sample_ranges.gaps(film.goal, film.ranges)
    start = None if film.partial is None else film.partial[0]
    split: list[Range] = []
    for first, end in pieces:
        cut = start if start is not None and first < start < end else first
        split += [(first, cut), (cut, end)] if cut > first else [(first, end)]
    return sorted(split, key=lambda piece: (piece[0] != start, piece[0]))


def _render(
    film: Film, piece: Range, renderer: Renderer, steps: Steps, deadline: float | None
) -> tuple[Film, bool]:
    first, end = piece
    before = sample_ranges.count(film.ranges)
    # The renderer goes on from the sums of all samples, and counts those of this range alone.
    counts: NDArray[np.uint64] = film.sample_count - np.uint64(before)
    renderer.resume(film.sum, film.sum_squares, film.half_sum, counts, film.invalid_per_pixel)
    if film.contributions is not None:
        renderer.split(film.contributions)

    def report(_: float, spp: float) -> None:
        if steps.progress is not None:
            whole = film.goal[1] - film.goal[0]
            steps.progress((before + spp) / whole, before + spp)

    interrupted = False
    try:
        while not renderer.render(end - first, report, steps.slice(deadline)):
            if deadline is not None and time.monotonic() >= deadline:
                break
            if steps.checkpoint is not None:
                steps.checkpoint(grown(film, piece, renderer))
    except KeyboardInterrupt:
        interrupted = True
    film = grown(film, piece, renderer)
    film.interrupted = interrupted
    return film, not interrupted and film.partial is None and not sample_ranges.gaps(piece, film.ranges)


def grown(film: Film, piece: Range, renderer: Renderer) -> Film:
    """`film` as it is with what the renderer, which goes on from it, has of `piece`; also while it renders."""
    total, sum_squares, half_sum, counts, invalid = renderer.snapshot()
    fewest, most = int(counts.min()), int(counts.max())
    first = piece[0]
    sample_count = counts + np.uint64(sample_ranges.count(film.ranges))
    result = dataclasses.replace(
        film,
        image=mean_of(total, sample_count, invalid),
        sample_count=sample_count,
        sum=total,
        sum_squares=sum_squares,
        half_sum=half_sum,
        invalid_per_pixel=invalid,
        contributions=renderer.contributions(),
        rays=film.rays + renderer.rays,
        seconds=film.seconds + renderer.seconds,
        invalid=[*film.invalid, *renderer.invalid][:MOST_INVALID_LISTED],
        invalid_count=film.invalid_count + renderer.invalid_count,
        ranges=sample_ranges.union([*film.ranges, (first, first + fewest)]),
        partial=(first + fewest, first + most) if fewest < most else None,
    )
    result.complete = result.missing == 0
    result.attributes = attributes_of(result)
    return result
