"""What the tests of pictures never do to the core, for the build with sanitizers: empty, tiny, huge and wrong input.

Run by test_sanitizers.py alone.
"""

from __future__ import annotations

import os

import numpy as np
import pytest

from etendue import _core

SQUARE = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], np.float32)
FACES = np.array([[0, 1, 2], [0, 2, 3]], np.uint32)


def test_this_is_the_instrumented_core() -> None:
    assert os.path.samefile(_core.__file__, os.environ["ETENDUE_CORE"])


def picture(
    scene: _core.Scene, perspective: bool = True, size: tuple[int, int] = (5, 3), scale: float = 1
) -> np.ndarray:
    pos = (0.4 * scale, 0.3 * scale, min(2 * scale, 1e9))
    camera = _core.Camera(pos, (0, 0, -1), (0, 1, 0), 60, 0.05, 2, perspective, *size)
    _core.auto_focus(scene, camera)
    for info in _core.algorithms():
        renderer = _core.Renderer(scene, camera, info.name, threads=2)
        assert renderer.render(3)
    return renderer.mean()


@pytest.mark.parametrize("kind", [kind.name for kind in _core.material_types()])
@pytest.mark.parametrize("roughness", [0.0, 1e-4, 1.0])
@pytest.mark.parametrize("ior", [1e-3, 1.0, 1e6])
def test_materials(kind: str, roughness: float, ior: float) -> None:
    paint = _core.Material(
        "m", kind, (1, 0, 0.5), ior=ior, roughness=roughness, absorb=3, emissive_strength=1
    )
    picture(_core.Scene([_core.Mesh(SQUARE, FACES)], [paint], [], _core.Sky()))


@pytest.mark.parametrize("size", [(1, 1), (1, 7), (17, 1), (33, 16)])
@pytest.mark.parametrize("perspective", [True, False])
def test_sizes(size: tuple[int, int], perspective: bool) -> None:
    for pixels in (None, np.ones((1, 1, 3), np.float32), np.zeros((2, 3, 3), np.float32)):
        picture(_core.Scene([], [], [], _core.Sky(pixels)), perspective, size)


@pytest.mark.parametrize("channels", [1, 3, 4])
@pytest.mark.parametrize("kind", [np.uint8, np.float32])
@pytest.mark.parametrize("uv", [0, 1, -1, 1e9, np.inf, np.nan])
def test_textures(channels: int, kind: type, uv: float) -> None:
    texture = _core.Texture(np.ones((2, 1, channels), kind), kind == np.uint8)
    uvs = np.full((4, 2), uv, np.float32)
    slots = dict.fromkeys(("albedo_texture", "emission_texture", "normal_texture", "cutout_texture"), 0)
    paint = _core.Material("m", "layered_ggx", emissive_strength=1, **slots)
    picture(_core.Scene([_core.Mesh(SQUARE, FACES, None, uvs)], [paint], [texture]))


@pytest.mark.parametrize("scale", [0, 1e-30, 1e-15, 1e-10, 1e-5, 1e5, 1e9])
def test_meshes(scale: float) -> None:
    lamp = _core.Material("m", "diffuse", emissive_strength=2)
    flat = np.zeros_like(SQUARE)
    for normals in (None, flat, SQUARE):
        mesh = _core.Mesh((SQUARE * np.float32(scale)).astype(np.float32), FACES, normals)
        picture(_core.Scene([mesh], [lamp], [], _core.Sky()), scale=scale)


def test_refusals() -> None:
    for value in (np.nan, np.inf, 2e9):
        for axis in range(3):
            wrong = SQUARE.copy()
            wrong[1, axis] = value
            with pytest.raises(ValueError, match="vertex 1 is not finite, or too far away"):
                _core.Mesh(wrong, FACES)
    with pytest.raises(ValueError, match=r"."):
        _core.Mesh(SQUARE, FACES + np.uint32(2))
    with pytest.raises(ValueError, match=r"."):
        _core.Scene([_core.Mesh(SQUARE, FACES, material=3)], [])
    with pytest.raises(ValueError, match=r"."):
        _core.Scene([], [_core.Material("m", "diffuse", albedo_texture=0)])
    _core.Mesh(SQUARE[:0], FACES[:0])
