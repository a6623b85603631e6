"""What a viewer asks of the core: coarse pictures early, looks at a render from outside, quick changes."""

from __future__ import annotations

import threading
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

import etendue
from etendue import _core
from etendue.config.overrides import Override
from etendue.film import save_pixels
from etendue.scene import Scene

STRIDES = (16, 8, 4, 2)


def loaded(size: tuple[int, int] = (37, 21)) -> Scene:
    overrides = [Override("framebuffer.res_w", size[0]), Override("framebuffer.res_h", size[1])]
    return etendue.load(etendue.read_config("lit.json", overrides))


def test_coarse_passes_take_samples_of_the_render(lit_scene: Callable[..., None]) -> None:
    scene = loaded()
    whole, coarse = scene.renderer(), scene.renderer()
    whole.render(3)
    taken = 0
    for stride in STRIDES:
        assert coarse.render_coarse(stride)
        count = coarse.sample_count()
        assert (count[::stride, ::stride] == 1).all()
        taken = int(count.sum())
        assert taken == count[::stride, ::stride].size
    coarse.render(3)
    for ours, theirs in zip(coarse.snapshot(), whole.snapshot(), strict=True):
        assert np.array_equal(ours, theirs)


def test_pictures_of_coarse_passes(lit_scene: Callable[..., None]) -> None:
    renderer = loaded().renderer()
    renderer.render_coarse(8)
    small, full = renderer.picture(8), renderer.picture()
    assert small.shape == (3, 5, 3)
    assert full.shape == (21, 37, 3)
    assert small.any()
    assert np.array_equal(full, small.repeat(8, axis=0).repeat(8, axis=1)[:21, :37])
    renderer.render(1)
    assert np.array_equal(renderer.picture(), renderer.mean())
    for stride in (0, 3, 32):
        with pytest.raises(ValueError, match="stride"):
            renderer.picture(stride)
        with pytest.raises(ValueError, match="stride"):
            renderer.render_coarse(stride)


def test_a_film_that_was_used_is_as_a_new_one(lit_scene: Callable[..., None]) -> None:
    films = _core.Films()
    for size in ((37, 21), (37, 21), (20, 40), (37, 21)):
        scene = loaded(size)
        first, second = scene.renderer(films=films), scene.renderer(films=films)
        whole = scene.renderer()
        whole.render(3)
        for renderer in (first, second):
            assert not any(array.any() for array in renderer.snapshot())
            renderer.render(3)
            for ours, theirs in zip(renderer.snapshot(), whole.snapshot(), strict=True):
                assert np.array_equal(ours, theirs)


def test_cancelled_coarse_passes_say_so(lit_scene: Callable[..., None]) -> None:
    renderer = loaded().renderer()
    renderer.cancel()
    assert not renderer.render_coarse(2)
    assert renderer.sample_count().sum() == 0
    assert renderer.render_coarse(2)


def test_snapshots_of_a_running_render_are_of_one_moment(lit_scene: Callable[..., None]) -> None:
    lit_scene(framebuffer={"res_w": 8, "res_h": 6, "sppx": 4}, sampler="independent")
    renderer = loaded((64, 64)).renderer()
    thread = threading.Thread(target=lambda: renderer.render(1_000_000))
    thread.start()
    try:
        seen = []
        while len(seen) < 5:
            total, squares, half, count, *_ = renderer.snapshot()
            if seen and count.sum() <= seen[-1]:
                continue
            seen.append(count.sum())
            # Cauchy and Schwarz: false for sums of different moments.
            assert (total**2 <= squares * count[..., None] * (1 + 1e-9)).all()
            assert (half <= total * (1 + 1e-12)).all()
    finally:
        renderer.cancel()
        thread.join()


@pytest.mark.parametrize(
    "changes",
    [
        [Override("scene.materials", [{"name": "floor", "type": "metal", "roughness": 0.3}])],
        [Override("scene.materials", [{"name": "light", "emissive_strength": 3}])],
        [Override("scene.materials", [{"name": "light", "emissive_strength": 0}])],
        [Override("scene.sky", {"intensity": 2})],
        [Override("scene.sky", {"envmap": "sky.hdr"})],
        [Override("scene.mesh_files", ["lit.obj", "lit.obj"])],
        [Override("camera.pos", [0.3, 1, 2]), Override("camera.lens_radius", 0.1)],
        [Override("algorithm", "NaivePathtracer"), Override("seed", 5)],
        [Override("camera.fov", 30), Override("auto_focus", False)],
    ],
)
def test_a_changed_scene_is_the_scene_that_is_loaded(
    changes: list[Override], lit_scene: Callable[..., None]
) -> None:
    save_pixels(Path("sky.hdr"), np.full((4, 8, 3), 0.5, np.float32), {})
    scene = loaded()
    config = scene.config.with_overrides(changes)
    changed, fresh = scene.changed(config), etendue.load(config)
    ours, theirs = changed.renderer(), fresh.renderer()
    ours.render(4)
    theirs.render(4)
    for one, other in zip(ours.snapshot(), theirs.snapshot(), strict=True):
        assert np.array_equal(one, other)
    assert changed.changed(scene.config).config == scene.config


def test_what_a_change_keeps(lit_scene: Callable[..., None]) -> None:
    scene = loaded()
    moved = scene.changed(scene.config.with_overrides([Override("camera.fov", 20)]))
    assert moved.core is scene.core
    patched = scene.changed(scene.config.with_overrides(["scene.materials[floor].roughness=1"]))
    assert patched.core is not scene.core
    assert patched.core.memory_bytes == scene.core.memory_bytes
    with pytest.raises(ValueError, match="material that is not there"):
        scene.core.with_materials([])
