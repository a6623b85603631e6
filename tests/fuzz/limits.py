"""What a hostile file may cost at most, enforced on this process while it reads one."""

from __future__ import annotations

import resource
import signal
import time
from collections.abc import Iterator
from contextlib import contextmanager

SECONDS = 10  # of the processor, so that a busy machine is no hang
ASLEEP = 120  # by the clock, for what waits without end
BYTES = 2 << 30


class Hang(BaseException):
    """Reading took longer than SECONDS. No Exception, so that no loader can catch it."""


def _hang(*_: object) -> None:
    raise Hang(f"no answer within {SECONDS} s of the processor, or {ASLEEP} s in all")


def _address_space() -> int:
    with open("/proc/self/statm") as file:
        return int(file.read().split()[0]) * resource.getpagesize()


@contextmanager
def limits() -> Iterator[None]:
    """BYTES of memory on top of what is in use, else MemoryError; SECONDS of work, else Hang.

    A library that hangs hears no signal; then the kernel ends the process after twice the work.
    """
    memory, processor = resource.getrlimit(resource.RLIMIT_AS), resource.getrlimit(resource.RLIMIT_CPU)
    handlers = {number: signal.signal(number, _hang) for number in (signal.SIGPROF, signal.SIGALRM)}
    resource.setrlimit(resource.RLIMIT_AS, (_address_space() + BYTES, memory[1]))
    resource.setrlimit(resource.RLIMIT_CPU, (int(time.process_time()) + 2 * SECONDS, processor[1]))
    signal.setitimer(signal.ITIMER_PROF, SECONDS)
    signal.alarm(ASLEEP)
    try:
        yield
    finally:
        signal.alarm(0)
        signal.setitimer(signal.ITIMER_PROF, 0)
        resource.setrlimit(resource.RLIMIT_CPU, processor)
        resource.setrlimit(resource.RLIMIT_AS, memory)
        for number, handler in handlers.items():
            signal.signal(number, handler)


def ran_out_of_memory(error: BaseException) -> bool:
    """Whether the error, or one behind it, is that BYTES did not suffice."""
    seen: BaseException | None = error
    while seen is not None:
        if isinstance(seen, MemoryError) or "bad_alloc" in str(seen):
            return True
        seen = seen.__cause__ or seen.__context__
    return False
