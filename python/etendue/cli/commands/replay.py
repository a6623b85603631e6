"""The options of `etendue replay`."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Annotated, NamedTuple

import typer

from ..app import AlgorithmName, ConfigFile, DataFolders, ImageSize, Settings, app, reported, require_folders


class Pixel(NamedTuple):
    """A place in the image, from its top left corner."""

    x: int
    y: int


def parse_pixel(text: str) -> Pixel:
    """`12,34` as a Pixel."""
    match = re.fullmatch(r"\s*(\d+)\s*,\s*(\d+)\s*", text)
    if match is None:
        raise typer.BadParameter(f"'{text}' is not X,Y in pixels from the top left corner, as in 12,34.")
    return Pixel(int(match.group(1)), int(match.group(2)))


@app.command(short_help="Tell the path of one sample, vertex by vertex.")
@reported
def replay(
    config: ConfigFile,
    pixel: Annotated[
        Pixel,
        typer.Option(
            "--pixel",
            metavar="X,Y",
            parser=parse_pixel,
            help="The pixel, from the top left corner, as in 12,34.",
        ),
    ],
    sample: Annotated[
        int, typer.Option("--sample", metavar="N", help="The index of the pixel's sample, from 0.")
    ] = 0,
    output: Annotated[
        Path | None,
        typer.Option(
            "-o", "--output", metavar="FILE", help="Also draw the path over the scene, as an .svg file."
        ),
    ] = None,
    algorithm: AlgorithmName = None,
    size: ImageSize = None,
    seed: Annotated[int | None, typer.Option("--seed", metavar="N", help="The seed of the render.")] = None,
    data: DataFolders = None,
    settings: Settings = None,
) -> None:
    """Tell the path of one sample of a render with these settings: positions, materials, lobes, pdfs, weights,
    throughput, Russian roulette."""
    from .. import replaying
    from ..render import overrides_of

    require_folders(data)
    overrides = overrides_of(algorithm, None, size, seed, settings or [])
    print(replaying.replay(config, pixel, sample, output, overrides, data or []))
