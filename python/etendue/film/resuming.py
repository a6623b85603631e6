"""Going on from a film file: its scene found again, what changed refused, and the command that does it."""

from __future__ import annotations

import os
import shlex
import shutil
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from .. import outputs
from ..config import Config
from ..errors import EtendueError
from . import file as film_file
from . import sample_ranges
from .origin import Origin

if TYPE_CHECKING:
    from ..config.overrides import Override
    from ..scene import Scene
    from . import Film

# Seconds between two writings of a film.
CHECKPOINT = 30.0


def _origin(film: Film | None) -> Origin:
    # Those of files have one.
    assert film is not None
    assert film.origin is not None
    return film.origin


def scene_name(film: Film | None) -> str:
    """The name of the scene file that `film` is of, without extension."""
    return _origin(film).scene_name


def config_of(
    film: Film, path: Path, overrides: Sequence[str | Override], data_dirs: Sequence[Path]
) -> tuple[Config, Sequence[Path]]:
    """The config in the film that was read from `path`, with overrides, and the folders to find its files.

    These are the given ones, those that it was rendered with, and its own. The folder of the scene file comes
    first of all, if it is still there.
    """
    origin = _origin(film)
    folders = [*data_dirs, *filter(Path.is_dir, map(Path, origin.data_dirs)), path.resolve().parent]
    config = Config.from_data(origin.config, origin.scene_file or None)
    return config.with_overrides(overrides) if overrides else config, list(dict.fromkeys(folders))


def require_same_scene(scene: Scene, film: Film, path: Path) -> None:
    """EtendueError with all that changed since the film that was read from `path`."""
    now = Origin.of(scene.config, scene.contents, scene.data_dirs)
    now.require_same(_origin(film), f"{path}: the scene or its settings have changed", "here", "in the film")


def check_place(path: Path, resumed: Path | None, images: Sequence[Path]) -> None:
    """EtendueError where a film cannot be written to `path`, or would take the place of another one."""
    if path.suffix.lower() != ".exr":
        raise EtendueError(f'{path}: a film file is an EXR image; its name must end with ".exr"')
    outputs.check([path])
    if path.resolve() in (image.resolve() for image in images):
        raise EtendueError(f"{path}: the image and the film cannot be one file")
    if not path.exists() or (resumed is not None and os.path.samefile(path, resumed)):
        return
    try:
        there = film_file.read_header(path)
    except EtendueError:
        return
    raise EtendueError(
        f"{path}: there is a film with the samples {sample_ranges.text(there.held)} already; go on from it "
        f"with {program()} render --resume {shlex.quote(str(path))}, or remove it first"
    )


def saved(film: Film, path: Path, compressed: bool = True) -> str | None:
    """Writes the film; why not, where that failed."""
    try:
        film_file.write(film, path, compressed)
    except EtendueError as error:
        return str(error)
    return None


def command(film: Path, images: Sequence[str], threads: int, checkpoint: float) -> str:
    """The command that goes on from the film, called in the current folder."""
    words = ["render", "--resume", str(film)]
    words += [word for output in images for word in ("-o", output)]
    words += ["--threads", str(threads)] if threads else []
    words += ["--checkpoint", f"{checkpoint:g}"] if checkpoint != CHECKPOINT else []
    return " ".join([program(), *map(shlex.quote, words)])


def program() -> str:
    """How this command is called from a shell."""
    called = sys.argv[0]
    if Path(called).name == "__main__.py":
        return f"{shlex.quote(sys.executable)} -m etendue"
    found = shutil.which(Path(called).name)
    if found is not None and os.path.exists(called) and os.path.samefile(found, called):
        return Path(called).name
    return shlex.quote(called) if Path(called).name == "etendue" else "etendue"
