"""Scene: what is in it, its lights and its materials."""

from __future__ import annotations

from imgui_bundle import imgui

from ... import _core
from ...config.patches import PATCHED
from ...scene import Scene
from ...scene.materials import Resolved
from ..document import Document
from ..viewer import IMAGES, MESHES, Viewer
from ..widgets import buttons, field, material_field, text_row, tooltip

_TEXTURES = ("albedo_texture", "emission_texture", "normal_texture", "cutout_texture")
_STRENGTH = "emissive_strength"


def draw(viewer: Viewer) -> None:
    """Draw the page."""
    scene = viewer.session.scene
    if scene is not None:
        _draw_contents(scene)
    buttons(
        (
            "Add mesh",
            "Add an OBJ, PLY, STL or glTF file.",
            lambda: viewer.ask("Add mesh", "", MESHES, viewer.add_mesh),
        ),
        (
            "Add envmap",
            "Light the scene by an equirectangular image.",
            lambda: viewer.ask("Add environment map", "", IMAGES, viewer.set_environment),
        ),
        ("Clear", "Leave nothing but a white sky.", viewer.clear),
    )
    if scene is None:
        return
    resolved = scene.surfaces.resolved(viewer.document.config.scene)
    dark = [patch.name for patch in viewer.document.config.scene.materials if patch.emissive_strength == 0]
    lights = [m for m in resolved.values() if m.emissive_strength > 0 or m.type == "light" or m.name in dark]
    if imgui.collapsing_header(f"Lights ({len(lights)})###lights", imgui.TreeNodeFlags_.default_open):
        _draw_sky(viewer.document)
        for material in lights:
            _draw_light(viewer, material)
    if imgui.collapsing_header(f"Materials ({len(resolved)})###materials"):
        for material in resolved.values():
            _draw_material(viewer, scene, material)


def _draw_contents(scene: Scene) -> None:
    bounds = scene.core.bounds
    if bounds is not None:
        lower, upper = (", ".join(f"{value:.4g}" for value in corner) for corner in bounds)
        text_row("bounds", f"{lower}\n{upper}")
    text_row("triangles", f"{scene.core.triangle_count:,}")
    text_row("light power", f"{sum(light.power for light in scene.lights):.5g}")


def _draw_sky(document: Document) -> None:
    imgui.push_id("sky")
    sky = document.config.scene.sky
    if sky is None:
        if imgui.button("Add sky"):
            document.set({("scene", "sky"): {"intensity": 1.0}})
    elif imgui.tree_node_ex("sky", imgui.TreeNodeFlags_.default_open):
        text_row("environment map", sky.envmap or "none: white")
        field(document, ("scene", "sky", "intensity"), "strength")
        if imgui.button("Remove sky"):
            document.set({("scene", "sky"): None})
        imgui.tree_pop()
    imgui.pop_id()


def _draw_light(viewer: Viewer, material: Resolved) -> None:
    document = viewer.document
    imgui.push_id(f"light {material.name}")
    if imgui.tree_node_ex(material.name, imgui.TreeNodeFlags_.default_open):
        _field(document, material, "albedo_col", "colour", material.albedo)
        _field(document, material, _STRENGTH, "strength", material.emissive_strength)
        lit = material.emissive_strength > 0
        if imgui.button("Extinguish###switch" if lit else "Light###switch"):
            viewer.switch_light(material.name, not lit)
        imgui.tree_pop()
    imgui.pop_id()


def _draw_material(viewer: Viewer, scene: Scene, material: Resolved) -> None:
    document = viewer.document
    imgui.push_id(f"material {material.name}")
    is_seen = viewer.material == material.name
    if is_seen:
        imgui.push_style_color(imgui.Col_.text, (1.0, 0.8, 0.35, 1.0))
    is_open = imgui.tree_node(material.name)
    if is_seen:
        imgui.pop_style_color()
    if is_open:
        kind = next(kind for kind in _core.material_types() if kind.name == material.type)
        node = {
            **document.schema(("scene", "materials", 0, "type")),
            "enum": [t.name for t in _core.material_types()],
        }
        material_field(document, material.name, "type", "type", node, material.type)
        text_row("lobes", f"{kind.bsdf}: {kind.summary}")
        shown = {"albedo_col": material.albedo}
        for key in PATCHED:
            if key != "type":
                _field(document, material, key, key, shown.get(key, getattr(material, key, None)))
        own = next(s.material for s in scene.surfaces.of_meshes if s.material.name == material.name)
        for key in _TEXTURES:
            texture = getattr(own, key)
            if texture is not None:
                text_row(key.replace("_", " "), texture.name)
                tooltip(str(texture))
        imgui.tree_pop()
    imgui.pop_id()


def _field(document: Document, material: Resolved, key: str, label: str, shown: object) -> None:
    place = ("scene", "materials", 0, key)
    node = {**document.schema(place), "limits": document.limits(place)}
    material_field(document, material.name, key, label, node, shown)
