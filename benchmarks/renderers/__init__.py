"""One renderer a file: a class `Renderer(world, width, height, threads, options)` with

    render(spp, seed)   an image, float (height, width, 3), of independent samples for every seed
    rays                how many rays the last render traced, or None

`options` is empty for settings that all of them share: box filter, no Russian roulette, no clamping, the same path
length. {"as_users": True} leaves what a user of that renderer would leave.
"""

from __future__ import annotations

import importlib.util
import sys
from typing import Any


def core_at(path: str | None) -> Any:
    """Étendue's compiled core, from this file or, without one, as it is installed."""
    if path is None:
        from etendue import _core

        return _core
    spec = importlib.util.spec_from_file_location("etendue._core", path)
    if spec is None or spec.loader is None:
        raise ImportError(f"{path} is no compiled module")
    core = importlib.util.module_from_spec(spec)
    sys.modules["etendue._core"] = core
    spec.loader.exec_module(core)
    return core
