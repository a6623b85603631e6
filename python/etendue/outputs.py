"""Output files: refused before hours of rendering, and never half written.

An image is written beside its place under a temporary name and renamed when it is whole, so that a file
that was there before survives any failure.
"""

from __future__ import annotations

import os
import tempfile
from collections.abc import Callable, Iterable
from pathlib import Path

from .errors import EtendueError, nearest_name

EXTENSIONS = (".exr", ".hdr", ".png", ".jpg", ".jpeg")


def check(paths: Iterable[str | os.PathLike[str]]) -> list[Path]:
    """The paths, each once, if all of them can be written; else EtendueError with those that cannot."""
    checked: dict[Path, None] = {}
    problems: list[str] = []
    for path in map(Path, paths):
        problem = _problem(path)
        if problem is None:
            checked[path] = None
        else:
            problems.append(f"{path}: {problem}")
    if problems:
        raise EtendueError("\n".join(problems))
    return list(checked)


def _problem(path: Path) -> str | None:
    if path.suffix.lower() not in EXTENSIONS:
        near = nearest_name(path.suffix, EXTENSIONS) if path.suffix else None
        hint = f'did you mean "{near}"? ' if near else ""
        allowed = f"({hint}allowed: {', '.join(EXTENSIONS)})"
        kind = f'no image can be written as "{path.suffix}"' if path.suffix else "the extension is missing"
        return f"{kind} {allowed}"
    try:
        if path.is_dir():
            return "cannot be written: it is a folder"
        if not path.parent.is_dir():
            return f"cannot be written: there is no folder {path.parent}"
        if path.exists() and not os.access(path, os.W_OK):
            return "cannot be written: the file is read-only"
        _temporary(path).unlink()
    except OSError as error:
        return f"cannot be written: {error.strerror or error}"
    return None


def write(path: Path, save: Callable[[Path], object]) -> None:
    """Has `save` write a file of the same extension beside `path`, then renames it to `path`."""
    temporary = None
    try:
        # Of a link, what it points to is replaced.
        target = path.resolve()
        temporary = _temporary(target)
        save(temporary)
        temporary.chmod(0o666 & ~_umask())
        temporary.replace(target)
    except OSError as error:
        raise EtendueError(f"{path}: cannot be written: {error.strerror or error}") from error
    finally:
        if temporary is not None:
            temporary.unlink(missing_ok=True)


def _temporary(path: Path) -> Path:
    handle, name = tempfile.mkstemp(prefix=f".{path.stem[:100]}-", suffix=path.suffix, dir=path.parent)
    os.close(handle)
    return Path(name)


def _umask() -> int:
    # There is no way to ask for it without setting it.
    mask = os.umask(0o077)
    os.umask(mask)
    return mask
