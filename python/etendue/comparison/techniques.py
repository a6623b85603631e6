"""An estimator's picture split by how its light was found and over how many rays: what MIS and roulette act on."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .. import _core
from ..config.overrides import Override
from ..display import tonemap
from ..scene import Scene
from .metrics import LUMINANCE

NAMES = ("BSDF sampling", "light sampling")
# The pictures are small: two of each technique and path length are kept in full.
_WIDTH, _SPP, _MOST_EDGES = 128, 64, 10
# Longer paths than this share a row.
ROWS = 6


@dataclass(frozen=True)
class Row:
    """Paths of `edges` rays. Arrays are indexed [weighted, technique]: [0] with MIS weights, [1] without.

    pictures: uint8 (2, 2, height, width, 3), brighter by `gain` than the image is shown. mean, variance: float64
    (2, 2), of one sample's luminance, mean over the image.
    """

    edges: str
    gain: float
    pictures: NDArray[np.uint8]
    mean: NDArray[np.float64]
    variance: NDArray[np.float64]


def measured(scene: Scene, progress: Callable[[float], object]) -> list[Row]:
    """The rows of the pyramid, the shortest paths first. Ctrl-C raises KeyboardInterrupt."""
    small = _small(scene)
    edges = min(_MOST_EDGES, small.config.max_cam_path_length)
    film = _core.TechniqueFilm(small.renderer(), edges)
    film.render(_SPP, progress)
    mean, variance = film.mean().astype(np.float64), film.variance().astype(np.float64)
    rows = [
        _row(str(n + 1), mean[:, :, n], variance[:, :, n], scene.config.framebuffer.exposure)
        for n in range(min(edges, ROWS))
    ]
    if edges > ROWS:
        longer = mean[:, :, ROWS:].sum(axis=2), variance[:, :, ROWS:].sum(axis=2)
        more = "" if edges == small.config.max_cam_path_length else " and more"
        rows.append(_row(f"{ROWS + 1} to {edges}{more}", *longer, scene.config.framebuffer.exposure))
    return rows


def _small(scene: Scene) -> Scene:
    framebuffer = scene.config.framebuffer
    width, height = framebuffer.res_w, framebuffer.res_h
    scale = min(1.0, _WIDTH / max(width, height))
    size = {"framebuffer.res_w": round(width * scale), "framebuffer.res_h": round(height * scale)}
    return scene.changed(
        scene.config.with_overrides([Override(key, max(1, n), "compare") for key, n in size.items()])
    )


def _row(edges: str, mean: NDArray[np.float64], variance: NDArray[np.float64], exposure: float) -> Row:
    """Of mean and variance (2, 2, height, width, 3)."""
    whole = mean[0].sum(axis=0) @ LUMINANCE * exposure
    bright = float(np.percentile(whole, 95))
    # Deep light is dim: it is shown brighter by a power of two that is told.
    gain = 1.0 if bright <= 0 else float(np.clip(2.0 ** np.round(np.log2(0.5 / bright)), 1, 2**12))
    pictures = tonemap(mean, exposure * gain)
    # Luminance's variance, the channels' noise going together.
    spread = np.square(np.sqrt(np.maximum(variance, 0)) @ LUMINANCE)
    return Row(edges, gain, pictures, (mean @ LUMINANCE).mean(axis=(2, 3)), spread.mean(axis=(2, 3)))
