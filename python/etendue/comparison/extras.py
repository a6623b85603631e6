"""The libraries that only reports need, imported when a report is made."""

from __future__ import annotations

import importlib
import importlib.util
import shlex
import sys
from pathlib import Path
from typing import Any

from ..errors import EtendueError

# Name of the import, and of what pip installs.
_PACKAGES = {
    "flip_evaluator": "flip-evaluator",
    "jinja2": "jinja2",
    "matplotlib": "matplotlib",
    "scipy": "scipy",
    "simpleimageio": "simpleimageio",
}


def require() -> None:
    """EtendueError that names every library that is missing and the command that installs them."""
    missing = [package for name, package in _PACKAGES.items() if importlib.util.find_spec(name) is None]
    if missing:
        raise EtendueError(
            f"comparing needs {', '.join(missing)}; install with: "
            f'{shlex.quote(sys.executable)} -m pip install "etendue[compare]"'
        )


def needed(name: str) -> Any:
    """The module `name`; EtendueError where it is not installed."""
    if importlib.util.find_spec(name.partition(".")[0]) is None:
        require()
    return importlib.import_module(name)


def flip_book_script() -> str:
    """The source of SimpleImageIO's FlipBook, which its wheel carries.

    Read as a file: importing the package would load its compiled library, which nothing here needs.
    """
    spec = importlib.util.find_spec("simpleimageio")
    if spec is None or spec.submodule_search_locations is None:
        require()
        raise EtendueError("simpleimageio: the package is damaged")
    script = Path(spec.submodule_search_locations[0], "flipbook.js")
    try:
        return script.read_text(encoding="utf-8")
    except OSError as error:
        raise EtendueError(f"{script}: cannot be read: {error.strerror or error}") from None
