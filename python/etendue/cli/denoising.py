"""What `etendue denoise` does."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from pathlib import Path

from .. import outputs
from ..denoise import require
from ..errors import EtendueError
from ..film import file as film_file
from ..film import resuming
from . import stages


def denoise(path: Path, images: Sequence[str], data_dirs: Sequence[Path], threads: int, quiet: bool) -> None:
    """Writes the film of `path` denoised; raises EtendueError."""
    require()
    paths = outputs.check(images)
    if any(image.resolve() == path.resolve() for image in paths):
        raise EtendueError(f"{path}: the film is kept; the denoised image needs another name")
    film = film_file.read(path)
    from .. import scene as scenes

    config, folders = resuming.config_of(film, path, (), data_dirs)
    scene = scenes.load(config, data_dirs=folders)
    resuming.require_same_scene(scene, film, path)

    def say(text: str) -> None:
        if not quiet:
            print(text, file=sys.stderr, flush=True)

    warnings: list[str] = []
    with stages.shown("denoising", say, quiet) as report:
        denoised = scene.denoise(film, threads, report, warnings)
    for warning in warnings:
        say(f"warning: {warning}")
    for image in paths:
        denoised.save(image)
    say(f"{denoised.attributes['denoised']} (biased): {', '.join(map(str, paths))}")
