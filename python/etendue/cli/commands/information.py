"""The options of the commands that tell: `etendue check`, `scenes`, `schema`, `algorithms` and `doctor`."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from ..app import ConfigFile, DataFolders, Settings, app, reported, require_folders


def _scene_names() -> list[str]:
    from ...models import SCENES

    return list(SCENES)


@app.command(short_help="Check a scene file: problems, contents, time.")
@reported
def check(config: ConfigFile, data: DataFolders = None, settings: Settings = None) -> None:
    """Say all that is wrong with a scene file, what is in it, and about how long it takes to render."""
    from .. import check as checking

    require_folders(data)
    print(checking.report(config, settings or [], data or []))


@app.command()
@reported
def scenes(
    names: Annotated[
        list[str] | None,
        typer.Argument(
            metavar="[NAME]...",
            autocompletion=_scene_names,
            help="The scenes to export; without: all.",
            show_default=False,
        ),
    ] = None,
    export: Annotated[
        Path | None,
        typer.Option("--export", metavar="DIR", help="Write the scenes' OBJ, MTL, PNG and HDR files there."),
    ] = None,
) -> None:
    """List the bundled scenes, or export them."""
    from .. import listings

    print(listings.scenes(names or []) if export is None else listings.export(export, names or []))


@app.command()
@reported
def schema() -> None:
    """Print the JSON Schema of scene files, for editors."""
    import json

    from ...config import json_schema

    print(json.dumps(json_schema(), indent=2))


@app.command(short_help="List the algorithms and their keys.")
@reported
def algorithms() -> None:
    """List the algorithms and the scene file's keys that each understands."""
    from .. import listings

    print(listings.algorithms())


@app.command(short_help="Say what is at work here, and what is missing.")
@reported
def doctor() -> None:
    """Say which versions are at work on which processor, what is missing and what installs it."""
    from .. import doctor as examination

    print(examination.report())
