"""What `etendue check` reports of a scene that can be rendered."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING

from ..config import read_config
from ..words import clock, counted, si
from . import memory

if TYPE_CHECKING:
    from ..scene import Scene

_MOST_LIGHTS = 12
# Large enough to keep all threads busy and to see most of the scene, small enough to be over at once.
_TRIAL_PIXELS = 160 * 160
_TRIAL_SECONDS = 2.0


def report(path: Path, overrides: Sequence[str] = (), data_dirs: Sequence[str | PathLike[str]] = ()) -> str:
    """The scene's warnings and contents, in lines for people; raises EtendueError with all that is wrong."""
    from .. import scene as scenes

    config = read_config(path, overrides, data_dirs)
    memory.require(config)
    for name in config.scenes_to_build(data_dirs):
        print(f"building the bundled scene {name}, this once", file=sys.stderr, flush=True)
    scene = scenes.load(config, data_dirs=data_dirs)
    framebuffer = config.framebuffer
    warnings = counted(len(scene.warnings), "warning") if scene.warnings else "no warnings"
    sizes = (scene.core.memory_bytes, memory.of_image(framebuffer))
    rows = [
        ("scene", f"{path}: no problems, {warnings}"),
        ("algorithm", scene.config.algorithm),
        ("image", f"{framebuffer.res_w} x {framebuffer.res_h}, {_goal(scene)}"),
        ("triangles", f"{scene.core.triangle_count:,}"),
        *_lights(scene),
        ("memory", f"{si(sizes[0])}B for the scene, {si(sizes[1])}B for the image"),
        ("loading", clock(scene.load_seconds)),
        ("time", _time(scene)),
    ]
    lines = [f"{name:<10} {value}" for name, value in rows]
    return "\n".join([*lines, *(f"warning: {warning}" for warning in scene.warnings)])


def _goal(scene: Scene) -> str:
    if scene.config.beauty_render:
        return f"samples until the error is below {scene.config.error_eps:g}"
    return f"{scene.config.framebuffer.sppx} samples per pixel"


def _lights(scene: Scene) -> list[tuple[str, str]]:
    lights = sorted(scene.core.lights, key=lambda light: -light.power)
    total = sum(light.power for light in lights)
    rows = [("lights", f"{len(lights)}" if lights else "none: the image will be black")]
    for light in lights[:_MOST_LIGHTS]:
        name = f' "{light.material}"' if light.material else ""
        share = f", {light.power / total:.0%}" if total > 0 else ""
        rows.append(("", f"{light.kind}{name}: power {light.power:.4g}{share}"))
    if len(lights) > _MOST_LIGHTS:
        rows.append(("", f"and {len(lights) - _MOST_LIGHTS} weaker ones"))
    return rows


def _time(scene: Scene) -> str:
    framebuffer = scene.config.framebuffer
    pixels = framebuffer.res_w * framebuffer.res_h
    scale = min(1.0, (_TRIAL_PIXELS / pixels) ** 0.5)
    size = max(1, round(framebuffer.res_w * scale)), max(1, round(framebuffer.res_h * scale))
    # The first pass also wakes the threads and fills the caches; the second is the one that counts.
    for spp in (1, 2):
        film = scene.render(spp=spp, size=size, time_limit=_TRIAL_SECONDS)
    per_sample = film.seconds / max(1, film.samples) * pixels
    whole = per_sample * framebuffer.sppx
    spp = framebuffer.sppx
    goal = "" if scene.config.beauty_render else f", {clock(whole)} for {spp}"
    return f"about {clock(per_sample)} for 1 spp{goal} (measured on a small image)"
