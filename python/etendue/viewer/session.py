"""A render that goes on behind a window, and pictures of it. It knows no window, and no window waits for it.

`show` says what is wanted and returns at once. One thread renders it, another develops pictures, and whoever
shows them looks at `status` and `picture` as often as he likes.
"""

from __future__ import annotations

import dataclasses
import math
import os
import threading
import time
from collections.abc import Callable
from typing import Any

from .. import _core
from ..config import Config
from ..errors import EtendueError
from ..film import Film
from ..scene import Scene
from .live import Live
from .pictures import MOST_COARSE, Look, Picture, Source, Stale, develop
from .scenes import Scenes
from .status import State, Status

# Shortest time between two pictures, and how long after one as many times its cost.
_INTERVAL, _DUTY = 0.1, 4.0
# A first pass may take this long.
_FIRST = 0.04
# The window comes before the picture, and the picture before its samples: by so much less priority. Threads of the
# render are started by its own, and inherit this.
_NICE = {"render": 5, "develop": 2}


def _is_same(one: Config, other: Config) -> bool:
    return one.data == other.data and one.path == other.path


def _of_samples(config: Config) -> dict[str, Any]:
    """What decides what a sample is, and of a beauty render which there are; not how they are shown."""
    found = config.model_dump()
    del found["framebuffer"]["sppx"], found["framebuffer"]["exposure"]
    if not config.beauty_render:
        del found["error_eps"]
    return found | {"folder": config.folder}


def _rest(live: Live, config: Config) -> bool:
    """Renders all that is missing; whether it is there."""
    if config.beauty_render:
        return live.renderer.render_until(config.error_eps)
    return live.renderer.render(config.framebuffer.sppx)


