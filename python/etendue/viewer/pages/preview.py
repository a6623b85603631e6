"""Preview: what is shown of the render, and how, and whether it goes on."""

from __future__ import annotations

import dataclasses

from imgui_bundle import imgui

from ...display.views import VIEWS
from ..pictures import MODES
from ..status import State
from ..viewer import Viewer
from ..widgets import buttons, control, field, tooltip


def draw(viewer: Viewer) -> None:
    """Draw the page."""
    for name, mode in MODES.items():
        if imgui.radio_button(mode.title, viewer.look.mode == name):
            viewer.look = dataclasses.replace(viewer.look, mode=name)
        tooltip(mode.summary)
    imgui.separator()
    field(viewer.document, ("framebuffer", "exposure"), "exposure")
    node = {"description": "How bright radiance is fitted to the screen, and to PNG and JPEG files."}
    changed, view = control("tone mapping", node, viewer.look.view, list(VIEWS))
    if changed:
        viewer.look = dataclasses.replace(viewer.look, view=view)
    changed, denoised = imgui.checkbox("Denoise", viewer.look.denoised)
    tooltip("Show the image denoised, which is biased. Files are saved as they are rendered.")
    if changed:
        viewer.denoise(denoised)
    imgui.separator()
    paused = viewer.session.status.state is State.PAUSED
    buttons(
        ("Restart", "Render from the first sample on (F5).", viewer.restart),
        ("Go on###pause" if paused else "Pause###pause", "Stop for a while (space).", viewer.pause),
        ("Abort", "Stop with what is there.", viewer.abort),
    )
    imgui.separator()
    changed, inspecting = imgui.checkbox("Pixel inspector", viewer.inspecting)
    tooltip("Click a pixel to see its value and the last paths through it (I).")
    if changed:
        viewer.inspecting = inspecting
