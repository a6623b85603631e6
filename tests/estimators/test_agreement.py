"""On the six scenes every estimator must converge to the same picture, whatever its settings.

Each image is cut into tiles; several independent renders give each tile's mean an honest spread;
Welch's test compares tiles between estimators, and Holm's correction keeps the whole table at one false alarm
in a thousand.
"""

from __future__ import annotations

import itertools
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy import stats

import etendue

CONFIGS = Path(__file__).resolve().parents[2] / "configs"
# Tests of one scene share a worker, which loads it once.
SCENES = [
    pytest.param(name, marks=pytest.mark.xdist_group(f"scene-{name}"))
    for name in ("box", "pots", "sibenik", "spz", "fireplace", "mis")
]
ESTIMATORS: dict[str, dict[str, object]] = {
    "naive": {"algorithm": "NaivePathtracer"},
    "nee": {"algorithm": "Pathtracer", "mis": "none"},
    "mis": {"algorithm": "Pathtracer", "mis": "power"},
}
ROULETTE = (0.0, 0.25, 1.0)
# Light sampling alone finds what glossy surfaces mirror of a lamp in rare bright samples. With few samples most renders
# lack them, and are darker and look surer than they are.
TIMES_AS_MANY = {("fireplace", "nee"): 4}
FALSE_ALARMS = 1e-3
SIZE, TILE = 64, 16
REPEATS = 8


@cache
def scene(name: str) -> etendue.Scene:
    return etendue.load(CONFIGS / f"a04_{name}.json")


@cache
def tiles(name: str, estimator: str, threshold: float, spp: int, depth: int) -> NDArray[np.float64]:
    """(repeats, tiles) means of luminance, each repeat of `spp` samples, or more, under its own random numbers."""
    out = []
    for repeat in range(REPEATS):
        film = scene(name).render(
            spp=spp * TIMES_AS_MANY.get((name, estimator), 1),
            size=(SIZE, SIZE),
            seed=1000 + repeat,
            sampler="independent",
            rr_threshold=threshold,
            max_cam_path_length=depth,
            **ESTIMATORS[estimator],  # type: ignore[arg-type]
        )
        image = film.image.astype(float) @ [0.2126, 0.7152, 0.0722]
        assert len(film.invalid) == 0
        assert film.image.min() >= 0
        out.append(image.reshape(SIZE // TILE, TILE, SIZE // TILE, TILE).mean((1, 3)).ravel())
    return np.array(out)


def disagreements(samples: list[NDArray[np.float64]]) -> tuple[NDArray[np.float64], NDArray[np.bool_]]:
    """p-values of all pairs and tiles, and which of them fall under Holm's correction."""
    p = np.concatenate(
        [stats.ttest_ind(a, b, equal_var=False).pvalue for a, b in itertools.combinations(samples, 2)]
    )
    # Tiles that see nothing but one constant colour have no spread at all.
    p = np.where(np.isnan(p), 1, p)
    order = np.argsort(p)
    fall = np.cumprod(p[order] <= FALSE_ALARMS / (len(p) - np.arange(len(p)))).astype(bool)
    return p, fall


def check(name: str, spp: int, depth: int = 12) -> None:
    renders = [
        tiles(name, estimator, threshold, spp, depth) for estimator in ESTIMATORS for threshold in (0.0, 0.25)
    ]
    p, fall = disagreements(renders)
    assert not fall.any(), f"{fall.sum()} of {len(p)} tiles disagree, smallest p {p.min():.2g}"


@pytest.mark.parametrize("name", SCENES)
def test_estimators_agree(name: str) -> None:
    check(name, spp=16)


@pytest.mark.slow
@pytest.mark.parametrize("name", SCENES)
def test_estimators_agree_at_thousands_of_samples(name: str) -> None:
    check(name, spp=512)


@pytest.mark.parametrize("name", SCENES)
def test_roulette_moves_no_mean(name: str) -> None:
    for estimator in ("naive", "mis"):
        renders = [tiles(name, estimator, threshold, 16, 12) for threshold in ROULETTE]
        p, fall = disagreements(renders)
        assert not fall.any(), f"{estimator}: smallest p {p.min():.2g}"


@pytest.mark.parametrize("name", SCENES)
def test_threads_give_the_same_bytes(name: str) -> None:
    one, two = (scene(name).render(spp=4, size=(SIZE, SIZE), threads=threads) for threads in (1, 2))
    assert one.image.tobytes() == two.image.tobytes()


@pytest.mark.slow
@pytest.mark.parametrize("name", SCENES)
def test_p_values_are_uniform(name: str) -> None:
    """Of renders that differ in their seeds alone: the test itself is calibrated."""
    renders = tiles(name, "mis", 0.25, 512, 12)
    p = stats.ttest_ind(renders[: REPEATS // 2], renders[REPEATS // 2 :], equal_var=False).pvalue
    assert stats.kstest(p[~np.isnan(p)], "uniform").pvalue > FALSE_ALARMS


@pytest.mark.slow
@pytest.mark.parametrize("name", SCENES)
def test_sobol_agrees_with_independent(name: str) -> None:
    """Across independent scramblings, which is where Sobol's estimates are independent of each other."""
    sobol = []
    for seed in range(REPEATS):
        film = scene(name).render(
            spp=512, size=(SIZE, SIZE), seed=seed, sampler="sobol", max_cam_path_length=12
        )
        image = film.image.astype(float) @ [0.2126, 0.7152, 0.0722]
        sobol.append(image.reshape(SIZE // TILE, TILE, SIZE // TILE, TILE).mean((1, 3)).ravel())
    p, fall = disagreements([np.array(sobol), tiles(name, "mis", 0.25, 512, 12)])
    assert not fall.any(), f"smallest p {p.min():.2g}"


@pytest.mark.slow
@pytest.mark.parametrize("name", SCENES)
def test_no_invalid_sample(name: str) -> None:
    """Neither a NaN nor a negative value at 256 samples per pixel, by either sampler."""
    for sampler in ("sobol", "independent"):
        film = scene(name).render(spp=256, size=(SIZE, SIZE), sampler=sampler)
        assert len(film.invalid) == 0
        assert np.isfinite(film.image).all()
        assert film.image.min() >= 0
