"""The command `etendue`: what its options are. What the commands do stands in modules of their own.

Nothing heavy is imported before a command needs it, so that `--help` and mistyped options answer at once.
"""

from __future__ import annotations

import functools
import os
import re
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Annotated, Any, NamedTuple, ParamSpec

import typer

from .errors import EtendueError

USAGE_ERROR = 2
INTERRUPTED = 130

Parameters = ParamSpec("Parameters")

app = typer.Typer(
    name="etendue",
    help="Étendue renders scene files by path tracing.",
    epilog="Start with: etendue render configs/a04_box.json",
    no_args_is_help=True,
    pretty_exceptions_enable=False,
    # Plain text keeps [brackets] and long messages whole.
    rich_markup_mode=None,
    context_settings={"help_option_names": ["-h", "--help"]},
)


class Size(NamedTuple):
    """Width and height in pixels."""

    width: int
    height: int


def parse_size(text: str) -> Size:
    """`640x480` as a Size."""
    match = re.fullmatch(r"\s*(\d+)\s*[xX×]\s*(\d+)\s*", text)
    if match is None:
        raise typer.BadParameter(f"'{text}' is not WIDTHxHEIGHT in pixels, as in 640x480.")
    return Size(int(match.group(1)), int(match.group(2)))


def _reported(command: Callable[Parameters, None]) -> Callable[Parameters, None]:
    """Tells an EtendueError on stderr and ends with its exit code instead of a traceback."""

    @functools.wraps(command)
    def reporting(*args: Parameters.args, **kwargs: Parameters.kwargs) -> None:
        try:
            command(*args, **kwargs)
            sys.stdout.flush()
        except EtendueError as error:
            print(error, file=sys.stderr)
            raise typer.Exit(USAGE_ERROR) from None
        except BrokenPipeError:
            # Whoever read the output has seen enough (etendue schema | head); the rest goes nowhere.
            os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
            raise typer.Exit(1) from None
        except OSError as error:
            print(f"{error.filename or 'output'}: {error.strerror or error}", file=sys.stderr)
            raise typer.Exit(USAGE_ERROR) from None
        except MemoryError:
            print("not enough memory", file=sys.stderr)
            raise typer.Exit(USAGE_ERROR) from None
        except KeyboardInterrupt:
            print("interrupted", file=sys.stderr)
            raise typer.Exit(INTERRUPTED) from None

    return reporting


def _require_folders(folders: list[Path] | None) -> None:
    missing = [f"--data: there is no folder {folder}" for folder in folders or () if not folder.is_dir()]
    if missing:
        raise EtendueError("\n".join(missing))


def _algorithm_names() -> list[str]:
    from . import _core

    return [info.name for info in _core.algorithms()]


def _scene_names() -> list[str]:
    from .models import SCENES

    return list(SCENES)


ConfigFile = Annotated[
    Path, typer.Argument(metavar="CONFIG", help="The scene file (JSON).", show_default=False)
]
DataFolders = Annotated[
    list[Path] | None,
    typer.Option(
        "--data", metavar="DIR", help="Also look for meshes and images in this folder. May be repeated."
    ),
]
Settings = Annotated[
    list[str] | None,
    typer.Option(
        "--set",
        metavar="KEY=VALUE",
        help="Change a key of the scene file for this run, as in rr_threshold=0.5, scene.sky.intensity=3 or "
        "scene.materials[floor].roughness=0.2. May be repeated.",
    ),
]


@app.command()
@_reported
def render(
    config: ConfigFile,
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
    time: Annotated[
        float | None,
        typer.Option(
            "--time",
            metavar="S",
            help="Stop after so many seconds of rendering, even if samples are missing.",
        ),
    ] = None,
    size: Annotated[
        Size | None,
        typer.Option(
            "--size", metavar="WxH", parser=parse_size, help="Width and height in pixels, as in 640x480."
        ),
    ] = None,
    algorithm: Annotated[
        str | None,
        typer.Option(
            "--algorithm",
            metavar="NAME",
            autocompletion=_algorithm_names,
            help="The estimator (see: etendue algorithms).",
        ),
    ] = None,
    threads: Annotated[
        int, typer.Option("--threads", metavar="N", help="Number of threads; 0 is one for each core.")
    ] = 0,
    seed: Annotated[
        int | None,
        typer.Option(
            "--seed", metavar="N", help="Another number gives other noise; the same, the same image."
        ),
    ] = None,
    data: DataFolders = None,
    settings: Settings = None,
    as_json: Annotated[
        bool, typer.Option("--json", help="Print one JSON object about the render on the standard output.")
    ] = False,
    quiet: Annotated[
        bool, typer.Option("--quiet", "-q", help="No progress and no messages but errors.")
    ] = False,
) -> None:
    """Render a scene file to images."""
    from . import render_command

    _require_folders(data)
    if threads < 0:
        raise EtendueError(
            f"--threads: a number of threads, or 0 for one on each core, is needed, not {threads}"
        )
    if time is not None and not 0 < time < float("inf"):
        raise EtendueError(f"--time: a number of seconds above 0 is needed, not {time:g}")
    overrides = render_command.overrides_of(algorithm, spp, size, seed, settings or [])
    job = render_command.Job(
        config, overrides, tuple(data or ()), tuple(output or ()), threads, time, as_json, quiet
    )
    code = render_command.run(job)
    if code:
        raise typer.Exit(code)


@app.command(short_help="Check a scene file: problems, contents, time.")
@_reported
def check(config: ConfigFile, data: DataFolders = None, settings: Settings = None) -> None:
    """Say all that is wrong with a scene file, what is in it, and about how long it takes to render."""
    from . import check as checking

    _require_folders(data)
    print(checking.report(config, settings or [], data or []))


@app.command()
@_reported
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
    from . import listings

    print(listings.scenes(names or []) if export is None else listings.export(export, names or []))


@app.command()
@_reported
def schema() -> None:
    """Print the JSON Schema of scene files, for editors."""
    import json

    from .config import json_schema

    print(json.dumps(json_schema(), indent=2))


@app.command(short_help="List the algorithms and their keys.")
@_reported
def algorithms() -> None:
    """List the algorithms and the scene file's keys that each understands."""
    from . import listings

    print(listings.algorithms())


@app.command(short_help="Say what is at work here, and what is missing.")
@_reported
def doctor() -> None:
    """Say which versions are at work on which processor, what is missing and what installs it."""
    from . import doctor as examination

    print(examination.report())


def _version(wanted: bool) -> None:
    if wanted:
        from .doctor import installed

        print(f"etendue {installed('etendue') or '(not installed as a package)'}")
        raise typer.Exit


@app.callback()
def _common(
    version: Annotated[
        bool, typer.Option("--version", callback=_version, is_eager=True, help="Print the version and exit.")
    ] = False,
) -> None:
    pass


def main(arguments: list[str] | None = None) -> Any:
    """Run the command with `arguments` (those of the process by default) and exit with its code."""
    return app(args=arguments, prog_name="etendue")
