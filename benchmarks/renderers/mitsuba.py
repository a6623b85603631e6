"""Mitsuba 3, by its path integrator."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

import drjit
import mitsuba as mi
import numpy as np
from numpy.typing import NDArray

from ..world import Material, Mesh, World

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
            scene[f"mesh{i}"] = self._mesh(i, mesh, world.materials[mesh.material])
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
            linear = pixels if pixels.dtype != np.uint8 else _decoded(pixels)
            pixels = (linear * scale).astype(np.float32)
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

    def _mesh(self, i: int, mesh: Mesh, material: Material) -> Any:
        properties = mi.Properties()
        properties["bsdf"] = self._bsdfs[mesh.material]
        if material.radiance > 0:
            texture = material.emission_texture if material.emission_texture >= 0 else material.albedo_texture
            radiance = self._colour(material.albedo, texture, material.radiance)
            properties["emitter"] = mi.load_dict({"type": "area", "radiance": radiance})
        if mesh.normals is None:
            properties["face_normals"] = True
        made = mi.Mesh(
            f"mesh{i}",
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


def _decoded(pixels: NDArray[np.uint8]) -> NDArray[np.float32]:
    c = pixels.astype(np.float32) / 255
    return np.where(c <= 0.04045, c / 12.92, ((c + 0.055) / 1.055) ** 2.4).astype(np.float32)


def _sky(pixels: NDArray[np.float32]) -> NDArray[np.float32]:
    """The same sky for Mitsuba, whose first and last row lie on the poles: every other row is one of ours."""
    height, width = pixels.shape[:2]
    out = np.empty((2 * height + 1, width, 3), np.float32)
    out[1::2] = pixels
    out[2:-1:2] = (pixels[1:] + pixels[:-1]) / 2
    out[0], out[-1] = pixels[0], pixels[-1]
    return out
