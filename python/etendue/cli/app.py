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
from typing import Annotated, NamedTuple, ParamSpec

import typer

from ..errors import EtendueError

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
    from .. import _core

    return [info.name for info in _core.algorithms()]


def _scene_names() -> list[str]:
    from ..models import SCENES

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
    as_json: Annotated[
        bool, typer.Option("--json", help="Print one JSON object about the render on the standard output.")
    ] = False,
    quiet: Annotated[
        bool, typer.Option("--quiet", "-q", help="No progress and no messages but errors.")
    ] = False,
) -> None:
    """Render a scene file to images, or go on from a film."""
    from ..film import resuming, sample_ranges
    from . import render as render_command

    if config is None and resume is None:
        context.fail("Missing argument 'CONFIG', or --resume and a film.")
    _require_folders(data)
    if threads < 0:
        raise EtendueError(
            f"--threads: a number of threads, or 0 for one on each core, is needed, not {threads}"
        )
    if time is not None and not 0 < time < float("inf"):
        raise EtendueError(f"--time: a number of seconds above 0 is needed, not {time:g}")
    if checkpoint is not None and film is None and resume is None:
        raise EtendueError("--checkpoint: there is no film to write; --film names one")
    if checkpoint is not None and not 0 < checkpoint < float("inf"):
        raise EtendueError(f"--checkpoint: a number of seconds above 0 is needed, not {checkpoint:g}")
    if samples is not None and (spp is not None or resume is not None):
        other = "--spp" if spp is not None else "--resume"
        raise EtendueError(f"--samples: excludes {other}; films of other samples are put together by merge")
    overrides = render_command.overrides_of(algorithm, spp, size, seed, settings or [])
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
    )
    code = render_command.run(job)
    if code:
        raise typer.Exit(code)


@app.command(short_help="Add up films of different samples.")
@_reported
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
    from . import films as film_commands

    print(film_commands.merge(parts, output))


def _view_names() -> list[str]:
    from ..display.views import VIEWS

    return list(VIEWS)


def _quantity_names() -> list[str]:
    from ..display.false_colour import QUANTITIES

    return list(QUANTITIES)


@app.command(short_help="Show a film as PNG or JPEG.")
@_reported
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
            help="Instead of the image, show its variance, relative-error or samples in false colours.",
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
    from . import films as film_commands

    if false_colour is not None:
        wrong = "--exposure" if exposure is not None else "--view" if view is not None else None
        if wrong:
            raise EtendueError(f"{wrong}: without effect on --false-colour")
        film_commands.false_colour(film, output, false_colour, scale)
        return
    if scale is not None:
        raise EtendueError("--scale: without effect but on --false-colour")
    film_commands.tonemap(film, output, exposure, view or "srgb")


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

    from ..config import json_schema

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
