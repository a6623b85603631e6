"""Blender's Cycles, on the CPU."""

from __future__ import annotations

import tempfile
from pathlib import Path
from typing import Any

import bpy
import numpy as np
from numpy.typing import NDArray

from ..world import Material, Mesh, View, World


class Renderer:
    """See the package."""

    rays = None

    def __init__(self, world: World, width: int, height: int, threads: int, options: dict[str, Any]) -> None:
        bpy.ops.wm.read_factory_settings(use_empty=True)
        self.scene = scene = bpy.context.scene
        self._images = [_image(f"texture{i}", pixels) for i, pixels in enumerate(world.textures)]
        materials = [self._material(i, material) for i, material in enumerate(world.materials)]
        for i, mesh in enumerate(world.meshes):
            scene.collection.objects.link(_object(i, mesh, materials[mesh.material]))
        self._sky(world.sky)
        self._camera(world.view)
        self._settings(width, height, threads, world.edges, bool(options.get("as_users")))
        self._file = Path(tempfile.mkdtemp()) / "image.exr"
        scene.render.filepath = str(self._file)
        # Builds everything, which the next renders keep.
        self.render(1, 0)

    def _settings(self, width: int, height: int, threads: int, edges: int, as_users: bool) -> None:
        render, cycles = self.scene.render, self.scene.cycles
        render.engine = "CYCLES"
        render.resolution_x, render.resolution_y, render.resolution_percentage = width, height, 100
        render.threads_mode, render.threads = "FIXED", threads
        render.use_persistent_data = True
        render.image_settings.file_format = "OPEN_EXR"
        render.image_settings.color_depth = "32"
        cycles.device = "CPU"
        cycles.use_denoising = cycles.use_adaptive_sampling = False
        # A sum of bounces: Cycles counts them after the first hit.
        bounces = ("max_bounces", "diffuse_bounces", "glossy_bounces", "transmission_bounces")
        for name in bounces:
            setattr(cycles, name, edges - 2)
        # What a user leaves on is biased; without it the pictures could not be compared.
        cycles.sample_clamp_direct = cycles.sample_clamp_indirect = 0
        cycles.blur_glossy = 0
        if not as_users:
            # No Russian roulette, and the sampler that is fastest on simple scenes.
            cycles.min_light_bounces = 1024
            cycles.min_transparent_bounces = 1024
            cycles.pixel_filter_type = "BOX"
            cycles.filter_width = 1.0
            cycles.use_light_tree = False
            cycles.sampling_pattern = "TABULATED_SOBOL"

    def _material(self, i: int, m: Material) -> Any:
        material = bpy.data.materials.new(f"material{i}")
        material.use_nodes = True
        nodes, links = material.node_tree.nodes, material.node_tree.links
        nodes.clear()
        output = nodes.new("ShaderNodeOutputMaterial")

        def colour(socket: Any, texture: int) -> None:
            socket.default_value = (*(float(c) for c in m.albedo), 1)
            if texture >= 0:
                image = nodes.new("ShaderNodeTexImage")
                image.image = self._images[texture]
                links.new(image.outputs["Color"], socket)

        def add(a: Any, b: Any) -> Any:
            node = nodes.new("ShaderNodeAddShader")
            links.new(a, node.inputs[0])
            links.new(b, node.inputs[1])
            return node.outputs[0]

        shader = None
        if m.kind != "light":
            shader = self._lobes(m, nodes, links, colour)
        if m.radiance > 0:
            emission = nodes.new("ShaderNodeEmission")
            colour(
                emission.inputs["Color"], m.emission_texture if m.emission_texture >= 0 else m.albedo_texture
            )
            # From the front alone.
            geometry, front = nodes.new("ShaderNodeNewGeometry"), nodes.new("ShaderNodeMath")
            front.operation = "MULTIPLY_ADD"
            links.new(geometry.outputs["Backfacing"], front.inputs[0])
            front.inputs[1].default_value, front.inputs[2].default_value = -m.radiance, m.radiance
            links.new(front.outputs[0], emission.inputs["Strength"])
            shader = emission.outputs[0] if shader is None else add(shader, emission.outputs[0])
        if shader is not None:
            links.new(shader, output.inputs["Surface"])
        return material

    def _lobes(self, m: Material, nodes: Any, links: Any, colour: Any) -> Any:
        def new(kind: str) -> Any:
            return nodes.new(kind)

        # Cycles takes the square root of the microfacets' alpha.
        roughness = float(np.sqrt(m.roughness))
        if m.kind in ("diffuse", "translucent"):
            node = new("ShaderNodeBsdfDiffuse" if m.kind == "diffuse" else "ShaderNodeBsdfTranslucent")
            colour(node.inputs["Color"], m.albedo_texture)
        elif m.kind == "glass":
            node = new("ShaderNodeBsdfGlass")
            node.distribution = "GGX"
            node.inputs["Roughness"].default_value, node.inputs["IOR"].default_value = 0.0, m.ior
            colour(node.inputs["Color"], m.albedo_texture)
        elif m.kind == "layered_ggx":
            node = new("ShaderNodeBsdfPrincipled")
            colour(node.inputs["Base Color"], m.albedo_texture)
            node.inputs["Roughness"].default_value, node.inputs["IOR"].default_value = roughness, m.ior
        elif m.kind == "metal":
            node = new("ShaderNodeBsdfMetallic")
            node.distribution, node.fresnel_type = "GGX", "PHYSICAL_CONDUCTOR"
            node.inputs["IOR"].default_value = (m.ior,) * 3
            node.inputs["Extinction"].default_value = (m.absorb,) * 3
            node.inputs["Roughness"].default_value = roughness
        else:
            # A dielectric that only reflects, without the rise to grazing angles.
            node = new("ShaderNodeBsdfAnisotropic")
            node.distribution = "GGX"
            f0 = ((m.ior - 1) / (m.ior + 1)) ** 2
            node.inputs["Color"].default_value = (*(float(c) * f0 for c in m.albedo), 1)
            node.inputs["Roughness"].default_value = 0.0 if m.kind == "specular" else roughness
        return node.outputs[0]

    def _sky(self, pixels: NDArray[np.float32] | None) -> None:
        world = bpy.data.worlds.new("sky")
        self.scene.world = world
        world.use_nodes = True
        nodes, links = world.node_tree.nodes, world.node_tree.links
        background = nodes["Background"]
        background.inputs["Color"].default_value = (0, 0, 0, 1)
        if pixels is None:
            return
        # Cycles' sky turns about z, with its seam at -x: (-x, z, y) of our direction is the same point of the image.
        image, where = nodes.new("ShaderNodeTexEnvironment"), nodes.new("ShaderNodeTexCoord")
        image.image = _image("sky", pixels)
        apart, together = nodes.new("ShaderNodeSeparateXYZ"), nodes.new("ShaderNodeCombineXYZ")
        negated = nodes.new("ShaderNodeMath")
        negated.operation = "MULTIPLY"
        negated.inputs[1].default_value = -1
        links.new(where.outputs["Generated"], apart.inputs[0])
        links.new(apart.outputs["X"], negated.inputs[0])
        links.new(negated.outputs[0], together.inputs["X"])
        links.new(apart.outputs["Z"], together.inputs["Y"])
        links.new(apart.outputs["Y"], together.inputs["Z"])
        links.new(together.outputs[0], image.inputs["Vector"])
        links.new(image.outputs["Color"], background.inputs["Color"])
        world.cycles.sampling_method = "MANUAL"
        world.cycles.sample_map_resolution = 2048

    def _camera(self, view: View) -> None:
        data = bpy.data.cameras.new("camera")
        data.sensor_fit, data.angle_y = "VERTICAL", float(np.radians(view.fov))
        data.sensor_fit = "VERTICAL"
        data.clip_start, data.clip_end = 1e-3, 1e6
        if view.lens_radius > 0:
            data.dof.use_dof, data.dof.focus_distance = True, view.focal_depth
            # The aperture is given by its f-number, the focal length in millimetres.
            data.dof.aperture_fstop = data.lens / 1000 / (2 * view.lens_radius)
        forward = np.array(view.dir, float) / np.linalg.norm(view.dir)
        right = np.cross(forward, view.up)
        right /= np.linalg.norm(right)
        matrix = np.eye(4)
        matrix[:3, 0], matrix[:3, 1], matrix[:3, 2] = right, np.cross(right, forward), -forward
        matrix[:3, 3] = view.pos
        camera = bpy.data.objects.new("camera", data)
        camera.matrix_world = matrix.T.tolist()
        self.scene.collection.objects.link(camera)
        self.scene.camera = camera

    def render(self, spp: int, seed: int) -> NDArray[np.float32]:
        """See the package."""
        self.scene.cycles.samples, self.scene.cycles.seed = spp, seed
        bpy.ops.render.render(write_still=True)
        image = bpy.data.images.load(str(self._file))
        width, height = image.size
        pixels = np.empty(width * height * 4, np.float32)
        image.pixels.foreach_get(pixels)
        bpy.data.images.remove(image)
        return pixels.reshape(height, width, 4)[::-1, :, :3]


