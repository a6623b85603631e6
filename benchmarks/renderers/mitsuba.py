"""Mitsuba 3, by its path integrator."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

import drjit
import mitsuba as mi
import numpy as np
from numpy.typing import NDArray

from ..world import Material, Mesh, World, linear

# Étendue's sky has phi = 0 along +x, Mitsuba's along -z.
_SKY_TO_WORLD = [[0, 0, -1, 0], [0, 1, 0, 0], [1, 0, 0, 0], [0, 0, 0, 1]]
_NO_ROULETTE = 100_000


def _find_llvm() -> None:
    """Dr.Jit 1.5 runs with LLVM 19, not with 14 to 16."""
    if "DRJIT_LIBLLVM_PATH" not in os.environ:
        for path in sorted(Path("/usr/lib").glob("*/libLLVM.so.19*")):
            os.environ["DRJIT_LIBLLVM_PATH"] = str(path)


def _rgb(colour: Any) -> dict[str, Any]:
    return {"type": "rgb", "value": [float(c) for c in colour]}


class Renderer:
    """See the package. Options: `variant`."""

    rays = None

    def __init__(self, world: World, width: int, height: int, threads: int, options: dict[str, Any]) -> None:
        _find_llvm()
        mi.set_variant(options.get("variant", "llvm_ad_rgb"))
        mi.set_log_level(mi.LogLevel.Error)
        drjit.set_thread_count(threads)
        roulette = 5 if options.get("as_users") else _NO_ROULETTE
        rfilter = "gaussian" if options.get("as_users") else "box"
        scene: dict[str, Any] = {
            "type": "scene",
            "integrator": {"type": "path", "max_depth": world.edges, "rr_depth": roulette},
            "sensor": self._sensor(world, width, height, rfilter),
        }
        self._textures = world.textures
        self._bsdfs = [mi.load_dict(self._bsdf(material)) for material in world.materials]
        for i, mesh in enumerate(world.meshes):
            material = world.materials[mesh.material]
            # It samples a textured lamp by its texture, and takes it that no two places of a mesh share one. In pieces,
            # which get as many samples together as the whole, such lamps are right.
            parts = _islands(mesh) if material.radiance > 0 and _emission(material) >= 0 else [mesh]
            areas = [_area(part) for part in parts]
            for k, part in enumerate(parts):
                scene[f"mesh{i}_{k}"] = self._mesh(f"mesh{i}_{k}", part, material, areas[k] / sum(areas))
        if world.sky is not None:
            to_world = mi.ScalarTransform4f(np.array(_SKY_TO_WORLD, float))
            scene["sky"] = {"type": "envmap", "bitmap": mi.Bitmap(_sky(world.sky)), "to_world": to_world}
        self.scene = mi.load_dict(scene, parallel=False)

    def _sensor(self, world: World, width: int, height: int, rfilter: str) -> dict[str, Any]:
        view = world.view
        target = np.add(view.pos, view.dir).tolist()
        sensor: dict[str, Any] = {
            "type": "perspective",
            "fov_axis": "y",
            "fov": view.fov,
            "near_clip": 1e-3,
            "far_clip": 1e5,
            "to_world": mi.ScalarTransform4f().look_at(list(view.pos), target, list(view.up)),
            "film": {
                "type": "hdrfilm",
                "width": width,
                "height": height,
                "rfilter": {"type": rfilter},
                "pixel_format": "rgb",
                "component_format": "float32",
            },
            "sampler": {"type": "independent"},
        }
        if view.lens_radius > 0:
            lens = {"aperture_radius": view.lens_radius, "focus_distance": view.focal_depth}
            sensor |= {"type": "thinlens", **lens}
        return sensor

    def _colour(self, colour: Any, texture: int, scale: float = 1) -> dict[str, Any]:
        if texture < 0:
            return _rgb(np.array(colour) * scale)
        pixels = self._textures[texture]
        if scale != 1:
            pixels = linear(pixels) * np.float32(scale)
        raw = pixels.dtype != np.uint8
        return {"type": "bitmap", "bitmap": mi.Bitmap(np.ascontiguousarray(pixels)), "raw": raw}

    def _bsdf(self, m: Material) -> dict[str, Any]:
        colour = self._colour(m.albedo, m.albedo_texture)
        if m.kind == "light":
            return {"type": "diffuse", "reflectance": _rgb((0, 0, 0))}
        if m.kind == "glass":
            tints = {"specular_reflectance": colour, "specular_transmittance": colour}
            return {"type": "dielectric", "int_ior": float(m.ior), "ext_ior": 1.0, **tints}
        if m.kind == "translucent":
            only_through = {"diff_trans": 2.0, "spec_trans": 0.0, "sheen": 0.0, "flatness": 0.0}
            return {"type": "principledthin", "base_color": colour, **only_through}
        if m.kind == "diffuse":
            lobe = {"type": "diffuse", "reflectance": colour}
        elif m.kind == "layered_ggx":
            rough = {"alpha": float(m.roughness), "int_ior": float(m.ior), "ext_ior": 1.0}
            # Étendue tints the coat as well.
            lobe = {"type": "roughplastic", "distribution": "ggx", "diffuse_reflectance": colour, **rough}
        else:
            # A dielectric that only reflects is a conductor without absorption.
            k = m.absorb if m.kind == "metal" else 0.0
            lobe = {"type": "roughconductor", "distribution": "ggx", "alpha": max(float(m.roughness), 1e-3)}
            lobe |= {"eta": float(m.ior), "k": float(k), "specular_reflectance": colour}
            if m.kind == "specular":
                lobe["type"] = "conductor"
                del lobe["distribution"], lobe["alpha"]
        return {"type": "twosided", "bsdf": lobe}

    def _mesh(self, name: str, mesh: Mesh, material: Material, share: float) -> Any:
        properties = mi.Properties()
        properties["bsdf"] = self._bsdfs[mesh.material]
        if material.radiance > 0:
            radiance = self._colour(material.albedo, _emission(material), material.radiance)
            properties["emitter"] = mi.load_dict(
                {"type": "area", "radiance": radiance, "sampling_weight": share}
            )
        if mesh.normals is None:
            properties["face_normals"] = True
        made = mi.Mesh(
            name,
            len(mesh.vertices),
            len(mesh.triangles),
            has_vertex_normals=mesh.normals is not None,
            has_vertex_texcoords=mesh.uvs is not None,
            props=properties,
        )
        parameters = mi.traverse(made)
        parameters["vertex_positions"] = mesh.vertices.ravel()
        parameters["faces"] = mesh.triangles.ravel()
        if mesh.normals is not None:
            parameters["vertex_normals"] = mesh.normals.ravel()
        if mesh.uvs is not None:
            # Mitsuba's images begin at v = 0, Étendue's end there.
            parameters["vertex_texcoords"] = (mesh.uvs * [1, -1] + [0, 1]).astype(np.float32).ravel()
        parameters.update()
        return made

    def render(self, spp: int, seed: int) -> NDArray[np.float32]:
        """See the package."""
        # Far apart, as the scalar variants add a block's number to the seed.
        return np.array(mi.render(self.scene, spp=spp, seed=1 + 1_000_003 * seed), dtype=np.float32)


def _emission(material: Material) -> int:
    """The texture that its radiance is multiplied by, or -1."""
    return material.emission_texture if material.emission_texture >= 0 else material.albedo_texture


def _area(mesh: Mesh) -> float:
    a, b, c = np.moveaxis(mesh.vertices[mesh.triangles].astype(float), 1, 0)
    return float(np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2)


def _islands(mesh: Mesh) -> list[Mesh]:
    """The parts that touch nowhere, each a mesh of its own."""
    _, places = np.unique(mesh.vertices, axis=0, return_inverse=True)
    triangles = places.reshape(-1)[mesh.triangles]
    # Of each place the lowest that is known to be connected with it.
    lowest = np.arange(triangles.max() + 1)
    while True:
        before = lowest.copy()
        np.minimum.at(lowest, triangles, lowest[triangles].min(1, keepdims=True))
        if np.array_equal(lowest, before):
            break
    islands = lowest[triangles[:, 0]]
    parts = []
    for island in np.unique(islands):
        own, corners = np.unique(mesh.triangles[islands == island], return_inverse=True)
        normals, uvs = (None if array is None else array[own] for array in (mesh.normals, mesh.uvs))
        parts.append(
            Mesh(mesh.vertices[own], corners.reshape(-1, 3).astype(np.uint32), normals, uvs, mesh.material)
        )
    return parts


def _sky(pixels: NDArray[np.float32]) -> NDArray[np.float32]:
    """The same sky for Mitsuba, whose first and last row lie on the poles: every other row is one of ours."""
    height, width = pixels.shape[:2]
    out = np.empty((2 * height + 1, width, 3), np.float32)
    out[1::2] = pixels
    out[2:-1:2] = (pixels[1:] + pixels[:-1]) / 2
    out[0], out[-1] = pixels[0], pixels[-1]
    return out
