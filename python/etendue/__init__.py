"""Étendue renders scenes by path tracing, and shows why an estimator is noisy.

import etendue

scene = etendue.load("configs/a04_box.json")
film = scene.render(spp=64, algorithm="Pathtracer", mis="balance")
film.image                      # float32 (height, width, 3), linear radiance, row 0 at the top
film.save("box.exr")
film.write("box.film.exr")      # etendue.read_film reads it, scene.render(resume=film) goes on from it
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from .comparison import Comparison, compare
    from .config import Config, read_config
    from .display import tonemap
    from .errors import EtendueError, Problem, SceneError
    from .film import Film
    from .film.file import read as read_film
    from .film.merging import merge
    from .scene import Scene, load

    __version__: str

__all__ = [
    "Comparison",
    "Config",
    "EtendueError",
    "Film",
    "Problem",
    "Scene",
    "SceneError",
    "__version__",
    "compare",
    "load",
    "merge",
    "read_config",
    "read_film",
    "tonemap",
]

_HOME = {
    "Comparison": "comparison",
    "compare": "comparison",
    "Config": "config",
    "read_config": "config",
    "tonemap": "display",
    "EtendueError": "errors",
    "Problem": "errors",
    "SceneError": "errors",
    "Film": "film",
    "merge": "film.merging",
    "read_film": "film.file",
    "Scene": "scene",
    "load": "scene",
}

_ALIASED = {"read_film": "read"}


def __getattr__(name: str) -> Any:
    # Importing on first use keeps `import etendue`, and so the command, quick.
    import importlib

    if name == "__version__":
        return _version()
    if name not in _HOME:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    value = getattr(importlib.import_module(f".{_HOME[name]}", __name__), _ALIASED.get(name, name))
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})


def _version() -> str:
    from importlib.metadata import PackageNotFoundError, version

    try:
        return version("etendue")
    except PackageNotFoundError:
        return "unknown"
