"""How the window looks: its font, its colours, its spacing."""

from __future__ import annotations

from imgui_bundle import ImVec2, hello_imgui, imgui

_FONT, _SIZE = "fonts/Roboto/Roboto-Regular.ttf", 15.0
_ACCENT = (0.26, 0.52, 0.80)


def load_font() -> None:
    """The font of all text."""
    hello_imgui.load_font(_FONT, _SIZE)


def apply() -> None:
    """A dark theme that leaves the picture the brightest thing in the window."""
    imgui.style_colors_dark()
    style = imgui.get_style()
    style.window_rounding = style.child_rounding = style.popup_rounding = 6
    style.frame_rounding = style.grab_rounding = 4
    style.window_border_size = style.popup_border_size = 0
    style.frame_padding = ImVec2(8, 4)
    style.item_spacing = ImVec2(8, 6)
    style.window_padding = ImVec2(12, 10)
    style.scrollbar_size = 12
    col = imgui.Col_

    def accent(strength: float, alpha: float = 1.0) -> tuple[float, float, float, float]:
        red, green, blue = (channel * strength for channel in _ACCENT)
        return red, green, blue, alpha

    grey = {
        col.window_bg: 0.105, col.popup_bg: 0.13, col.menu_bar_bg: 0.14, col.frame_bg: 0.19,
        col.frame_bg_hovered: 0.24, col.frame_bg_active: 0.28, col.button: 0.23, col.separator: 0.22,
        col.title_bg: 0.13, col.title_bg_active: 0.16, col.header: 0.20, col.child_bg: 0.09,
        col.scrollbar_bg: 0.105, col.scrollbar_grab: 0.28, col.table_row_bg_alt: 0.13,
    }  # fmt: skip
    for place, value in grey.items():
        style.set_color_(place, (value, value + 0.004, value + 0.012, 1.0))
    style.set_color_(col.text, (0.90, 0.91, 0.92, 1.0))
    style.set_color_(col.text_disabled, (0.55, 0.57, 0.60, 1.0))
    for place, strength in (
        (col.button_hovered, 0.85), (col.button_active, 1.0), (col.header_hovered, 0.75), (col.header_active, 0.9),
        (col.slider_grab, 1.0), (col.slider_grab_active, 1.2), (col.check_mark, 1.25), (col.resize_grip_hovered, 1.0),
    ):  # fmt: skip
        style.set_color_(place, accent(strength))
