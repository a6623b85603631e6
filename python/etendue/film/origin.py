"""What a film is of: the scene, the settings, and where both came from."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..config.patches import PATCHED, merged
from ..errors import EtendueError

if TYPE_CHECKING:
    from ..config import Config
    from . import Attribute, Film
    from .fingerprint import Contents

_MOST_DIFFERENCES = 12
# Top-level settings that are no parameters of the algorithm.
_OTHERS = ("algorithm", "sampler", "filter", "seed", "auto_focus")


@dataclass(frozen=True)
class Origin:
    """What a film is of.

    config: the scene file's plain data, with every change that options made. scene_file: where it was, "" if
    nowhere. data_dirs: folders in which its files were looked for. settings: each key with an influence on
    samples, and its value. files: for each place in the scene, name and digest of what was loaded there.
    version: of the Étendue that rendered.
    """

    config: dict[str, Any]
    scene_file: str = ""
    data_dirs: tuple[str, ...] = ()
    settings: dict[str, Any] = field(default_factory=dict)
    files: dict[str, list[str]] = field(default_factory=dict)
    version: str = ""

    @classmethod
    def of(cls, config: Config, contents: Contents, data_dirs: Sequence[str | PathLike[str]]) -> Origin:
        """The origin of films that `config` gives with these contents of its files."""
        from .. import __version__

        return cls(
            config.data,
            "" if config.path is None else str(config.path.resolve()),
            tuple(dict.fromkeys(str(Path(folder).resolve()) for folder in data_dirs)),
            # As they will be when they have been in a file.
            json.loads(json.dumps(dict(_settings(config)))),
            {key: list(content) for key, content in contents.items()},
            __version__,
        )

    @property
    def scene_name(self) -> str:
        """The scene file's name without folder and extension."""
        return Path(self.scene_file).stem or "scene"

    @property
    def scene_hash(self) -> str:
        """One hash over all that decides what a sample is, but for the version."""
        digests = {key: digest for key, (_, digest) in self.files.items()}
        return hashlib.sha256(json.dumps([self.settings, digests], sort_keys=True).encode()).hexdigest()

    @property
    def parameters(self) -> dict[str, Any]:
        """The values of the algorithm's parameters."""
        return {key: value for key, value in self.settings.items() if "." not in key and key not in _OTHERS}

    def differences(self, other: Origin, here: str, there: str) -> list[str]:
        """What keeps films of the two apart, a line each; `here` and `there` say which is which."""
        found = []
        if self.version != other.version:
            found.append(f"Étendue's version: {self.version} {here}, {other.version} {there}")
        for key in dict.fromkeys((*self.settings, *other.settings)):
            mine_text, its_text = _shown(key, self.settings), _shown(key, other.settings)
            if mine_text != its_text:
                found.append(f"{key}: {mine_text} {here}, {its_text} {there}")
        for key in dict.fromkeys((*self.files, *other.files)):
            mine, its = self.files.get(key), other.files.get(key)
            if mine is None or its is None:
                name = (mine or its or [""])[0]
                found.append(f"{name} ({key}): only {there if mine is None else here}")
            elif mine[1] != its[1]:
                names = mine[0] if mine[0] == its[0] else f"{mine[0]} {here}, {its[0]} {there}"
                found.append(f"{names} ({key}): the content differs")
        return found

    def require_same(self, other: Origin, refusal: str, here: str, there: str) -> None:
        """Raises EtendueError with `refusal` and the differences, if there are any."""
        found = self.differences(other, here, there)
        if found:
            more = len(found) - _MOST_DIFFERENCES
            lines = found[:_MOST_DIFFERENCES] + ([f"and {more} more"] if more > 0 else [])
            raise EtendueError("\n  ".join([f"{refusal}:", *lines]))


def attributes_of(film: Film) -> dict[str, Attribute]:
    """How `film` was made, for files of it; nothing of a film without an origin."""
    origin = film.origin
    if origin is None:
        return {}
    text = json.dumps(origin.config, ensure_ascii=False)
    settings = origin.settings
    return {
        "version": origin.version,
        "scene": Path(origin.scene_file).name,
        "config": text,
        "config_sha256": hashlib.sha256(text.encode()).hexdigest(),
        "algorithm": settings["algorithm"],
        "parameters": json.dumps(origin.parameters),
        "sampler": settings["sampler"],
        "filter": settings["filter"],
        "seed": settings["seed"],
        "spp": float(film.spp),
        "rays": film.rays,
        "seconds": float(film.seconds),
        "invalid_samples": film.invalid_count,
        "complete": int(film.complete),
    }


def _shown(key: str, settings: dict[str, Any]) -> str:
    return json.dumps(settings[key], ensure_ascii=False) if key in settings else "not set"


def _settings(config: Config) -> Iterator[tuple[str, Any]]:
    """Every key with an influence on what a sample is. How many there are and how they are shown has none."""
    yield "algorithm", config.algorithm
    yield from config.parameters().items()
    yield from (("sampler", config.sampler), ("filter", config.filter), ("seed", config.seed))
    size = config.framebuffer.res_w, config.framebuffer.res_h
    yield from zip(("framebuffer.res_w", "framebuffer.res_h"), size, strict=True)
    camera = config.camera.model_dump()
    if config.camera.perspective:
        yield "auto_focus", config.auto_focus
        if config.auto_focus:
            del camera["focal_depth"]
    for key, value in camera.items():
        yield f"camera.{key}", value
    sky = config.scene.sky
    yield "scene.sky", None if sky is None else "present"
    if sky is not None:
        yield from (("scene.sky.intensity", sky.intensity), ("scene.sky.scene_radius", sky.scene_radius))
    for name, patch in sorted(merged(config.scene.materials).items()):
        for key in PATCHED:
            if getattr(patch, key) is not None:
                yield f"scene.materials[{name}].{key}", getattr(patch, key)