class Session:
    """A live render. All methods may be called from the window's thread, and none of them waits for long."""

    def __init__(self, scenes: Scenes, threads: int = 0) -> None:
        self._scenes = scenes
        self._threads = threads
        self._films = _core.Films()
        self._changed = threading.Condition()
        self._config: Config | None = None
        self._version = 0
        self._fresh = 0
        self._state = State.LOADING
        self._problem: str | None = None
        self._paused = self._aborted = self._closed = False
        self._live: Live | None = None
        # What takes the place of what is shown when it has learned.
        self._coming: Live | None = None
        self._look = Look()
        self._undeveloped = False
        self._picture: Picture | None = None
        self._trouble: str | None = None
        self._crash: BaseException | None = None
        self._sample_seconds = math.inf
        self._workers = [
            threading.Thread(
                target=self._guarded, args=(work, _NICE[name]), name=f"etendue-{name}", daemon=True
            )
            for name, work in (("render", self._render_forever), ("develop", self._develop_forever))
        ]
        for worker in self._workers:
            worker.start()

    # What a window asks for.

    def show(self, config: Config, restart: bool = False) -> None:
        """Render this config from now on; where only more samples are asked for, what is there is kept."""
        with self._changed:
            if self._config is not None and _is_same(config, self._config) and not restart:
                return
            self._config = config
            self._version += 1
            if restart:
                self._fresh = self._version
            self._paused = self._aborted = False
            self._interrupt()

    def restart(self, threads: int | None = None) -> None:
        """Render the same again, from the first sample on, perhaps by another number of threads."""
        if threads is not None:
            self._threads = threads
        if self._config is not None:
            self.show(self._config, restart=True)

    def pause(self, paused: bool = True) -> None:
        """Stop, or go on."""
        with self._changed:
            if self._state in (State.RENDERING, State.PAUSED):
                self._paused = paused
                self._state = State.PAUSED if paused else State.RENDERING
                self._interrupt()

    def abort(self) -> None:
        """Stop for good, with what is there."""
        with self._changed:
            if self._state in (State.RENDERING, State.PAUSED):
                self._version += 1
                self._aborted = True
                self._state = State.ABORTED
                self._interrupt()

    def look(self, look: Look) -> None:
        """Show the render in another way."""
        with self._changed:
            if look != self._look:
                self._look = look
                self._undeveloped = True
                self._changed.notify_all()

    @property
    def picture(self) -> Picture | None:
        """The newest picture."""
        return self._picture

    def take_trouble(self) -> str | None:
        """Why the last picture could not be made as it was to be, told once."""
        trouble, self._trouble = self._trouble, None
        return trouble

    @property
    def scene(self) -> Scene | None:
        """The scene of what is shown."""
        live = self._live
        return None if live is None else live.scene

    @property
    def renderer(self) -> _core.Renderer | None:
        """The renderer of what is shown."""
        live = self._live
        return None if live is None else live.renderer

    @property
    def errors(self) -> list[tuple[float, float]]:
        """Estimates of the relative error so far, with the seconds of rendering after which each was made."""
        live = self._live
        return [] if live is None else list(live.errors)

    def film(self) -> Film | None:
        """The film as it is now; None: there is none yet."""
        live = self._live
        return None if live is None or live.hurried else live.taken()

    @property
    def status(self) -> Status:
        """How far it is. Raises what went wrong where it should not."""
        if self._crash is not None:
            raise self._crash
        live = self._live
        if live is None:
            return Status(self._state, problem=self._problem)
        return live.status(self._state, self._problem)

    def close(self) -> None:
        """End the threads; returns once they have."""
        with self._changed:
            self._closed = True
            self._interrupt()
        for worker in self._workers:
            worker.join()

    def _interrupt(self) -> None:
        """Ends the running pass, unless it is the first: however fast changes come, each shows something."""
        if self._live is not None and self._live.stride:
            self._live.renderer.cancel()
        if self._coming is not None:
            self._coming.renderer.cancel()
        self._changed.notify_all()

    # The render's thread.

    def _guarded(self, work: Callable[[], None], nice: int) -> None:
        thread = threading.get_native_id()
        # A viewer that was begun with less priority may not take more.
        os.setpriority(os.PRIO_PROCESS, thread, min(os.getpriority(os.PRIO_PROCESS, thread) + nice, 19))
        try:
            work()
        except BaseException as error:
            self._crash = error

    def _render_forever(self) -> None:
        done = 0
        while True:
            with self._changed:
                self._changed.wait_for(lambda: self._closed or self._version != done)  # noqa: B023
                if self._closed:
                    return
                version, config, aborted = self._version, self._config, self._aborted
            if config is not None and not aborted:
                try:
                    self._render(version, config)
                except (EtendueError, MemoryError) as error:
                    self._finish(version, State.FAILED, str(error) or "not enough memory")
            done = version

    def _finish(self, version: int, state: State, problem: str | None = None) -> None:
        with self._changed:
            if version == self._version:
                self._state, self._problem = state, problem
            # What is loading has nothing to show yet.
            self._undeveloped = self._undeveloped or state is not State.LOADING
            self._changed.notify_all()

    def _render(self, version: int, config: Config) -> None:
        live = self._live
        if live is not None and self._goes_on(live, version, config):
            live.scene = dataclasses.replace(live.scene, config=config)
        else:
            self._finish(version, State.LOADING)
            scene = self._scenes.get(config)
            stride = self._first_stride(config)
            # Whoever changed something is waiting: what is learned comes after the first picture.
            live = first = Live(scene, scene.renderer(self._threads, films=self._films, prepares=False))
            first.hurried = first.renderer.learns
            before = time.monotonic()
            first.step(lambda: first.renderer.render_coarse(stride))
            self._sample_seconds = (time.monotonic() - before) / max(first.renderer.samples_done, 1)
            with self._changed:
                self._live = first
                self._advanced(first, stride)
            if first.hurried:
                self._finish(version, State.RENDERING)
                live = Live(scene, scene.renderer(self._threads, films=self._films))
                if not self._takes_over(version, live, stride):
                    return
        self._finish(version, State.RENDERING)
        while live.stride > 1:
            stride = live.stride // 2
            if stride > 1 and not self._step(version, live, lambda: live.renderer.render_coarse(stride)):  # noqa: B023
                return
            if stride == 1 and not self._step(version, live, lambda: live.renderer.render(1)):
                return
            with self._changed:
                self._advanced(live, stride)
        self._films.settle(config.framebuffer.res_w, config.framebuffer.res_h)
        if self._step(version, live, lambda: _rest(live, config)):
            live.note_error()
            self._finish(version, State.DONE)

    def _takes_over(self, version: int, live: Live, stride: int) -> bool:
        """Shows what has learned instead of the hurried picture before it. False where something else is wanted."""
        self._coming = live
        learned = self._step(version, live, live.renderer.prepare)
        if learned and self._step(version, live, lambda: live.renderer.render_coarse(stride)):
            with self._changed:
                self._live, self._coming = live, None
                self._advanced(live, stride)
            return True
        self._coming = None
        return False

    def _goes_on(self, live: Live, version: int, config: Config) -> bool:
        """Whether what is there is part of what is wanted."""
        if live.hurried or self._fresh == version or _of_samples(live.scene.config) != _of_samples(config):
            return False
        return config.beauty_render or config.framebuffer.sppx >= int(live.renderer.sample_count().max())

    def _first_stride(self, config: Config) -> int:
        pixels = config.framebuffer.res_w * config.framebuffer.res_h
        stride = 2
        while stride < MOST_COARSE and self._sample_seconds * pixels / stride**2 > _FIRST:
            stride *= 2
        return stride

    def _advanced(self, live: Live, stride: int) -> None:
        live.stride = stride
        self._undeveloped = True
        self._changed.notify_all()

    def _step(self, version: int, live: Live, work: Callable[[], bool]) -> bool:
        """Does a part of the render, through all pauses. False where something else is wanted."""
        while True:
            with self._changed:
                self._changed.wait_for(lambda: self._closed or self._version != version or not self._paused)
                if self._closed or self._version != version:
                    return False
            if live.step(work):
                return True

    # The thread that develops pictures.

    def _develop_forever(self) -> None:
        number, wait = 0, _INTERVAL
        shown: Live | None = None
        while True:
            with self._changed:
                rendering = self._state is State.RENDERING
                self._changed.wait_for(lambda: self._closed or self._undeveloped, wait if rendering else None)
                if self._closed:
                    return
                live, look, is_new = self._live, self._look, self._undeveloped
                self._undeveloped = False
            if live is None or not live.stride:
                continue
            start = time.monotonic()
            # Between two passes, with what the finer one has so far.
            stride = live.stride if is_new else max(live.stride // 2, 1)
            source = self._source(live, look, stride, live is shown)
            number += 1
            try:
                self._picture = develop(source, look, number)
                shown = live
            except Stale:
                continue
            except EtendueError as refused:
                self._trouble = str(refused)
            cost = time.monotonic() - start
            live.note_error()
            wait = max(_INTERVAL, _DUTY * cost)

    def _source(self, live: Live, look: Look, stride: int, is_shown: bool) -> Source:
        version = self._version

        def go_on(_: float) -> None:
            # A change waits for no other picture of what it replaces, but has the first one even so.
            is_old = self._live is not live or (is_shown and self._version != version)
            if self._closed or is_old or self._look != look:
                raise Stale

        return Source(live.scene, live.renderer, stride, live.taken, live.surfaces, go_on)
