"""The viewer's window beside a render on all cores: how many frames it gets, and how soon a change is seen.

`xvfb-run -a -s "-screen 0 1280x800x24" python -m benchmarks.viewer`, in a minute; docs/viewer.md has what it found.
"""

from __future__ import annotations

import argparse
import math
import os
import statistics
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

from etendue.config import Config
from etendue.viewer import session as sessions
from etendue.viewer.navigation import flown, turned
from etendue.viewer.status import State
from etendue.viewer.viewer import Viewer
from etendue.viewer.window import Window

from .scenes import ROOT

SIZE = ("framebuffer.res_w=1280", "framebuffer.res_h=720", "framebuffer.sppx=1000000")
_PATIENCE = 120.0
_REST = 0.4  # seconds of rendering between two changes
_SETTLED = 4.0  # until nothing is left of a change but its render


class Probe:
    """Makes changes in a window as a hand would, and notes which frame shows them."""

    def __init__(self, scene: str, seconds: float, changes: int) -> None:
        self._viewer = Viewer([ROOT / "configs" / f"a04_{scene}.json"], overrides=SIZE)
        self._window = Window(self._viewer)
        self._seconds, self._changes = seconds, changes
        self._configs: dict[int, Config] = {}  # by the picture's number
        self._frames: list[float] = []  # when each was on the screen
        self._found: dict[str, float] = {}

    def run(self) -> dict[str, float]:
        """What was measured, in frames a second and milliseconds."""
        develop, callbacks = sessions.develop, self._window.params.callbacks
        draw, steps = callbacks.show_gui, self._steps()

        def noted(source: Any, look: Any, number: int) -> Any:
            self._configs[number] = source.scene.config
            return develop(source, look, number)

        def frame() -> None:
            next(steps, None)
            draw()

        sessions.develop = noted
        callbacks.show_gui = frame
        callbacks.after_swap = lambda: self._frames.append(time.monotonic())
        try:
            self._window.run()
        finally:
            sessions.develop = develop
        return self._found

    def _steps(self) -> Iterator[None]:
        yield from self._until(lambda: self._viewer.session.status.spp > 1)
        yield from self._untouched()
        yield from self._single_changes("turns", self._turn)
        yield from self._single_changes("materials", self._polish)
        yield from self._flight()
        self._window.params.app_shall_exit = True

    def _until(self, condition: Callable[[], bool]) -> Iterator[None]:
        deadline = time.monotonic() + _PATIENCE
        while not condition():
            assert time.monotonic() < deadline, self._viewer.session.status
            yield

    def _for(self, seconds: float) -> Iterator[None]:
        end = time.monotonic() + seconds
        yield from self._until(lambda: time.monotonic() >= end)

    def _untouched(self) -> Iterator[None]:
        yield from self._for(_SETTLED)
        self._frames.clear()
        own, drawing = time.thread_time(), seconds_of("llvmpipe")
        yield from self._for(self._seconds)
        assert self._viewer.session.status.state is State.RENDERING
        frames = len(self._frames) / 1000
        self._found["window's thread, ms a frame"] = (time.thread_time() - own) / frames
        self._found["software for OpenGL, ms a frame"] = (seconds_of("llvmpipe") - drawing) / frames
        self._note_frames("untouched")

    def _single_changes(self, name: str, change: Callable[[int], None]) -> Iterator[None]:
        waits = []
        for index in range(self._changes):
            yield from self._for(_REST)
            change(index)
            wanted, changed = self._viewer.document.config, time.monotonic()
            yield from self._until(lambda: self._shown() is wanted)  # noqa: B023
            waits.append(self._frames[-1] - changed)
        self._note_waits(name, waits)

    def _turn(self, index: int) -> None:
        turn = 0.01 * math.sin(index), 0.01 * math.cos(index)
        self._viewer.document.set(turned(self._viewer.document.config.camera, *turn), "look")

    def _polish(self, index: int) -> None:
        assert self._viewer.session.scene is not None
        name = self._viewer.session.scene.surfaces.of_meshes[0].material.name
        self._viewer.document.set_material(name, {"roughness": (index % 9 + 1) / 10}, name)

    def _flight(self) -> Iterator[None]:
        """A change a frame: each is seen when its picture is, or that of a later one."""
        yield from self._for(_REST)
        self._frames.clear()
        waits, pending = [], []
        end = time.monotonic() + self._seconds
        while pending or time.monotonic() < end:
            if time.monotonic() < end:
                forward = 0.01 if len(self._frames) // 30 % 2 else -0.01
                self._viewer.document.set(flown(self._viewer.document.config.camera, 0, 0, forward), "fly")
                pending.append((self._viewer.document.config, time.monotonic()))
            yield
            shown = [config is self._shown() for config, _ in pending]
            if any(shown):
                seen = shown.index(True) + 1
                waits += [self._frames[-1] - changed for _, changed in pending[:seen]]
                del pending[:seen]
        self._note_frames("flight")
        self._note_waits("flight", waits)

    def _shown(self) -> Config | None:
        """What the last frame has shown."""
        picture = self._window.canvas.picture
        return None if picture is None else self._configs.get(picture.number)

    def _note_frames(self, name: str) -> None:
        between = [after - before for before, after in zip(self._frames, self._frames[1:], strict=False)]
        self._found[f"{name}: frames a second"] = 1 / statistics.mean(between)
        self._found[f"{name}: 95% of frames within, ms"] = 1000 * statistics.quantiles(between, n=20)[-1]

    def _note_waits(self, name: str, seconds: list[float]) -> None:
        self._found[f"{name}: seen after, median, ms"] = 1000 * statistics.median(seconds)
        self._found[f"{name}: seen after, 95th percentile, ms"] = (
            1000 * statistics.quantiles(seconds, n=20)[-1]
        )
        self._found[f"{name}: seen after, longest, ms"] = 1000 * max(seconds)


def seconds_of(name: str) -> float:
    """Seconds of the processor that this process's threads of such a name have taken."""
    ticks = 0
    for folder in Path("/proc/self/task").iterdir():
        of_thread, _, numbers = (folder / "stat").read_text().rpartition(")")
        if name in of_thread:
            ticks += sum(map(int, numbers.split()[11:13]))
    return ticks / os.sysconf("SC_CLK_TCK")


def main() -> None:
    """Measures, and prints a table."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.viewer", description=__doc__)
    parser.add_argument("scenes", nargs="*", default=["box", "sibenik"], metavar="SCENE")
    parser.add_argument("--seconds", type=float, default=6, help="of a render untouched, and of a flight")
    parser.add_argument("--changes", type=int, default=30, help="single ones")
    arguments = parser.parse_args()
    load = os.getloadavg()[0]
    found = {name: Probe(name, arguments.seconds, arguments.changes).run() for name in arguments.scenes}
    print(f"load before: {load:.1f}, {os.cpu_count()} cores\n")
    print(f"| | {' | '.join(found)} |\n|---|{'---|' * len(found)}")
    for figure in next(iter(found.values())):
        print(f"| {figure} | {' | '.join(f'{of_scene[figure]:.1f}' for of_scene in found.values())} |")


if __name__ == "__main__":
    main()
