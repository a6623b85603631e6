"""Camera: where it stands, where it looks, and its lens."""

from __future__ import annotations

from imgui_bundle import imgui

from ..viewer import Viewer
from ..widgets import buttons, control, field

FIELDS = {
    "pos": "pos",
    "dir": "dir",
    "up": "up",
    "fov": "fov",
    "lens_radius": "lens radius",
    "focal_depth": "focal depth",
    "perspective": "perspective",
}


def draw(viewer: Viewer) -> None:
    """Draw the page."""
    document = viewer.document
    for key in document.keys_of(("camera",)):
        if key == "focal_depth":
            field(document, ("auto_focus",), "auto focal depth")
            imgui.begin_disabled(document.config.auto_focus)
            scene = viewer.session.scene
            auto = scene is not None and document.config.auto_focus
            shown = scene.focal_depth if auto and scene is not None else None
            field(document, ("camera", key), FIELDS[key], shown)
            imgui.end_disabled()
        else:
            field(document, ("camera", key), FIELDS.get(key, key))
    imgui.separator()
    node = {
        "type": "number",
        "exclusiveMinimum": 0,
        "description": "How fast WASD and RF fly. Also: the mouse wheel.",
    }
    changed, speed = control("speed", node, viewer.speed)
    if changed:
        viewer.speed = speed
    imgui.separator()
    buttons(
        (
            "Copy",
            "Copy the camera to the clipboard, as JSON.",
            lambda: imgui.set_clipboard_text(viewer.copied_camera()),
        ),
        (
            "Paste",
            "Take the camera from JSON on the clipboard.",
            lambda: viewer.attempt(lambda: viewer.paste_camera(imgui.get_clipboard_text() or "")),
        ),
    )
