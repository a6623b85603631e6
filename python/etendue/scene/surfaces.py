"""What the meshes of a loaded scene are made of, ready to be patched again without reading a file."""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from .. import _core
from ..config.patches import merged
from ..config.sections import SceneSection, Sky
from ..loaders.types import Material, Texture
from .materials import Resolved, resolve
from .textures import NONE


@dataclass(frozen=True)
class Surface:
    """The material of one mesh, as its file has it; `textures` are indices: albedo, emission, normal, cutout."""

    mesh: str
    material: Material
    textures: tuple[int, int, int, int] = (NONE, NONE, NONE, NONE)

    @classmethod
    def of(cls, mesh: str, material: Material, textures: tuple[int, int, int, int]) -> Surface:
        """Keeps of each texture its name alone: the pixels are in the compiled core."""
        named = dataclasses.replace(
            material,
            albedo_texture=_name(material.albedo_texture),
            emission_texture=_name(material.emission_texture),
            normal_texture=_name(material.normal_texture),
            cutout_texture=_name(material.cutout_texture),
        )
        return cls(mesh, named, textures)


@dataclass
class Surfaces:
    """Materials and sky of a scene before the scene file's patches: one surface for each mesh, in their order.

    environment: float32 (h, w, 3), the pixels of the sky's image, if it has one.
    """

    of_meshes: list[Surface] = field(default_factory=list)
    environment: NDArray[np.float32] | None = None

    @property
    def material_names(self) -> list[str]:
        """Each once: a material's id is its index here."""
        return list(dict.fromkeys(surface.material.name for surface in self.of_meshes))

    def resolved(self, section: SceneSection) -> dict[str, Resolved]:
        """The materials under their names, with the patches of `section`."""
        patches, types = merged(section.materials), _core.material_types()
        return {
            surface.material.name: resolve(surface.material, patches.get(surface.material.name), types)
            for surface in self.of_meshes
        }

    def materials(self, section: SceneSection) -> list[_core.Material]:
        """The materials with the patches of `section`, one for each mesh."""
        patches, types = merged(section.materials), _core.material_types()
        found = []
        for surface in self.of_meshes:
            material = resolve(surface.material, patches.get(surface.material.name), types)
            found.append(
                _core.Material(
                    material.name,
                    material.type,
                    material.albedo,
                    material.ior,
                    material.roughness,
                    material.absorb,
                    material.coated,
                    material.emissive_strength,
                    *surface.textures,
                )
            )
        return found

    def sky(self, section: Sky | None) -> _core.Sky | None:
        """The sky that `section` describes."""
        if section is None:
            return None
        return _core.Sky(self.environment, section.intensity, section.scene_radius)


def _name(texture: Texture | None) -> Path | None:
    return texture if texture is None or isinstance(texture, Path) else Path(texture.path)
