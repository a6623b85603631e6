"""The folder of a comparison: the report, the results, and the finished repeats, from which it can go on."""

from __future__ import annotations

import json
import re
from pathlib import Path

from .. import outputs
from ..errors import EtendueError
from ..film import file as film_file
from ..film.origin import Origin
from .tally import Point, Repeat

_MARK = "comparison.json"


class Folder:
    """Made by `Folder.open`. `parts` holds a film and a curve for each finished repeat."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self.parts = path / "parts"
        self.index = path / "index.html"
        self.results = path / "results.json"

    @classmethod
    def open(cls, path: Path) -> Folder:
        """The folder, made where it is missing; EtendueError for one that holds anything else."""
        folder = cls(path)
        try:
            if path.exists() and not path.is_dir():
                raise EtendueError(f"{path}: a folder is needed, and this is a file")
            there = sorted(entry.name for entry in path.iterdir()) if path.exists() else []
            if there and not (folder.parts / _MARK).exists():
                raise EtendueError(
                    f"{path}: the folder holds something else ({there[0]}); name one that is empty or new"
                )
            folder.parts.mkdir(parents=True, exist_ok=True)
            (folder.parts / _MARK).touch()
        except OSError as error:
            raise EtendueError(f"{path}: cannot be written: {error.strerror or error}") from None
        return folder

    def find(self, name: str, origin: Origin, goal: str, reference: str) -> Repeat | None:
        """The repeat of this origin, if it was finished against the same reference."""
        film_path, curve_path = self._places(name, origin, goal)
        try:
            kept = json.loads(curve_path.read_text())
            if kept["reference"] != reference:
                return None
            film = film_file.read(film_path)
            curve = [Point(**point) for point in kept["curve"]]
        except (EtendueError, OSError, ValueError, KeyError, TypeError):
            return None
        same = film.origin is not None and not film.origin.differences(origin, "", "")
        return Repeat(film, curve) if same and curve and curve[-1].spp == film.spp else None

    def keep(self, name: str, repeat: Repeat, goal: str, reference: str) -> None:
        """Keeps a finished repeat."""
        film, curve = repeat.film, repeat.curve
        assert film.origin is not None
        film_path, curve_path = self._places(name, film.origin, goal)
        film.write(film_path)
        kept = {"reference": reference, "curve": [point.as_dict() for point in curve]}
        outputs.write(curve_path, lambda path: path.write_text(json.dumps(kept)))

    def _places(self, name: str, origin: Origin, goal: str) -> tuple[Path, Path]:
        readable = re.sub(r"[^A-Za-z0-9_-]+", "-", name)[:40].strip("-") or "estimator"
        stem = f"{readable}-{goal}-seed{origin.settings['seed']}-{origin.scene_hash[:12]}"
        return self.parts / f"{stem}.film.exr", self.parts / f"{stem}.json"
