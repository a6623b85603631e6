"""The menu bar above and the status line below."""

from __future__ import annotations

from imgui_bundle import imgui

from ..words import clock, si
from .pages import PAGES
from .status import State, Status
from .viewer import Viewer


def draw_menu(viewer: Viewer) -> None:
    """Draw the menu bar: each menu opens its page in the panel, or closes it."""
    if not imgui.begin_main_menu_bar():
        return
    for name in PAGES:
        chosen = viewer.page == name
        if imgui.menu_item(name, "", chosen)[0]:
            viewer.page = None if chosen else name
    title = f"{viewer.document.name}{' *' if viewer.document.is_changed else ''}"
    imgui.same_line(imgui.get_window_width() - imgui.calc_text_size(title).x - imgui.get_font_size())
    imgui.text_disabled(title)
    imgui.end_main_menu_bar()


def status_text(status: Status) -> str:
    """The status line of one render."""
    if status.state is State.LOADING:
        return "loading ..."
    if status.state is State.FAILED:
        return (status.problem or "failed").splitlines()[0]
    error = "error ..." if status.error is None else f"error {_percent(status.error)}"
    if status.bound is not None:
        error += f", to be {_percent(status.bound)}"
    parts = [
        f"{status.spp:.0f} of {status.goal} spp" if status.goal is not None else f"{status.spp:.4g} spp",
        f"{si(status.samples_per_second)} samples/s",
        f"{si(status.rays_per_second)} rays/s",
        error,
        clock(status.seconds),
    ]
    if status.eta is not None:
        parts.append(f"{clock(status.eta)} left")
    return f"{status.state.value} {status.percent}%   " + "   ".join(parts)


def _percent(value: float) -> str:
    return f"{100 * value:.3g}%" if value < 10 else f"{100 * value:.0f}%"


def draw_status(viewer: Viewer) -> None:
    """Draw the status line, one for each render."""
    for session in viewer.sessions:
        status = session.status
        done = status.state is State.DONE
        colour = (0.45, 0.85, 0.55, 1.0) if done else (0.95, 0.45, 0.4, 1.0) if status.problem else None
        scene = session.scene
        name = f"{scene.config.algorithm}: " if scene is not None and viewer.split is not None else ""
        text = name + status_text(status)
        if colour:
            imgui.text_colored(colour, text)
        else:
            imgui.text_unformatted(text)
