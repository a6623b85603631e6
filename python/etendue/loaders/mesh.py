"""Mesh files of every supported format."""

from __future__ import annotations

from collections.abc import Callable
from os import PathLike
from pathlib import Path

from ..errors import EtendueError
from .types import MeshFile


def _obj(path: Path, warnings: list[str]) -> MeshFile:
    from .obj import load_obj

    return load_obj(path, warnings)


def _plain(path: Path, warnings: list[str]) -> MeshFile:
    from .other import load_plain

    return load_plain(path, warnings)


def _gltf(path: Path, warnings: list[str]) -> MeshFile:
    from .gltf import load_gltf

    return load_gltf(path, warnings)


_READERS: dict[str, Callable[[Path, list[str]], MeshFile]] = {
    ".obj": _obj,
    ".ply": _plain,
    ".stl": _plain,
    ".gltf": _gltf,
    ".glb": _gltf,
}


def load_mesh(path: str | PathLike[str], warnings: list[str]) -> MeshFile:
    """The meshes and materials of an OBJ (with MTL), PLY, STL, glTF or GLB file, one mesh for each material.

    What is left out or repaired is appended to `warnings`. Raises EtendueError naming the file, and the line
    where there is one, for a file that is missing, broken or empty, or that has a vertex that is not finite.
    """
    file = Path(path)
    reader = _READERS.get(file.suffix.lower())
    if reader is None:
        allowed = ", ".join(_READERS)
        raise EtendueError(f'{file}: unknown kind of mesh "{file.suffix}" (allowed: {allowed})')
    if not file.is_file():
        raise EtendueError(f"{file}: no such file")
    return reader(file, warnings)
