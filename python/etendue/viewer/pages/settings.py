"""Settings: how long and how well to render."""

from __future__ import annotations

from imgui_bundle import imgui

from ...config.located_json import Loc
from ..viewer import Viewer
from ..widgets import control, field

# As the exercise sheet calls them; every other key is called as in the scene file.
LABELS: dict[Loc, str] = {
    ("beauty_render",): "Beauty render",
    ("error_eps",): "error bound",
    ("framebuffer", "res_w"): "width",
    ("framebuffer", "res_h"): "height",
    ("framebuffer", "sppx"): "sppx",
    ("rr_min_path_length",): "RR min path length",
    ("rr_threshold",): "RR threshold",
    ("max_cam_path_length",): "max path length",
}
# On other pages, or of no use here.
_ELSEWHERE = ("$schema", "algorithm", "auto_focus", "framebuffer", "camera", "scene")


def draw(viewer: Viewer) -> None:
    """Draw the page."""
    document = viewer.document
    for loc, label in LABELS.items():
        field(document, loc, label)
    imgui.separator()
    for key in document.keys_of():
        if key not in _ELSEWHERE and (key,) not in LABELS:
            field(document, (key,), key)
    imgui.separator()
    node = {"type": "integer", "minimum": 0, "maximum": 1024, "description": "0 is one for each core."}
    changed, threads = control("threads", node, viewer.threads)
    if changed:
        viewer.use_threads(threads)
