"""What renders a scene keeps it, and lets it go."""

from __future__ import annotations

import sys
from collections.abc import Callable

import pytest

from etendue import _core

from .worlds import diffuse, ground, looking, scene

CAMERA = looking((0, 1, 0), (0, 0, 0), 4)


def a_renderer(world: _core.Scene) -> _core.Renderer:
    return _core.Renderer(world, CAMERA, "Pathtracer", {})


@pytest.mark.parametrize(
    "make",
    [
        a_renderer,
        lambda world: _core.AovPass(world, CAMERA),
        lambda world: _core.TechniqueFilm(a_renderer(world)),
        lambda world: _core.RayRecord(a_renderer(world), 1),
    ],
    ids=["Renderer", "AovPass", "TechniqueFilm", "RayRecord"],
)
def test_a_scene_lives_as_long_as_what_renders_it(make: Callable[[_core.Scene], object]) -> None:
    world = scene((ground(), diffuse()))
    alone = sys.getrefcount(world)
    renders = make(world)
    assert sys.getrefcount(world) > alone
    del renders
    assert sys.getrefcount(world) == alone
