"""What an OBJ file says itself, and its entry in the cache."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

from numpy.typing import NDArray

from . import cache
from .types import Mesh


@dataclass
class Parsed:
    """An OBJ file without its MTL files.

    names: of the materials, by the meshes' index. usemtl: the first use of each name, and its line. mtllib: each
    statement, and its line. notes: warnings, without the file's path that begins all of them. digest: as of MeshFile.
    """

    meshes: list[Mesh]
    names: list[str]
    usemtl: list[tuple[int, str]]
    mtllib: list[tuple[int, str]]
    notes: list[str]
    digest: str = ""


def find(path: Path, stamp: cache.Stamp) -> Parsed | None:
    """What `keep` was given with this stamp."""
    found = cache.find(path, stamp)
    if found is None:
        return None
    about, arrays = found
    meshes = []
    for name, material, indices in about.pop("meshes"):
        of_mesh: list[Any] = [None if index is None else arrays[index] for index in indices]
        vertices, triangles, normals, uvs = of_mesh
        meshes.append(Mesh(name, vertices, triangles, normals, uvs, material))
    return Parsed(meshes, **about)


def keep(path: Path, stamp: cache.Stamp, parsed: Parsed) -> None:
    """Keeps `parsed`, with its digest, for the file of this stamp."""
    from ..film.fingerprint import of_meshes

    parsed.digest = of_meshes(parsed.meshes)
    arrays: list[NDArray[Any]] = []

    def index_of(array: NDArray[Any] | None) -> int | None:
        if array is None:
            return None
        arrays.append(array)
        return len(arrays) - 1

    meshes = [
        (m.name, m.material, [index_of(array) for array in (m.vertices, m.triangles, m.normals, m.uvs)])
        for m in parsed.meshes
    ]
    cache.keep(path, stamp, {**vars(parsed), "meshes": meshes}, arrays)
