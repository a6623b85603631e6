"""What `etendue replay` does."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from pathlib import Path

from ..config import read_config
from ..config.overrides import Override
from ..errors import EtendueError


def replay(
    path: Path,
    pixel: tuple[int, int],
    sample: int,
    output: Path | None,
    overrides: Sequence[str | Override],
    data_dirs: Sequence[Path],
) -> str:
    """The path in lines for people, after drawing it to `output`; raises EtendueError."""
    from .. import scene as scenes

    if output is not None and output.suffix.lower() != ".svg":
        raise EtendueError(f'{output}: paths are drawn as .svg, not as "{output.suffix}"')
    config = read_config(path, overrides, data_dirs)
    for name in config.scenes_to_build(data_dirs):
        print(f"building the bundled scene {name}, this once", file=sys.stderr, flush=True)
    scene = scenes.load(config, data_dirs=data_dirs)
    told = scene.replay(pixel, sample)
    if output is not None:
        told.save(output, scene)
    return str(told)
