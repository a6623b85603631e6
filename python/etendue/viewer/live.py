"""A render on its way."""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

from numpy.typing import NDArray

from .. import _core
from ..film import Film
from ..film.progressive import grown, grown_beauty
from ..scene import Scene
from .status import State, Status


@dataclass
class Live:
    """A scene on its way to a film.

    stride: of the last finished pass; 0: none yet. hurried: it shows something until another has learned.
    """

    scene: Scene
    renderer: _core.Renderer
    hurried: bool = False
    stride: int = 0
    seconds: float = 0.0
    since: float | None = None
    errors: list[tuple[float, float]] = field(default_factory=list)
    surfaces: dict[str, NDArray[Any]] = field(default_factory=dict)

    @property
    def bound(self) -> float | None:
        """The error to be reached; None: it is a number of samples."""
        config = self.scene.config
        return config.error_eps if config.beauty_render else None

    @property
    def clock(self) -> float:
        """Seconds spent rendering."""
        since = self.since
        return self.seconds + (0 if since is None else time.monotonic() - since)

    def taken(self) -> Film:
        """The film as it is now."""
        # Made when it is asked for: a change that is flown over needs none.
        film, bound = self.scene.empty_film(), self.bound
        if bound is None:
            film = grown(film, film.goal, self.renderer)
        else:
            film = grown_beauty(film, 0, self.renderer)
            film.complete = self.renderer.error <= bound
        film.seconds = self.clock
        return film

    def status(self, state: State, problem: str | None) -> Status:
        """How far it is."""
        framebuffer, seconds, error = self.scene.config.framebuffer, self.clock, self.error
        pixels, samples = framebuffer.res_w * framebuffer.res_h, self.renderer.samples_done
        fraction = samples / (pixels * framebuffer.sppx)
        bound = self.bound
        if bound is not None:
            # The error falls with the root of the number of samples.
            fraction = 0.0 if error is None else min((bound / error) ** 2, 1.0)
        running = state is State.RENDERING and fraction > 0
        return Status(
            state,
            samples / pixels,
            None if bound is not None else framebuffer.sppx,
            fraction,
            samples / seconds if seconds > 0 else 0.0,
            self.renderer.rays / seconds if seconds > 0 else 0.0,
            error,
            bound,
            seconds,
            seconds * (1 / fraction - 1) if running else None,
            problem,
        )

    @property
    def error(self) -> float | None:
        """The estimate of the film's error; None: unknown yet."""
        error = self.renderer.error
        return error if math.isfinite(error) else None

    def note_error(self) -> None:
        """Adds the error to `errors`, if there is news of it."""
        error = self.error
        if error is not None and (not self.errors or self.errors[-1][1] != error):
            self.errors.append((self.clock, error))

    def step(self, work: Callable[[], bool]) -> bool:
        """Does a part of the render, on the clock."""
        self.since = time.monotonic()
        try:
            return work()
        finally:
            self.seconds, self.since = self.clock, None
