"""What the path tracers compute in the lanes of vector registers is, bit by bit, what floats come to."""

from __future__ import annotations

import numpy as np
import pytest
from bsdf_cases import FAST, Case, typed_cases
from light_scenes import LIGHT_CHOICES, REFERENCES, SCENES, choosing, mesh, rows
from numpy.typing import NDArray

from etendue import _core

# Not a multiple of the number of lanes: some are off at the end.
N = 4 * _core.LANES * 13 + 1


def directions(rng: np.random.Generator, n: int, upper: bool = False) -> NDArray[np.float32]:
    d = rng.normal(size=(n, 3))
    if upper:
        d[:, 2] = np.abs(d[:, 2])
    return (d / np.linalg.norm(d, axis=1, keepdims=True)).astype(np.float32)


def assert_same(lanes: NDArray[np.generic], floats: NDArray[np.generic]) -> None:
    np.testing.assert_array_equal(lanes, floats)


@pytest.mark.parametrize("case", list(dict.fromkeys(FAST + typed_cases())), ids=str)
def test_bsdfs(case: Case) -> None:
    bsdf, rng = case.make((0.9, 0.5, 0.1)), case.rng(17)
    wo, wi, u = directions(rng, N, upper=True), directions(rng, N), rng.random((N, 3), dtype=np.float32)
    f, pdf = bsdf.values_in_lanes(wo, wi)
    assert_same(f, bsdf.f(wo, wi))
    assert_same(pdf, bsdf.pdf(wo, wi))
    drawn, one_by_one = bsdf.sample_in_lanes(wo, u), bsdf.sample(wo, u)
    assert drawn.keys() == one_by_one.keys()
    for key in drawn:
        assert_same(drawn[key], one_by_one[key])
    assert_same(bsdf.diffuse_share_in_lanes(wo[:, 2].copy()), bsdf.diffuse_share(wo[:, 2].copy()))


@pytest.mark.parametrize("kind", _core.samplers())
@pytest.mark.parametrize("vertex", [0, 1, 5, 999_999])
def test_random_numbers(kind: str, vertex: int) -> None:
    sampler = _core.Sampler(kind, 3)
    for first in (0, 2**32 - 7):
        # More pairs than a vertex makes at once.
        place = {"pixel": 77, "first": first, "count": N, "vertex": vertex, "pairs": 11}
        assert_same(sampler.points_in_lanes(**place), sampler.points(**place))


@pytest.mark.parametrize("with_mis", [False, True])
@pytest.mark.parametrize("kind", LIGHT_CHOICES)
@pytest.mark.parametrize("name", SCENES)
def test_light_samples(name: str, kind: str, with_mis: bool) -> None:
    scene = SCENES[name]()
    rng = np.random.default_rng(9)
    found = 0
    for reference in REFERENCES:
        asked = (rows(reference, N), rng.random((N, 2), dtype=np.float32))
        lanes = scene.sample_light_in_lanes(*asked, **choosing(scene, kind), with_mis=with_mis)
        floats = scene.sample_light(*asked, **choosing(scene, kind), with_mis=with_mis)
        for key in floats:
            assert_same(lanes[key], floats[key])
        found += int((floats["index"] >= 0).sum())
    assert found > 0


def bumpy() -> _core.Scene:
    """A wavy sheet with smooth normals, the same flat, and one with a normal map; around them nothing."""
    x, y = np.meshgrid(np.linspace(-1, 1, 12), np.linspace(-1, 1, 12))
    points = np.stack([x, y, 0.2 * np.sin(4 * x + y)], axis=-1).reshape(-1, 3).astype(np.float32)
    normals = np.stack([-0.8 * np.cos(4 * x + y), -0.2 * np.cos(4 * x + y), np.ones_like(x)], axis=-1)
    normals = normals.reshape(-1, 3) / np.linalg.norm(normals.reshape(-1, 3), axis=1, keepdims=True)
    uvs = ((points[:, :2] + 1) / 2).astype(np.float32)
    corner = (np.arange(11)[:, None] * 12 + np.arange(11)).reshape(-1, 1)
    triangles = np.concatenate([corner + (0, 1, 13), corner + (0, 13, 12)]).astype(np.uint32)
    bumps = np.random.default_rng(4).integers(60, 200, (16, 16, 3)).astype(np.uint8)
    bumps[..., 2] = 255
    meshes = [
        _core.Mesh(points, triangles, normals=normals.astype(np.float32)),
        mesh(points + np.float32([2.5, 0, 0]), triangles),
        _core.Mesh(points - np.float32([2.5, 0, 0]), triangles, normals.astype(np.float32), uvs, 1),
    ]
    materials = [
        _core.Material("smooth", "diffuse"),
        _core.Material("mapped", "diffuse", albedo_texture=0, normal_texture=0),
    ]
    return _core.Scene(meshes, materials, [_core.Texture(bumps, srgb=False)])


def test_surfaces() -> None:
    scene = bumpy()
    rng = np.random.default_rng(21)
    origin = (rng.normal(size=(N, 3)) * [3, 1, 1]).astype(np.float32)
    aim = (rng.uniform(-1, 1, (N, 3)) * [3.5, 1, 0.2] - origin).astype(np.float32)
    direction = aim / np.linalg.norm(aim, axis=1, keepdims=True)
    lanes, floats = scene.intersect_in_lanes(origin, direction), scene.intersect(origin, direction)
    assert 0.5 < np.isfinite(floats["distance"]).mean() < 1
    for key in lanes:
        assert_same(lanes[key], floats[key])
