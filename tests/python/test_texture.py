"""Lookups in textures of all formats, of sizes that fill no whole tiles, against bilinear interpolation in numpy."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from etendue import _core
from etendue.display import srgb_to_linear

SIZES = [(1, 1), (1, 5), (7, 1), (2, 3), (4, 4), (5, 9), (8, 8), (13, 17), (64, 20)]
FORMATS = [("uint8", True), ("uint8", False), ("float32", False)]
CORNERS = np.float32([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)])
UVS = CORNERS[:, :2] * 3.5 - 1.25  # over several repetitions of the image


def looked_at(
    pixels: NDArray[Any], srgb: bool, slot: str, towards: tuple[float, float, float] = (0, 0, -1)
) -> tuple[_core.Scene, NDArray[Any], NDArray[Any], NDArray[Any]]:
    """A shining square with this texture, and 500 rays that look at it: origins, directions, uvs."""
    material = _core.Material("m", "diffuse", emissive_strength=1.0, **{slot: 0})
    square = _core.Mesh(CORNERS, np.uint32([(0, 1, 2), (0, 2, 3)]), None, UVS)
    scene = _core.Scene([square], [material], [_core.Texture(pixels, srgb)])
    places = np.random.default_rng(1).random((500, 2), dtype=np.float32)
    directions = np.tile(np.float32(towards) / np.float32(np.linalg.norm(towards)), (500, 1))
    origins = np.column_stack([places, np.zeros(500, np.float32)]) - directions
    return scene, origins, directions, UVS[0] + places * (UVS[2] - UVS[0])


def image(size: tuple[int, int], channels: int, kind: str) -> NDArray[Any]:
    random = np.random.default_rng(size).random((*size, channels))
    return (random * 255).astype(np.uint8) if kind == "uint8" else random.astype(np.float32)


def bilinear(pixels: NDArray[Any], uv: NDArray[Any]) -> NDArray[Any]:
    """At uv, v = 0 at the bottom; the image repeats."""
    height, width = pixels.shape[:2]
    x, y = uv[:, 0] * float(width) - 0.5, (1 - uv[:, 1].astype(float)) * height - 0.5
    left, top = np.floor(x).astype(int), np.floor(y).astype(int)
    found = np.zeros((len(uv), pixels.shape[2]))
    for i, j in ((0, 0), (1, 0), (0, 1), (1, 1)):
        share = (x - left if i else 1 - x + left) * (y - top if j else 1 - y + top)
        found += share[:, None] * pixels[(top + j) % height, (left + i) % width]
    return found


def undecoded(pixels: NDArray[Any]) -> NDArray[Any]:
    return pixels / 255 if pixels.dtype == np.uint8 else pixels.astype(float)


@pytest.mark.parametrize("size", SIZES)
@pytest.mark.parametrize("channels", [1, 3, 4])
@pytest.mark.parametrize(("kind", "srgb"), FORMATS)
def test_colours(size: tuple[int, int], channels: int, kind: str, srgb: bool) -> None:
    pixels = image(size, channels, kind)
    scene, origins, directions, uv = looked_at(pixels, srgb, "emission_texture")
    linear = srgb_to_linear(undecoded(pixels)) if srgb else undecoded(pixels)
    colours = np.broadcast_to(bilinear(linear[..., :3], uv), (len(uv), 3))
    np.testing.assert_allclose(scene.lights[0].Le(origins, directions), colours, atol=1e-4)
    mean = np.broadcast_to(linear[..., :3].mean((0, 1)), 3) @ [0.2126, 0.7152, 0.0722]
    assert scene.lights[0].power == pytest.approx(np.pi * mean, rel=1e-4)


@pytest.mark.parametrize("size", SIZES)
@pytest.mark.parametrize("channels", [1, 3, 4])
@pytest.mark.parametrize("kind", ["uint8", "float32"])
def test_opacity(size: tuple[int, int], channels: int, kind: str) -> None:
    pixels = image(size, channels, kind)
    pixels = pixels // 5 if kind == "uint8" else pixels / 5
    scene, origins, directions, uv = looked_at(pixels, True, "cutout_texture")
    opacity = bilinear(undecoded(pixels), uv)[:, 0 if channels < 4 else 3]
    decided = np.abs(opacity - 0.1) > 1e-4
    is_hit = np.isfinite(scene.intersect(origins, directions)["distance"])
    np.testing.assert_array_equal(is_hit[decided], opacity[decided] >= 0.1)


@pytest.mark.parametrize("size", SIZES)
@pytest.mark.parametrize("channels", [1, 3, 4])
@pytest.mark.parametrize("kind", ["uint8", "float32"])
def test_normals(size: tuple[int, int], channels: int, kind: str) -> None:
    """Of values in [7/8, 1], seen from where (1, 1, 1) points, so that none is bent."""
    pixels = image(size, channels, kind)
    pixels = pixels // 8 + 223 if kind == "uint8" else pixels / 8 + np.float32(0.875)
    scene, origins, directions, uv = looked_at(pixels, True, "normal_texture", (-1, -1, -1))
    normals = 2 * np.broadcast_to(bilinear(undecoded(pixels)[..., :3], uv), (len(uv), 3)) - 1
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    np.testing.assert_allclose(scene.intersect(origins, directions)["shading_normal"], normals, atol=1e-4)
