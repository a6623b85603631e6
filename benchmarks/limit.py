"""How close a render comes to the bare tracing of its own rays.

fraction of limit = seconds to trace the render's rays again and nothing else / seconds of the render
"""

from __future__ import annotations

import statistics
import time
from dataclasses import asdict, dataclass

from .renderers import etendue
from .world import World


@dataclass(frozen=True)
class Limit:
    """Medians; `spread` is half the distance between the smallest and the largest fraction of the repeats."""

    scene: str
    threads: int
    rays_per_sample: float
    bare_mrays: float
    render_mrays: float
    fraction: float
    spread: float

    def row(self) -> dict[str, object]:
        """For JSON."""
        return asdict(self)


def measure(world: World, size: int, spp: int, repeats: int, threads: int) -> Limit:
    """Renders and replays in alternation. Seconds are those of the processor, over all threads."""
    renderer = etendue.Renderer(world, size, size, threads, {})
    record = renderer.record(spp)
    record.replay(threads)
    bare, full = [], []
    for _ in range(repeats):
        # What is learned before the first sample is no part of the rays.
        prepared = renderer.prepared()
        start = time.process_time()
        record.replay(threads)
        middle = time.process_time()
        prepared.render(spp)
        full.append(time.process_time() - middle)
        bare.append(middle - start)
    fractions = [b / f for b, f in zip(bare, full, strict=True)]
    million = record.rays / 1e6 * threads
    return Limit(
        world.name,
        threads,
        record.rays / (size * size * spp),
        million / statistics.median(bare),
        million / statistics.median(full),
        statistics.median(fractions),
        (max(fractions) - min(fractions)) / 2,
    )
