"""The bundled scenes: modelled in code, built once into the user's cache.

Every scene is a module here with a function `build(folder)` that writes the files it lists in `FILES`,
under the names that the scene files of the exercise use.
"""

from __future__ import annotations

import hashlib
import importlib
import os
import shutil
import tempfile
from pathlib import Path

# Scene -> the files that scene files refer to.  Kept here so that looking a name up imports no model.
SCENES: dict[str, tuple[str, ...]] = {
    "box": ("CornellBox-Original.obj",),
    "pots": ("checkerpots/checkerpots.obj", "envmaps/sunset.hdr"),
    "sibenik": ("sibenik/sibenik_base.obj", "sibenik/sibenik_light_dome.obj"),
    "spz": ("sponza/sponza_light.obj", "sponza/sponza_base.obj"),
    "fireplace": ("fireplace/fireplace_room.obj",),
    "mis": ("mis.obj",),
}


def cache_folder() -> Path:
    """Where built scenes live: `$ETENDUE_CACHE`, else `etendue` under `$XDG_CACHE_HOME` or `~/.cache`.

    Falls back to a folder of the user's under the system's temporary folder where that cannot be written.
    """
    chosen = os.environ.get("ETENDUE_CACHE")
    if chosen:
        return Path(chosen)
    base = Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "etendue"
    try:
        base.mkdir(parents=True, exist_ok=True)
        if os.access(base, os.W_OK):
            return base
    except OSError:
        pass
    return Path(tempfile.gettempdir()) / f"etendue-{os.getuid()}"


def folder(scene: str) -> Path:
    """The folder of a bundled scene's files; its name changes with the code that models it."""
    here = Path(__file__).parent
    sources = sorted([here / f"{scene}.py", *here.glob(f"_{scene}*.py"), here / "mesh.py", here / "model.py"])
    digest = hashlib.sha256(b"".join(p.read_bytes() for p in sources)).hexdigest()[:12]
    return cache_folder() / "scenes" / f"{scene}-{digest}"


def is_built(scene: str) -> bool:
    """Whether the scene's files are in the cache."""
    return folder(scene).is_dir()


def build(scene: str) -> Path:
    """The folder with the scene's files, modelling them first where the cache lacks them.

    The folder appears whole or not at all, so that two processes may build at once.
    """
    target = folder(scene)
    if target.is_dir():
        return target
    target.parent.mkdir(parents=True, exist_ok=True)
    work = Path(tempfile.mkdtemp(prefix=f"{scene}-", dir=target.parent))
    try:
        importlib.import_module(f"etendue.models.{scene}").build(work)
        work.chmod(0o755)
        try:
            work.rename(target)
        except OSError:
            if not target.is_dir():
                raise
    finally:
        shutil.rmtree(work, ignore_errors=True)
    return target


def find(name: str) -> Path | None:
    """The path of a bundled scene's file by the name that scene files use, or None."""
    wanted = Path(name).as_posix().removeprefix("./")
    for scene, files in SCENES.items():
        if wanted in files:
            return build(scene) / wanted
    return None


def export(scene: str, to: Path) -> list[Path]:
    """Copies the scene's files below `to` and gives back their paths."""
    source = build(scene)
    copies = []
    for path in sorted(p for p in source.rglob("*") if p.is_file()):
        copy = to / path.relative_to(source)
        copy.parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(path, copy)
        copies.append(copy)
    return copies
