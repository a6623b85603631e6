"""How a render's progress is shown: a bar in a terminal, a line every tenth in a log, or not at all."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any

from .words import clock, si

# Takes what the renderer reports: the part that is done (0..1) and the samples per pixel so far.
Report = Callable[[float, float], None]


@dataclass(frozen=True)
class Goal:
    """What a render is to reach: samples in each of the pixels, or the time limit in seconds before that.

    spp_before: samples that were there when it began, which cost it no time.
    """

    spp: int
    pixels: int
    time_limit: float | None = None
    spp_before: float = 0.0

    def part(self, fraction: float, seconds: float) -> float:
        """How much is done (0..1): of the samples, or of the time, whichever will end the render."""
        if fraction >= 1 or self.time_limit is None:
            return min(fraction, 1.0)
        # Time that has run out does not mean that the last samples are in.
        return max(fraction, min(seconds / self.time_limit, 0.999))

    def part_here(self, fraction: float, seconds: float) -> float:
        """As `part`, of what was left to do at the beginning."""
        before = self.spp_before / self.spp
        return self.part((fraction - before) / (1 - before) if before < 1 else 1.0, seconds)

    def describe(self, fraction: float, spp_done: float, seconds: float) -> tuple[str, str, str, str]:
        """Percent, samples, speed and time left, in words; 100% is said of what is finished alone."""
        part = self.part(fraction, seconds)
        percent = f"{min(int(part * 100), 100 if part >= 1 else 99)}%"
        samples = f"{spp_done:.{0 if spp_done == int(spp_done) else 1}f}/{self.spp} spp"
        spp_here = spp_done - self.spp_before
        speed = f"{si(spp_here * self.pixels / seconds)} samples/s" if seconds > 0 and spp_here > 0 else ""
        part_here = self.part_here(fraction, seconds)
        left = f"{clock(seconds * (1 - part_here) / part_here)} left" if 0 < part_here < 1 else ""
        return percent, samples, speed, left


@contextmanager
def shown(goal: Goal, quiet: bool) -> Iterator[Report]:
    """A callback `(fraction, samples per pixel so far)` that shows progress on stderr."""
    if quiet:
        yield lambda fraction, spp_done: None
    elif sys.stderr.isatty():
        with _bar(goal) as report:
            yield report
    else:
        yield _Lines(goal)


class _Lines:
    """One line per tenth, for logs."""

    def __init__(self, goal: Goal) -> None:
        self.goal = goal
        self.start = time.monotonic()
        self.tenth = 0

    def __call__(self, fraction: float, spp_done: float) -> None:
        seconds = time.monotonic() - self.start
        tenth = int(self.goal.part(fraction, seconds) * 10)
        if tenth > self.tenth:
            self.tenth = tenth
            parts = self.goal.describe(fraction, spp_done, seconds)
            print("  ".join(part for part in parts if part), file=sys.stderr, flush=True)


@contextmanager
def _bar(goal: Goal) -> Iterator[Report]:
    from rich.console import Console
    from rich.progress import BarColumn, Progress, TextColumn

    names = ("percent", "samples", "speed", "left")
    columns = [TextColumn("{task.fields[" + name + "]}") for name in names]
    console = Console(stderr=True)
    start = time.monotonic()
    # The bar is drawn by the renderer's own reports; a refreshing thread would take time from the rendering.
    with Progress(BarColumn(), *columns, console=console, auto_refresh=False, transient=True) as progress:
        blank: dict[str, Any] = dict.fromkeys(names, "")
        task = progress.add_task("", total=1.0, **blank)

        def report(fraction: float, spp_done: float) -> None:
            seconds = time.monotonic() - start
            words: dict[str, Any] = dict(zip(names, goal.describe(fraction, spp_done, seconds), strict=True))
            progress.update(task, completed=goal.part(fraction, seconds), refresh=True, **words)

        yield report
