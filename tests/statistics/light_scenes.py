"""One scene for each thing that can make a light hard to sample."""

from __future__ import annotations

import itertools
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from etendue import _core

Scene = _core.Scene


def mesh(vertices: object, triangles: object, uvs: object = None, material: int = 0) -> _core.Mesh:
    return _core.Mesh(
        np.asarray(vertices, dtype=np.float32),
        np.asarray(triangles, dtype=np.uint32),
        uvs=None if uvs is None else np.asarray(uvs, dtype=np.float32),
        material=material,
    )


def square(y: float = 2.0, size: float = 1.0, material: int = 0) -> _core.Mesh:
    """A square in the plane y, its front down, its texture once across."""
    corners = [(-size, y, -size), (size, y, -size), (size, y, size), (-size, y, size)]
    return mesh(corners, [(0, 1, 2), (0, 2, 3)], [(0, 0), (1, 0), (1, 1), (0, 1)], material)


def lamp(**values: object) -> _core.Material:
    return _core.Material("lamp", "light", **{"albedo": (1, 1, 1), "emissive_strength": 3.0} | values)


GREY = _core.Material("grey", "diffuse")


def triangle() -> Scene:
    return Scene([mesh([(-0.5, 2, -1), (1.5, 1.5, 0), (0, 2.5, 1)], [(0, 1, 2)])], [lamp()])


def quad() -> Scene:
    return Scene([square()], [lamp(albedo=(1, 0.5, 0.1))])


def small_and_far() -> Scene:
    return Scene([square(50, 0.2)], [lamp()])


def unequal_triangles() -> Scene:
    """A fan whose triangles differ in area by 10,000 times."""
    angles = np.concatenate([[0], np.cumsum(np.geomspace(1e-4, 2, 12))])
    rim = np.stack([np.sin(angles), np.full(len(angles), 2.0), np.cos(angles)], axis=1)
    fan = [(0, i + 1, i + 2) for i in range(len(angles) - 1)]
    return Scene([mesh([(0, 2, 0), *rim], [(a, c, b) for a, b, c in fan])], [lamp()])


def icosahedron() -> Scene:
    """Convex and closed: from outside half of it is turned away."""
    t = (1 + 5**0.5) / 2
    points = [(0, a, b * t) for a in (-1, 1) for b in (-1, 1)]
    points = np.array([np.roll(point, shift) for shift in range(3) for point in points]) / (1 + t * t) ** 0.5
    apart = np.linalg.norm(points[:, None] - points, axis=2)
    edge = apart[apart > 0].min() * 1.01
    faces = []
    for a, b, c in itertools.combinations(range(12), 3):
        if max(apart[a, b], apart[b, c], apart[a, c]) < edge:
            out = np.cross(points[b] - points[a], points[c] - points[a]) @ points[a] > 0
            faces.append((a, b, c) if out else (a, c, b))
    turn = np.linalg.qr(np.random.default_rng(3).normal(size=(3, 3)))[0]
    turn *= np.sign(np.linalg.det(turn))
    return Scene([mesh(0.7 * points @ turn + [0, 2, 0], faces)], [lamp()])


def not_convex() -> Scene:
    """Three slats one behind the other, that hide parts of each other and show each other's backs."""
    parts, faces = [], []
    for i, (y, tilt) in enumerate([(1.5, 0.5), (2.0, -0.8), (2.5, 0.1)]):
        parts += [(-0.6, y - tilt, -0.4), (0.6, y + tilt, -0.4), (0.6, y + tilt, 0.4), (-0.6, y - tilt, 0.4)]
        faces += [(4 * i, 4 * i + 1, 4 * i + 2), (4 * i, 4 * i + 2, 4 * i + 3)]
    return Scene([mesh(parts, faces)], [lamp()])


def textured() -> Scene:
    """Emission by a texture, which the choice of a point knows nothing of."""
    rng = np.random.default_rng(5)
    pixels = rng.random((8, 8, 3), dtype=np.float32) ** 4
    pixels[:, 4:] = 0
    return Scene([square()], [lamp(emission_texture=0)], [_core.Texture(pixels, srgb=False)])


def cut_out() -> Scene:
    """A lamp with holes; behind them is another, that they show."""
    hole = np.ones((8, 8, 1), dtype=np.float32)
    hole[2:6, 1:5] = 0
    return Scene(
        [square(), square(3, 2, 1)], [lamp(cutout_texture=0), lamp()], [_core.Texture(hole, srgb=False)]
    )


