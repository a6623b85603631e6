"""What there is to render, how far it is, and how long the rest will take."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass

# Called with the part of all the work that is done (0..1), the seconds left (None: unknown yet), and what is
# being rendered.
Report = Callable[[float, float | None, str], object]


@dataclass(frozen=True)
class Task:
    """One render: of which kind, how large (in samples or seconds), and its name for people."""

    kind: str
    amount: float
    name: str


class Work:
    """Tasks done one after another. Those of one kind cost the same for the same amount."""

    def __init__(self, tasks: list[Task], report: Report | None) -> None:
        self._left = list(tasks)
        self._report = report
        self._pace: dict[str, float] = {}
        self._spent = 0.0
        self._current: Task | None = None
        self._start = 0.0

    def skip(self, task: Task) -> None:
        """It need not be done: its result is there."""
        self._left.remove(task)

    def begin(self, task: Task) -> None:
        """From here on `advance` tells about this one."""
        self._left.remove(task)
        self._current, self._start = task, time.monotonic()
        self.advance(0.0)

    def advance(self, fraction: float) -> None:
        """The current task is done to this part (0..1)."""
        if self._report is None or self._current is None:
            return
        seconds = time.monotonic() - self._start
        paces = dict(self._pace)
        if fraction > 0:
            paces[self._current.kind] = seconds / (fraction * self._current.amount)
        if not paces:
            self._report(0.0, None, self._current.name)
            return
        # Kinds that had no turn yet cost what the others do on average.
        usual = sum(paces.values()) / len(paces)
        here = self._current.amount * (1 - fraction) * paces.get(self._current.kind, usual)
        left = here + sum(task.amount * paces.get(task.kind, usual) for task in self._left)
        done = self._spent + seconds
        self._report(done / (done + left) if done > 0 else 0.0, left, self._current.name)

    def finish(self) -> None:
        """The current task is done."""
        assert self._current is not None
        seconds = time.monotonic() - self._start
        self._spent += seconds
        self._pace[self._current.kind] = max(seconds, 1e-9) / self._current.amount
        self.advance(1.0)
        self._current = None
