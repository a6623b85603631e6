"""Worlds that Étendue and Mitsuba 3 define equally, as plain arrays which both are then made from.

Surfaces are flat triangles: each renderer has its own cure for shading normals that look away.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from etendue.models import box, mesh, mis

Colour = tuple[float, float, float]
Vector = tuple[float, float, float]
SIZE = 64


@dataclass(frozen=True)
class Look:
    """A material: `kind` is Étendue's type.

    `texture`, float32 (h, w, 3), linear, row 0 at the top, replaces the albedo.
    """

    kind: str
    albedo: Colour = (0.5, 0.5, 0.5)
    ior: float = 1.5
    absorb: float = 0.0
    roughness: float = 0.1
    radiance: float = 0.0  # of the front, times albedo
    texture: NDArray[np.float32] | None = None


@dataclass(frozen=True)
class View:
    """A thin lens, square image."""

    pos: Vector
    dir: Vector
    up: Vector = (0, 1, 0)
    fov: float = 60
    lens_radius: float = 0
    focal_depth: float = 1


@dataclass(frozen=True)
class World:
    """Geometry with its looks, what surrounds it, and how it is rendered.

    `sky` is float32 (h, w, 3), equirectangular, or None.
    """

    parts: list[tuple[mesh.Mesh, Look]]
    view: View
    edges: int
    spp: int  # of each of the repeats
    sky: NDArray[np.float32] | None = None


def lamp(radiance: float, colour: Colour = (1, 1, 1)) -> Look:
    return Look("light", colour, radiance=radiance)


def diffuse(*albedo: float) -> Look:
    return Look("diffuse", albedo)  # type: ignore[arg-type]


def ground(half: float, uv_scale: float = 1) -> mesh.Mesh:
    corners = ((-half, 0, half), (half, 0, half), (half, 0, -half), (-half, 0, -half))
    return mesh.quad(*corners, uv_scale=(uv_scale, uv_scale))


def cornell() -> World:
    """The bundled box, all of it Lambertian; the lamp is out of view, so that there is little noise."""
    model = box.model()
    parts = []
    for name, meshes in model.parts.items():
        material = model.materials[name]
        look = lamp(100, tuple(material.kd)) if name == "light" else diffuse(*material.kd)  # type: ignore[arg-type]
        parts += [(part, look) for part in meshes]
    return World(parts, View((0, 1, 2.4), (0, -0.25, -1), fov=50), edges=8, spp=48)


def plates() -> World:
    """The plates of roughness 0.0025 to 0.1 under their four lamps, as conductors.

    The view ends below the lamps, whose rims would be most of the noise.
    """
    model = mis.model()
    strengths = {name: (strength, colour) for name, colour, strength in mis.LAMPS}
    roughness = {name: alpha for name, alpha, _, _ in mis.PLATES}
    parts = []
    for name, meshes in model.parts.items():
        if name in strengths:
            look = lamp(*strengths[name])
        elif name in roughness:
            look = Look("metal", (0.6, 0.6, 0.6), ior=0.2, absorb=3.1, roughness=roughness[name])
        else:
            look = diffuse(*model.materials[name].kd)
        parts += [(part, look) for part in meshes]
    view = View((-0.85342, 4.161, 2.3017), (0.050643, -0.48166, -0.87489), fov=44)
    return World(parts, view, edges=5, spp=48)


def sky() -> NDArray[np.float32]:
    """A horizon, a dark ground and a small sun; no symmetry, so that a turned sky would be seen."""
    h, w = 24, 48
    v, u = np.meshgrid((np.arange(h) + 0.5) / h, (np.arange(w) + 0.5) / w, indexing="ij")
    up = np.cos(np.pi * v)
    base = np.where(up > 0, 0.4 + 0.6 * (1 - up), 0.15)
    pixels = base[..., None] * np.stack(
        [0.7 + 0.3 * np.cos(2 * np.pi * u), 0.8 + 0 * u, 1 - 0.3 * np.sin(2 * np.pi * u)], -1
    )
    pixels[5:7, 9:11] += np.array([30, 26, 20])
    return pixels.astype(np.float32)


def under_a_sky() -> World:
    """A glass ball, a glass slab and a rough conductor on Lambertian ground under a sky with a sun.

    Mitsuba multiplies Smith's masking and shadowing, Étendue correlates them by height: alike where roughness
    times the tangent of the angle is small, so the conductor faces the camera.
    """
    ball = mesh.sphere(0.5, 40, 20).moved(-0.55, 0.6, 0)
    slab = mesh.box(0.6, 0.9, 0.15).turned("y", 30).moved(0.15, 0.5, 0.75)
    tilted = mesh.box(1.1, 1.1, 0.1).turned("x", -25).turned("y", -20).moved(0.75, 0.75, -0.5)
    parts = [
        (ground(4), diffuse(0.6, 0.5, 0.4)),
        (ball, Look("glass", (0.95, 1, 0.9), ior=1.5)),
        (slab, Look("glass", (1, 1, 1), ior=1.33)),
        (tilted, Look("metal", (0.9, 0.7, 0.4), ior=0.4, absorb=2.4, roughness=0.15)),
    ]
    return World(parts, View((0.2, 1.5, 3), (-0.03, -0.28, -1), fov=45), edges=10, spp=64, sky=sky())


def sheet() -> World:
    """A translucent sheet between a lamp and the camera's room, lit from both sides."""
    curtain = mesh.quad((-0.8, 0.05, 0), (0.8, 0.05, 0), (0.8, 1.6, 0.1), (-0.8, 1.6, 0.1))
    behind = mesh.quad((-0.4, 0.6, -1.2), (0.4, 0.6, -1.2), (0.4, 1.2, -1.2), (-0.4, 1.2, -1.2))
    above = mesh.disc(0.3).turned("x", 150).moved(0.5, 2, 1.2)
    wall = mesh.quad((-2, 0, -1.5), (2, 0, -1.5), (2, 2.5, -1.5), (-2, 2.5, -1.5))
    parts = [
        (ground(2), diffuse(0.6, 0.6, 0.6)),
        (wall, diffuse(0.3, 0.5, 0.7)),
        (curtain, Look("translucent", (0.7, 0.6, 0.3))),
        (behind, lamp(6, (1, 0.9, 0.8))),
        (above, lamp(9, (0.8, 0.9, 1))),
    ]
    return World(parts, View((0.4, 1.2, 3), (-0.1, -0.15, -1), fov=50), edges=8, spp=48)


def textured() -> World:
    """Textured ground, off the lens's focus, in a lamp's and the sky's light."""
    texture = np.random.default_rng(5).uniform(0.05, 0.95, (5, 7, 3)).astype(np.float32)
    block = mesh.box(0.6, 0.6, 0.6).turned("y", 25).moved(0.3, 0.301, -0.2)
    above = mesh.disc(0.4).turned("x", 180).moved(-0.8, 1.8, 0.5)
    parts = [
        (ground(2.5, uv_scale=2.5), Look("diffuse", texture=texture)),
        (block, diffuse(0.7, 0.7, 0.7)),
        (above, lamp(8)),
    ]
    view = View((0, 1.4, 2.6), (0, -0.5, -1), fov=50, lens_radius=0.08, focal_depth=2.5)
    return World(parts, view, edges=6, spp=48, sky=0.3 * sky())


WORLDS = {"box": cornell, "plates": plates, "sky": under_a_sky, "sheet": sheet, "texture": textured}
