"""What the core makes of the arrays of a mesh, over many more triangles than a thread packs at a time."""

from __future__ import annotations

import numpy as np
import pytest

from etendue import _core

_PAINT = [_core.Material("grey", "diffuse")]


def _field(count: int, size: float) -> tuple[np.ndarray, np.ndarray]:
    """Vertices (3 count, 3) and triangles of `count` tilted triangles of this size, beside each other."""
    rng = np.random.default_rng(7)
    corners = rng.random((count, 3, 3)) * [0.1, 0.1, 0.1] + [[0, 0, 0], [0.8, 0, 0], [0, 0.8, 0]]
    corners[:, :, 0] += np.arange(count)[:, None] % 150
    corners[:, :, 1] += np.arange(count)[:, None] // 150
    return (corners.reshape(-1, 3) * size).astype(np.float32), np.arange(3 * count, dtype=np.uint32).reshape(
        -1, 3
    )


@pytest.mark.parametrize("size", [1, 1e-6, 1e-12])
@pytest.mark.parametrize("is_smooth", [False, True])
def test_every_triangle_is_as_its_arrays_say(is_smooth: bool, size: float) -> None:
    # Of small triangles fewer, as single precision does not tell many apart that far from the origin.
    vertices, triangles = _field(20_000 if size == 1 else 3, size)
    rng = np.random.default_rng(3)
    uvs = rng.random((len(vertices), 2), np.float32)
    a, b, c = vertices[triangles].astype(np.float64).transpose(1, 0, 2)
    flat = np.cross(b - a, c - a)
    flat /= np.linalg.norm(flat, axis=1, keepdims=True)
    normals = None
    if is_smooth:
        tilted = np.repeat(flat, 3, axis=0) + 0.2 * rng.standard_normal(vertices.shape)
        normals = (tilted / np.linalg.norm(tilted, axis=1, keepdims=True)).astype(np.float32)
    scene = _core.Scene([_core.Mesh(vertices, triangles, normals, uvs)], _PAINT)
    middle = (a + b + c) / 3
    origin = (middle + [0, 0, 10 * size]).astype(np.float32)
    hit = scene.intersect(origin, np.broadcast_to(np.float32([0, 0, -1]), origin.shape).copy())
    assert (hit["material"] == 0).all()
    assert np.abs(hit["normal"] - flat).max() <= 1e-3
    if size < 1e-9:
        # Where the square of an area underflows, Embree finds the triangle, but not the place on it.
        return
    assert np.abs(hit["position"] - middle).max() <= 1e-3 * size
    assert np.abs(hit["uv"] - uvs[triangles].mean(axis=1)).max() <= 0.02
    shading = flat
    if normals is not None:
        shading = normals[triangles].astype(np.float64).mean(axis=1)
        shading /= np.linalg.norm(shading, axis=1, keepdims=True)
    assert np.abs(hit["shading_normal"] - shading).max() <= 0.02
    assert scene.bounds is not None
    assert np.array_equal(scene.bounds, [vertices.min(axis=0), vertices.max(axis=0)])


def test_arrays_are_checked_when_they_are_copied() -> None:
    vertices, triangles = _field(1, 1)
    mesh = _core.Mesh(vertices, triangles)
    triangles[0, 0] = 3
    with pytest.raises(ValueError, match="triangle 0 names a vertex that is not there"):
        _core.Scene([mesh], _PAINT)
    triangles[0, 0] = 0
    vertices[2, 1] = np.nan
    with pytest.raises(ValueError, match="vertex 2 is not finite, or too far away"):
        _core.Scene([mesh], _PAINT)
    vertices[2, 1] = 1
    assert _core.Scene([mesh], _PAINT).triangle_count == 1


def test_a_scene_keeps_its_own_arrays() -> None:
    vertices, triangles = _field(1, 1)
    scene = _core.Scene([_core.Mesh(vertices, triangles)], _PAINT)
    before = scene.bounds
    vertices += 5
    assert scene.bounds == before
    hit = scene.intersect(np.float32([[0.3, 0.3, 5]]), np.float32([[0, 0, -1]]))
    assert hit["material"][0] == 0


def test_building_alone_takes_time() -> None:
    mesh = _core.Mesh(*_field(20_000, 1))
    seconds, processor = _core.Scene.build_alone([mesh, mesh])
    assert 0 < seconds < 60
    assert 0 < processor < 60
