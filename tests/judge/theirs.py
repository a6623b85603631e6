"""The same world rendered by Mitsuba 3, from the same arrays. Importing this needs the extra `judge`."""

from __future__ import annotations

from typing import Any

import mitsuba as mi
import numpy as np
from numpy.typing import NDArray

from .worlds import SIZE, Look, View, World

# The variant without a just-in-time compiler: it needs no LLVM.
mi.set_variant("scalar_rgb")
mi.set_log_level(mi.LogLevel.Error)

# Étendue's sky has phi = 0 along +x, Mitsuba's along -z.
SKY_TO_WORLD = np.array([[0, 0, -1, 0], [0, 1, 0, 0], [1, 0, 0, 0], [0, 0, 0, 1]], float)


def _rgb(colour: Any) -> dict[str, Any]:
    return {"type": "rgb", "value": [float(c) for c in colour]}


def _bsdf(look: Look) -> dict[str, Any]:
    if look.kind == "light":
        return {"type": "diffuse", "reflectance": _rgb((0, 0, 0))}
    if look.kind == "glass":
        tint = {"specular_reflectance": _rgb(look.albedo), "specular_transmittance": _rgb(look.albedo)}
        return {"type": "dielectric", "int_ior": look.ior, "ext_ior": 1.0, **tint}
    if look.kind == "translucent":
        # Disney's thin surface with all of its light sent through by a cosine lobe.
        only_through = {"diff_trans": 2.0, "spec_trans": 0.0, "sheen": 0.0, "flatness": 0.0}
        return {"type": "principledthin", "base_color": _rgb(look.albedo), **only_through}
    if look.kind == "metal":
        lobe = {
            "type": "roughconductor",
            "distribution": "ggx",
            "alpha": look.roughness,
            "eta": look.ior,
            "k": look.absorb,
            "specular_reflectance": _rgb(look.albedo),
        }
    else:
        assert look.kind == "diffuse"
        lobe = {"type": "diffuse", "reflectance": _rgb(look.albedo)}
        if look.texture is not None:
            pixels = mi.Bitmap(look.texture)
            lobe["reflectance"] = {"type": "bitmap", "bitmap": pixels, "raw": True, "filter_type": "bilinear"}
    return {"type": "twosided", "bsdf": lobe}


def _mesh(
    name: str, vertices: NDArray[Any], faces: NDArray[Any], uvs: NDArray[Any] | None, look: Look
) -> Any:
    properties = mi.Properties()
    properties["bsdf"] = mi.load_dict(_bsdf(look))
    if look.radiance > 0:
        radiance = _rgb(np.array(look.albedo) * look.radiance)
        properties["emitter"] = mi.load_dict({"type": "area", "radiance": radiance})
    mesh = mi.Mesh(name, len(vertices), len(faces), has_vertex_texcoords=uvs is not None, props=properties)
    parameters = mi.traverse(mesh)
    parameters["vertex_positions"] = vertices.astype(np.float32).ravel()
    parameters["faces"] = faces.astype(np.uint32).ravel()
    if uvs is not None:
        # Mitsuba's images begin at v = 0, Étendue's end there.
        parameters["vertex_texcoords"] = (uvs * [1, -1] + [0, 1]).astype(np.float32).ravel()
    parameters.update()
    return mesh


def sky_pixels(pixels: NDArray[np.float32]) -> NDArray[np.float32]:
    """The same sky for Mitsuba, whose first and last row lie on the poles: every other row is one of ours."""
    height, width = pixels.shape[:2]
    out = np.empty((2 * height + 1, width, 3), np.float32)
    out[1::2] = pixels
    out[2:-1:2] = (pixels[1:] + pixels[:-1]) / 2
    out[0], out[-1] = pixels[0], pixels[-1]
    return out


def sky_emitter(pixels: NDArray[np.float32]) -> dict[str, Any]:
    to_world = mi.ScalarTransform4f(SKY_TO_WORLD)
    return {"type": "envmap", "bitmap": mi.Bitmap(sky_pixels(pixels)), "to_world": to_world}


def _sensor(view: View) -> dict[str, Any]:
    target = np.add(view.pos, view.dir).tolist()
    sensor = {
        "type": "perspective",
        "fov_axis": "y",
        "fov": view.fov,
        "near_clip": 1e-3,
        "far_clip": 1e4,
        "to_world": mi.ScalarTransform4f().look_at(list(view.pos), target, list(view.up)),
        "film": {
            "type": "hdrfilm",
            "width": SIZE,
            "height": SIZE,
            "rfilter": {"type": "box"},
            "pixel_format": "rgb",
            "component_format": "float32",
        },
        "sampler": {"type": "independent"},
    }
    if view.lens_radius > 0:
        sensor |= {
            "type": "thinlens",
            "aperture_radius": view.lens_radius,
            "focus_distance": view.focal_depth,
        }
    return sensor


def render(world: World, seeds: range) -> NDArray[np.float64]:
    """Independent images, (seeds, SIZE, SIZE, 3)."""
    # The depth of both counts edges. Roulette is off; Étendue's own stays on.
    path = {"type": "path", "max_depth": world.edges, "rr_depth": 1000}
    scene = {"type": "scene", "integrator": path, "sensor": _sensor(world.view)}
    for i, (part, look) in enumerate(world.parts):
        scene[f"part{i}"] = _mesh(f"part{i}", part.vertices, part.faces, part.uvs, look)
    if world.sky is not None:
        scene["sky"] = sky_emitter(world.sky)
    loaded = mi.load_dict(scene)
    # Far apart, as a seed may be added to the numbers of blocks.
    images = [mi.render(loaded, spp=world.spp, seed=1 + 1_000_003 * seed) for seed in seeds]
    return np.array([np.array(image, dtype=float) for image in images])
