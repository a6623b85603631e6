"""Étendue, from the same arrays as the others."""

from __future__ import annotations

import os
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..world import World
from . import core_at

# Another build of the compiled core, for ablations.
_core = core_at(os.environ.get("ETENDUE_BENCHMARK_CORE"))


class Renderer:
    """See the package. Options: `sampler` and the estimator's switches, besides those of all."""

    rays: int | None = None

    def __init__(self, world: World, width: int, height: int, threads: int, options: dict[str, Any]) -> None:
        self.threads, self.options = threads, options
        textures = [_core.Texture(pixels, pixels.dtype == np.uint8) for pixels in world.textures]
        materials = [
            _core.Material(
                m.kind,
                m.kind,
                tuple(m.albedo),
                m.ior,
                m.roughness,
                m.absorb,
                False,
                m.radiance,
                m.albedo_texture,
                m.emission_texture,
            )
            for m in world.materials
        ]
        meshes = [_core.Mesh(m.vertices, m.triangles, m.normals, m.uvs, m.material) for m in world.meshes]
        sky = None if world.sky is None else _core.Sky(world.sky)
        self.scene = _core.Scene(meshes, materials, textures, sky)
        v = world.view
        self.camera = _core.Camera(
            v.pos, v.dir, v.up, v.fov, v.lens_radius, v.focal_depth, True, width, height
        )
        self.parameters: dict[str, Any] = {"max_cam_path_length": world.edges}
        if not options.get("as_users"):
            self.parameters["rr_threshold"] = 0.0
        for name in ("path_reuse", "light_tracing", "light_splitting", "portals", "light_choice"):
            if name in options:
                self.parameters[name] = options[name]

    def auto_focus(self) -> float:
        """The distance that a scene file's `auto_focus` focuses on."""
        return float(_core.auto_focus(self.scene, self.camera))

    def _renderer(self, seed: int) -> Any:
        image_filter = "blackman_harris" if self.options.get("as_users") else "box"
        return _core.Renderer(
            self.scene,
            self.camera,
            "Pathtracer",
            self.parameters,
            sampler=self.options.get("sampler", "sobol"),
            filter=image_filter,
            seed=seed,
            threads=self.threads,
        )

    def prepared(self) -> Any:
        """A renderer of seed 0 that has only its samples to take yet."""
        renderer = self._renderer(0)
        renderer.prepare()
        return renderer

    def record(self, spp: int) -> Any:
        """The rays of the image that `render(spp, 0)` makes."""
        return _core.RayRecord(self._renderer(0), spp)

    def render(self, spp: int, seed: int) -> NDArray[np.float32]:
        """See the package."""
        renderer = self._renderer(seed)
        renderer.render(spp)
        self.rays = renderer.rays
        return renderer.mean()
