"""What `etendue render` does, around the rendering itself."""

from __future__ import annotations

import json
import sys
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from . import memory, outputs, progress
from .config import read_config
from .config_overrides import Override
from .errors import EtendueError
from .words import clock, counted, si

if TYPE_CHECKING:
    from .film import Film
    from .scene import Scene

INTERRUPTED = 130


@dataclass(frozen=True)
class Job:
    """One call of `etendue render`."""

    config: Path
    overrides: Sequence[str | Override] = ()
    data_dirs: Sequence[Path] = ()
    outputs: Sequence[str] = ()
    threads: int = 0
    time_limit: float | None = None
    as_json: bool = False
    quiet: bool = False

    def say(self, text: str) -> None:
        """A line for people; the standard output is left to --json."""
        if not self.quiet:
            print(text, file=sys.stderr, flush=True)


def overrides_of(
    algorithm: str | None,
    spp: int | None,
    size: tuple[int, int] | None,
    seed: int | None,
    settings: Sequence[str],
) -> list[str | Override]:
    """The changes to the scene file that options ask for, after those of --set."""
    changes: list[str | Override] = list(settings)
    width, height = size or (None, None)
    for option, key, value in (
        ("--algorithm", "algorithm", algorithm),
        ("--spp", "framebuffer.sppx", spp),
        ("--size", "framebuffer.res_w", width),
        ("--size", "framebuffer.res_h", height),
        ("--seed", "seed", seed),
    ):
        if value is not None:
            changes.append(Override(key, value, option))
    return changes


def run(job: Job) -> int:
    """Render as `job` says; the exit code: 0, or 130 where Ctrl-C came before the end."""
    paths = outputs.check(job.outputs or [f"{job.config.stem}.png"])
    config = read_config(job.config, job.overrides, job.data_dirs)
    memory.require(config)
    from . import scene as scenes

    for name in config.scenes_to_build(job.data_dirs):
        job.say(f"building the bundled scene {name}, this once")
    scene = scenes.load(config, data_dirs=job.data_dirs)
    for warning in scene.warnings:
        job.say(f"warning: {warning}")
    job.say(_introduction(scene))
    film = _render(job, scene)
    if film is None:
        job.say("interrupted before the first samples; nothing was written")
        return INTERRUPTED
    _save(film, paths)
    for line in _closing(film, config.framebuffer.sppx, paths):
        job.say(line)
    if job.as_json:
        print(json.dumps(_summary(film, scene, paths)))
    return INTERRUPTED if film.interrupted else 0


def _render(job: Job, scene: Scene) -> Film | None:
    """The film; None where Ctrl-C came before its first samples."""
    framebuffer = scene.config.framebuffer
    goal = progress.Goal(framebuffer.sppx, framebuffer.res_w * framebuffer.res_h, job.time_limit)
    with progress.shown(goal, job.quiet) as report:
        try:
            return scene.render(threads=job.threads, time_limit=job.time_limit, progress=report)
        except KeyboardInterrupt:
            return None


def _save(film: Film, paths: Sequence[Path]) -> None:
    """Writes all that can be written before it tells what cannot."""
    problems: list[str] = []
    for path in paths:
        try:
            film.save(path)
        except EtendueError as error:
            problems.append(str(error))
    if problems:
        raise EtendueError("\n".join(problems))


def _introduction(scene: Scene) -> str:
    config, framebuffer = scene.config, scene.config.framebuffer
    contents = (counted(scene.core.triangle_count, "triangle"), counted(len(scene.core.lights), "light"))
    return (
        f"{config.algorithm}, {framebuffer.res_w} x {framebuffer.res_h}, {framebuffer.sppx} spp; "
        f"{', '.join(contents)}, loaded in {clock(scene.load_seconds)}"
    )


def _closing(film: Film, wanted: int, paths: Sequence[Path]) -> Iterator[str]:
    spp = f"{film.spp:.3f}".rstrip("0").rstrip(".")
    if film.invalid_count:
        x, y, sample = film.invalid[0]
        where = f"the first at pixel ({x}, {y}), sample {sample}"
        yield f"warning: {counted(film.invalid_count, 'sample')} without a finite radiance left out, {where}"
    if not film.complete:
        yield f"{'interrupted' if film.interrupted else 'the time is over'}: {spp} of {wanted} spp are done"
    rate = f" ({si(film.samples / film.seconds)} samples/s)" if film.seconds > 0 else ""
    yield f"{spp} spp in {clock(film.seconds)}{rate}: {', '.join(map(str, paths))}"


def _summary(film: Film, scene: Scene, paths: Sequence[Path]) -> dict[str, Any]:
    """What --json prints."""
    height, width = film.image.shape[:2]
    return {
        "algorithm": scene.config.algorithm,
        "spp": int(film.spp) if film.spp.is_integer() else film.spp,
        "width": width,
        "height": height,
        "seconds": film.seconds,
        "load_seconds": scene.load_seconds,
        "rays": film.rays,
        "samples_per_second": film.samples / film.seconds if film.seconds > 0 else None,
        "mean": film.image.mean(axis=(0, 1), dtype="float64").tolist(),
        "invalid_samples": film.invalid_count,
        "outputs": [str(path) for path in paths],
    }
