"""Algorithms: whatever estimators are registered, with the parameters of each."""

from __future__ import annotations

from typing import Any

from imgui_bundle import imgui

from ... import _core
from ..split import other_than
from ..viewer import Viewer
from ..widgets import control, field, tooltip
from .settings import LABELS


def draw(viewer: Viewer) -> None:
    """Draw the page."""
    document = viewer.document
    for info in _core.algorithms():
        if imgui.radio_button(info.name, document.config.algorithm == info.name):
            document.set({("algorithm",): info.name})
        tooltip(info.summary)
    imgui.separator_text(document.config.algorithm)
    for parameter in parameters_of(document.config.algorithm):
        field(document, (parameter.name,), label_of(parameter.name))
    imgui.separator_text("Split view")
    imgui.text_wrapped("A second estimator of the same scene, right of a line that can be dragged.")
    changed, _ = imgui.checkbox("Split view", viewer.split is not None)
    if changed:
        viewer.toggle_split()
    if viewer.split is not None:
        _draw_right(viewer)


def label_of(parameter: str) -> str:
    """What a parameter is called on the pages."""
    return LABELS.get((parameter,), parameter)


def parameters_of(algorithm: str) -> list[Any]:
    """The parameters that an algorithm has registered."""
    return [p for info in _core.algorithms() if info.name == algorithm for p in info.parameters]


def _draw_right(viewer: Viewer) -> None:
    split, document = viewer.split, viewer.document
    assert split is not None
    names = [info.name for info in _core.algorithms()]
    algorithm = split.algorithm or other_than(document.config.algorithm)
    imgui.push_id("right")
    changed, name = control("right", {"description": "The estimator right of the line."}, algorithm, names)
    if changed:
        split.algorithm = name
    for parameter in parameters_of(algorithm):
        node = document.schema((parameter.name,))
        value = split.parameters.get(parameter.name, document.value((parameter.name,)))
        changed, value = control(label_of(parameter.name), node, value)
        if changed:
            split.parameters[parameter.name] = value
    imgui.pop_id()
