"""What is rendered beside the image: what its camera rays hit, and contributions kept apart."""

from __future__ import annotations

import dataclasses
import json
from collections.abc import Callable, Iterable, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ..errors import EtendueError
from ..film import aovs

if TYPE_CHECKING:
    from ..film import Attribute, Film
    from . import Scene

Progress = Callable[[float], object]


def aovs_of(
    scene: Scene, film: Film, names: Sequence[str], threads: int, progress: Progress | None
) -> dict[str, NDArray[Any]]:
    """The AOVs of these names, in their order."""
    on_surfaces = aovs.from_source(names, "surfaces")
    found = {name: aovs.of_film(name, film) for name in names if name not in on_surfaces}
    if on_surfaces:
        found |= surfaces(scene, film, on_surfaces, threads, progress)
    return {name: found[name] for name in names}


def attributes(scene: Scene, film: Film, names: Iterable[str]) -> dict[str, Attribute]:
    """What readers of the layers need to know: the samples behind them, and whose ids are in them."""
    notes: dict[str, Attribute] = {}
    if aovs.from_source(names, "surfaces"):
        notes["aov_samples"] = aovs.samples_of(film)[1]
    if "object_id" in names:
        objects = [surface.mesh for surface in scene.surfaces.of_meshes]
        notes["objects"] = json.dumps(objects, ensure_ascii=False)
    if "material_id" in names:
        notes["materials"] = json.dumps(scene.surfaces.material_names, ensure_ascii=False)
    return notes


def surfaces(
    scene: Scene, film: Film, names: Sequence[str], threads: int, progress: Progress | None
) -> dict[str, NDArray[Any]]:
    """The AOVs of surfaces, of the film's first samples."""
    from .. import _core

    config = scene.config_of(film)
    size = config.framebuffer.res_w, config.framebuffer.res_h
    found = _core.AovPass(scene.core, scene.camera(size), config.sampler, config.filter, config.seed, threads)
    found.render(*aovs.samples_of(film), progress)
    arrays = {name: aovs.of_surface(name, found) for name in names}
    if "material_id" in arrays:
        # In the core every mesh has a material of its own; those of one name are the same.
        unique = scene.surfaces.material_names
        ids = [unique.index(surface.material.name) for surface in scene.surfaces.of_meshes]
        # -1, of nothing, stays.
        arrays["material_id"] = np.array([*ids, -1], np.int32)[arrays["material_id"]]
    return arrays


def guides(
    scene: Scene, film: Film, threads: int, progress: Progress | None
) -> tuple[NDArray[np.float32], NDArray[np.float32]]:
    """Albedo and normal for the denoiser, out of the film where it has them."""
    found = film.aovs
    if not set(aovs.GUIDES) <= set(found):
        found = surfaces(scene, film, aovs.GUIDES, threads, progress)
    albedo, normal = (found[name] for name in aovs.GUIDES)
    return albedo, normal


def split(film: Film, algorithm: str) -> Film:
    """`film`, with contributions kept apart from here on; EtendueError where its samples were taken without."""
    from .. import _core

    if next(info.longest_path for info in _core.algorithms() if info.name == algorithm) == 0:
        raise EtendueError(f"{algorithm}: follows no light, so there are no contributions to keep apart")
    if film.samples > 0:
        aovs.require_contributions(film)
        return film
    return dataclasses.replace(film, contributions=np.zeros((*film.sample_count.shape, 2, 2, 3)))
