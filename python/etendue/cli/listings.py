"""What `etendue algorithms` and `etendue scenes` print."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from .. import models
from ..errors import EtendueError, nearest_name
from ..words import si


def algorithms() -> str:
    """Every algorithm with its summary and the scene file's keys that only some algorithms have."""
    from .. import _core
    from ..config import json_schema
    from ..config.schema import describe, node_at

    root = json_schema()
    blocks = []
    for info in _core.algorithms():
        lines = [f"{info.name}\n    {info.summary}"]
        for parameter in info.parameters:
            node = node_at(root, (parameter.name,))
            allowed = describe(root, node) if node is not None else parameter.kind
            lines.append(
                f'    "{parameter.name}": {allowed} (default {parameter.default}). {parameter.summary}'
            )
        blocks.append("\n".join(lines))
    return "\n".join(blocks)


def scenes(names: Sequence[str]) -> str:
    """A line for each bundled scene (of `names`, or all): triangles, size if in the cache, files."""
    rows = [("scene", "triangles", "size", "files")]
    for name in _known(names):
        if models.is_built(name):
            folder = models.folder(name)
            size = sum(path.stat().st_size for path in folder.rglob("*") if path.is_file())
            rows.append((name, f"{_triangles(folder):,}", f"{si(size)}B", ", ".join(models.SCENES[name])))
        else:
            rows.append((name, "", "not built yet", ", ".join(models.SCENES[name])))
    widths = [max(len(row[column]) for row in rows) for column in range(3)]
    lines = [
        f"{row[0]:<{widths[0]}}  {row[1]:>{widths[1]}}  {row[2]:>{widths[2]}}  {row[3]}".rstrip()
        for row in rows
    ]
    return "\n".join([*lines, "", f"Built on first use, in {models.cache_folder()}"])


def export(folder: Path, names: Sequence[str]) -> str:
    """Copies the scenes' files (of `names`, or all) below `folder`; their paths, one a line."""
    copies: list[Path] = []
    chosen = _known(names)
    try:
        folder.mkdir(parents=True, exist_ok=True)
        for name in chosen:
            copies += models.export(name, folder)
    except OSError as error:
        where = error.filename or folder
        raise EtendueError(f"{where}: cannot be written: {error.strerror or error}") from error
    return "\n".join(map(str, copies))


def _known(names: Sequence[str]) -> list[str]:
    for name in names:
        if name not in models.SCENES:
            near = nearest_name(name, models.SCENES)
            hint = f'did you mean "{near}"? ' if near else ""
            raise EtendueError(
                f'there is no bundled scene "{name}" ({hint}allowed: {", ".join(models.SCENES)})'
            )
    return list(names or models.SCENES)


def _triangles(folder: Path) -> int:
    return sum(_faces(path) for path in folder.rglob("*.obj"))


def _faces(path: Path) -> int:
    return path.read_bytes().count(b"\nf ")
