"""The options of the commands on films: `etendue merge` and `etendue tonemap`."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from ...errors import EtendueError
from ..app import app, reported


@app.command(short_help="Add up films of different samples.")
@reported
def merge(
    parts: Annotated[
        list[Path], typer.Argument(metavar="PART", help="Films of one scene.", show_default=False)
    ],
    output: Annotated[
        Path,
        typer.Option("-o", "--output", metavar="FILE", help="Where the film of all samples goes (.exr)."),
    ],
) -> None:
    """Add up films of different samples of one scene, rendered with --samples, to the film of all of them."""
    from .. import films as film_commands

    print(film_commands.merge(parts, output))


def _view_names() -> list[str]:
    from ...display.views import VIEWS

    return list(VIEWS)


def _quantity_names() -> list[str]:
    from ...display.false_colour import QUANTITIES

    return list(QUANTITIES)


@app.command(short_help="Show a film as PNG or JPEG.")
@reported
def tonemap(
    film: Annotated[
        Path,
        typer.Argument(
            metavar="FILM", help="A film, or another linear image (.exr, .hdr).", show_default=False
        ),
    ],
    output: Annotated[
        Path, typer.Option("-o", "--output", metavar="FILE", help="Where the image goes: .png or .jpg.")
    ],
    exposure: Annotated[
        float | None,
        typer.Option(
            "--exposure",
            metavar="E",
            help="Factor on the radiance. Without it: the scene file's framebuffer.exposure.",
        ),
    ] = None,
    view: Annotated[
        str | None,
        typer.Option(
            "--view",
            metavar="NAME",
            autocompletion=_view_names,
            help="How bright radiance is fitted to a screen: srgb clips it, reinhard, hable, aces and agx "
            "roll it off.  [default: srgb]",
        ),
    ] = None,
    false_colour: Annotated[
        str | None,
        typer.Option(
            "--false-colour",
            metavar="NAME",
            autocompletion=_quantity_names,
            help="Instead of the image, show its variance, relative-error, tile-error or samples in false "
            "colours.",
        ),
    ] = None,
    scale: Annotated[
        str | None,
        typer.Option(
            "--scale",
            metavar="A:B",
            help="The values of the darkest and the lightest false colour. Without it: 98% of the pixels "
            "are between them.",
        ),
    ] = None,
) -> None:
    """Show a film, or another linear image, as a PNG or JPEG file."""
    from .. import films as film_commands

    if false_colour is not None:
        wrong = "--exposure" if exposure is not None else "--view" if view is not None else None
        if wrong:
            raise EtendueError(f"{wrong}: without effect on --false-colour")
        film_commands.false_colour(film, output, false_colour, scale)
        return
    if scale is not None:
        raise EtendueError("--scale: without effect but on --false-colour")
    film_commands.tonemap(film, output, exposure, view or "srgb")
