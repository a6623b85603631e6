"""The scenes of the benchmark: the bundled ones, and three that are built for it."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np

from etendue import _core
from etendue.config import read_config
from etendue.config.patches import merged
from etendue.loaders.image import load_image
from etendue.loaders.mesh import load_mesh
from etendue.models import mesh as shapes
from etendue.scene.materials import resolve
from etendue.scene.textures import Textures

from .renderers import etendue
from .world import Material, Mesh, View, World

ROOT = Path(__file__).resolve().parent.parent
CACHE = ROOT / "build" / "benchmarks"
BUNDLED = ("box", "pots", "sibenik", "spz", "fireplace", "mis")


def bundled(name: str) -> World:
    """A scene of configs/, without normal maps and cut-outs, which renderers define differently."""
    config = read_config(ROOT / f"configs/a04_{name}.json")
    patches, types = merged(config.scene.materials), _core.material_types()
    textures = Textures([])
    meshes, materials = [], []
    for file_name in config.scene.mesh_files:
        file = load_mesh(config.find_file(file_name, ()), [])
        for mesh in file.meshes:
            source = file.materials[mesh.material]
            made = resolve(source, patches.get(source.name), types)
            has_uvs = mesh.uvs is not None
            kind = next(t.bsdf for t in types if t.name == made.type)
            materials.append(
                Material(
                    kind,
                    made.albedo,
                    made.ior,
                    made.roughness,
                    made.absorb,
                    made.emissive_strength,
                    textures.colour(source.albedo_texture) if has_uvs else -1,
                    textures.colour(source.emission_texture) if has_uvs else -1,
                )
            )
            meshes.append(Mesh(mesh.vertices, mesh.triangles, mesh.normals, mesh.uvs, len(materials) - 1))
    sky = config.scene.sky
    pixels = None
    if sky is not None and sky.envmap is not None:
        image = load_image(config.find_file(sky.envmap, ()), "environment", [])
        pixels = np.asarray(image.pixels, np.float32)[..., :3] * np.float32(sky.intensity)
    camera = config.camera
    view = View(camera.pos, camera.dir, camera.up, camera.fov, camera.lens_radius, camera.focal_depth)
    images = [np.ascontiguousarray(_three_channels(image.pixels)) for image in textures.images]
    world = World(name, meshes, materials, view, config.parameters()["max_cam_path_length"], images, pixels)
    if config.auto_focus:
        view.focal_depth = etendue.Renderer(world, 512, 512, 1, {}).auto_focus()
    return world


def _three_channels(pixels: np.ndarray) -> np.ndarray:
    return np.repeat(pixels[..., :1], 3, axis=2) if pixels.shape[2] == 1 else pixels[..., :3]


class _Builder:
    """Collects shapes of models/mesh.py."""

    def __init__(self) -> None:
        self.meshes: list[Mesh] = []
        self.materials: list[Material] = []

    def material(self, kind: str, *albedo: float, **others: float) -> int:
        """A new material's index."""
        self.materials.append(Material(kind, albedo, **others))  # type: ignore[arg-type]
        return len(self.materials) - 1

    def add(self, shape: shapes.Mesh, material: int) -> None:
        """A shape of that material."""
        normals = None if shape.normals is None else shape.normals.astype(np.float32)
        vertices, triangles = shape.vertices.astype(np.float32), shape.faces.astype(np.uint32)
        self.meshes.append(Mesh(vertices, triangles, normals, None, material))

    def world(self, name: str, view: View, sky: np.ndarray | None = None) -> World:
        """What has been collected."""
        return World(name, self.meshes, self.materials, view, sky=sky)


def room() -> World:
    """A closed room of a million triangles: bumpy walls, 30 bumpy balls, a lamp under the ceiling."""
    b, rng = _Builder(), np.random.default_rng(1)
    colours = [(0.75, 0.72, 0.68), (0.6, 0.2, 0.15), (0.2, 0.4, 0.6), (0.7, 0.6, 0.3)]
    kinds = [b.material("diffuse", *colour) for colour in colours]

    def wall(origin: tuple[float, ...], s: tuple[float, ...], t: tuple[float, ...]) -> shapes.Mesh:
        o, s_, t_ = np.array(origin, float), np.array(s, float), np.array(t, float)
        n = np.cross(s_, t_) / (np.linalg.norm(s_) * np.linalg.norm(t_))
        waves = rng.uniform(4, 25, (8, 2)), rng.uniform(0, 6, 8)

        def f(u: np.ndarray, v: np.ndarray) -> np.ndarray:
            edge = np.minimum(1, 20 * np.minimum.reduce([u, 1 - u, v, 1 - v]))  # walls meet in straight lines
            height = edge * sum(0.006 * np.sin(k[0] * u + k[1] * v + p) for k, p in zip(*waves, strict=True))
            return o + u[:, None] * s_ + v[:, None] * t_ + height[:, None] * n

        return shapes.surface(f, 200, 200)

    # Each s x t points into the room, x -3..3, y 0..3, z -3..3.
    b.add(wall((-3, 0, 3), (6, 0, 0), (0, 0, -6)), kinds[0])
    b.add(wall((-3, 3, -3), (6, 0, 0), (0, 0, 6)), kinds[0])
    b.add(wall((-3, 0, -3), (6, 0, 0), (0, 3, 0)), kinds[0])
    b.add(wall((3, 0, 3), (-6, 0, 0), (0, 3, 0)), kinds[0])
    b.add(wall((-3, 0, 3), (0, 0, -6), (0, 3, 0)), kinds[1])
    b.add(wall((3, 0, -3), (0, 0, 6), (0, 3, 0)), kinds[2])
    for i in range(30):
        radius = rng.uniform(0.15, 0.4)
        x, z = rng.uniform(-2.4, 2.4), rng.uniform(-2.4, 1.2)
        k = rng.uniform(8, 30, 3) / radius
        bump = lambda p, k=k, r=radius: p * (1 + 0.04 * np.sin(p @ np.diag(k)).sum(1) / r * r)[:, None]  # noqa: E731
        b.add(
            shapes.sphere(radius, 144, 90).bent(bump).moved(x, radius + rng.uniform(0, 1.5), z), kinds[i % 4]
        )
    lamp = shapes.quad((-0.5, 2.9, 0.5), (-0.5, 2.9, -0.5), (0.5, 2.9, -0.5), (0.5, 2.9, 0.5))
    b.add(lamp, b.material("light", 1, 0.95, 0.85, radiance=20))
    return b.world("room", View((0, 1.6, 2.8), (0, -0.1, -1), (0, 1, 0), 65))


