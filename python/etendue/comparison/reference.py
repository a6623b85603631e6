"""The image that errors are measured against: made here and cached, or given."""

from __future__ import annotations

import contextlib
import dataclasses
import hashlib
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from .. import models
from ..config.overrides import Override
from ..errors import EtendueError
from ..film import Film, sample_ranges
from ..film import file as film_file
from ..film.origin import Origin
from ..scene import Scene
from . import metrics
from .estimators import Estimator
from .goal import Goal

# Samples and pixels that are independent let the reference's own error be known exactly; power-weighted MIS is the
# estimator without a blind spot. Its seed is far from those of the repeats.
ESTIMATOR = Estimator(
    "reference", {"algorithm": "Pathtracer", "mis": "power", "sampler": "independent", "path_reuse": False}
)
_SEED_DISTANCE = 2**31
_CHECKPOINT_SECONDS = 60.0


@dataclass(frozen=True)
class Reference:
    """image: float32 (height, width, 3). variance: float64, of each value of `image`; None where unknown.

    sharing: how many pixels shared their paths, see `Film`.
    halves: two images of half of the samples each. name: where it comes from, for people. identity: the same for
    the same pixels alone.
    """

    image: NDArray[np.float32]
    variance: NDArray[np.float64] | None
    halves: tuple[NDArray[np.float32], NDArray[np.float32]] | None
    name: str
    identity: str
    spp: float | None = None
    seconds: float | None = None
    film: Path | None = None
    sharing: int = 1

    @property
    def own_errors(self) -> dict[str, float]:
        """MSE and relMSE of the reference itself, from its halves A and B: E (A - B)² / 4 is its variance."""
        if self.halves is None:
            return {}
        error = np.square(self.halves[0].astype(np.float64) - self.halves[1]) / 4
        weight = np.square(self.image, dtype=np.float64) + metrics.EPSILON
        return {"MSE": float(error.mean()), "relMSE": float((error / weight).mean())}

    @property
    def luminance_variance(self) -> NDArray[np.float64]:
        """float64 (height, width): the most that pixels add to the variance of a sum of luminances, the errors of
        channels and of pixels that shared paths going together.
        """
        if self.variance is None:
            return np.zeros(self.image.shape[:2])
        return self.sharing * np.square(np.sqrt(self.variance) @ metrics.LUMINANCE)


def given(path: Path, width: int, height: int) -> Reference:
    """The reference in an image or film file; EtendueError where it does not fit."""
    from ..loaders import load_image

    found = None
    if path.suffix.lower() == ".exr":
        with contextlib.suppress(film_file.NoFilm):
            found = of_film(film_file.read(path), str(path))
    if found is None:
        image = np.ascontiguousarray(load_image(path, "environment").pixels, np.float32)
        found = Reference(image, None, None, str(path), hashlib.sha256(image.data).hexdigest())
    if found.image.shape != (height, width, 3):
        size = f"{found.image.shape[1]} x {found.image.shape[0]}"
        raise EtendueError(f"{path}: the reference has {size} pixels, the comparison {width} x {height}")
    return found


def made(scene: Scene, goal: Goal, threads: int, progress: Callable[[float], object]) -> Reference:
    """The reference of `scene`, gone on from the cached one where that has not enough of `goal` yet.

    Ctrl-C raises KeyboardInterrupt, with what is done kept in the cache.
    """
    scene = scene_of(scene)
    path = _cached(scene)
    film = _read(path)
    if not reached(film, goal):
        path.parent.mkdir(parents=True, exist_ok=True)
        film = _render(scene, goal, film, threads, progress, lambda now: now.write(path))
        if not reached(film, goal):
            raise KeyboardInterrupt
    assert film is not None
    return of_film(film, f"{ESTIMATOR.settings['algorithm']} with MIS, independent samples", path)


def missing(scene: Scene, goal: Goal) -> float:
    """How many of the goal's samples or seconds are not in the cache yet."""
    film = _read(_cached(scene_of(scene)), header_only=True)
    if film is None:
        return goal.amount
    return max(goal.amount - (film.seconds if goal.spp is None else sample_ranges.count(film.ranges)), 0.0)


def scene_of(scene: Scene) -> Scene:
    """`scene` with the reference's estimator and seed."""
    config = ESTIMATOR.config(scene.config)
    seed = (config.seed + _SEED_DISTANCE) % 2**32
    return dataclasses.replace(scene, config=config.with_overrides([Override("seed", seed, "reference")]))


def of_film(film: Film, name: str, path: Path | None = None) -> Reference:
    """The reference that a film holds."""
    count = (film.sample_count - film.invalid_per_pixel).astype(np.float64)[..., None]
    in_half = film.half_count.astype(np.float64)[..., None]
    half = [
        np.divide(total, number, out=np.zeros_like(total), where=number > 0).astype(np.float32)
        for total, number in ((film.half_sum, in_half), (film.sum - film.half_sum, count - in_half))
    ]
    return Reference(
        film.image,
        film.variance.astype(np.float64) / np.maximum(count, 1),
        (half[0], half[1]),
        name,
        hashlib.sha256(film.image.data).hexdigest(),
        film.spp,
        film.seconds,
        path,
        film.sharing,
    )


def _cached(scene: Scene) -> Path:
    origin = Origin.of(scene.config, scene.contents, scene.data_dirs)
    digest = hashlib.sha256(f"{origin.scene_hash} {origin.version}".encode()).hexdigest()[:24]
    return models.cache_folder() / "references" / f"{digest}.film.exr"


def _read(path: Path, header_only: bool = False) -> Film | None:
    """The film there; None where there is none that can be read, which is then made anew."""
    try:
        return film_file.read_header(path) if header_only else film_file.read(path)
    except EtendueError:
        return None


def reached(film: Film | None, goal: Goal) -> bool:
    """Whether the film is as good as the goal asks."""
    if film is None:
        return False
    if goal.spp is not None:
        return sample_ranges.count(film.ranges) >= goal.spp
    return film.seconds >= 0.99 * goal.amount


def _render(
    scene: Scene,
    goal: Goal,
    start: Film | None,
    threads: int,
    progress: Callable[[float], object],
    keep: Callable[[Film], object],
) -> Film:
    done = 0.0 if start is None else start.seconds
    seconds = None if goal.seconds is None else goal.seconds - done
    began = time.monotonic()

    def report(fraction: float, _: float) -> None:
        progress(fraction if seconds is None else min((time.monotonic() - began) / seconds, 1.0))

    film = scene.render(
        spp=goal.spp if seconds is None else sample_ranges.MOST,
        resume=start,
        threads=threads,
        time_limit=seconds,
        progress=report,
        checkpoint=keep,
        checkpoint_seconds=_CHECKPOINT_SECONDS,
    )
    keep(film)
    return film
