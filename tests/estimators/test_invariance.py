"""What must not change the picture: scale, place, threads, interruptions."""

from __future__ import annotations

import time

import numpy as np
import pytest
from scipy import stats

from etendue import _core
from etendue.models import box

from .worlds import Estimator, core_mesh, diffuse, estimators, lamp

SIZE = 32


def cornell(scale: float = 1, offset: float = 0) -> tuple[_core.Scene, _core.Camera]:
    """The Cornell box with a glass block, and its camera, scaled about the origin and then moved."""
    model = box.model()
    materials, parts = [], []
    for name, meshes in model.parts.items():
        kinds = {"light": lamp(78), "shortBox": _core.Material(name, "glass", (1, 1, 1), ior=1.5)}
        materials.append(kinds.get(name, diffuse(float(np.mean(model.materials[name].kd)))))
        parts += [core_mesh(mesh, len(materials) - 1, scale, offset) for mesh in meshes]
    position = tuple(np.array([0, 1, 2.4]) * scale + offset)
    camera = _core.Camera(position, (0, 0, -1), (0, 1, 0), 70, 0.02 * scale, 3 * scale, True, SIZE, SIZE)
    return _core.Scene(parts, materials, []), camera


def tile_means(renderer: _core.Renderer) -> np.ndarray:
    image = renderer.mean()[..., 1].astype(float)
    return image.reshape(4, SIZE // 4, 4, SIZE // 4).mean((1, 3)).ravel()


@pytest.mark.parametrize("estimator", list(estimators(roulette=(0.25,))), ids=str)
@pytest.mark.parametrize(("scale", "offset"), [(1e-3, 0), (1e3, 0), (1, 1000), (1, -1000)])
def test_scale_and_place(estimator: Estimator, scale: float, offset: float) -> None:
    """The same random numbers give the same picture, but for paths that rounding turns elsewhere."""
    means = []
    for s, o in ((1, 0), (scale, offset)):
        runs = [tile_means(estimator.render(*cornell(s, o), spp=8, seed=seed)) for seed in range(4)]
        means.append(np.array(runs))
    difference = means[0] - means[1]
    # A thousand units away a vertex is off by up to 6e-5, and a lamp 0.2 wide by as much of its area.
    moved = np.abs(difference.mean(0)) > 1e-3 * means[0].mean(0)
    p = np.nan_to_num(stats.ttest_1samp(difference, 0).pvalue, nan=1)
    assert not (moved & (p < 1e-3 / len(p))).any(), f"a tile moved, p = {p[moved].min():.2g}"
    # Few paths change, so the whole picture may move by little.
    assert abs(difference.mean()) < 0.01 * means[0].mean()


@pytest.mark.parametrize("sampler", _core.samplers())
@pytest.mark.parametrize("estimator", list(estimators(roulette=(0.25,))), ids=str)
def test_threads_give_the_same_bytes(estimator: Estimator, sampler: str) -> None:
    images = [
        estimator.render(*cornell(), spp=4, sampler=sampler, threads=threads, seed=7).mean()
        for threads in (1, 2, 5)
    ]
    assert (images[0] == images[1]).all()
    assert (images[0] == images[2]).all()


@pytest.mark.parametrize("sampler", _core.samplers())
def test_seeds_differ(sampler: str) -> None:
    estimator = Estimator("Pathtracer")
    first, second = (
        estimator.render(*cornell(), spp=4, sampler=sampler, seed=seed).mean() for seed in (0, 1)
    )
    assert (first != second).mean() > 0.5


def test_a_render_in_steps_is_the_render_in_one() -> None:
    world, camera = cornell()
    steps = _core.Renderer(world, camera, "Pathtracer", threads=2)
    for samples in (1, 4, 5, 16):
        assert steps.render(samples)
    whole = _core.Renderer(world, camera, "Pathtracer", threads=1)
    assert whole.render(16)
    assert (steps.sum() == whole.sum()).all()
    assert (steps.sum_squares() == whole.sum_squares()).all()
    assert steps.rays == whole.rays


def test_cancelling_keeps_what_is_done_and_goes_on() -> None:
    world, camera = cornell()
    renderer = _core.Renderer(world, camera, "Pathtracer", threads=2)
    calls = []

    def stop(fraction: float, spp: float) -> None:
        calls.append((fraction, spp))
        if spp > 4:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        renderer.render(10**6, progress=stop)
    counts = renderer.sample_count()
    assert 4 < counts.mean() < 10**6
    assert calls[-1][0] < 1
    target = int(counts.max()) + 2
    assert renderer.render(target)
    whole = _core.Renderer(world, camera, "Pathtracer", threads=1)
    assert whole.render(target)
    assert (renderer.sum() == whole.sum()).all()


def test_cancel_returns_within_a_tenth_of_a_second() -> None:
    import threading

    model = box.model()
    world = _core.Scene(
        [core_mesh(m, 0) for meshes in model.parts.values() for m in meshes], [diffuse(1.0)], []
    )
    camera = _core.Camera((0, 1, 0), (0, 0, -1), (0, 1, 0), 90, 0, 1, True, 512, 512)
    # Paths of thousands of edges, as nothing absorbs: the worst case for stopping.
    renderer = _core.Renderer(
        world, camera, "NaivePathtracer", {"max_cam_path_length": 3000, "rr_threshold": 0.0}, threads=2
    )
    stopped_at = []

    def stop() -> None:
        stopped_at.append(time.process_time())
        renderer.cancel()

    timer = threading.Timer(0.5, stop)
    timer.start()
    assert not renderer.render(1000)
    # Of the processor, as a busy machine may give others the time.
    assert time.process_time() - stopped_at[0] < 0.1
    timer.join()


def test_time_limit_gives_every_pixel_a_sample() -> None:
    world, camera = cornell()
    renderer = _core.Renderer(world, camera, "Pathtracer", threads=1)
    before = time.process_time()
    assert not renderer.render(10**6, time_limit=0.2)
    assert time.process_time() - before < 2
    assert renderer.sample_count().min() >= 1
    assert renderer.seconds > 0.2
