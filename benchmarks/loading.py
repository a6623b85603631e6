"""How long a scene takes until it can be rendered, beside Embree's structure over its triangles and nothing else."""

from __future__ import annotations

import gc
import os
import statistics
import time
from collections.abc import Callable
from dataclasses import asdict, dataclass

import etendue
from etendue import _core
from etendue.loaders import cache

from .renderers.etendue import Renderer
from .scenes import BUNDLED, ROOT, prepared
from .world import World


@dataclass(frozen=True)
class Loading:
    """Medians, in seconds of the processor over all threads; `times` are multiples of Embree's of the same turn.

    Both have a key for each way: "arrays", and for the bundled scenes "file" and "file, cached".
    """

    scene: str
    triangles: int
    embree: float
    seconds: dict[str, float]
    times: dict[str, float]

    def row(self) -> dict[str, object]:
        """For JSON."""
        return asdict(self)


def measure(scene: str, repeats: int) -> Loading:
    """Builds and loads in turns."""
    world = World.read(prepared(scene))
    meshes = [_core.Mesh(m.vertices, m.triangles, m.normals, m.uvs, m.material) for m in world.meshes]
    ways: dict[str, Callable[[], object]] = {"arrays": lambda: Renderer(world, 8, 8, 0, {})}
    if scene in BUNDLED:
        ways["file"] = lambda: _loaded(scene, "0")
        ways["file, cached"] = lambda: _loaded(scene, "")
        # Files that were just written are not kept yet.
        time.sleep(3)
    for way in ways.values():
        way()
    embree: list[float] = []
    seconds: dict[str, list[float]] = {name: [] for name in ways}
    for _ in range(repeats):
        embree.append(_core.Scene.build_alone(meshes)[1])
        for name, way in ways.items():
            seconds[name].append(_timed(way))
    return Loading(
        scene,
        world.triangles,
        statistics.median(embree),
        {name: statistics.median(found) for name, found in seconds.items()},
        {
            name: statistics.median(s / e for s, e in zip(found, embree, strict=True))
            for name, found in seconds.items()
        },
    )


def _loaded(scene: str, megabytes: str) -> object:
    os.environ[cache.VARIABLE] = megabytes
    return etendue.load(ROOT / f"configs/a04_{scene}.json")


def _timed(way: Callable[[], object]) -> float:
    gc.collect()
    start = time.process_time()
    made = way()
    seconds = time.process_time() - start
    # Not before: giving memory back is no part of the wait.
    del made
    return seconds
