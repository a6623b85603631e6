"""What is compared: estimators, each a name and the keys of the scene file that it sets."""

from __future__ import annotations

import dataclasses
import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from os import PathLike
from pathlib import Path
from typing import Any

from ..config import Config
from ..config.overrides import Override
from ..errors import EtendueError, nearest_name

PRESETS: dict[str, dict[str, Any]] = {
    "naive": {"algorithm": "NaivePathtracer"},
    "nee": {"algorithm": "Pathtracer", "mis": "none"},
    "mis": {"algorithm": "Pathtracer", "mis": "power"},
    "balance": {"algorithm": "Pathtracer", "mis": "balance"},
}
DEFAULT = ("naive", "nee", "mis")
# What all estimators of one comparison share.
_SHARED = ("seed", "framebuffer", "beauty_render", "error_eps")


@dataclass(frozen=True)
class Estimator:
    """A name, and the values of keys (as of --set) that make the estimator from the scene file."""

    name: str
    settings: Mapping[str, Any] = field(default_factory=dict)

    def config(self, base: Config) -> Config:
        """`base` with this estimator's keys; raises SceneError for a key or value that is not allowed."""
        overrides = [Override(key, value, f"estimator {self.name}") for key, value in self.settings.items()]
        return base.with_overrides(overrides) if overrides else base


Choice = str | Estimator | Mapping[str, Any]


def parse(text: str) -> list[Estimator]:
    """What `--estimators` names: presets and algorithms with commas between them, or a JSON file."""
    if text.lower().endswith(".json"):
        return read(text)
    return chosen([name.strip() for name in text.split(",") if name.strip()])


def read(path: str | PathLike[str]) -> list[Estimator]:
    """The estimators in a JSON file: {"name": {"key": value, ...}, ...}."""
    file = Path(path)
    try:
        data = json.loads(file.read_text(encoding="utf-8-sig"))
    except OSError as error:
        raise EtendueError(f"{file}: cannot be read: {error.strerror or error}") from None
    except ValueError as error:
        raise EtendueError(f"{file}: not a JSON file in UTF-8 ({error})") from None
    if not isinstance(data, dict):
        raise EtendueError(f'{file}: {{"name": {{"key": value}}}} is needed, an object of estimators by name')
    return _named(data, f"{file}: ")


def chosen(choice: Sequence[Choice] | Mapping[str, Mapping[str, Any]]) -> list[Estimator]:
    """Estimators from a mapping of names to keys, or a list of names and Estimators."""
    if isinstance(choice, Mapping):
        return _named(choice, "")
    found = [each if isinstance(each, Estimator) else _by_name(str(each)) for each in choice]
    return _checked(found, "")


def _named(data: Mapping[str, Any], place: str) -> list[Estimator]:
    wrong = [name for name, settings in data.items() if not isinstance(settings, Mapping)]
    if wrong:
        raise EtendueError(f'{place}estimator {wrong[0]}: an object of keys, as {{"mis": "none"}}, is needed')
    return _checked([Estimator(name, dict(settings)) for name, settings in data.items()], place)


def _by_name(name: str) -> Estimator:
    from .. import _core

    if name in PRESETS:
        return Estimator(name, PRESETS[name])
    algorithms = [info.name for info in _core.algorithms()]
    if name in algorithms:
        return Estimator(name, {"algorithm": name})
    known = [*PRESETS, *algorithms]
    near = nearest_name(name, known)
    hint = f'did you mean "{near}"? ' if near else ""
    raise EtendueError(
        f'there is no estimator "{name}" ({hint}allowed: {", ".join(known)}, or a file whose name ends in .json)'
    )


def _checked(estimators: list[Estimator], place: str) -> list[Estimator]:
    names = [estimator.name for estimator in estimators]
    if not names:
        raise EtendueError(f"{place}estimators: at least one is needed")
    for name in names:
        if not name.strip() or len(name) > 100:
            raise EtendueError(f"{place}estimators: a name of 1 to 100 characters is needed, not {name!r}")
        if names.count(name) > 1:
            raise EtendueError(f'{place}estimators: the name "{name}" is there twice')
    for estimator in estimators:
        for key in estimator.settings:
            if key.split(".")[0].split("[")[0] in _SHARED:
                raise EtendueError(
                    f"{place}estimator {estimator.name}: {key} is the same for all that are compared; set it by "
                    "an option of the command"
                )
    return [dataclasses.replace(estimator, settings=dict(estimator.settings)) for estimator in estimators]