def lamps() -> World:
    """10,000 lamps of the size of a coin over a field of blocks."""
    b, rng = _Builder(), np.random.default_rng(2)
    grey = [b.material("diffuse", *([a] * 3)) for a in (0.35, 0.55, 0.75)]
    b.add(shapes.quad((-12, 0, 12), (12, 0, 12), (12, 0, -12), (-12, 0, -12)), grey[1])
    for i in range(150):
        height = rng.uniform(0.2, 1.6)
        block = shapes.box(rng.uniform(0.2, 0.7), height, rng.uniform(0.2, 0.7)).turned(
            "y", rng.uniform(0, 90)
        )
        b.add(block.moved(rng.uniform(-8, 8), height / 2, rng.uniform(-12, 3)), grey[i % 3])
    coin = shapes.disc(0.03, 6)
    for _ in range(10_000):
        colour = 0.3 + 0.7 * rng.random(3)
        lamp = b.material("light", *colour, radiance=float(100 * np.exp(rng.normal())))
        x, y, z = rng.uniform(-8, 8), rng.uniform(0.4, 3), rng.uniform(-12, 3)
        b.add(coin.turned("x", 180 + rng.uniform(-40, 40)).moved(x, y, z), lamp)
    return b.world("lamps", View((0, 3.5, 7), (0, -0.35, -1), (0, 1, 0), 55))


def sun() -> World:
    """A rough golden knot of 200k triangles on grey ground under a sky with a small sun."""
    b = _Builder()
    n, m = 2000, 50

    def knot(u: np.ndarray, v: np.ndarray) -> np.ndarray:
        t, s = 2 * np.pi * u, 2 * np.pi * v

        def curve(t: np.ndarray) -> np.ndarray:
            r = 1 + 0.45 * np.cos(3 * t)
            return np.stack([r * np.cos(2 * t), 0.5 * np.sin(3 * t), r * np.sin(2 * t)], 1)

        along = curve(t + 1e-4) - curve(t - 1e-4)
        along /= np.linalg.norm(along, axis=1, keepdims=True)
        side = np.cross(along, [0, 1, 0])
        side /= np.linalg.norm(side, axis=1, keepdims=True)
        up = np.cross(side, along)
        return curve(t) + 0.22 * (np.cos(s)[:, None] * side - np.sin(s)[:, None] * up)

    b.add(shapes.surface(knot, n, m).smooth().moved(0, 0.75, 0), b.material(
        "metal", 1, 0.86, 0.57, ior=0.2, absorb=3.1, roughness=0.25))  # fmt: skip
    ground = shapes.quad((-8, 0, 8), (8, 0, 8), (8, 0, -8), (-8, 0, -8))
    b.add(ground, b.material("diffuse", 0.4, 0.4, 0.42))
    h, w = 256, 512
    up = np.repeat(np.cos(np.pi * (np.arange(h) + 0.5) / h)[:, None], w, axis=1)
    sky = np.where(up > 0, 0.25 + 0.5 * (1 - up), 0.1)[..., None] * np.array([0.6, 0.75, 1.0])
    sky[70:73, 300:303] += 9000
    return b.world("sun", View((0.4, 2.2, 4.2), (-0.08, -0.38, -1), (0, 1, 0), 45), sky.astype(np.float32))


BUILT: dict[str, Callable[[], World]] = {"room": room, "lamps": lamps, "sun": sun}
NAMES = (*BUNDLED, *BUILT)


def prepared(name: str) -> Path:
    """The file of a scene's world, made where it is not there."""
    path = CACHE / f"{name}.npz"
    if not path.exists():
        (BUILT[name]() if name in BUILT else bundled(name)).write(path)
    return path
