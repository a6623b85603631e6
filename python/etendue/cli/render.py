"""What `etendue render` does, around the rendering itself."""

from __future__ import annotations

import functools
import json
import math
import shlex
import sys
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from .. import outputs
from ..config import Config, read_config
from ..config.overrides import Override
from ..errors import EtendueError
from ..film import file as film_file
from ..film import resuming
from ..words import clock, counted, si
from . import beside, films, memory, progress
from .app import USAGE_ERROR
from .interrupts import Interrupts

if TYPE_CHECKING:
    from ..film import Film
    from ..film.sample_ranges import Range
    from ..scene import Scene


@dataclass(frozen=True)
class Job:
    """One call of `etendue render`; `config` or `resume` is given, or both."""

    config: Path | None
    overrides: Sequence[str | Override] = ()
    data_dirs: Sequence[Path] = ()
    outputs: Sequence[str] = ()
    threads: int = 0
    time_limit: float | None = None
    as_json: bool = False
    quiet: bool = False
    film: Path | None = None
    checkpoint: float = resuming.CHECKPOINT
    resume: Path | None = None
    spp: int | None = None
    samples: Range | None = None
    aovs: Sequence[str] = ()
    denoise: bool | None = None  # None: after a beauty render, where there is a denoiser
    sample_map: Path | None = None
    json_progress: bool = False

    def say(self, text: str, event: str = "message") -> None:
        """A line for people, or for scripts that want progress; the standard output is left to --json."""
        if not self.quiet or event == "error":
            line = json.dumps({"event": event, "text": text}) if self.json_progress else text
            print(line, file=sys.stderr, flush=True)

    @property
    def film_path(self) -> Path | None:
        """Where the film goes: back to where it came from, unless another place is named."""
        return self.film or self.resume


def overrides_of(
    algorithm: str | None,
    spp: int | None,
    size: tuple[int, int] | None,
    seed: int | None,
    settings: Sequence[str],
    beauty: bool = False,
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
        ("--beauty", "beauty_render", beauty or None),
    ):
        if value is not None:
            changes.append(Override(key, value, option))
    return changes


def run(job: Job) -> int:
    """Render as `job` says; the exit code: 0, or 130 or 143 where Ctrl-C or SIGTERM came before the end."""
    with Interrupts() as interrupts:
        try:
            return _run(job, interrupts)
        except KeyboardInterrupt:
            job.say("interrupted", "error")
            return interrupts.exit_code
        except EtendueError as error:
            if not job.json_progress:
                raise
            job.say(str(error), "error")
            return USAGE_ERROR


def _run(job: Job, interrupts: Interrupts) -> int:
    start = None if job.resume is None else film_file.read(job.resume)
    name = job.config.stem if job.config is not None else resuming.scene_name(start)
    paths = outputs.check(job.outputs or [f"{name}.exr" if job.aovs else f"{name}.png"])
    if job.sample_map is not None:
        films.require_display(job.sample_map)
    config, data_dirs = _config(job, start)
    is_beauty = config.beauty_render and job.spp is None and job.samples is None
    wanted = beside.wanted(
        job.aovs, paths, is_beauty if job.denoise is None else job.denoise, job.denoise is None
    )
    if job.film_path is not None:
        resuming.check_place(job.film_path, job.resume, [*paths, *wanted.denoised])
    memory.require(config, wanted.bytes_per_pixel)
    from .. import scene as scenes

    for name in config.scenes_to_build(data_dirs):
        job.say(f"building the bundled scene {name}, this once")
    scene = scenes.load(config, data_dirs=data_dirs)
    for warning in scene.warnings:
        job.say(f"warning: {warning}")
    if start is not None and job.resume is not None:
        resuming.require_same_scene(scene, start, job.resume)
    spp = None if is_beauty else _spp_wanted(job, config, start)
    job.say(_introduction(scene, spp, start))
    film = _render(job, scene, start, spp, wanted.kept_apart, interrupts)
    if film is None:
        job.say("interrupted before the first samples; nothing was written")
        return interrupts.exit_code
    if job.film_path is not None and wanted.takes_time:
        # Before what follows can be killed. If it fails, so will the writing at the end, and tell.
        resuming.saved(film, job.film_path, compressed=False)
    quiet = job.quiet or job.json_progress
    film, denoised, left_out, problem = beside.made(scene, film, wanted, job.threads, job.say, quiet)
    with interrupts.shielded():
        _save(film, paths, denoised, wanted.denoised, job)
    stopped = film.interrupted or interrupts.by_signal
    interrupted = left_out is not None or (stopped and not film.complete)
    if left_out is not None:
        job.say(f"interrupted before {left_out}")
    for line in _closing(film, paths, job, interrupted):
        job.say(line)
    if denoised is not None:
        job.say(f"{denoised.attributes['denoised']} (biased): {', '.join(map(str, wanted.denoised))}")
    if problem is not None:
        raise EtendueError(problem)
    if job.as_json:
        print(json.dumps(_summary(film, scene, [*paths, *(wanted.denoised if denoised else ())])))
    return interrupts.exit_code if interrupted else 0


def _config(job: Job, start: Film | None) -> tuple[Config, Sequence[Path]]:
    if job.config is not None:
        return read_config(job.config, job.overrides, job.data_dirs), job.data_dirs
    assert start is not None
    assert job.resume is not None
    return resuming.config_of(start, job.resume, job.overrides, job.data_dirs)


