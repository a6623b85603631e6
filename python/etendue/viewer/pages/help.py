"""Help: the keys."""

from __future__ import annotations

from imgui_bundle import imgui

from ..keys import KEYS, MOUSE
from ..viewer import Viewer


def draw(viewer: Viewer) -> None:
    """Draw the page."""
    rows = [*((key.name, key.summary) for key in KEYS), *MOUSE]
    if imgui.begin_table("keys", 2, imgui.TableFlags_.row_bg | imgui.TableFlags_.sizing_stretch_prop):
        for name, summary in rows:
            imgui.table_next_row()
            imgui.table_next_column()
            imgui.text_unformatted(name)
            imgui.table_next_column()
            imgui.push_text_wrap_pos(0.0)
            imgui.text_unformatted(summary)
            imgui.pop_text_wrap_pos()
        imgui.end_table()
