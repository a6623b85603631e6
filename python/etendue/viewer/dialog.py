"""The question for a file."""

from __future__ import annotations

from pathlib import Path

from imgui_bundle import imgui

from .viewer import Question, Viewer

_MOST_LISTED = 200


def draw(viewer: Viewer) -> None:
    """Draw the question, if there is one."""
    question = viewer.question
    if question is None:
        return
    if not imgui.is_popup_open(question.title):
        imgui.open_popup(question.title)
    middle = imgui.get_main_viewport().get_center()
    imgui.set_next_window_pos(middle, imgui.Cond_.appearing, (0.5, 0.5))
    imgui.set_next_window_size((560, 0))
    shown, _ = imgui.begin_popup_modal(question.title, None, imgui.WindowFlags_.no_saved_settings)
    if not shown:
        return
    if imgui.is_window_appearing():
        imgui.set_keyboard_focus_here()
    imgui.set_next_item_width(-1)
    entered, question.text = imgui.input_text(
        "##file", question.text, imgui.InputTextFlags_.enter_returns_true
    )
    if imgui.is_item_edited():
        question.problem = ""
    _draw_folder(question)
    if question.problem:
        imgui.push_text_wrap_pos(0.0)
        imgui.text_colored((0.95, 0.45, 0.4, 1.0), question.problem)
        imgui.pop_text_wrap_pos()
    there = question.saves and Path(question.text).expanduser().is_file()
    if (
        imgui.button("Replace###ok" if there else "Save###ok" if question.saves else "Open###ok", (120, 0))
        or entered
    ):
        viewer.answer()
    imgui.same_line()
    if imgui.button("Cancel", (120, 0)) or imgui.is_key_pressed(imgui.Key.escape):
        viewer.question = None
    if viewer.question is None:
        imgui.close_current_popup()
    imgui.end_popup()


def _draw_folder(question: Question) -> None:
    """What may be chosen in the folder that the text names."""
    path = Path(question.text or ".").expanduser()
    folder = path if question.text.endswith("/") or path.is_dir() else path.parent
    imgui.begin_child("folder", (0, 180), imgui.ChildFlags_.borders)
    for entry in _entries(folder, question):
        if imgui.selectable(entry.name + ("/" if entry.is_dir() else ""), entry == path)[0]:
            question.text = str(entry) + ("/" if entry.is_dir() else "")
    imgui.end_child()


def _entries(folder: Path, question: Question) -> list[Path]:
    try:
        found = [entry for entry in folder.iterdir() if not entry.name.startswith(".")]
        wanted = [e for e in found if e.is_dir() or e.suffix.lower() in question.suffixes]
    except OSError:
        return []
    return [folder.parent, *sorted(wanted, key=lambda e: (not e.is_dir(), e.name))[:_MOST_LISTED]]
