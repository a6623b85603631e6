"""Where the files that a scene names are found."""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator, Sequence
from os import PathLike
from pathlib import Path
from typing import Any

from .. import models
from ..errors import EtendueError, Problem, nearest_name
from .located_json import Loc
from .problems import Source

Folders = Sequence[str | PathLike[str]]


def find(name: str, folder: Path | None, data_dirs: Folders) -> Path | None:
    """The file that `name` means, or None.

    Tried as given, beside the scene file (in `folder`), under each of `data_dirs`, under $ETENDUE_DATA, then
    among the bundled scenes, which models that scene on first use. EtendueError where that fails.
    """
    found = _on_disk(name, folder, data_dirs)
    if found is not None:
        return found
    try:
        return models.find(name)
    except OSError as error:
        where = error.filename or models.cache_folder()
        raise EtendueError(
            f"{where}: the bundled scene cannot be built here: {error.strerror or error}"
        ) from error


def missing(data: Any, source: Source, folder: Path | None, data_dirs: Folders) -> list[Problem]:
    """A problem for every file that the scene's plain `data` names and that is nowhere; models nothing."""
    bundled = {file for files in models.SCENES.values() for file in files}
    return [
        not_found(name, loc, source, folder, data_dirs)
        for loc, name in named(data)
        if Path(name).as_posix() not in bundled and _on_disk(name, folder, data_dirs) is None
    ]


def to_build(data: Any, folder: Path | None, data_dirs: Folders) -> list[str]:
    """The bundled scenes that must be modelled before the files that `data` names are there."""
    wanted = {Path(name).as_posix() for _, name in named(data) if _on_disk(name, folder, data_dirs) is None}
    return [
        scene
        for scene, files in models.SCENES.items()
        if wanted.intersection(files) and not models.is_built(scene)
    ]


def named(data: Any) -> Iterator[tuple[Loc, str]]:
    """Every file name in a scene's plain data, with its place; tolerates data of any shape."""
    scene = data.get("scene") if isinstance(data, dict) else None
    if not isinstance(scene, dict):
        return
    meshes, sky = scene.get("mesh_files"), scene.get("sky")
    for index, name in enumerate(meshes if isinstance(meshes, list) else ()):
        if isinstance(name, str) and name:
            yield ("scene", "mesh_files", index), name
    if isinstance(sky, dict) and isinstance(sky.get("envmap"), str) and sky["envmap"]:
        yield ("scene", "sky", "envmap"), sky["envmap"]


def not_found(name: str, loc: Loc, source: Source, folder: Path | None, data_dirs: Folders) -> Problem:
    """The problem that `name` is nowhere, with where it was looked for and the nearest name there is."""
    extra = _extra_folders(data_dirs)
    places = ["as given"]
    places += (
        [f"beside the scene file ({folder})"] if folder is not None and not Path(name).is_absolute() else []
    )
    places += [f"under {place}" for place in extra]
    places += [] if os.environ.get("ETENDUE_DATA") else ["under $ETENDUE_DATA (which is not set)"]
    places += ["among the bundled scenes"]
    known = [file for files in models.SCENES.values() for file in files]
    for place in filter(None, (folder, *extra)):
        beside = place / Path(name).parent
        try:
            known += [
                (Path(name).parent / entry.name).as_posix() for entry in beside.iterdir() if entry.is_file()
            ]
        except OSError:
            continue
    suffix = Path(name).suffix.lower()
    near = nearest_name(name, (other for other in known if Path(other).suffix.lower() == suffix), 0.75)
    return source.problem(loc, f"no such file; looked {', '.join(places)}", value=name, nearest=near)


def _on_disk(name: str, folder: Path | None, data_dirs: Folders) -> Path | None:
    for candidate in _candidates(name, folder, data_dirs):
        if candidate.is_file():
            return candidate
    return None


def _candidates(name: str, folder: Path | None, data_dirs: Folders) -> Iterator[Path]:
    yield Path(name)
    for place in filter(None, (folder, *_extra_folders(data_dirs))):
        yield place / name


def _extra_folders(data_dirs: Iterable[str | PathLike[str]]) -> list[Path]:
    from_environment = [part for part in os.environ.get("ETENDUE_DATA", "").split(os.pathsep) if part]
    return [Path(place) for place in (*data_dirs, *from_environment)]
