"""The options of `etendue denoise`."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from ..app import DataFolders, Quiet, Threads, app, reported, require_folders, require_threads


@app.command(short_help="Denoise a film.")
@reported
def denoise(
    film: Annotated[
        Path, typer.Argument(metavar="FILM", help="A film, as --film writes it.", show_default=False)
    ],
    output: Annotated[
        list[str],
        typer.Option(
            "-o",
            "--output",
            metavar="FILE",
            help="Where the denoised image goes: .exr, .hdr, .png or .jpg. May be repeated.",
            show_default=False,
        ),
    ],
    data: DataFolders = None,
    threads: Threads = 0,
    quiet: Quiet = False,
) -> None:
    """Denoise a film with Open Image Denoise, guided by what its scene shows in each pixel. Biased.

    The film stays as it is.
    """
    from .. import denoising

    require_folders(data)
    require_threads(threads)
    denoising.denoise(film, output, tuple(data or ()), threads, quiet)
