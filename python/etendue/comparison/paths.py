"""How long an estimator's paths are, from a sample of them replayed."""

from __future__ import annotations

import numpy as np

from .. import _core
from ..scene import Scene
from .statistics import CONFIDENCE, Estimate, student

_PATHS = 4096


def mean_length(scene: Scene) -> Estimate:
    """Edges (rays, those to lights left aside) of a path on average, over 4,096 random pixels and samples."""
    renderer = scene.renderer(threads=1)
    width, height = scene.config.framebuffer.res_w, scene.config.framebuffer.res_h
    random = np.random.default_rng(0)
    places = zip(random.integers(0, width, _PATHS), random.integers(0, height, _PATHS), strict=True)
    edges = [
        len(
            _core.replay(renderer, int(x), int(y), int(random.integers(0, 2**20)), with_lights=False).vertices
        )
        for x, y in places
    ]
    half = student(CONFIDENCE, _PATHS - 1) * float(np.std(edges, ddof=1)) / _PATHS**0.5
    mean = float(np.mean(edges))
    return Estimate(mean, mean - half, mean + half)
