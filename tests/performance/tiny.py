"""Renders a tiny scene and ends; what the instruction counter runs.

python -m tests.performance.tiny SCENE SPP
"""

from __future__ import annotations

import os
import sys

import numpy as np
from benchmarks.renderers import core_at

_core = core_at(os.environ.get("ETENDUE_BENCHMARK_CORE"))

SIZE = 32


def quad(a: list[float], b: list[float], c: list[float], d: list[float], material: int) -> _core.Mesh:
    vertices = np.array([a, b, c, d], np.float32)
    return _core.Mesh(vertices, np.array([[0, 1, 2], [0, 2, 3]], np.uint32), None, None, material)


def box() -> tuple[_core.Scene, tuple[float, float, float]]:
    """Five Lambertian walls, a rough metal one, and a lamp."""
    materials = [
        _core.Material("wall", "diffuse", (0.7, 0.6, 0.5)),
        _core.Material("metal", "metal", (0.9, 0.8, 0.6), 0.2, 0.2, 3.0),
        _core.Material("lamp", "light", (1.0, 1.0, 1.0), emissive_strength=20.0),
    ]
    meshes = [
        quad([-1, -1, 1], [1, -1, 1], [1, -1, -1], [-1, -1, -1], 0),
        quad([-1, 1, -1], [1, 1, -1], [1, 1, 1], [-1, 1, 1], 0),
        quad([-1, -1, -1], [1, -1, -1], [1, 1, -1], [-1, 1, -1], 1),
        quad([-1, -1, 1], [-1, -1, -1], [-1, 1, -1], [-1, 1, 1], 0),
        quad([1, -1, -1], [1, -1, 1], [1, 1, 1], [1, 1, -1], 0),
        quad([-0.3, 0.99, -0.3], [0.3, 0.99, -0.3], [0.3, 0.99, 0.3], [-0.3, 0.99, 0.3], 2),
    ]
    return _core.Scene(meshes, materials, [], None), (0.0, 0.0, 3.0)


def sky() -> tuple[_core.Scene, tuple[float, float, float]]:
    """A smooth textured hill under a sky."""
    n = 12
    x, z = np.meshgrid(np.linspace(-1, 1, n), np.linspace(-1, 1, n))
    y = 0.4 * np.exp(-3 * (x * x + z * z))
    vertices = np.stack([x, y, z], -1).reshape(-1, 3).astype(np.float32)
    normals = np.stack([6 * x * y, np.ones_like(y), 6 * z * y], -1).reshape(-1, 3)
    normals = (normals / np.linalg.norm(normals, axis=1, keepdims=True)).astype(np.float32)
    uvs = np.stack([x, z], -1).reshape(-1, 2).astype(np.float32)
    i = (np.arange(n - 1)[:, None] * n + np.arange(n - 1)).ravel()
    triangles = np.concatenate([np.stack([i, i + n, i + 1], 1), np.stack([i + 1, i + n, i + n + 1], 1)])
    random = np.random.default_rng(1)
    texture = _core.Texture(random.integers(0, 255, (8, 8, 3), dtype=np.uint8), True)
    material = _core.Material("hill", "layered_ggx", (1.0, 1.0, 1.0), 1.3, 0.3, albedo_texture=0)
    mesh = _core.Mesh(vertices, triangles.astype(np.uint32), normals, uvs, 0)
    pixels = random.random((16, 32, 3), dtype=np.float32)
    return _core.Scene([mesh], [material], [texture], _core.Sky(pixels)), (0.0, 1.0, 2.0)


def main(name: str, spp: int) -> None:
    scene, eye = {"box": box, "sky": sky}[name]()
    towards = tuple(-c for c in eye)
    camera = _core.Camera(eye, towards, (0.0, 1.0, 0.0), 50.0, 0.0, 1.0, True, SIZE, SIZE)
    renderer = _core.Renderer(scene, camera, "Pathtracer", {}, threads=1)
    renderer.render(spp)


if __name__ == "__main__":
    main(sys.argv[1], int(sys.argv[2]))
