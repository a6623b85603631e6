"""Files that are dropped on the window."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from imgui_bundle import hello_imgui


def on_drop(receive: Callable[[list[str]], None]) -> None:
    """Have `receive` called with the paths of files that are dropped; once the window is there."""
    import glfw
    from imgui_bundle.glfw_utils import glfw_window_hello_imgui

    if hello_imgui.get_runner_params().platform_backend_type is not hello_imgui.PlatformBackendType.glfw:
        return
    drop: Any = lambda _, paths: receive(list(paths))  # noqa: E731
    glfw.set_drop_callback(glfw_window_hello_imgui(), drop)
