"""Windows driven by ImGui's own test engine: mouse and keyboard as a user would move them."""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from typing import Any

from imgui_bundle.imgui import test_engine

from etendue.viewer.status import State
from etendue.viewer.viewer import Viewer
from etendue.viewer.window import Window

PATIENCE = 600.0  # only who fails waits for so long
SIZE = (640, 480)  # fewer pixels for software to draw


class Hand:
    """What a test does to a window. Controls are named by page and label."""

    def __init__(self, context: Any, viewer: Viewer) -> None:
        self.context = context
        self.viewer = viewer

    def open(self, page: str) -> None:
        """Opens a page by its menu."""
        if self.viewer.page != page:
            self.context.item_click(f"//##MainMenuBar##MenuBar/{page.replace('/', chr(92) + '/')}")
            self.context.yield_(2)
        assert self.viewer.page == page

    def place(self, page: str, label: str) -> str:
        return f"//Panel/{page.replace('/', chr(92) + '/')}/{label.replace('/', chr(92) + '/')}"

    def type(self, place: str, value: float | str) -> None:
        """Types a value into a number or a text."""
        self.context.item_input_value(place, value)
        self.context.yield_(2)

    def click(self, place: str) -> None:
        self.context.item_click(place)
        self.context.yield_(2)

    def choose(self, place: str, value: str) -> None:
        """Chooses an item of a combo."""
        parent, name = place.rsplit("/", 1)
        self.context.set_ref(parent)
        self.context.combo_click(f"{name}/{value}")
        self.context.set_ref("")
        self.context.yield_(2)

    def press(self, *keys: Any) -> None:
        chord = 0
        for key in keys:
            chord |= int(key)
        self.context.key_press(chord)
        self.context.yield_(2)

    def wait(self, condition: Callable[[], bool], what: str) -> None:
        """Lets frames pass until something is so."""
        deadline = time.monotonic() + PATIENCE
        while not condition():
            assert time.monotonic() < deadline, f"no {what} in {PATIENCE:.0f} s: {self.viewer.session.status}"
            self.context.yield_()

    def wait_for_picture(self) -> None:
        config = self.viewer.document.config
        self.wait(lambda: self._shows(config.data), "picture of the change")

    def wait_until_done(self) -> None:
        self.wait(lambda: self.viewer.session.status.state is State.DONE, "end of the render")

    def _shows(self, data: dict[str, Any]) -> bool:
        scene = self.viewer.session.scene
        return scene is not None and scene.config.data == data and self.viewer.session.picture is not None


def drive(viewer: Viewer, steps: Callable[[Hand], None]) -> None:
    """Opens a window, takes the steps in it and closes it; what a step raises is raised."""
    window = Window(viewer)
    window.params.app_window_params.window_geometry.size = SIZE
    failures: list[BaseException] = []

    def run(context: Any) -> None:
        try:
            steps(Hand(context, viewer))
            assert not context.is_error(), "the test engine could not do what it was told"
        except BaseException as error:
            failures.append(error)
        finally:
            window.params.app_shall_exit = True

    def register(engine: Any) -> None:
        io = test_engine.get_io(engine)
        io.config_watchdog_kill_test = io.config_watchdog_warning = math.inf
        io.config_log_to_tty = True
        io.config_mouse_draw_cursor = False
        test = test_engine.register_test(engine, "viewer", "steps")
        test.test_func = run
        test_engine.queue_test(engine, test)

    window.run(register)
    if failures:
        raise failures[0]
