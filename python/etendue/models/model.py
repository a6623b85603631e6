"""A model: meshes under material names, written as OBJ with its MTL."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TextIO

import numpy as np

from etendue.models.mesh import Floats, Mesh, merged

Colour = Sequence[float]


@dataclass(frozen=True)
class MtlMaterial:
    """A material as the MTL format words it: linear RGB colours, texture names relative to the MTL file."""

    name: str
    kd: Colour = (0.8, 0.8, 0.8)
    ks: Colour = (0.0, 0.0, 0.0)
    ke: Colour = (0.0, 0.0, 0.0)
    ni: float = 1.5
    ns: float = 100.0
    map_kd: str | None = None
    map_d: str | None = None
    map_bump: str | None = None
    map_ke: str | None = None

    def text(self) -> str:
        lines = [f"newmtl {self.name}"]
        lines += [
            f"{key} {_numbers(value)}" for key, value in (("Kd", self.kd), ("Ks", self.ks), ("Ke", self.ke))
        ]
        lines += [f"Ni {self.ni:g}", f"Ns {self.ns:g}", "illum 2"]
        maps = (
            ("map_Kd", self.map_kd),
            ("map_d", self.map_d),
            ("map_Bump", self.map_bump),
            ("map_Ke", self.map_ke),
        )
        lines += [f"{key} {value}" for key, value in maps if value is not None]
        return "\n".join(lines) + "\n"


@dataclass
class Model:
    """What one OBJ file will hold.  `add` may be called any number of times per material."""

    materials: dict[str, MtlMaterial] = field(default_factory=dict)
    parts: dict[str, list[Mesh]] = field(default_factory=dict)

    def material(self, name: str, **properties: object) -> str:
        """Declares a material (the fields of `MtlMaterial`) and gives back its name."""
        self.materials[name] = MtlMaterial(name, **properties)  # type: ignore[arg-type]
        return name

    def add(self, material: str, *meshes: Mesh) -> None:
        """Adds meshes under a declared material."""
        if material not in self.materials:
            raise KeyError(f"material {material!r} is not declared")
        self.parts.setdefault(material, []).extend(meshes)

    @property
    def triangle_count(self) -> int:
        return sum(len(m.faces) for meshes in self.parts.values() for m in meshes)

    def write(self, path: Path) -> None:
        """Writes `path` (.obj) and the .mtl of the same name beside it."""
        path.parent.mkdir(parents=True, exist_ok=True)
        mtl = path.with_suffix(".mtl")
        mtl.write_text("\n".join(m.text() for m in self.materials.values()), encoding="utf-8")
        with path.open("w", encoding="utf-8") as out:
            out.write(f"mtllib {mtl.name}\n")
            first = np.ones(3, int)
            for name, meshes in self.parts.items():
                mesh = merged(meshes)
                out.write(f"o {name}\nusemtl {name}\n")
                columns = [mesh.faces + first[0]]
                _write_rows(out, "v", np.round(mesh.vertices, 6))
                first[0] += len(mesh.vertices)
                slots = "%d"
                if mesh.uvs is not None:
                    _write_rows(out, "vt", np.round(mesh.uvs, 5))
                    columns.append(mesh.faces + first[1])
                    first[1] += len(mesh.uvs)
                    slots = "%d/%d"
                if mesh.normals is not None:
                    _write_rows(out, "vn", np.round(mesh.normals, 5))
                    columns.append(mesh.faces + first[2])
                    first[2] += len(mesh.normals)
                    slots = "%d/%d/%d" if mesh.uvs is not None else "%d//%d"
                corners = np.stack(columns, 2).reshape(len(mesh.faces), -1)
                out.write(
                    ("f " + " ".join([slots] * 3) + "\n") * len(corners) % tuple(corners.ravel().tolist())
                )


def _write_rows(out: TextIO, key: str, rows: Floats) -> None:
    line = key + " %.7g" * rows.shape[1] + "\n"
    out.write(line * len(rows) % tuple(rows.ravel().tolist()))


def _numbers(values: Colour) -> str:
    return " ".join(f"{v:g}" for v in values)
