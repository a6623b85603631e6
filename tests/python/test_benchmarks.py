"""The benchmarks' own arithmetic, and that the recorded rays are those of the render."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT))

from benchmarks.compare import EPSILON, rel_mse  # noqa: E402
from benchmarks.renderers import etendue  # noqa: E402
from benchmarks.world import Material, Mesh, View, World, linear  # noqa: E402

from etendue.display import srgb_to_linear  # noqa: E402


def world() -> World:
    """A floor under a lamp and a sky."""
    floor = np.array([[-2, 0, 2], [2, 0, 2], [2, 0, -2], [-2, 0, -2]], np.float32)
    lamp = np.array([[-1, 2, -1], [1, 2, -1], [1, 2, 1], [-1, 2, 1]], np.float32)
    triangles = np.array([[0, 1, 2], [0, 2, 3]], np.uint32)
    uvs = np.array([[0, 0], [1, 0], [1, 1], [0, 1]], np.float32)
    materials = [
        Material("diffuse", (0.5, 0.5, 0.5), albedo_texture=0),
        Material("light", (1, 1, 1), radiance=5),
    ]
    texture = np.full((2, 2, 3), 128, np.uint8)
    return World(
        "tiny",
        [Mesh(floor, triangles, None, uvs, 0), Mesh(lamp, triangles, None, None, 1)],
        materials,
        View((0, 1, 4), (0, -0.2, -1), (0, 1, 0), 60),
        5,
        [texture],
        np.full((4, 8, 3), 0.2, np.float32),
    )


def test_error_is_the_variance_over_the_squared_reference() -> None:
    reference = np.full((10, 10, 3), 2.0, np.float32)
    images = np.stack([reference - 0.3, reference + 0.3])
    assert rel_mse(images, reference) == pytest.approx(2 * 0.3**2 / (4 + EPSILON), rel=1e-5)
    images[0, 0, 0] = 100
    assert rel_mse(images, reference) > 1
    assert rel_mse(images, reference, trim=0.01) == pytest.approx(2 * 0.3**2 / (4 + EPSILON), rel=1e-5)


def test_a_world_survives_its_file(tmp_path: Path) -> None:
    path = tmp_path / "world.npz"
    world().write(path)
    read, written = World.read(path), world()
    assert (read.materials, read.view, read.edges) == (written.materials, written.view, written.edges)
    image = etendue.Renderer(read, 16, 16, 1, {}).render(2, 3)
    assert np.array_equal(image, etendue.Renderer(written, 16, 16, 1, {}).render(2, 3))


def test_textures_are_decoded_as_etendue_decodes_them() -> None:
    encoded = np.arange(256, dtype=np.uint8).repeat(3).reshape(16, 16, 3)
    np.testing.assert_allclose(linear(encoded), srgb_to_linear(encoded / 255), rtol=1e-5)
    radiance = np.full((2, 2, 3), 7.5, np.float32)
    np.testing.assert_array_equal(linear(radiance), radiance)


def test_a_world_without_its_coats() -> None:
    coated = world()
    coated.materials.append(Material("layered_ggx", (0.1, 0.2, 0.3), ior=1.4, albedo_texture=0))
    bare = coated.uncoated()
    assert bare.materials[-1] == Material("diffuse", (0.1, 0.2, 0.3), ior=1.4, albedo_texture=0)
    assert bare.materials[:-1] == coated.materials[:-1]
    assert not coated.is_common
    assert bare.is_common == world().is_common


def test_the_rays_recorded_are_those_of_the_render() -> None:
    renderer = etendue.Renderer(world(), 24, 16, 2, {})
    record = renderer.record(3)
    renderer.render(3, 0)
    assert record.rays == renderer.rays
    hits = record.replay(1)
    assert 0 < hits < record.rays
    assert record.replay(2) == hits


def test_what_is_missing_is_said() -> None:
    wrong = [sys.executable, "-m", "benchmarks", "limit", "--scenes", "nowhere"]
    done = subprocess.run(wrong, cwd=ROOT, capture_output=True, text=True)
    assert done.returncode == 2
    assert "nowhere" in done.stderr


def test_loading_is_held_against_embree(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    from benchmarks import loading

    monkeypatch.setenv("ETENDUE_FILE_CACHE", "")
    monkeypatch.setattr(loading, "prepared", lambda _: tmp_path / "world.npz")
    world().write(tmp_path / "world.npz")
    found = loading.measure("box", 2)
    assert found.triangles == 4
    assert set(found.seconds) == set(found.times) == {"arrays", "file", "file, cached"}
    assert found.embree > 0
    assert found.times["file"] > 0
