"""Digests of what files brought into a scene, so that a film knows the scene that it is of.

The content counts as it was understood, not the bytes of a file: a comment, another folder or another time
stamp changes nothing, a vertex or a texel does.
"""

from __future__ import annotations

import dataclasses
import hashlib
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..loaders.types import Image, Mesh, MeshFile, Texture

# For each place in the scene: the name of the file there, and the digest of its content.
Contents = dict[str, tuple[str, str]]


def contents(
    files: Sequence[MeshFile], textures: Sequence[Image], environment: tuple[str, NDArray[Any]] | None
) -> Contents:
    """Digests of the scene's mesh files, in order, of its textures as the core has them, and of its sky."""
    found: Contents = {}
    for index, file in enumerate(files):
        found[f"scene.mesh_files[{index}]"] = file.path.name, file.digest or of_meshes(file.meshes)
        found[f"materials of scene.mesh_files[{index}]"] = file.path.name, _of_materials(file)
    for index, image in enumerate(textures):
        found[f"texture {index}"] = Path(image.path).name, image.digest or of_image(image)
    if environment is not None:
        name, pixels = environment
        found["scene.sky.envmap"] = Path(name).name, _digest([pixels])
    return found


def of_meshes(meshes: Sequence[Mesh]) -> str:
    """The digest of a mesh file's meshes, without their materials."""
    arrays = [array for mesh in meshes for array in (mesh.vertices, mesh.triangles, mesh.normals, mesh.uvs)]
    return _digest(arrays, [str(mesh.material) for mesh in meshes])


def of_image(image: Image) -> str:
    """The digest of a texture."""
    return _digest([image.pixels], [str(image.srgb)])


def _of_materials(file: MeshFile) -> str:
    return _digest([], [_described(material) for material in file.materials])


def _described(material: Any) -> str:
    parts = []
    for field in dataclasses.fields(material):
        value = getattr(material, field.name)
        if isinstance(value, (Path, Image)):
            # Where a texture lies does not matter, and what is in it has a digest of its own.
            value = _name(value)
        parts.append(f"{field.name}={value!r}")
    return ",".join(parts)


def _name(texture: Texture) -> str:
    return texture.name if isinstance(texture, Path) else Path(texture.path).name


def _digest(arrays: Sequence[NDArray[Any] | None], texts: Sequence[str] = ()) -> str:
    whole = hashlib.sha256()
    for array in arrays:
        if array is None:
            whole.update(b"none")
            continue
        whole.update(f"{array.dtype.str}{array.shape}".encode())
        whole.update(np.ascontiguousarray(array).data)
    for text in texts:
        whole.update(f"{len(text)}:{text}".encode())
    return whole.hexdigest()
