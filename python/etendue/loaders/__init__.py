"""Meshes, textures and environment maps, read into numpy arrays."""

from __future__ import annotations

from .image import load_image
from .mesh import load_mesh
from .types import Image, Material, Mesh, MeshFile, Texture

__all__ = ["Image", "Material", "Mesh", "MeshFile", "Texture", "load_image", "load_mesh"]
