"""What the loaders hand over: plain dataclasses over numpy arrays."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

Colour = tuple[float, float, float]


@dataclass
class Image:
    """Pixels of an image file, row 0 at the top.

    `pixels` is uint8 (h, w, c) where `srgb` is true, or where the file holds data (a normal map, an opacity
    map), and float32 (h, w, c), linear, otherwise. c is 1, 3 or 4; a fourth channel is opacity. `digest` is that of
    both where it is known already, else empty.
    """

    pixels: NDArray[np.uint8] | NDArray[np.float32]
    srgb: bool
    path: str
    digest: str = ""


#: where a texture is: a file, or pixels that were inside a mesh file
Texture = Path | Image


@dataclass
class Material:
    """A material as its mesh file describes it, before the scene file's patches.

    `albedo` and `emission` are linear R, G, B. `emissive_strength` is the luminance of `emission`.
    `roughness` is the GGX alpha. Textures are paths of
    files that exist, or images where the mesh file itself holds them.
    """

    name: str
    albedo: Colour = (0.8, 0.8, 0.8)
    albedo_texture: Texture | None = None
    emission: Colour = (0.0, 0.0, 0.0)
    emissive_strength: float = 0.0
    emission_texture: Texture | None = None
    ior: float = 1.5
    roughness: float = 0.1
    normal_texture: Texture | None = None
    #: opacity map; the same file as `albedo_texture` where its alpha channel is meant
    cutout_texture: Texture | None = None


@dataclass
class Mesh:
    """Triangles of one material of one file.

    `vertices` float32 (n, 3); `normals` float32 (n, 3) of unit length, or None (flat shading); `uvs` float32
    (n, 2) or None, v = 0 at the bottom of the image; `triangles` uint32 (m, 3), counter-clockwise seen from
    the front; `material` an index into `MeshFile.materials`.
    """

    name: str
    vertices: NDArray[np.float32]
    triangles: NDArray[np.uint32]
    normals: NDArray[np.float32] | None = None
    uvs: NDArray[np.float32] | None = None
    material: int = 0


@dataclass
class MeshFile:
    """Everything one mesh file brings; `digest` is that of its meshes where it is known already, else empty."""

    path: Path
    meshes: list[Mesh] = field(default_factory=list)
    materials: list[Material] = field(default_factory=list)
    digest: str = ""
