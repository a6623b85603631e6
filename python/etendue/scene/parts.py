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
from ..errors import EtendueError, Problem, SceneError, nearest_name
from ..film import fingerprint
from ..loaders.image import load_image
from ..loaders.mesh import load_mesh
from ..loaders.types import Material, Mesh, MeshFile
from .surfaces import Surface, Surfaces
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
        self.surfaces = Surfaces()
        self._environment: tuple[str, NDArray[np.float32]] | None = None
        files = self._mesh_files()
        self._read_sky()
        if not self._problems and not files and config.scene.sky is None:
            message = "an empty scene: it names no mesh file and has no sky"
            self._problems.append(config.problem(("scene",), message))
        if self._problems:
            raise SceneError(self._problems)
        notes: list[str] = []
        self._textures = Textures(notes)
        self._add(files)
        self.materials = self.surfaces.materials(config.scene)
        self.sky = self.surfaces.sky(config.scene.sky)
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
        if sky is None or sky.envmap is None:
            return
        name, notes = sky.envmap, list[str]()
        image = self._tried(
            ("scene", "sky", "envmap"), lambda: load_image(self._find(name), "environment", notes)
        )
        if image is None:
            return
        self.surfaces.environment = np.asarray(image.pixels, np.float32)
        self._environment = name, self.surfaces.environment
        self.warnings += [Problem(note) for note in notes]

    def _add(self, files: list[MeshFile]) -> None:
        self._textures.read_ahead(
            file.materials[mesh.material] for file in files for mesh in file.meshes if mesh.uvs is not None
        )
        for file in files:
            for mesh in file.meshes:
                self.meshes.append(
                    _core.Mesh(
                        mesh.vertices, mesh.triangles, mesh.normals, mesh.uvs, len(self.surfaces.of_meshes)
                    )
                )
                material = file.materials[mesh.material]
                textures = self._textures_of(file, mesh, material)
                self.surfaces.of_meshes.append(Surface.of(mesh.name, material, textures))
        self._warn_of_patches({material.name for file in files for material in file.materials})
        self._warn_of_bright()

    def _textures_of(self, file: MeshFile, mesh: Mesh, material: Material) -> tuple[int, int, int, int]:
        if mesh.uvs is not None:
            return (
                self._textures.colour(material.albedo_texture),
                self._textures.colour(material.emission_texture),
                self._textures.normal(material.normal_texture),
                self._textures.cutout(material.cutout_texture, material.albedo_texture),
            )
        wanted = (
            material.albedo_texture,
            material.emission_texture,
            material.normal_texture,
            material.cutout_texture,
        )
        if any(texture is not None for texture in wanted):
            message = (
                f'{file.path}: material "{material.name}" has textures, but its mesh has no texture '
                "coordinates"
            )
            self.warnings.append(Problem(f"{message}; the plain colour is used"))
        return NONE, NONE, NONE, NONE

    def _warn_of_bright(self) -> None:
        # A texture goes before the colour, and a light reflects nothing.
        plain = {s.material.name for s in self.surfaces.of_meshes if s.material.albedo_texture is None}
        for name, material in self.surfaces.resolved(self._config.scene).items():
            if max(material.albedo) > 1 and name in plain and material.type != "light":
                text = " ".join(f"{value:g}" for value in material.albedo)
                message = f'material "{name}": an albedo above 1 ({text}) reflects more light than arrives'
                self.warnings.append(Problem(message))

    def _warn_of_patches(self, names: set[str]) -> None:
        for index, patch in enumerate(self._config.scene.materials):
            if patch.name not in names:
                near = nearest_name(patch.name, names)
                loc: Loc = ("scene", "materials", index, "name")
                message = "no mesh of the scene has a material of this name"
                self.warnings.append(self._config.problem(loc, message, value=patch.name, nearest=near))
