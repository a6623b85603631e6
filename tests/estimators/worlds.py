"""Small scenes with known radiance, and every estimator in every setting worth telling apart."""

from __future__ import annotations

import itertools
from collections import ChainMap
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from etendue import _core
from etendue.models import mesh as meshes

Array = NDArray[np.float32]


def core_mesh(mesh: meshes.Mesh, material: int, scale: float = 1, offset: float = 0) -> _core.Mesh:
    vertices = (mesh.vertices * scale + offset).astype(np.float32)
    normals = None if mesh.normals is None else mesh.normals.astype(np.float32)
    uvs = None if mesh.uvs is None else mesh.uvs.astype(np.float32)
    return _core.Mesh(vertices, mesh.faces.astype(np.uint32), normals, uvs, material)


def scene(*parts: tuple[meshes.Mesh, _core.Material], sky: _core.Sky | None = None) -> _core.Scene:
    """A scene of (mesh, material) pairs."""
    return _core.Scene(
        [core_mesh(mesh, i) for i, (mesh, _) in enumerate(parts)], [m for _, m in parts], [], sky
    )


def ground(size: float = 2, y: float = 0) -> meshes.Mesh:
    """A square in the xz plane, facing up."""
    s = size / 2
    return meshes.quad((-s, y, s), (s, y, s), (s, y, -s), (-s, y, -s))


def diffuse(albedo: float = 0.5, emission: float = 0) -> _core.Material:
    """A Lambertian surface; `emission` is its radiance."""
    return _core.Material("surface", "diffuse", (albedo,) * 3, emissive_strength=emission / albedo)


def lamp(radiance: float = 1) -> _core.Material:
    return _core.Material("lamp", "light", (1, 1, 1), emissive_strength=radiance)


def looking(
    pos: tuple[float, float, float], at: tuple[float, float, float], size: int = 16, fov: float = 1e-3
):
    """A camera so narrow that every pixel sees one point."""
    direction = tuple(np.subtract(at, pos))
    up = (0, 1, 0) if abs(direction[1]) < 0.99 * np.linalg.norm(direction) else (0, 0, 1)
    return _core.Camera(pos, direction, up, fov, 0, 1, True, size, size)


@dataclass(frozen=True)
class Estimator:
    """A registered algorithm with settings: what a test runs."""

    algorithm: str
    parameters: dict[str, object] = field(default_factory=dict)
    longest_path: int | None = None

    def __str__(self) -> str:
        return "-".join([self.algorithm, *(f"{k}={v}" for k, v in self.parameters.items())])

    def has(self, parameter: str) -> bool:
        return any(
            p.name == parameter for a in _core.algorithms() if a.name == self.algorithm for p in a.parameters
        )

    def render(
        self, world: _core.Scene, camera: _core.Camera, spp: int, edges: int = 10, **options
    ) -> _core.Renderer:
        """A finished render, by independent random numbers unless told otherwise."""
        limits = {"max_cam_path_length": edges} if self.has("max_cam_path_length") else {}
        options = {"sampler": "independent", "threads": 1, **options}
        renderer = _core.Renderer(world, camera, self.algorithm, {**limits, **self.parameters}, **options)
        assert renderer.render(spp)
        assert renderer.invalid_count == 0
        return renderer


def estimators(roulette: tuple[float, ...] = (0, 1)) -> Iterator[Estimator]:
    """Every algorithm that pictures light transport, with each of its choices and roulette thresholds, and its
    switches all off or all on.

    With a threshold of 1 roulette acts at every bounce but the first.
    """
    for info in _core.algorithms():
        if info.longest_path == 0:
            continue
        axes: list[list[dict[str, object]]] = [
            [{p.name: choice} for choice in p.choices] for p in info.parameters if p.kind == "choice"
        ]
        switches = [p.name for p in info.parameters if p.kind == "bool"]
        if switches:
            axes.append([dict.fromkeys(switches, False), dict.fromkeys(switches, True)])
        if any(p.name == "rr_threshold" for p in info.parameters):
            axes.append([{"rr_threshold": float(threshold)} for threshold in roulette])
        for settings in itertools.product(*axes):
            yield Estimator(info.name, dict(ChainMap(*settings)), info.longest_path)


def full_transport(roulette: tuple[float, ...] = (0, 1)) -> list[Estimator]:
    """Those whose paths may be of any length."""
    return [e for e in estimators(roulette) if e.longest_path is None]


def check_pieces(make: Callable[..., _core.Renderer]) -> None:
    """That a picture is the same on any number of threads, in pieces, late, and path by path.

    `make` takes the options of a renderer; the picture is of 32 x 32.
    """
    whole, pieces = make(seed=3, threads=2), make(seed=3, threads=1)
    whole.render(20)
    for stride in (16, 4):
        pieces.render_coarse(stride)
    for samples in (1, 7, 20):
        pieces.render(samples)
    np.testing.assert_array_equal(whole.mean(), pieces.mean())
    late = make(seed=3, first_sample=19)
    late.render(1)
    assert list(_core.replay(whole, 5, 20, 19).radiance) == late.mean()[20, 5].tolist()
