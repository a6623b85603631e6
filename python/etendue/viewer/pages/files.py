"""Input/Output: what goes to files and comes from them."""

from __future__ import annotations

from pathlib import Path

from imgui_bundle import imgui

from ..viewer import CONFIGS, Viewer
from ..widgets import buttons


def draw(viewer: Viewer) -> None:
    """Draw the page."""
    name = viewer.document.name
    imgui.separator_text("Rendering")
    buttons(
        ("Save PNG", "Save the image as it is shown.", lambda: _save_rendering(viewer, f"{name}.png")),
        ("Save EXR", "Save linear radiance.", lambda: _save_rendering(viewer, f"{name}.exr")),
        (
            "Save film",
            "Save all that it takes to go on from here: etendue render --resume.",
            lambda: viewer.ask(
                "Save film",
                f"{name}.film.exr",
                (".exr",),
                lambda path: viewer.save_film(path, lambda film, place: film.write(place)),
                saves=True,
            ),
        ),
    )
    imgui.separator_text("Scene file")
    config = viewer.document.config
    imgui.push_text_wrap_pos(0.0)
    imgui.text_unformatted(f"{config.path or 'not saved yet'}{' *' if viewer.document.is_changed else ''}")
    imgui.pop_text_wrap_pos()
    buttons(
        (
            "Save config",
            "Save a scene file that renders the same from the command line.",
            lambda: save_config(viewer),
        ),
        ("Load config", "Open another scene file.", lambda: load_config(viewer)),
    )


def save_config(viewer: Viewer) -> None:
    """Ask where the scene file goes."""
    path = viewer.document.config.path or Path("scene.json")
    viewer.ask("Save config", str(path), CONFIGS, viewer.save_config, saves=True)


def load_config(viewer: Viewer) -> None:
    """Ask for a scene file to open."""
    viewer.ask("Load config", "", CONFIGS, lambda path: viewer.open([path]))


def _save_rendering(viewer: Viewer, name: str) -> None:
    suffix = Path(name).suffix
    viewer.ask("Save rendering", name, (suffix,), viewer.save_rendering, saves=True)
