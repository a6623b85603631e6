"""The pages of the panel, under the names that the exercise sheet gives to its menus."""

from __future__ import annotations

from collections.abc import Callable

from ..viewer import Viewer
from . import algorithms, camera, files, help, preview, scene, settings

PAGES: dict[str, Callable[[Viewer], None]] = {
    "Camera": camera.draw,
    "Scene": scene.draw,
    "Algorithms": algorithms.draw,
    "Preview": preview.draw,
    "Input/Output": files.draw,
    "Settings": settings.draw,
    "Help": help.draw,
}