def _image(name: str, pixels: NDArray[Any]) -> Any:
    height, width = pixels.shape[:2]
    is_srgb = pixels.dtype == np.uint8
    image = bpy.data.images.new(name, width, height, float_buffer=not is_srgb)
    image.colorspace_settings.name = "sRGB" if is_srgb else "Non-Color"
    rgba = np.ones((height, width, 4), np.float32)
    rgba[..., :3] = pixels[::-1] / 255 if is_srgb else pixels[::-1]
    image.pixels.foreach_set(rgba.ravel())
    image.update()
    image.pack()
    return image


def _object(i: int, mesh: Mesh, material: Any) -> Any:
    data = bpy.data.meshes.new(f"mesh{i}")
    corners = mesh.triangles.ravel()
    data.vertices.add(len(mesh.vertices))
    data.vertices.foreach_set("co", mesh.vertices.ravel())
    data.loops.add(len(corners))
    data.loops.foreach_set("vertex_index", corners.astype(np.int32))
    data.polygons.add(len(mesh.triangles))
    data.polygons.foreach_set("loop_start", np.arange(0, len(corners), 3, dtype=np.int32))
    data.polygons.foreach_set("use_smooth", np.full(len(mesh.triangles), mesh.normals is not None))
    if mesh.uvs is not None:
        layer = data.uv_layers.new(name="uv")
        layer.data.foreach_set("uv", mesh.uvs[corners].ravel())
    data.update(calc_edges=True)
    if mesh.normals is not None:
        data.normals_split_custom_set_from_vertices(mesh.normals)
    data.materials.append(material)
    return bpy.data.objects.new(f"mesh{i}", data)
