"""The files of a scene, read and turned into what the compiled core takes."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from os import PathLike
from pathlib import Path
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from .. import _core
from ..config import Config
from ..config.located_json import Loc
from ..config.patches import merged
from ..errors import EtendueError, Problem, SceneError, nearest_name
from ..film import fingerprint
from ..loaders.image import load_image
from ..loaders.mesh import load_mesh
from ..loaders.types import Material, Mesh, MeshFile
from .materials import Resolved, resolve
from .textures import NONE, Textures

Result = TypeVar("Result")


class Parts:
    """Meshes, materials, textures and sky of a scene, and `contents`, the digests of all that files brought.

    Raises SceneError with the problems of all files at once. `warnings` says what was repaired or left out.
    """

    def __init__(self, config: Config, data_dirs: Sequence[str | PathLike[str]]) -> None:
        self._config = config
        self._data_dirs = data_dirs
        self._problems: list[Problem] = []
        self.warnings: list[Problem] = []
        self.meshes: list[_core.Mesh] = []
        self.materials: list[_core.Material] = []
        self.sky: _core.Sky | None = None
        self._environment: tuple[str, NDArray[np.float32]] | None = None
        files = self._mesh_files()
        self._read_sky()
        if not self._problems and not files and self.sky is None:
            message = "an empty scene: it names no mesh file and has no sky"
            self._problems.append(config.problem(("scene",), message))
        if self._problems:
            raise SceneError(self._problems)
        notes: list[str] = []
        self._textures = Textures(notes)
        self._add(files)
        self.textures = [_core.Texture(image.pixels, image.srgb) for image in self._textures.images]
        self.contents = fingerprint.contents(files, self._textures.images, self._environment)
        self.warnings += [Problem(note) for note in notes]

    def _tried(self, loc: Loc, read: Callable[[], Result]) -> Result | None:
        try:
            return read()
        except SceneError as error:
            # It tells its place in the scene file itself.
            self._problems += error.problems
        except EtendueError as error:
            self._problems.append(self._config.problem(loc, str(error)))
        except MemoryError:
            self._problems.append(self._config.problem(loc, "not enough memory to read it"))
        return None

    def _find(self, name: str) -> Path:
        return self._config.find_file(name, self._data_dirs)

    def _mesh_files(self) -> list[MeshFile]:
        notes: list[str] = []
        read: dict[Path, MeshFile] = {}
        files: list[MeshFile] = []

        def load(name: str) -> MeshFile:
            path = self._find(name)
            if path not in read:
                read[path] = load_mesh(path, notes)
            return read[path]

        for index, name in enumerate(self._config.scene.mesh_files):
            file = self._tried(("scene", "mesh_files", index), lambda name=name: load(name))  # type: ignore[misc]
            if file is not None:
                files.append(file)
        self.warnings += [Problem(note) for note in notes]
        return files

    def _read_sky(self) -> None:
        sky = self._config.scene.sky
        if sky is None:
            return
        pixels = None
        if sky.envmap is not None:
            name, notes = sky.envmap, list[str]()
            image = self._tried(
                ("scene", "sky", "envmap"), lambda: load_image(self._find(name), "environment", notes)
            )
            if image is None:
                return
            pixels = np.asarray(image.pixels, np.float32)
            self._environment = name, pixels
            self.warnings += [Problem(note) for note in notes]
        self.sky = _core.Sky(pixels, sky.intensity, sky.scene_radius)

    def _add(self, files: list[MeshFile]) -> None:
        patches = merged(self._config.scene.materials)
        types = _core.material_types()
        bright: dict[str, Resolved] = {}
        self._textures.read_ahead(
            file.materials[mesh.material] for file in files for mesh in file.meshes if mesh.uvs is not None
        )
        for file in files:
            resolved = [resolve(material, patches.get(material.name), types) for material in file.materials]
            for mesh in file.meshes:
                material = resolved[mesh.material]
                # A texture goes before the colour, and a light reflects nothing.
                plain = file.materials[mesh.material].albedo_texture is None
                if max(material.albedo) > 1 and plain and material.type != "light":
                    bright[material.name] = material
                self.meshes.append(
                    _core.Mesh(mesh.vertices, mesh.triangles, mesh.normals, mesh.uvs, len(self.materials))
                )
                self.materials.append(self._material(file, mesh, file.materials[mesh.material], material))
        self._warn_of_patches({material.name for file in files for material in file.materials})
        for material in bright.values():
            text = " ".join(f"{value:g}" for value in material.albedo)
            self.warnings.append(
                Problem(
                    f'material "{material.name}": an albedo above 1 ({text}) reflects more light than arrives'
                )
            )

    def _material(self, file: MeshFile, mesh: Mesh, source: Material, material: Resolved) -> _core.Material:
        textures = dict.fromkeys(("albedo", "emission", "normal", "cutout"), NONE)
        wanted = (
            source.albedo_texture,
            source.emission_texture,
            source.normal_texture,
            source.cutout_texture,
        )
        if mesh.uvs is not None:
            textures["albedo"] = self._textures.colour(source.albedo_texture)
            textures["emission"] = self._textures.colour(source.emission_texture)
            textures["normal"] = self._textures.normal(source.normal_texture)
            textures["cutout"] = self._textures.cutout(source.cutout_texture, source.albedo_texture)
        elif any(texture is not None for texture in wanted):
            message = (
                f'{file.path}: material "{source.name}" has textures, but its mesh has no texture coordinates'
            )
            self.warnings.append(Problem(f"{message}; the plain colour is used"))
        return _core.Material(
            material.name,
            material.type,
            material.albedo,
            material.ior,
            material.roughness,
            material.absorb,
            material.coated,
            material.emissive_strength,
            *textures.values(),
        )

    def _warn_of_patches(self, names: set[str]) -> None:
        for index, patch in enumerate(self._config.scene.materials):
            if patch.name not in names:
                near = nearest_name(patch.name, names)
                loc: Loc = ("scene", "materials", index, "name")
                message = "no mesh of the scene has a material of this name"
                self.warnings.append(self._config.problem(loc, message, value=patch.name, nearest=near))
