"""Two builds of the compiled core over the same scenes, in alternation."""

from __future__ import annotations

import statistics
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from .contestants import Contestant
from .scenes import prepared


def ablate(
    scene: str, cores: Sequence[Path], size: int, spp: int, repeats: int, threads: int
) -> dict[str, object]:
    """Seconds of the processor of the first core over those of each other, and whether the pictures are the same."""
    running = [
        Contestant(
            "etendue",
            prepared(scene),
            size,
            threads,
            environment={"ETENDUE_BENCHMARK_CORE": str(core.resolve())},
        )
        for core in cores
    ]
    seconds: list[list[float]] = [[] for _ in cores]
    images = []
    for repeat in range(repeats):
        for i, contestant in enumerate(running):
            _, cpu, image = contestant.render(spp, 1)
            seconds[i].append(cpu)
            if repeat == 0:
                images.append(image)
    for contestant in running:
        contestant.close()
    ratios = [[a / b for a, b in zip(seconds[0], other, strict=True)] for other in seconds[1:]]
    return {
        "scene": scene,
        "speed_over_first": [statistics.median(r) for r in ratios],
        "least": [min(r) for r in ratios],
        "most": [max(r) for r in ratios],
        "same_picture": [bool(np.array_equal(images[0], image)) for image in images[1:]],
    }
