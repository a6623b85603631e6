"""Controls drawn from the scene file's schema: its limits, its choices, and what each key means as a tooltip."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

from imgui_bundle import imgui

from ..config.located_json import Loc
from ..config.schema import Schema
from .document import Document

_LABELS, _RESET = 8.6, 1.7  # widths, in heights of a line of text
_LARGEST_INT = 2**31 - 1
_FORMAT = "%.4g"


def control(label: str, node: Schema, value: Any, choices: list[str] | None = None) -> tuple[bool, Any]:
    """A labelled control for a value of this schema: whether it was changed, and to what."""
    _label(label, node.get("description"))
    return bare_control(label, node, value, choices)


def bare_control(label: str, node: Schema, value: Any, choices: list[str] | None = None) -> tuple[bool, Any]:
    """The same without the label beside it."""
    name, kind = f"##{label}", node.get("type")
    known = choices or node.get("enum")
    if known is not None:
        changed, new = _choice(name, [str(one) for one in known], value)
    elif kind == "boolean":
        changed, new = imgui.checkbox(name, bool(value))
    elif kind == "integer":
        changed, new = _integer(name, node, int(value))
    elif kind == "number":
        changed, new = _number(name, node, float(value))
    elif kind == "array":
        changed, new = _triple(name, node, list(value))
    else:
        changed, new = imgui.input_text(name, str(value or ""), imgui.InputTextFlags_.enter_returns_true)
    description = node.get("description")
    if description:
        tooltip(description)
    return changed, new


def field(document: Document, loc: Loc, label: str, shown: Any = None) -> None:
    """The control of one key of the scene file. shown: what the key amounts to where the file leaves it open."""
    node = document.schema(loc)
    if node.get("type") == "array":
        node = {**node, "limits": document.limits(loc)}
    value = document.value(loc)
    changed, new = control(label, node, value if shown is None else shown)
    if changed:
        document.set({loc: new}, gesture=loc)


def material_field(document: Document, name: str, key: str, label: str, node: Schema, shown: Any) -> None:
    """The control of one key of a material's patch, with a button that takes the key back to the mesh file's."""
    patch = next((p for p in reversed(document.config.scene.materials) if p.name == name), None)
    is_patched = patch is not None and getattr(patch, key) is not None
    _label(label, node.get("description"), reset=True)
    changed, new = bare_control(label, node, shown)
    if changed:
        document.set_material(name, {key: new}, gesture=(name, key))
    imgui.same_line()
    imgui.begin_disabled(not is_patched)
    if imgui.button(f"x##{label}"):
        document.set_material(name, {key: None})
    imgui.end_disabled()
    tooltip("As the mesh file and the material's type have it.")


def buttons(*actions: tuple[str, str, Callable[[], object]]) -> None:
    """Buttons side by side, as wide as there is room: label, tooltip, what each does."""
    room, gap = imgui.get_content_region_avail().x, imgui.get_style().item_spacing.x
    width = (room - gap * (len(actions) - 1)) / len(actions)
    for index, (label, summary, action) in enumerate(actions):
        if index:
            imgui.same_line()
        if imgui.button(label, (width, 0)):
            action()
        tooltip(summary)


def text_row(label: str, text: str) -> None:
    """A label and a text that cannot be changed."""
    _label(label, None)
    imgui.push_text_wrap_pos(0.0)
    imgui.text_unformatted(text)
    imgui.pop_text_wrap_pos()


def tooltip(text: str) -> None:
    """Tells about the control before it, while the mouse rests on it."""
    if imgui.is_item_hovered(imgui.HoveredFlags_.for_tooltip) and imgui.begin_tooltip():
        imgui.push_text_wrap_pos(imgui.get_font_size() * 24)
        imgui.text_unformatted(text)
        imgui.pop_text_wrap_pos()
        imgui.end_tooltip()


def _label(label: str, description: str | None, reset: bool = False) -> None:
    line = imgui.get_font_size()
    imgui.align_text_to_frame_padding()
    imgui.text_unformatted(label)
    if description:
        tooltip(description)
    if imgui.calc_text_size(label).x < (_LABELS - 0.5) * line:
        imgui.same_line(_LABELS * line)
    else:
        imgui.set_cursor_pos_x(_LABELS * line)
    imgui.set_next_item_width(-_RESET * line if reset else -1)


def _choice(name: str, known: list[str], value: Any) -> tuple[bool, Any]:
    index = known.index(str(value)) if str(value) in known else -1
    changed, new = imgui.combo(name, index, known)
    return changed and new != index, known[new] if new >= 0 else value


def _integer(name: str, node: Schema, value: int) -> tuple[bool, int]:
    low, high = node.get("minimum", -_LARGEST_INT), node.get("maximum", _LARGEST_INT)
    if high > _LARGEST_INT:
        typing = imgui.InputTextFlags_.chars_decimal | imgui.InputTextFlags_.enter_returns_true
        changed, text = imgui.input_text(name, str(value), typing)
        is_number = text.isdecimal() and low <= int(text) <= high
        return changed and is_number, int(text) if is_number else value
    speed = max(abs(value) / 200, 0.05)
    return imgui.drag_int(name, value, speed, low, high, "%d", imgui.SliderFlags_.always_clamp)


def _bounds(node: Schema) -> tuple[float, float]:
    low = float(node.get("minimum", node.get("exclusiveMinimum", -math.inf)) or 0)
    high = float(node.get("maximum", node.get("exclusiveMaximum", math.inf)) or 0)
    # What is excluded is kept off by the smallest step that the control shows.
    low += 1e-3 if "exclusiveMinimum" in node else 0
    return low, high - (1e-3 if "exclusiveMaximum" in node else 0)


def _number(name: str, node: Schema, value: float) -> tuple[bool, float]:
    low, high = _bounds(node)
    clamp = imgui.SliderFlags_.always_clamp
    if high - low <= 360:
        changed, new = imgui.slider_float(name, value, low, high, _FORMAT, clamp)
    else:
        low, high = max(low, -1e30), min(high, 1e30)
        changed, new = imgui.drag_float(name, value, _speed([value]), low, high, _FORMAT, clamp)
    return changed, _rounded(new)


def _triple(name: str, node: Schema, value: list[float]) -> tuple[bool, list[float]]:
    limits = node.get("limits", {})
    if (limits.get("minimum"), limits.get("maximum")) == (0, 1):
        shown = [min(max(float(v), 0.0), 1.0) for v in value]
        changed, new = imgui.color_edit3(name, shown, imgui.ColorEditFlags_.float)
        return changed, [min(max(_rounded(v), 0.0), 1.0) for v in new]
    changed, new = imgui.drag_float3(name, [float(v) for v in value], _speed(value), 0, 0, _FORMAT)
    return changed, [_rounded(v) for v in new]


def _speed(values: list[float]) -> float:
    return max(max(abs(value) for value in values) / 200, 0.005)


def _rounded(value: float) -> float:
    """Without the digits that single precision made up."""
    return float(f"{value:.7g}")