def occluded() -> Scene:
    """Something dark hides part of the lamp."""
    return Scene(
        [square(), mesh([(-0.3, 1.5, -2), (0.4, 1.5, -2), (0, 1.2, 2)], [(0, 1, 2)], material=1)],
        [lamp(), GREY],
    )


def two_sided_look() -> Scene:
    """Back to back: the same place seen from above and from below is two lamps."""
    up = mesh([(-1, 2.01, -1), (1, 2.01, -1), (1, 2.01, 1), (-1, 2.01, 1)], [(0, 2, 1), (0, 3, 2)])
    return Scene([square(), up], [lamp()])


def sky(pixels: NDArray[np.float32] | None, intensity: float = 1.5) -> Scene:
    image = None if pixels is None else np.ascontiguousarray(pixels, dtype=np.float32)
    return Scene([square(material=0)], [GREY], sky=_core.Sky(image, intensity))


def uniform_sky() -> Scene:
    return sky(None)


def image_sky() -> Scene:
    return sky(np.random.default_rng(6).random((6, 12, 3)) ** 2)


def sunny_sky() -> Scene:
    """A sun of one pixel of 512, two thousand times as bright."""
    pixels = np.random.default_rng(7).random((16, 32, 3)) * 0.1 + 0.05
    pixels[5, 9] = 300
    return sky(pixels)


def half_black_sky() -> Scene:
    pixels = np.random.default_rng(8).random((8, 16, 3)) + 0.1
    pixels[4:] = 0
    pixels[:, 3:6] = 0
    return sky(pixels)


def polar_sky() -> Scene:
    """Bright at both poles, where rows are small, and across the seam."""
    pixels = np.full((8, 16, 3), 0.05)
    pixels[0], pixels[-1], pixels[:, 0], pixels[:, -1] = 5, 8, 2, 1
    return sky(pixels)


def tiny_sky() -> Scene:
    return sky(np.array([[[1.0, 0.5, 0.2], [0.1, 2.0, 0.3]]]))


SCENES: dict[str, Callable[[], Scene]] = {
    f.__name__: f
    for f in (
        triangle,
        quad,
        small_and_far,
        unequal_triangles,
        icosahedron,
        not_convex,
        textured,
        cut_out,
        occluded,
        two_sided_look,
    )
    + (uniform_sky, image_sky, sunny_sky, half_black_sky, polar_sky, tiny_sky)
}

# In front, aside, near, at a grazing angle, and behind (the lamps that are one-sided are dark from there).
#: values of the parameter
LIGHT_CHOICES = next(p.choices for a in _core.algorithms() for p in a.parameters if p.name == "light_choice")
REFERENCES = np.array(
    [(0.1, 0, 0.2), (3, 0.5, -1), (0.2, 1.9, 0.1), (4, 1.8, 0.3), (0.3, 4, -0.2)], dtype=np.float32
)


def choosing(scene: _core.Scene, light_choice: str) -> dict[str, Any]:
    """Arguments of the scene's functions for a `light_choice`; for "learned" with factors of all sizes."""
    if light_choice != "learned":
        return {"light_choice": light_choice}
    rng = np.random.default_rng(5)
    slots = rng.lognormal(0, 2, (17, 16)).astype(np.float32)
    share = 0.3 if any(light.kind == "SkyLight" for light in scene.lights) else 1.0
    return {"learned": _core.LightFactors(share, slots[0].tolist(), slots[1:].tolist())}


def registered_kinds() -> set[str]:
    """The kinds of light in the sources, found as the build finds them."""
    folder = Path(__file__).parents[2] / "src" / "gi" / "lights"
    names = {re.search(r"class (\w+Light) {", file.read_text()) for file in folder.glob("*.h")}
    assert None not in names
    return {name[1] for name in names if name}


def rows(vector: NDArray[np.float32], n: int) -> NDArray[np.float32]:
    """The same vector n times."""
    return np.repeat(vector[None], n, axis=0)


def seen(
    scene: _core.Scene, light: _core.Light, reference: NDArray[np.float32], sample: dict[str, NDArray]
) -> NDArray[np.bool_]:
    """Which samples are good, and show the point that was drawn."""
    n = len(sample["pdf"])
    good = sample["pdf"] > 0
    found = scene.intersect(
        rows(reference, n), sample["wi"] + np.where(good, 0, 1).astype(np.float32)[:, None]
    )
    if light.material is None:
        return good & np.isinf(found["distance"])
    apart = np.linalg.norm(found["position"].astype(float) - sample["position"], axis=1)
    return good & (apart < 1e-4 * np.linalg.norm(sample["position"] - reference, axis=1))
