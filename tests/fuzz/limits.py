"""What a hostile file may cost at most, enforced on this process while it reads one."""

from __future__ import annotations

import resource
import signal
from collections.abc import Iterator
from contextlib import contextmanager

SECONDS = 10
BYTES = 2 << 30


class Hang(BaseException):
    """Reading took longer than SECONDS. No Exception, so that no loader can catch it."""


def _hang(*_: object) -> None:
    raise Hang(f"no answer within {SECONDS} s")


def _address_space() -> int:
    with open("/proc/self/statm") as file:
        return int(file.read().split()[0]) * resource.getpagesize()


@contextmanager
def limits() -> Iterator[None]:
    """BYTES of memory on top of what is in use, else MemoryError; SECONDS of time, else Hang.

    A library that hangs hears no signal; then the kernel ends the process after twice the time.
    """
    soft, hard = resource.getrlimit(resource.RLIMIT_AS)
    handler = signal.signal(signal.SIGALRM, _hang)
    resource.setrlimit(resource.RLIMIT_AS, (_address_space() + BYTES, hard))
    signal.setitimer(signal.ITIMER_PROF, 2 * SECONDS)
    signal.alarm(SECONDS)
    try:
        yield
    finally:
        signal.alarm(0)
        signal.setitimer(signal.ITIMER_PROF, 0)
        resource.setrlimit(resource.RLIMIT_AS, (soft, hard))
        signal.signal(signal.SIGALRM, handler)


def ran_out_of_memory(error: BaseException) -> bool:
    """Whether the error, or one behind it, is that BYTES did not suffice."""
    seen: BaseException | None = error
    while seen is not None:
        if isinstance(seen, MemoryError) or "bad_alloc" in str(seen):
            return True
        seen = seen.__cause__ or seen.__context__
    return False