def _spp_wanted(job: Job, config: Config, start: Film | None) -> int:
    """Samples per pixel that there are to be in the end."""
    if start is not None:
        first, end = start.goal
        if job.spp is not None:
            end = first + job.spp
        elif job.config is not None:
            end = max(end, first + config.framebuffer.sppx)
        first, end = start.towards((first, end))
        return end - first
    if job.samples is not None:
        return job.samples[1] - job.samples[0]
    return config.framebuffer.sppx


def _render(
    job: Job,
    scene: Scene,
    start: Film | None,
    spp: int | None,
    aovs: Sequence[str],
    interrupts: Interrupts,
) -> Film | None:
    """The film; None where Ctrl-C came before its first samples."""
    config, framebuffer = scene.config, scene.config.framebuffer
    before = 0.0 if start is None else start.spp
    bound = config.error_eps if spp is None else None
    goal = progress.Goal(spp, framebuffer.res_w * framebuffer.res_h, job.time_limit, before, bound)

    def checkpoint(film: Film) -> None:
        assert job.film_path is not None
        with interrupts.shielded():
            problem = resuming.saved(film, job.film_path, compressed=False)
        if problem is not None:
            job.say(f"warning: {problem}; rendering goes on, and writing is tried again")
        if interrupts.by_signal:
            raise KeyboardInterrupt

    with progress.shown(goal, job.quiet, job.json_progress) as report:
        try:
            return scene.render(
                spp=None if job.samples is not None else spp,
                samples=job.samples,
                resume=start,
                threads=job.threads,
                time_limit=job.time_limit,
                progress=report,
                error=report.error,
                checkpoint=None if job.film_path is None else checkpoint,
                checkpoint_seconds=job.checkpoint,
                aovs=aovs,
            )
        except KeyboardInterrupt:
            return None


def _save(
    film: Film, paths: Sequence[Path], denoised: Film | None, denoised_paths: Sequence[Path], job: Job
) -> None:
    """Writes all that can be written, the film first, before it tells what cannot."""
    problems: list[str] = []
    if job.film_path is not None and (problem := resuming.saved(film, job.film_path)) is not None:
        problems.append(problem)
    writers = [functools.partial(film.save, path) for path in paths]
    if denoised is not None:
        writers += [functools.partial(denoised.save, path) for path in denoised_paths]
    if job.sample_map is not None:
        writers.append(functools.partial(films.false_colour_of, film, job.sample_map, "samples"))
    for write in writers:
        try:
            write()
        except EtendueError as error:
            problems.append(str(error))
    if problems:
        raise EtendueError("\n".join(problems))


def _introduction(scene: Scene, spp: int | None, start: Film | None) -> str:
    config, framebuffer = scene.config, scene.config.framebuffer
    contents = (counted(scene.core.triangle_count, "triangle"), counted(len(scene.core.lights), "light"))
    there = "" if start is None else f", {_spp(start)} of them there"
    goal = f"{spp} spp{there}"
    if spp is None:
        goal = f"beauty render to an error of {config.error_eps:g}"
        goal += "" if start is None else f", {_spp(start)} spp there"
    return (
        f"{config.algorithm}, {framebuffer.res_w} x {framebuffer.res_h}, {goal}; "
        f"{', '.join(contents)}, loaded in {clock(scene.load_seconds)}"
    )


def _spp(film: Film) -> str:
    return f"{film.spp:.3f}".rstrip("0").rstrip(".")


def _closing(film: Film, paths: Sequence[Path], job: Job, interrupted: bool) -> Iterator[str]:
    if film.invalid_count:
        x, y, sample = film.invalid[0]
        where = f"the first at pixel ({x}, {y}), sample {sample}"
        yield f"warning: {counted(film.invalid_count, 'sample')} without a finite radiance left out, {where}"
    if not film.complete:
        wanted = film.goal[1] - film.goal[0]
        done = "" if film.bound is not None else f": {_spp(film)} of {wanted} spp are done"
        yield f"{'interrupted' if interrupted else 'the time is over'}{done}"
    if film.bound is not None:
        yield _beauty_report(film, film.bound)
    rate = f" ({si(film.samples / film.seconds)} samples/s)" if film.seconds > 0 else ""
    written = [*paths, *(path for path in (job.sample_map, job.film_path) if path is not None)]
    yield f"{_spp(film)} spp in {clock(film.seconds)}{rate}: {', '.join(map(str, written))}"
    if not film.complete and job.film_path is not None:
        yield f"to go on: {_command(job)}"


def _command(job: Job) -> str:
    assert job.film_path is not None
    command = resuming.command(job.film_path, job.outputs, job.threads, job.checkpoint)
    layers = f" --sample-map {shlex.quote(str(job.sample_map))}" if job.sample_map is not None else ""
    layers += f" --aov {','.join(job.aovs)}" if job.aovs else ""
    denoise = {None: "", True: " --denoise", False: " --no-denoise"}[job.denoise]
    return f"{command}{layers}{denoise}"


def _beauty_report(film: Film, bound: float) -> str:
    error, counts = film.error, film.sample_count
    share = (error.tiles <= bound).mean()
    return (
        f"error {error.value:.3g} (95% interval {error.low:.3g} to {error.high:.3g}), {share:.1%} of the tiles within "
        f"{bound:g}; {counts.min()} to {counts.max()} samples per pixel"
    )


def _summary(film: Film, scene: Scene, paths: Sequence[Path]) -> dict[str, Any]:
    """What --json prints."""
    height, width = film.image.shape[:2]
    error = film.error
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
        "error": error.value if math.isfinite(error.value) else None,
        "error_interval": [error.low, error.high] if math.isfinite(error.value) else None,
        "error_eps": film.bound,
        "complete": film.complete,
        "invalid_samples": film.invalid_count,
        "outputs": [str(path) for path in paths],
    }
