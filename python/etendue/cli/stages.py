"""Progress of what is not the rendering itself: a part that is done, and the time left."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager

from ..words import clock

# What is done sooner needs no line in a log.
_SOON = 2.0


@contextmanager
def shown(what: str, say: Callable[[str], None], quiet: bool) -> Iterator[Callable[[float], None]]:
    """A callback with the part that is done (0..1): a bar in a terminal, else lines by `say`, one a tenth."""
    if quiet:
        yield lambda part: None
    elif sys.stderr.isatty():
        with _bar(what) as report:
            yield report
    else:
        start, told = time.monotonic(), 0

        def report(part: float) -> None:
            nonlocal told
            seconds = time.monotonic() - start
            if int(part * 10) > told and seconds > _SOON:
                told = int(part * 10)
                say(f"{what}: {_described(part, seconds)}")

        yield report


def _described(part: float, seconds: float) -> str:
    left = f"  {clock(seconds * (1 - part) / part)} left" if 0 < part < 1 else ""
    return f"{int(part * 100)}%{left}"


@contextmanager
def _bar(what: str) -> Iterator[Callable[[float], None]]:
    from rich.console import Console
    from rich.progress import BarColumn, Progress, TextColumn

    columns = (BarColumn(), TextColumn(what), TextColumn("{task.fields[said]}"))
    start = time.monotonic()
    # Drawn by the reports themselves, as that of the rendering.
    with Progress(*columns, console=Console(stderr=True), auto_refresh=False, transient=True) as progress:
        task = progress.add_task("", total=1.0, said="")

        def report(part: float) -> None:
            said = _described(part, time.monotonic() - start)
            progress.update(task, completed=part, refresh=True, said=said)

        yield report
