"""The options of `etendue view`."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from ...errors import EtendueError
from ..app import DataFolders, Settings, Threads, app, reported, require_folders, require_threads


@app.command(short_help="Open a window on a scene, to change it and see the noise change.")
@reported
def view(
    paths: Annotated[
        list[Path] | None,
        typer.Argument(
            metavar="[CONFIG | MESH | HDR]...",
            help="A scene file, and meshes and an environment map to add to it.",
            show_default=False,
        ),
    ] = None,
    threads: Threads = 0,
    data: DataFolders = None,
    settings: Settings = None,
    screenshot: Annotated[
        Path | None,
        typer.Option(
            "--screenshot", metavar="FILE", help="Write what the window shows (.png, .jpg), and close it."
        ),
    ] = None,
    after: Annotated[
        float | None,
        typer.Option(
            "--after",
            metavar="SECONDS",
            help="When to take the screenshot: so long after the first picture.  [default: 5]",
        ),
    ] = None,
) -> None:
    """Open a window that shows the render as it converges and lets everything of the scene file be changed."""
    from ... import outputs, viewer

    require_folders(data)
    require_threads(threads)
    if after is not None and (screenshot is None or not 0 <= after < float("inf")):
        raise EtendueError("--after: a number of seconds of at least 0, with --screenshot, is needed")
    if screenshot is not None:
        outputs.check([screenshot])
    viewer.require_extra()
    from ...viewer.viewer import Viewer
    from ...viewer.window import Window, require_display

    require_display()
    shown = Viewer(paths or (), data or (), settings or (), threads)
    Window(shown, screenshot, 5.0 if after is None else after).run()
