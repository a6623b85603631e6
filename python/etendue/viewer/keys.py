"""What the keys do; Help lists the same."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from dataclasses import dataclass

from imgui_bundle import imgui

from .navigation import flown
from .pages.files import load_config, save_config
from .pictures import MODES
from .viewer import Viewer

_CTRL, _SHIFT = int(imgui.Key.mod_ctrl), int(imgui.Key.mod_shift)
_FLIGHT = "fly"

MOUSE = (
    ("left drag", "look around"),
    ("wheel", "fly faster or slower"),
    ("right click", "focus on what is under the mouse, and name it"),
    ("left click", "with the pixel inspector: look at this pixel"),
    ("drop a file", "open a scene file, add a mesh, set the environment map"),
)


@dataclass(frozen=True)
class Key:
    """A key, or several that do one thing together."""

    name: str
    summary: str
    chords: tuple[int, ...] = ()
    action: Callable[[Viewer], object] = lambda viewer: None


def _show(mode: str) -> Callable[[Viewer], object]:
    return lambda viewer: setattr(viewer, "look", dataclasses.replace(viewer.look, mode=mode))


def _expose(factor: float) -> Callable[[Viewer], object]:
    place = ("framebuffer", "exposure")
    return lambda viewer: viewer.document.set(
        {place: float(f"{viewer.document.config.framebuffer.exposure * factor:.6g}")}
    )


def _toggle_page(viewer: Viewer) -> None:
    viewer.page = None if viewer.page else "Camera"


def _toggle_inspector(viewer: Viewer) -> None:
    viewer.inspecting = not viewer.inspecting


KEYS = (
    Key("W A S D R F", "fly: forward, left, back, right, up, down"),
    Key("space", "pause, go on", (int(imgui.Key.space),), Viewer.pause),
    Key("F5", "render from the first sample on", (int(imgui.Key.f5),), Viewer.restart),
    Key("Ctrl Z", "undo", (_CTRL | int(imgui.Key.z),), lambda viewer: viewer.document.undo()),
    Key(
        "Ctrl Y, Ctrl Shift Z",
        "redo",
        (_CTRL | int(imgui.Key.y), _CTRL | _SHIFT | int(imgui.Key.z)),
        lambda viewer: viewer.document.redo(),
    ),
    Key("Ctrl O", "load a scene file", (_CTRL | int(imgui.Key.o),), load_config),
    Key("Ctrl S", "save the scene file", (_CTRL | int(imgui.Key.s),), save_config),
    Key(
        "Ctrl C",
        "copy the camera as JSON",
        (_CTRL | int(imgui.Key.c),),
        lambda viewer: imgui.set_clipboard_text(viewer.copied_camera()),
    ),
    Key(
        "Ctrl V",
        "paste a camera",
        (_CTRL | int(imgui.Key.v),),
        lambda viewer: viewer.paste_camera(imgui.get_clipboard_text() or ""),
    ),
    *(
        Key(str(number), f"show: {mode.title}", (int(imgui.Key._0) + number,), _show(name))
        for number, (name, mode) in enumerate(MODES.items(), start=1)
    ),
    Key("+", "brighter", (int(imgui.Key.equal), int(imgui.Key.keypad_add)), _expose(2**0.5)),
    Key("-", "darker", (int(imgui.Key.minus), int(imgui.Key.keypad_subtract)), _expose(2**-0.5)),
    Key("I", "pixel inspector", (int(imgui.Key.i),), _toggle_inspector),
    Key("X", "split view", (int(imgui.Key.x),), Viewer.toggle_split),
    Key("Tab", "hide or show the panel", (int(imgui.Key.tab),), _toggle_page),
)


def press(viewer: Viewer) -> None:
    """Does what the keys that are pressed in this frame ask for, unless they go into a text."""
    if imgui.get_io().want_text_input or viewer.question is not None:
        return
    for key in KEYS:
        if any(imgui.is_key_chord_pressed(chord) for chord in key.chords):
            viewer.attempt(lambda key=key: key.action(viewer))  # type: ignore[misc]
    _fly(viewer)


def _fly(viewer: Viewer) -> None:
    io = imgui.get_io()
    if io.key_ctrl or io.key_alt or io.key_super:
        return

    def way(forth: imgui.Key, back: imgui.Key) -> int:
        return imgui.is_key_down(forth) - imgui.is_key_down(back)

    right, up, forward = (
        way(imgui.Key.d, imgui.Key.a),
        way(imgui.Key.r, imgui.Key.f),
        way(imgui.Key.w, imgui.Key.s),
    )
    if right or up or forward:
        step = viewer.speed * min(io.delta_time, 0.1)
        moved = flown(viewer.document.config.camera, right * step, up * step, forward * step)
        viewer.attempt(lambda: viewer.document.set(moved, gesture=_FLIGHT))


def is_flying() -> bool:
    """Whether a key that flies is held."""
    keys = (imgui.Key.w, imgui.Key.a, imgui.Key.s, imgui.Key.d, imgui.Key.r, imgui.Key.f)
    return any(imgui.is_key_down(key) for key in keys)
