"""How far a render is, for those who watch it."""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import Enum


class State(Enum):
    """What a session is doing."""

    LOADING = "loading"
    RENDERING = "rendering"
    PAUSED = "paused"
    ABORTED = "aborted"
    DONE = "done"
    FAILED = "failed"


@dataclass(frozen=True)
class Status:
    """How far a render is. `seconds` is time spent rendering; rates are means over it.

    goal: samples per pixel to reach; None: it is the error that is to fall to `bound`. error: estimate of the
    relative error; None: not known yet. eta: seconds until it is done. problem: why there is nothing to render.
    """

    state: State = State.LOADING
    spp: float = 0.0
    goal: int | None = None
    fraction: float = 0.0
    samples_per_second: float = 0.0
    rays_per_second: float = 0.0
    error: float | None = None
    bound: float | None = None
    seconds: float = 0.0
    eta: float | None = None
    problem: str | None = None

    @property
    def percent(self) -> int:
        """100 when all is done, and not before."""
        if self.state is State.DONE:
            return 100
        return min(math.floor(100 * self.fraction), 99)
