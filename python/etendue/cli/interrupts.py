"""Ctrl-C and SIGTERM: the first ends a render so that what is done is saved, the second ends that, too."""

from __future__ import annotations

import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType, TracebackType
from typing import Any

_SIGNALS = (signal.SIGINT, signal.SIGTERM)


class Interrupts:
    """While it is entered, either signal raises KeyboardInterrupt, but for the first inside `shielded`."""

    def __init__(self) -> None:
        self._received: int | None = None
        self._shields = 0
        self._before: dict[signal.Signals, Any] = {}

    def __enter__(self) -> Interrupts:
        # Python lets the main thread alone decide about signals.
        if threading.current_thread() is threading.main_thread():
            self._before = {number: signal.signal(number, self._handle) for number in _SIGNALS}
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        for number, handler in self._before.items():
            signal.signal(number, handler)

    def _handle(self, number: int, frame: FrameType | None) -> None:
        is_first = self._received is None
        self._received = self._received or number
        if not (is_first and self._shields):
            raise KeyboardInterrupt

    @property
    def exit_code(self) -> int:
        """What a shell expects of a process that the signal ended; that of Ctrl-C where there was none."""
        return 128 + (self._received or signal.SIGINT)

    @property
    def by_signal(self) -> bool:
        """Whether there was one yet."""
        return self._received is not None

    @contextmanager
    def shielded(self) -> Iterator[None]:
        """What is inside is finished before the first signal counts; `by_signal` says if there was one."""
        self._shields += 1
        try:
            yield
        finally:
            self._shields -= 1
