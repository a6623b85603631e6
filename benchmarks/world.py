"""A scene as plain arrays, which every renderer of the benchmark builds its own scene from.

It needs numpy alone, as the peers run in an interpreter of their own.
"""

from __future__ import annotations

import json
from dataclasses import asdict, dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

Colour = tuple[float, float, float]


@dataclass
class Material:
    """`kind` is one of Étendue's BSDFs; the rest is what docs/scene-format.md says. Textures are indices, or -1."""

    kind: str
    albedo: Colour
    ior: float = 1.5
    roughness: float = 0.1
    absorb: float = 0.0
    radiance: float = 0.0
    albedo_texture: int = -1
    emission_texture: int = -1


@dataclass
class Mesh:
    """Triangles (m, 3) over vertices (n, 3); normals (n, 3) and uvs (n, 2) or None, v = 0 at the bottom."""

    vertices: NDArray[np.float32]
    triangles: NDArray[np.uint32]
    normals: NDArray[np.float32] | None
    uvs: NDArray[np.float32] | None
    material: int


@dataclass
class View:
    """A camera, angles in degrees; `focal_depth` along dir."""

    pos: Colour
    dir: Colour
    up: Colour
    fov: float
    lens_radius: float = 0.0
    focal_depth: float = 1.0


def linear(texture: NDArray[Any]) -> NDArray[np.float32]:
    """Of a texture of a World, as it is or out of sRGB (IEC 61966-2-1)."""
    if texture.dtype != np.uint8:
        return texture.astype(np.float32)
    c = texture / np.float32(255)
    return np.where(c <= 0.04045, c / 12.92, ((c + 0.055) / 1.055) ** 2.4).astype(np.float32)


@dataclass
class World:
    """A scene. `textures` are (h, w, 3), uint8 in sRGB or float32 linear; `sky` (h, w, 3), linear radiance."""

    name: str
    meshes: list[Mesh]
    materials: list[Material]
    view: View
    edges: int = 10
    textures: list[NDArray[Any]] = field(default_factory=list)
    sky: NDArray[np.float32] | None = None

    #: BSDFs that all of the renderers define alike
    COMMON = frozenset({"diffuse", "translucent", "glass", "light"})

    @property
    def triangles(self) -> int:
        """How many triangles there are."""
        return sum(len(mesh.triangles) for mesh in self.meshes)

    @property
    def is_common(self) -> bool:
        """Whether all renderers define all of its materials alike, so that one reference serves all."""
        return {material.kind for material in self.materials} <= self.COMMON

    def uncoated(self) -> World:
        """The same without coats, which every renderer defines in its own way: their diffuse bases alone."""
        materials = [replace(m, kind="diffuse") if m.kind == "layered_ggx" else m for m in self.materials]
        return replace(self, materials=materials)

    def write(self, path: Path) -> None:
        """Into one file that `read` reads."""
        arrays: dict[str, NDArray[Any]] = {f"texture{i}": t for i, t in enumerate(self.textures)}
        for i, mesh in enumerate(self.meshes):
            for name in ("vertices", "triangles", "normals", "uvs"):
                value = getattr(mesh, name)
                if value is not None:
                    arrays[f"{name}{i}"] = value
        if self.sky is not None:
            arrays["sky"] = self.sky
        about = {
            "name": self.name,
            "edges": self.edges,
            "view": asdict(self.view),
            "materials": [asdict(m) for m in self.materials],
            "mesh_materials": [m.material for m in self.meshes],
            "textures": len(self.textures),
        }
        path.parent.mkdir(parents=True, exist_ok=True)
        partial = path.with_suffix(".part.npz")
        np.savez(partial, about=np.array(json.dumps(about)), **arrays)
        partial.replace(path)

    @staticmethod
    def read(path: Path) -> World:
        """What `write` wrote."""
        with np.load(path) as file:
            about = json.loads(str(file["about"]))
            meshes = [
                Mesh(
                    file[f"vertices{i}"],
                    file[f"triangles{i}"],
                    file.get(f"normals{i}"),
                    file.get(f"uvs{i}"),
                    material,
                )
                for i, material in enumerate(about["mesh_materials"])
            ]
            return World(
                about["name"],
                meshes,
                [Material(**_with_tuples(m)) for m in about["materials"]],
                View(**_with_tuples(about["view"])),
                about["edges"],
                [file[f"texture{i}"] for i in range(about["textures"])],
                file.get("sky"),
            )


def _with_tuples(values: dict[str, Any]) -> dict[str, Any]:
    """JSON has no tuples."""
    return {key: tuple(value) if isinstance(value, list) else value for key, value in values.items()}
