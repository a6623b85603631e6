"""The options of `etendue render`."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from ...errors import EtendueError
from ..app import (
    AlgorithmName,
    DataFolders,
    ImageSize,
    Quiet,
    Settings,
    Threads,
    app,
    reported,
    require_folders,
    require_threads,
)


def _aov_names() -> list[str]:
    from ...film.aovs import AOVS

    return list(AOVS)


@app.command()
@reported
def render(
    context: typer.Context,
    config: Annotated[
        Path | None,
        typer.Argument(
            metavar="CONFIG",
            help="The scene file (JSON); with --resume not needed.",
            show_default=False,
        ),
    ] = None,
    output: Annotated[
        list[str] | None,
        typer.Option(
            "-o",
            "--output",
            metavar="FILE",
            help="Where the image goes: .exr holds linear radiance, .png and .jpg the exposed sRGB image. "
            "May be repeated. Without it: the scene file's name with .png, in the current folder.",
        ),
    ] = None,
    spp: Annotated[
        int | None, typer.Option("--spp", metavar="N", help="Samples per pixel (framebuffer.sppx).")
    ] = None,
    beauty: Annotated[
        bool,
        typer.Option(
            "--beauty",
            help="Beauty render: add samples, worst tiles first, until the error is below error_eps "
            "(beauty_render).",
        ),
    ] = False,
    time: Annotated[
        float | None,
        typer.Option(
            "--time",
            metavar="S",
            help="Stop after so many seconds of rendering, even if samples are missing.",
        ),
    ] = None,
    size: ImageSize = None,
    algorithm: AlgorithmName = None,
    threads: Threads = 0,
    seed: Annotated[
        int | None,
        typer.Option(
            "--seed", metavar="N", help="Another number gives other noise; the same, the same image."
        ),
    ] = None,
    data: DataFolders = None,
    settings: Settings = None,
    film: Annotated[
        Path | None,
        typer.Option(
            "--film",
            metavar="FILE",
            help="Also keep the film there: an EXR with all that it takes to go on from it, as box.film.exr.",
        ),
    ] = None,
    checkpoint: Annotated[
        float | None,
        typer.Option(
            "--checkpoint",
            metavar="S",
            help="Seconds of rendering between two writings of the film.  [default: 30]",
        ),
    ] = None,
    resume: Annotated[
        Path | None,
        typer.Option(
            "--resume",
            metavar="FILM",
            help="Go on from a film, with the scene and the settings that it carries, and write it back "
            "there, or to --film.",
        ),
    ] = None,
    samples: Annotated[
        str | None,
        typer.Option(
            "--samples",
            metavar="A:B",
            help="Render the samples with the indices from A to B - 1 of every pixel, for etendue merge.",
        ),
    ] = None,
    aov: Annotated[
        list[str] | None,
        typer.Option(
            "--aov",
            metavar="NAMES",
            autocompletion=_aov_names,
            help="Also write what else is known of each pixel, as layers of EXR images: albedo, normal, depth, "
            "position, object_id, material_id, sample_count, variance, direct, indirect, bsdf_sampling, "
            "light_sampling, denoising_albedo, denoising_normal. With commas between, or repeated.",
        ),
    ] = None,
    denoise: Annotated[
        bool | None,
        typer.Option(
            "--denoise/--no-denoise",
            help="Also write each image denoised by Open Image Denoise, as box.denoised.png beside box.png. "
            "Biased.  [default: after a beauty render, where the denoiser is installed]",
            show_default=False,
        ),
    ] = None,
    sample_map: Annotated[
        Path | None,
        typer.Option(
            "--sample-map",
            metavar="FILE",
            help="Also write how many samples each pixel has, in false colours (.png, .jpg).",
        ),
    ] = None,
    as_json: Annotated[
        bool, typer.Option("--json", help="Print one JSON object about the render on the standard output.")
    ] = False,
    json_progress: Annotated[
        bool,
        typer.Option(
            "--json-progress", help="Progress and messages as one JSON object a line on the standard error."
        ),
    ] = False,
    quiet: Quiet = False,
) -> None:
    """Render a scene file to images, or go on from a film."""
    from ...film import resuming, sample_ranges
    from .. import render as render_command

    if config is None and resume is None:
        context.fail("Missing argument 'CONFIG', or --resume and a film.")
    require_folders(data)
    require_threads(threads)
    if time is not None and not 0 < time < float("inf"):
        raise EtendueError(f"--time: a number of seconds above 0 is needed, not {time:g}")
    if checkpoint is not None and film is None and resume is None:
        raise EtendueError("--checkpoint: there is no film to write; --film names one")
    if checkpoint is not None and not 0 < checkpoint < float("inf"):
        raise EtendueError(f"--checkpoint: a number of seconds above 0 is needed, not {checkpoint:g}")
    if samples is not None and (spp is not None or resume is not None):
        other = "--spp" if spp is not None else "--resume"
        raise EtendueError(f"--samples: excludes {other}; films of other samples are put together by merge")
    if beauty and (spp is not None or samples is not None):
        other = "--spp" if spp is not None else "--samples"
        raise EtendueError(f"--beauty: excludes {other}; the error decides how many samples there will be")
    overrides = render_command.overrides_of(algorithm, spp, size, seed, settings or [], beauty)
    job = render_command.Job(
        config,
        overrides,
        tuple(data or ()),
        tuple(output or ()),
        threads,
        time,
        as_json,
        quiet,
        film,
        resuming.CHECKPOINT if checkpoint is None else checkpoint,
        resume,
        spp,
        None if samples is None else sample_ranges.parse(samples),
        aovs=[name.strip() for names in aov or () for name in names.split(",")],
        denoise=denoise,
        sample_map=sample_map,
        json_progress=json_progress,
    )
    code = render_command.run(job)
    if code:
        raise typer.Exit(code)
