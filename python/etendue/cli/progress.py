"""How a render's progress is shown: a bar in a terminal, a line every tenth in a log, as JSON, or not at all."""

from __future__ import annotations

import json
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any

from ..words import clock, si

# Seconds between two lines for scripts.
_JSON_SECONDS = 0.5


@dataclass(frozen=True)
class Goal:
    """What a render is to reach: samples in each of the pixels or an error, or the time limit before that.

    spp_before: samples that were there when it began, which cost it no time.
    """

    spp: int | None
    pixels: int
    time_limit: float | None = None
    spp_before: float = 0.0
    bound: float | None = None


@dataclass(frozen=True)
class Status:
    """Where a render is: the part of its samples (0..1) that is done, of a beauty render by its own guess."""

    goal: Goal
    fraction: float
    spp: float
    seconds: float
    error: float | None = None

    @property
    def part(self) -> float:
        """How much is done (0..1): of the samples, or of the time, whichever will end the render."""
        if self.fraction >= 1 or self.goal.time_limit is None:
            return min(self.fraction, 1.0)
        # Time that has run out does not mean that the last samples are in.
        return max(self.fraction, min(self.seconds / self.goal.time_limit, 0.999))

    @property
    def samples_per_second(self) -> float | None:
        """Samples of all pixels together, those that were there before left aside."""
        here = self.spp - self.goal.spp_before
        return here * self.goal.pixels / self.seconds if self.seconds > 0 and here > 0 else None

    @property
    def seconds_left(self) -> float | None:
        """None where nothing tells, and at the end."""
        limit, before = self.goal.time_limit, self.goal.spp_before
        whole = self.spp / self.fraction if self.fraction > 0 else 0.0
        guesses = [] if limit is None else [max(limit - self.seconds, 0.0)]
        if whole > self.spp > before:
            guesses.append(self.seconds * (whole - self.spp) / (self.spp - before))
        return min(guesses) if guesses and self.fraction < 1 and self.seconds > 0 else None

    def words(self) -> tuple[str, str, str, str, str]:
        """Percent, samples, speed, error and time left; 100% is said of what is finished alone."""
        goal, speed, left = self.goal, self.samples_per_second, self.seconds_left
        spp = f"{self.spp:.{0 if self.spp == int(self.spp) else 1}f}"
        error = "" if self.error is None else f"error {self.error:.3g}"
        return (
            f"{min(int(self.part * 100), 100 if self.part >= 1 else 99)}%",
            f"{spp} spp" if goal.spp is None else f"{spp}/{goal.spp} spp",
            "" if speed is None else f"{si(speed)} samples/s",
            f"{error} of {goal.bound:g}" if error and goal.bound is not None else error,
            "" if left is None else f"{clock(left)} left",
        )

    def data(self) -> dict[str, Any]:
        """For scripts, as docs/films.md describes it."""
        return {
            "event": "progress",
            "fraction": self.part,
            "spp": self.spp,
            "spp_goal": self.goal.spp,
            "samples_per_second": self.samples_per_second,
            "error": self.error,
            "error_goal": self.goal.bound,
            "seconds": self.seconds,
            "seconds_left": self.seconds_left,
        }


class Report:
    """Takes what a render reports, and shows it."""

    def __init__(self, goal: Goal, show: Callable[[Status], object]) -> None:
        self._goal = goal
        self._show = show
        self._start = time.monotonic()
        self._error: float | None = None

    def error(self, estimate: float) -> None:
        """The film's error, as far as it is known."""
        self._error = estimate

    def __call__(self, fraction: float, spp: float) -> None:
        """The part that is done (0..1), and the samples per pixel so far."""
        self._show(Status(self._goal, fraction, spp, time.monotonic() - self._start, self._error))


@contextmanager
def shown(goal: Goal, quiet: bool, as_json: bool = False) -> Iterator[Report]:
    """What shows the progress towards `goal` on stderr."""
    if as_json:
        yield Report(goal, _JsonLines())
    elif quiet:
        yield Report(goal, lambda status: None)
    elif sys.stderr.isatty():
        with _bar() as show:
            yield Report(goal, show)
    else:
        yield Report(goal, _Lines())


class _Lines:
    """One line per tenth, for logs."""

    def __init__(self) -> None:
        self.tenth = 0

    def __call__(self, status: Status) -> None:
        tenth = int(status.part * 10)
        if tenth > self.tenth:
            self.tenth = tenth
            print("  ".join(word for word in status.words() if word), file=sys.stderr, flush=True)


class _JsonLines:
    """An object on a line of its own, twice a second and at the end."""

    def __init__(self) -> None:
        self.next = 0.0

    def __call__(self, status: Status) -> None:
        if status.seconds >= self.next or status.fraction >= 1:
            self.next = status.seconds + _JSON_SECONDS
            print(json.dumps(status.data()), file=sys.stderr, flush=True)


@contextmanager
def _bar() -> Iterator[Callable[[Status], None]]:
    from rich.console import Console
    from rich.progress import BarColumn, Progress, TextColumn

    names = ("percent", "samples", "speed", "error", "left")
    columns = [TextColumn("{task.fields[" + name + "]}") for name in names]
    # The bar is drawn by the renderer's own reports; a refreshing thread would take time from the rendering.
    with Progress(
        BarColumn(), *columns, console=Console(stderr=True), auto_refresh=False, transient=True
    ) as bar:
        blank: dict[str, Any] = dict.fromkeys(names, "")
        task = bar.add_task("", total=1.0, **blank)

        def show(status: Status) -> None:
            words: dict[str, Any] = dict(zip(names, status.words(), strict=True))
            bar.update(task, completed=status.part, refresh=True, **words)

        yield show
