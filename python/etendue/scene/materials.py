"""What a mesh's material becomes: its type by name, the type's defaults, then the scene file's patches."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from ..config.sections import MaterialPatch
from ..loaders.types import Colour, Material

if TYPE_CHECKING:
    from .._core import MaterialType


@dataclass(frozen=True)
class Resolved:
    """A material as it is rendered, apart from its textures."""

    name: str
    type: str
    albedo: Colour
    ior: float
    roughness: float
    absorb: float
    coated: bool
    emissive_strength: float


def type_of(text: str, types: Sequence[MaterialType]) -> MaterialType:
    """The first of `types` of whose texts `text` contains one, in any case of letters."""
    lower = text.lower()
    return next(kind for kind in types if not kind.matches or any(match in lower for match in kind.matches))


def resolve(material: Material, patch: MaterialPatch | None, types: Sequence[MaterialType]) -> Resolved:
    """`material` with the defaults of its type and the keys of `patch`."""
    kind = type_of((patch and patch.type) or material.name, types)

    def chosen(key: str, default: float | None, own: float) -> float:
        value = getattr(patch, key, None)
        return value if value is not None else default if default is not None else own

    strength = material.emissive_strength
    if strength == 0 and kind.emissive_strength is not None:
        strength = kind.emissive_strength
    albedo = material.albedo if kind.albedo is None else _colour(kind.albedo)
    if patch is not None and patch.albedo_col is not None:
        albedo = patch.albedo_col
    return Resolved(
        name=material.name,
        type=kind.name,
        albedo=albedo,
        ior=chosen("ior", kind.ior, material.ior),
        roughness=chosen("roughness", kind.roughness, material.roughness),
        absorb=chosen("absorb", kind.absorb, 0.0),
        coated=bool(patch and patch.coated),
        emissive_strength=chosen("emissive_strength", None, strength),
    )


def _colour(values: Sequence[float]) -> Colour:
    red, green, blue = values
    return red, green, blue
