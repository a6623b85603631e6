"""LuxCoreRender, by its CPU path tracer."""

from __future__ import annotations

import time
from typing import Any

import numpy as np
import pyluxcore
from numpy.typing import NDArray

from ..world import Material, World, linear


class Renderer:
    """See the package."""

    rays = None

    def __init__(self, world: World, width: int, height: int, threads: int, options: dict[str, Any]) -> None:
        pyluxcore.Init(lambda message: None)
        self.size = width, height
        self.as_users, self.threads, self.edges = bool(options.get("as_users")), threads, world.edges
        scene = self.scene = pyluxcore.Scene()
        for i, pixels in enumerate(world.textures):
            _define_texture(scene, f"texture{i}", pixels)
        properties = self._camera(world)
        for i, material in enumerate(world.materials):
            properties.Set(self._material(f"material{i}", material))
        for i, mesh in enumerate(world.meshes):
            normals = None if mesh.normals is None else list(map(tuple, mesh.normals.tolist()))
            # Its images begin at the top.
            uvs = None if mesh.uvs is None else list(map(tuple, (mesh.uvs * [1, -1] + [0, 1]).tolist()))
            points, triangles = mesh.vertices.tolist(), mesh.triangles.tolist()
            scene.DefineMesh(
                f"mesh{i}", list(map(tuple, points)), list(map(tuple, triangles)), normals, uvs, None, None
            )
            properties.Set(_property(f"scene.objects.object{i}.shape", f"mesh{i}"))
            properties.Set(_property(f"scene.objects.object{i}.material", f"material{mesh.material}"))
        if world.sky is not None:
            _define_image(scene, "sky", world.sky)
            properties.Set(_property("scene.lights.sky.type", "infinite"))
            properties.Set(_property("scene.lights.sky.file", "sky"))
            properties.Set(_property("scene.lights.sky.gamma", 1.0))
            # Its poles are on z and its u runs the other way round.
            turn = [1, 0, 0, 0, 0, 0, 1, 0, 0, 1, 0, 0, 0, 0, 0, 1]
            properties.Set(pyluxcore.Property("scene.lights.sky.transformation", [float(v) for v in turn]))
        scene.Parse(properties)
        self._build()

    def _build(self) -> None:
        # The hierarchy is built when a session starts.
        self.render(1, 1)

    def _camera(self, world: World) -> Any:
        view, properties = world.view, pyluxcore.Properties()
        width, height = self.size
        target = np.add(view.pos, view.dir).tolist()
        # The field of view is that of the shorter side.
        fov = view.fov
        if width < height:
            fov = float(np.degrees(2 * np.arctan(np.tan(np.radians(fov) / 2) * width / height)))
        for name, value in {
            "type": "perspective",
            "lookat.orig": [float(v) for v in view.pos],
            "lookat.target": [float(v) for v in target],
            "up": [float(v) for v in view.up],
            "fieldofview": float(fov),
            "lensradius": float(view.lens_radius),
            "focaldistance": float(view.focal_depth),
            "autofocus.enable": 0,
            "cliphither": 1e-3,
        }.items():
            properties.Set(_property(f"scene.camera.{name}", value))
        return properties

    def _material(self, name: str, m: Material) -> Any:
        properties = pyluxcore.Properties()
        prefix = f"scene.materials.{name}."

        def put(key: str, value: Any) -> None:
            properties.Set(_property(prefix + key, value))

        albedo = [float(c) for c in m.albedo]
        colour: Any = f"texture{m.albedo_texture}" if m.albedo_texture >= 0 else albedo
        if m.kind in ("diffuse", "light"):
            put("type", "matte")
            put("kd", [0.0] * 3 if m.kind == "light" else colour)
        elif m.kind == "translucent":
            put("type", "mattetranslucent")
            put("kr", [0.0] * 3)
            put("kt", colour)
        elif m.kind == "glass":
            put("type", "glass")
            put("kr", colour)
            put("kt", colour)
            put("interiorior", float(m.ior))
        elif m.kind == "metal":
            put("type", "metal2")
            texture = f"scene.textures.fresnel_{name}."
            square = lambda shift: (m.ior + shift) ** 2 + m.absorb**2  # noqa: E731
            reflectance = square(-1) / square(1)
            properties.Set(_property(texture + "type", "fresnelcolor"))
            properties.Set(_property(texture + "kr", [reflectance * c for c in albedo]))
            put("fresnel", f"fresnel_{name}")
            put("uroughness", float(m.roughness))
            put("vroughness", float(m.roughness))
        elif m.kind == "specular":
            put("type", "mirror")
            f0 = ((m.ior - 1) / (m.ior + 1)) ** 2
            put("kr", [f0 * c for c in albedo])
        else:
            put("type", "glossy2")
            put("kd", [0.0] * 3 if m.kind in ("microfacet", "phong") else colour)
            put("ks", [1.0] * 3)
            put("index", float(m.ior))
            put("uroughness", float(m.roughness))
            put("vroughness", float(m.roughness))
        if m.radiance > 0:
            texture_index = m.emission_texture if m.emission_texture >= 0 else m.albedo_texture
            if texture_index >= 0:
                put("emission", f"texture{texture_index}")
                put("emission.gain", [float(m.radiance)] * 3)
            else:
                put("emission", [c * float(m.radiance) for c in albedo])
        return properties

    def render(self, spp: int, seed: int) -> NDArray[np.float32]:
        """See the package."""
        width, height = self.size
        properties = pyluxcore.Properties()
        settings: dict[str, Any] = {
            "renderengine.type": "PATHCPU",
            "sampler.type": "SOBOL",
            "renderengine.seed": int(seed) + 1,
            "native.threads.count": self.threads,
            "film.width": width,
            "film.height": height,
            "film.outputs.0.type": "RGB",
            "film.outputs.0.filename": "image.exr",
            "film.imagepipelines.0.0.type": "NOP",
            "batch.haltspp": [spp, 0],
            "path.pathdepth.total": self.edges + 1,
            "path.pathdepth.diffuse": self.edges + 1,
            "path.pathdepth.glossy": self.edges + 1,
            "path.pathdepth.specular": self.edges + 1,
        }
        if not self.as_users:
            settings |= {
                "path.russianroulette.depth": 1000,
                "film.filter.type": "BOX",
                "film.filter.width": 0.5,
                "path.forceblackbackground.enable": 0,
                "sampler.sobol.adaptive.strength": 0.0,
            }
        for name, value in settings.items():
            properties.Set(_property(name, value))
        session = pyluxcore.RenderSession(pyluxcore.RenderConfig(properties, self.scene))
        session.Start()
        while not session.HasDone():
            time.sleep(0.002)
            session.UpdateStats()
        session.Stop()
        pixels = np.zeros(width * height * 3, np.float32)
        session.GetFilm().GetOutputFloat(pyluxcore.FilmOutputType.RGB, pixels)
        return pixels.reshape(height, width, 3)[::-1]


def _property(name: str, value: Any) -> Any:
    return pyluxcore.Property(name, value)


def _define_image(scene: Any, name: str, pixels: NDArray[Any]) -> None:
    height, width = pixels.shape[:2]
    values = np.ascontiguousarray(pixels, np.float32).ravel()
    scene.DefineImageMap(name, values, 1.0, 3, width, height)


def _define_texture(scene: Any, name: str, pixels: NDArray[Any]) -> None:
    # Linear: of an image that is known by name it takes the gamma that it was defined with, and no other.
    _define_image(scene, f"{name}_pixels", linear(pixels))
    properties = pyluxcore.Properties()
    properties.Set(_property(f"scene.textures.{name}.type", "imagemap"))
    properties.Set(_property(f"scene.textures.{name}.file", f"{name}_pixels"))
    properties.Set(_property(f"scene.textures.{name}.gamma", 1.0))
    scene.Parse(properties)
