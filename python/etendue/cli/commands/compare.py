"""The options of `etendue compare`."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from ..app import (
    ConfigFile,
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


@app.command()
@reported
def compare(
    config: ConfigFile,
    estimators: Annotated[
        str,
        typer.Option(
            "--estimators",
            metavar="LIST",
            help="What to compare: naive, nee, mis, balance and names of algorithms with commas between them, or a "
            'JSON file {"name": {"key": value}} with keys as of --set.',
        ),
    ] = "naive,nee,mis",
    output: Annotated[
        Path | None,
        typer.Option(
            "-o",
            "--output",
            metavar="DIR",
            help="Folder for the report, new or of a comparison before. Without it: the scene file's name with "
            "-compared, in the current folder.",
        ),
    ] = None,
    spp: Annotated[
        int | None,
        typer.Option("--spp", metavar="N", help="Equal samples: per pixel of each image (framebuffer.sppx)."),
    ] = None,
    time: Annotated[
        float | None,
        typer.Option("--time", metavar="S", help="Equal time: seconds of rendering for each image."),
    ] = None,
    repeats: Annotated[
        int,
        typer.Option(
            "--repeats", metavar="N", help="Images of each estimator, under independent random numbers."
        ),
    ] = 8,
    reference: Annotated[
        Path | None,
        typer.Option(
            "--reference",
            metavar="FILE",
            help="The converged image, an EXR or a film. Without it one is rendered, with 16 times the samples "
            "or time, at least 1024 spp, and cached.",
        ),
    ] = None,
    reference_spp: Annotated[
        int | None, typer.Option("--reference-spp", metavar="N", help="Samples per pixel of that reference.")
    ] = None,
    size: ImageSize = None,
    threads: Threads = 0,
    seed: Annotated[
        int | None,
        typer.Option("--seed", metavar="N", help="Of the first repeat; the others count on from it."),
    ] = None,
    data: DataFolders = None,
    settings: Settings = None,
    fail_above: Annotated[
        list[str] | None,
        typer.Option(
            "--fail-above",
            metavar="METRIC=VALUE",
            help="Exit with code 1 if that metric of an estimator is above the value, as in relMSE=0.01. "
            "May be repeated.",
        ),
    ] = None,
    fail_if_biased: Annotated[
        bool, typer.Option("--fail-if-biased", help="Exit with code 1 if an estimator is biased.")
    ] = False,
    quiet: Quiet = False,
) -> None:
    """Compare estimators on one scene: a report of noise, time and bias."""
    from .. import compare as compare_command
    from ..render import overrides_of

    require_folders(data)
    require_threads(threads)
    job = compare_command.Job(
        config,
        estimators,
        overrides_of(None, None, size, seed, settings or []),
        output or Path(f"{config.stem}-compared"),
        spp,
        time,
        repeats,
        reference,
        reference_spp,
        threads,
        tuple(data or ()),
        compare_command.limits(fail_above or []),
        fail_if_biased,
        quiet,
    )
    code = compare_command.run(job)
    if code:
        raise typer.Exit(code)
