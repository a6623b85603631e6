"""A render on its way."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

from numpy.typing import NDArray

from .. import _core
from ..film import Film
from ..film.progressive import grown
from ..scene import Scene
from .status import State, Status


@dataclass
class Live:
    """A scene on its way to a film. stride: of the last finished pass; 0: none yet."""

    scene: Scene
    renderer: _core.Renderer
    film: Film
    stride: int = 0
    seconds: float = 0.0
    since: float | None = None
    errors: list[tuple[float, float]] = field(default_factory=list)
    surfaces: dict[str, NDArray[Any]] = field(default_factory=dict)

    @property
    def clock(self) -> float:
        """Seconds spent rendering."""
        since = self.since
        return self.seconds + (0 if since is None else time.monotonic() - since)

    def taken(self) -> Film:
        """The film as it is now."""
        film = grown(self.film, self.film.goal, self.renderer)
        film.seconds = self.clock
        return film

    def status(self, state: State, problem: str | None) -> Status:
        """How far it is."""
        framebuffer = self.scene.config.framebuffer
        pixels, seconds = framebuffer.res_w * framebuffer.res_h, self.clock
        samples = self.renderer.samples_done
        missing = pixels * framebuffer.sppx - samples
        rate = samples / seconds if seconds > 0 else 0.0
        return Status(
            state,
            samples / pixels,
            framebuffer.sppx,
            rate,
            self.renderer.rays / seconds if seconds > 0 else 0.0,
            self.errors[-1][1] if self.errors else None,
            seconds,
            missing / rate if rate > 0 and state is State.RENDERING else None,
            problem,
        )

    def step(self, work: Callable[[], bool]) -> bool:
        """Does a part of the render, on the clock."""
        self.since = time.monotonic()
        try:
            return work()
        finally:
            self.seconds, self.since = self.clock, None
