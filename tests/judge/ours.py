"""A world rendered by Étendue's core."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from etendue import _core

from .worlds import SIZE, Look, World


def _material(look: Look, texture: int) -> _core.Material:
    return _core.Material(
        look.kind,
        look.kind,
        look.albedo,
        ior=look.ior,
        roughness=look.roughness,
        absorb=look.absorb,
        emissive_strength=look.radiance,
        albedo_texture=texture,
    )


def render(world: World, seeds: range) -> NDArray[np.float64]:
    """Independent images, (seeds, SIZE, SIZE, 3)."""
    meshes, materials, textures = [], [], []
    for part, look in world.parts:
        if look.texture is not None:
            textures.append(_core.Texture(look.texture, False))
        materials.append(_material(look, -1 if look.texture is None else len(textures) - 1))
        vertices, faces = part.vertices.astype(np.float32), part.faces.astype(np.uint32)
        uvs = None if part.uvs is None else part.uvs.astype(np.float32)
        meshes.append(_core.Mesh(vertices, faces, None, uvs, len(materials) - 1))
    sky = None if world.sky is None else _core.Sky(world.sky)
    scene = _core.Scene(meshes, materials, textures, sky)
    view = world.view
    camera = _core.Camera(
        view.pos, view.dir, view.up, view.fov, view.lens_radius, view.focal_depth, True, SIZE, SIZE
    )
    images = []
    for seed in seeds:
        renderer = _core.Renderer(
            scene,
            camera,
            "Pathtracer",
            {"max_cam_path_length": world.edges},
            sampler="independent",
            filter="box",
            seed=seed,
        )
        assert renderer.render(world.spp)
        assert renderer.invalid_count == 0
        images.append(renderer.mean().astype(float))
    return np.array(images)
