"""Builds of the core other than the installed one: with mutants, with sanitizers, for other processors."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent


def build(folder: Path, target: str, *options: str, sources: Path = ROOT) -> Path:
    """`folder` with `target` built there, or brought up to date; RuntimeError with what went wrong."""
    import nanobind

    _run(
        *("cmake", "-S", sources, "-B", folder, "-G", "Ninja", f"-DPython_EXECUTABLE={sys.executable}"),
        *(f"-Dnanobind_DIR={nanobind.cmake_dir()}", *options),
    )
    _run("cmake", "--build", folder, "--target", target)
    return folder


def core_in(folder: Path) -> Path:
    """The compiled module of a build."""
    return next(folder.glob("_core*.so"))


def _run(*command: object) -> None:
    words = [str(word) for word in command]
    done = subprocess.run(words, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    if done.returncode:
        raise RuntimeError(f"{' '.join(words)}:\n{done.stdout[-4000:]}")
