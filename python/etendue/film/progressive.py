"""Rendering towards a range of samples, or an error, in steps, from whatever a film has already."""

from __future__ import annotations

import dataclasses
import math
import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

from . import MOST_INVALID_LISTED, Film, mean_of, sample_ranges
from .error import sums_of
from .origin import attributes_of
from .sample_ranges import Range

if TYPE_CHECKING:
    from .._core import Renderer

# Called with the part that is done (0..1) and the samples per pixel so far.
Progress = Callable[[float, float], object]
RendererFrom = Callable[[int], "Renderer"]


@dataclass(frozen=True)
class Steps:
    """What happens while a film is rendered.

    progress(fraction, samples_per_pixel): called about 20 times a second. error(estimate): called before it, with
    the film's error where there is an estimate. checkpoint(film): called with the film so far every `seconds`
    seconds, but not at the end. time_limit: seconds after which rendering ends. An exception from any of them
    ends the render and is raised, but for KeyboardInterrupt.
    """

    progress: Progress | None = None
    error: Callable[[float], object] | None = None
    checkpoint: Callable[[Film], object] | None = None
    seconds: float = 30.0
    time_limit: float | None = None

    def slice(self, deadline: float | None) -> float | None:
        """Seconds until something is to be done; None: never."""
        limits = [] if deadline is None else [deadline - time.monotonic()]
        limits += [] if self.checkpoint is None else [self.seconds]
        return max(min(limits), 0.0) if limits else None

    def report(self, renderer: Renderer, fraction: float, spp: float) -> None:
        """Tells where the renderer is."""
        if self.error is not None and math.isfinite(renderer.error):
            self.error(renderer.error)
        if self.progress is not None:
            self.progress(fraction, spp)


def go_on(film: Film, renderer_from: RendererFrom, steps: Steps) -> Film:
    """`film` with the samples that its goal and its bound ask for, as far as time and Ctrl-C permit.

    `renderer_from(first)` gives a renderer whose samples begin at the index `first`, modulo 2^64.
    """
    deadline = None if steps.time_limit is None else time.monotonic() + steps.time_limit
    film = dataclasses.replace(film, complete=film.missing == 0 and film.bound is None, interrupted=False)
    # Gaps are closed first: the samples of a beauty render are a pixel's first ones.
    for piece in [*_pieces(film), *([] if film.bound is None else [None])]:
        if deadline is not None and film.samples and time.monotonic() >= deadline:
            break
        if piece is None:
            film, done = _beauty(film, renderer_from, steps, deadline)
        else:
            film, done = _range(film, piece, renderer_from, steps, deadline)
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


def _range(
    film: Film, piece: Range, renderer_from: RendererFrom, steps: Steps, deadline: float | None
) -> tuple[Film, bool]:
    """The film with the samples of `piece`, and whether it has them all."""
    first, end = piece
    before, whole = sample_ranges.count(film.ranges), film.goal[1] - film.goal[0]
    # The renderer counts the samples that are there, wherever they lie in the sequence, as the first.
    renderer = _renderer(film, renderer_from, first - before)
    return _in_steps(
        lambda seconds: renderer.render(
            before + end - first, lambda _, spp: steps.report(renderer, spp / whole, spp), seconds
        ),
        lambda: grown(film, piece, renderer),
        steps,
        deadline,
    )


def _beauty(
    film: Film, renderer_from: RendererFrom, steps: Steps, deadline: float | None
) -> tuple[Film, bool]:
    """The film with as many samples in each tile as its bound takes, and whether it is kept."""
    bound = film.bound
    assert bound is not None
    first = sample_ranges.hull(film.held)[0]
    renderer = _renderer(film, renderer_from, first)
    before = dataclasses.replace(film, ranges=[], partial=None)
    film, film.complete = _in_steps(
        lambda seconds: renderer.render_until(
            bound, lambda fraction, spp: steps.report(renderer, fraction, spp), seconds
        ),
        lambda: grown_beauty(before, first, renderer),
        steps,
        deadline,
    )
    return film, film.complete


def _renderer(film: Film, renderer_from: RendererFrom, first: int) -> Renderer:
    """A renderer that goes on from all that is in the film."""
    renderer = renderer_from(first)
    renderer.resume(*sums_of(film))
    if film.contributions is not None:
        renderer.split(film.contributions)
    return renderer


def _in_steps(
    render: Callable[[float | None], bool], so_far: Callable[[], Film], steps: Steps, deadline: float | None
) -> tuple[Film, bool]:
    """The film after `render(seconds)`, again and again, and whether it has come to its end."""
    try:
        while not render(steps.slice(deadline)):
            if deadline is not None and time.monotonic() >= deadline:
                return so_far(), False
            if steps.checkpoint is not None:
                steps.checkpoint(so_far())
    except KeyboardInterrupt:
        film = so_far()
        film.interrupted = True
        return film, False
    return so_far(), True


def grown(film: Film, piece: Range, renderer: Renderer) -> Film:
    """`film` with what the renderer, which goes on from it with the samples of `piece`, has; also while it renders."""
    total, sum_squares, half_sum, sample_count, invalid, half_count = renderer.snapshot()
    before = sample_ranges.count(film.ranges)
    fewest, most = (piece[0] + int(count) - before for count in (sample_count.min(), sample_count.max()))
    result = dataclasses.replace(
        film,
        image=mean_of(total, sample_count, invalid),
        sample_count=sample_count,
        sum=total,
        sum_squares=sum_squares,
        half_sum=half_sum,
        invalid_per_pixel=invalid,
        half_count=half_count,
        contributions=renderer.contributions(),
        rays=film.rays + renderer.rays,
        seconds=film.seconds + renderer.seconds,
        invalid=[*film.invalid, *renderer.invalid][:MOST_INVALID_LISTED],
        invalid_count=film.invalid_count + renderer.invalid_count,
        ranges=sample_ranges.union([*film.ranges, (piece[0], fewest)]),
        partial=(fewest, most) if fewest < most else None,
    )
    result.complete = result.missing == 0
    result.attributes = attributes_of(result)
    return result


def grown_beauty(film: Film, first: int, renderer: Renderer) -> Film:
    """The same of a beauty render, whose samples begin at the index `first`, of a film without ranges."""
    now = grown(film, (first, first), renderer)
    now.goal, now.complete = sample_ranges.hull(now.ranges), False
    return now
