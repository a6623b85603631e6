"""Where the camera goes: flying and looking around, as changes of the scene file's camera."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from ..config.located_json import Loc
from ..config.sections import Camera

# Degrees of turn for a drag over the height of the image, in fields of view.
_STEEPEST = math.radians(89)


def unit(vector: Sequence[float] | np.ndarray[Any, Any]) -> np.ndarray[Any, Any]:
    """float64 (3,): the vector at length 1."""
    values = np.asarray(vector, np.float64)
    return values / np.linalg.norm(values)


def flown(camera: Camera, right: float, up: float, forward: float) -> dict[Loc, Any]:
    """The camera moved by so much along its own right, the world's up in the scene file, and its direction."""
    direction, above = unit(camera.dir), unit(camera.up)
    aside = unit(np.cross(direction, above))
    moved = np.asarray(camera.pos) + right * aside + up * above + forward * direction
    return {("camera", "pos"): _plain(np.clip(moved, -1e9, 1e9))}


def turned(camera: Camera, right: float, down: float) -> dict[Loc, Any]:
    """The camera turned by these angles (radians) around `up`, and up or down but never over."""
    direction, above = unit(camera.dir), unit(camera.up)
    height = math.asin(float(np.clip(direction @ above, -1, 1)))
    level = unit(direction - (direction @ above) * above)
    aside = np.cross(level, above)
    height = min(max(height - down, -_STEEPEST), _STEEPEST)
    around = math.cos(right) * level + math.sin(right) * aside
    return {("camera", "dir"): _plain(math.cos(height) * around + math.sin(height) * above)}


def angles_of_drag(camera: Camera, pixels: tuple[float, float], height: float) -> tuple[float, float]:
    """Angles of a drag over an image so many pixels high: what is under the mouse stays there, nearly."""
    view = math.radians(camera.fov) if camera.perspective else math.pi
    return -pixels[0] / height * view, -pixels[1] / height * view


def _plain(values: np.ndarray[Any, Any]) -> list[float]:
    return [float(f"{value:.7g}") for value in values]
