"""The window: what is where in it, and its frames."""

from __future__ import annotations

import os
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

from imgui_bundle import hello_imgui, imgui, implot

from ..errors import EtendueError
from ..film import save_pixels
from . import bars, dialog, inspector, keys, plot, style
from .canvas import Canvas
from .dropping import on_drop
from .pages import PAGES
from .status import State
from .viewer import Viewer

SIZE = (1280, 800)
_PANEL = 21.0  # widths of the panel, in heights of a line of text
# Frames a second; the pause between two is up to a millisecond too long for 30.
_FRAMES_BUSY, _FRAMES_IDLE, _FRAMES_MOST = 31.0, 10.0, 60.0
_STILL = (
    imgui.WindowFlags_.no_decoration
    | imgui.WindowFlags_.no_move
    | imgui.WindowFlags_.no_saved_settings
    | imgui.WindowFlags_.no_bring_to_front_on_focus
)


class Window:
    """A window that shows a viewer; `run` returns when it is closed, and closes the viewer."""

    def __init__(self, viewer: Viewer, screenshot: Path | None = None, after: float = 0.0) -> None:
        self.viewer = viewer
        self.canvas = Canvas()
        self._screenshot, self._after = screenshot, after
        self._shown_since: float | None = None
        self.params = self._params()

    def run(self, tests: Callable[[Any], None] | None = None) -> None:
        """Opens the window. tests(engine) registers tests with ImGui's test engine, which then drives the window.

        Raises EtendueError where there is no display, or the screenshot cannot be written.
        """
        if tests is not None:
            self.params.use_imgui_test_engine = True
            self.params.callbacks.register_tests = lambda: tests(hello_imgui.get_imgui_test_engine())
        implot.create_context()
        try:
            hello_imgui.run(self.params)
        except RuntimeError as error:
            if "glfwInit" in str(error) or "Window" in str(error):
                raise EtendueError(no_display("it cannot be opened")) from error
            raise
        finally:
            implot.destroy_context()
            self.viewer.close()
        if self._screenshot is not None:
            save_pixels(self._screenshot, hello_imgui.final_app_window_screenshot()[..., :3].copy(), {})

    def _params(self) -> hello_imgui.RunnerParams:
        params = hello_imgui.RunnerParams()
        params.app_window_params.window_title = "Étendue"
        params.app_window_params.window_geometry.size = SIZE
        params.imgui_window_params.default_imgui_window_type = (
            hello_imgui.DefaultImGuiWindowType.no_default_window
        )
        # Nothing is remembered: the scene file is all there is to a session.
        params.ini_disable = True
        params.callbacks.load_additional_fonts = style.load_font
        params.callbacks.setup_imgui_style = style.apply
        params.callbacks.post_init = lambda: on_drop(self._drop)
        params.callbacks.show_gui = self._frame
        # Edges of triangles are smooth anyway, and software renderers are slow enough.
        options = hello_imgui.OpenGlOptions()
        options.anti_aliasing_samples = 1
        params.renderer_backend_options.open_gl_options = options
        params.fps_idling.fps_idle = _FRAMES_IDLE
        params.fps_idling.fps_max = _FRAMES_MOST
        return params

    def _drop(self, paths: list[str]) -> None:
        self.viewer.attempt(lambda: self.viewer.open(paths))

    def _frame(self) -> None:
        viewer = self.viewer
        keys.press(viewer)
        bars.draw_menu(viewer)
        self._draw_areas()
        if viewer.inspecting:
            self._place_over_image(at_bottom=False)
            inspector.draw(viewer)
        if viewer.split is not None:
            self._place_over_image(at_bottom=True)
            plot.draw(viewer)
        dialog.draw(viewer)
        viewer.update()
        if not imgui.is_any_item_active() and not keys.is_flying():
            viewer.document.end_gesture()
        self._pace()
        self._close_after_screenshot()

    def _pace(self) -> None:
        """Decides how soon the next frame follows; a test waits for none."""
        if self.params.use_imgui_test_engine:
            return
        busy = any(
            session.status.state in (State.RENDERING, State.LOADING) for session in self.viewer.sessions
        )
        pace = self.params.fps_idling
        # An idle window sleeps for as long as a frame may take, and draws after that: too late for a steady pace.
        pace.enable_idling = not busy
        pace.fps_max = _FRAMES_BUSY if busy else _FRAMES_MOST

    def _draw_areas(self) -> None:
        viewer, line = self.viewer, imgui.get_font_size()
        area = imgui.get_main_viewport()
        left, top = area.work_pos.x, area.work_pos.y
        padding = imgui.get_style().window_padding.y
        status = padding + imgui.get_text_line_height_with_spacing() * len(viewer.sessions)
        panel = _PANEL * line if viewer.page is not None else 0.0
        height = area.work_size.y - status
        if viewer.page is not None:
            _place((left, top), (panel, height))
            imgui.begin("Panel", None, _STILL & ~imgui.WindowFlags_.no_scrollbar)
            imgui.push_id(viewer.page)
            viewer.attempt(lambda: PAGES[viewer.page or "Camera"](viewer))
            imgui.pop_id()
            imgui.end()
        _place((left + panel, top), (area.work_size.x - panel, height))
        imgui.push_style_var(imgui.StyleVar_.window_padding, (0, 0))
        imgui.push_style_var(imgui.StyleVar_.window_rounding, 0)
        imgui.push_style_color(imgui.Col_.window_bg, (0.06, 0.06, 0.065, 1))
        imgui.begin("Image", None, _STILL | imgui.WindowFlags_.no_scroll_with_mouse)
        self.canvas.draw(viewer)
        self._draw_message()
        imgui.end()
        imgui.pop_style_color()
        imgui.pop_style_var(2)
        _place((left, top + height), (area.work_size.x, status))
        imgui.push_style_var(imgui.StyleVar_.window_padding, (12, padding / 2))
        imgui.push_style_var(imgui.StyleVar_.window_rounding, 0)
        imgui.begin("Status", None, _STILL)
        bars.draw_status(viewer)
        imgui.end()
        imgui.pop_style_var(2)

    def _place_over_image(self, at_bottom: bool) -> None:
        """Where a window of its own opens: beside the panel, whose controls stay in sight."""
        area, line = imgui.get_main_viewport(), imgui.get_font_size()
        y = area.work_pos.y + (area.work_size.y - 4 * line if at_bottom else line)
        at = area.work_pos.x + (_PANEL + 1) * line, y
        imgui.set_next_window_pos(at, imgui.Cond_.first_use_ever, (0, int(at_bottom)))

    def _draw_message(self) -> None:
        problem = self.viewer.session.status.problem
        message = (problem, True) if problem else self.viewer.message
        if message is None:
            return
        text, failed = message
        area, width = imgui.get_window_pos(), imgui.get_window_size().x - 60
        size = imgui.calc_text_size(text, False, width)
        at = area.x + 20, area.y + imgui.get_window_size().y - size.y - 24
        lines = imgui.get_window_draw_list()
        shade = imgui.get_color_u32((0.35, 0.1, 0.1, 0.92) if failed else (0.1, 0.1, 0.11, 0.88))
        lines.add_rect_filled((at[0] - 10, at[1] - 7), (at[0] + size.x + 10, at[1] + size.y + 7), shade, 5)
        imgui.set_cursor_screen_pos(at)
        imgui.push_text_wrap_pos(imgui.get_cursor_pos_x() + width)
        imgui.text_unformatted(text)
        imgui.pop_text_wrap_pos()

    def _close_after_screenshot(self) -> None:
        if self._screenshot is None:
            return
        now = time.monotonic()
        shown = self.canvas.picture is not None or self.viewer.session.status.state is State.FAILED
        if self._shown_since is None and shown:
            self._shown_since = now
        if self._shown_since is not None and now - self._shown_since >= self._after:
            self.params.app_shall_exit = True


def no_display(reason: str) -> str:
    """The message that there is no display."""
    return f"view: no display: {reason}. etendue render CONFIG writes an image without one"


def require_display() -> None:
    """Raises EtendueError where no window can be opened."""
    if sys.platform.startswith("linux") and not (
        os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY")
    ):
        raise EtendueError(no_display("neither DISPLAY nor WAYLAND_DISPLAY is set"))


def _place(corner: tuple[float, float], size: tuple[float, float]) -> None:
    imgui.set_next_window_pos(corner)
    imgui.set_next_window_size(size)
