"""`--set KEY=VALUE`, and the options that stand for one key: changes to a scene's data before it is checked.

A key is a path of names and numbers: `rr_threshold`, `scene.sky.intensity`, `scene.materials.0.roughness`,
`scene.materials[floor].roughness`. In brackets stands an index or the name of a material, which may hold
dots; a material that has no patch yet gets one. A value is read as JSON, else taken as a text.
"""

from __future__ import annotations

import copy
import json
import re
from collections.abc import Iterable
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

from ..errors import Problem, nearest_name
from .located_json import Loc
from .problems import path_text

_STEP = re.compile(r"(?:^|\.)(?P<name>[^.\[\]]+)|\[(?P<inside>\"[^\"]*\"|[^\]]+)\]")


@dataclass(frozen=True)
class Override:
    """One key set to a plain value; `place` is what messages name as its origin, e.g. "--spp"."""

    key: str
    value: Any
    place: str = "--set"


class _Refused(Exception):
    """Why an override cannot be applied."""


def apply(data: Any, overrides: Iterable[str | Override]) -> tuple[Any, dict[Loc, str], list[Problem]]:
    """A copy of `data` with the overrides applied in order, the option behind each change, and problems."""
    data = copy.deepcopy(data)
    places: dict[Loc, str] = {}
    problems: list[Problem] = []
    for override in overrides:
        try:
            if isinstance(override, str):
                override = _parse(override)
            places[_set(data, override.key, override.value)] = override.place
        except _Refused as refused:
            text = override if isinstance(override, str) else f"{override.key}={override.value}"
            problems.append(Problem(str(refused), f"--set {text}"))
    return data, places, problems


def _parse(text: str) -> Override:
    key, equals, value = text.partition("=")
    if not equals:
        raise _Refused("a key, an equals sign and a value are needed, as in rr_threshold=0.5")
    return Override(key.strip(), _value(value))


def _value(text: str) -> Any:
    try:
        return json.loads(text)
    except ValueError:
        return text
    except RecursionError:
        raise _Refused("nested too deeply") from None


def _steps(key: str) -> list[str]:
    steps: list[str] = []
    end = 0
    while end < len(key):
        match = _STEP.match(key, end)
        if match is None:
            raise _Refused(
                f"cannot read the key at {key[end:]!r}; keys look like scene.materials[floor].roughness"
            )
        name, inside = match.group("name"), match.group("inside")
        steps.append(name if name is not None else f"[{inside}")
        end = match.end()
    if not steps:
        raise _Refused("the key is missing before the equals sign")
    return steps


def _set(data: Any, key: str, value: Any) -> Loc:
    steps = _steps(key)
    here: Any = data
    loc: Loc = ()
    for step, following in pairwise(steps):
        position = _position(here, loc, step)
        if isinstance(here, dict) and here.get(position) is None:
            # Setting something inside a section that is absent or null brings the section into being.
            here[position] = [] if following.startswith("[") else {}
        here, loc = here[position], (*loc, position)
    position = _position(here, loc, steps[-1])
    here[position] = value
    return (*loc, position)


def _position(container: Any, loc: Loc, step: str) -> str | int:
    """The dict key or list index that `step` means in `container`; a material without a patch is appended."""
    in_brackets = step.startswith("[")
    name = step.removeprefix("[")
    where = path_text(loc) or "the scene file"
    if isinstance(container, dict):
        if in_brackets:
            raise _Refused(f"{where} is no list; its keys are given with a dot")
        return name
    if not isinstance(container, list):
        raise _Refused(f"{where} is a single value, with nothing inside it to set")
    if re.fullmatch(r"-?[0-9]+", name):
        index = int(name)
        if not 0 <= index < len(container):
            held = f"0 to {len(container) - 1}" if container else "none, the list is empty"
            raise _Refused(f"{where} has no item {index} (allowed: {held})")
        return index
    if loc != ("scene", "materials"):
        raise _Refused(f"{where} is a list; its items are given by number, from 0")
    return _material(container, name.strip('"'), appendable=in_brackets)


def _material(patches: list[Any], name: str, appendable: bool) -> int:
    names = [patch.get("name") if isinstance(patch, dict) else None for patch in patches]
    if name in names:
        # Of two patches for one material the later has the last word.
        return len(names) - 1 - names[::-1].index(name)
    if not appendable:
        near = nearest_name(name, [known for known in names if isinstance(known, str)])
        hint = f'; did you mean "{near}"?' if near else ""
        raise _Refused(f'no material "{name}" is patched in scene.materials{hint}')
    patches.append({"name": name})
    return len(patches) - 1
