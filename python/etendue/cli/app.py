"""The command `etendue` itself, and what its subcommands (in commands/) share: errors, kinds of options."""

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


def reported(command: Callable[Parameters, None]) -> Callable[Parameters, None]:
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


def require_folders(folders: list[Path] | None) -> None:
    """Raise EtendueError that names what of --data is no folder."""
    missing = [f"--data: there is no folder {folder}" for folder in folders or () if not folder.is_dir()]
    if missing:
        raise EtendueError("\n".join(missing))


def require_threads(threads: int) -> None:
    """Raise EtendueError where `threads` is no number of threads."""
    if threads < 0:
        raise EtendueError(
            f"--threads: a number of threads, or 0 for one on each core, is needed, not {threads}"
        )


def _algorithm_names() -> list[str]:
    from .. import _core

    return [info.name for info in _core.algorithms()]


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
AlgorithmName = Annotated[
    str | None,
    typer.Option(
        "--algorithm",
        metavar="NAME",
        autocompletion=_algorithm_names,
        help="The estimator (see: etendue algorithms).",
    ),
]
ImageSize = Annotated[
    Size | None,
    typer.Option(
        "--size", metavar="WxH", parser=parse_size, help="Width and height in pixels, as in 640x480."
    ),
]
Threads = Annotated[
    int, typer.Option("--threads", metavar="N", help="Number of threads; 0 is one for each core.")
]
Quiet = Annotated[bool, typer.Option("--quiet", "-q", help="No progress and no messages but errors.")]


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
