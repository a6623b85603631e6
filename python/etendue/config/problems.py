"""From what pydantic found in a scene file to problems a person can act on."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from os import PathLike
from typing import Any

from pydantic_core import ErrorDetails

from ..errors import MISSING, Problem, nearest_name
from . import schema
from .located_json import Loc, LocatedJson

# Algorithms that the exercise's later sheets write: right names, for which an honest answer is due.
LATER_ALGORITHMS = ("Bidirectional", "VolumetricPathtracer", "PhotonMapping", "LightCuts")

_OUT_OF_RANGE = {"greater_than", "greater_than_equal", "less_than", "less_than_equal"}


def path_text(loc: Loc) -> str:
    """`("scene", "materials", 3, "roughness")` as `scene.materials[3].roughness`."""
    text = ""
    for step in loc:
        text += f"[{step}]" if isinstance(step, int) else f".{step}" if text else step
    return text


@dataclass(frozen=True)
class Source:
    """Where a config's values came from: lines of a file, and options such as `--set` that replaced some."""

    file: str | PathLike[str] | None = None
    located: LocatedJson = field(default_factory=lambda: LocatedJson(None))
    overridden: Mapping[Loc, str] = field(default_factory=dict)

    def problem(
        self, loc: Loc, message: str, *, key: bool = False, because_of: Loc | None = None, **more: Any
    ) -> Problem:
        """A problem at `loc`, told with the place that its value came from.

        key: the key itself is at fault, not its value. because_of: another value that took part in it.
        """
        for place in (loc, because_of):
            option = None if place is None else self._option(place)
            if option is not None:
                return Problem(message, option, None, path_text(loc), **more)
        line = self.located.line(loc, key) if self.file is not None else None
        return Problem(message, self.file, line, path_text(loc) or None, **more)

    def _option(self, loc: Loc) -> str | None:
        # An option inside something that the file does not have made that as well.
        absent = loc not in self.located.value_lines
        for place, option in self.overridden.items():
            if loc[: len(place)] == place or (absent and place[: len(loc)] == loc):
                return option
        return None


def duplicate_problems(source: Source) -> list[Problem]:
    """One problem for each key given twice in the same object."""
    return [
        Problem(f"this key is given twice, first on line {first}", source.file, line, path_text(loc))
        for loc, line, first in source.located.duplicates
    ]


def problems_of(errors: Iterable[ErrorDetails], root: schema.Schema, source: Source) -> list[Problem]:
    """Problems for pydantic's `errors`; `root` is the JSON Schema of the scene file."""
    return [_problem(error, root, source) for error in errors]


def _problem(error: ErrorDetails, root: schema.Schema, source: Source) -> Problem:
    loc: Loc = tuple(error["loc"])
    kind, value = error["type"], error["input"]
    if kind == "extra_forbidden":
        return _unknown_key(loc, root, source)
    if kind == "missing":
        return source.problem(loc, "this key is missing", allowed=_allowed(root, loc))
    if kind == "parallel":
        return source.problem(loc, error["msg"], value=list(value), because_of=(*loc[:-1], "dir"))
    if kind in ("number_of_values", "zero_vector"):
        return source.problem(loc, error["msg"], value=list(value))
    if kind == "single_precision":
        return source.problem(loc, error["msg"], value=value)
    if kind == "finite_number":
        return source.problem(loc, "not a finite number", value=value, allowed=_allowed(root, loc))
    if kind == "literal_error" and isinstance(value, str):
        return _unknown_choice(loc, value, root, source)
    if kind in _OUT_OF_RANGE or (
        kind == "int_type" and isinstance(value, int) and not isinstance(value, bool)
    ):
        return source.problem(loc, "out of range", value=value, allowed=_allowed(root, loc))
    if kind == "string_too_short":
        return source.problem(loc, "empty", value=value, allowed=_allowed(root, loc))
    return source.problem(loc, "wrong type", value=_short(value), allowed=_allowed(root, loc))


def _unknown_key(loc: Loc, root: schema.Schema, source: Source) -> Problem:
    name, siblings = str(loc[-1]), schema.keys_at(root, loc[:-1])
    siblings = [sibling for sibling in siblings if not sibling.startswith("$")]
    nearest = nearest_name(name, siblings)
    if nearest is None:
        elsewhere = [path for path, _ in schema.all_keys(root) if path.rsplit(".", 1)[-1] == name]
        nearest = elsewhere[0] if len(elsewhere) == 1 else None
    return source.problem(loc, "unknown key", key=True, nearest=nearest, allowed=", ".join(siblings))


def _unknown_choice(loc: Loc, value: str, root: schema.Schema, source: Source) -> Problem:
    node = schema.node_at(root, loc)
    choices = [str(choice) for choice in schema.choices(root, node)] if node else []
    message = "unknown value"
    if loc == ("algorithm",):
        if value in LATER_ALGORITHMS:
            message = "Étendue has no such algorithm; it belongs to a later exercise sheet"
            return source.problem(loc, message, value=value, allowed=", ".join(choices))
        message = "unknown algorithm"
    return source.problem(
        loc, message, value=value, nearest=nearest_name(value, choices), allowed=", ".join(choices)
    )


def _allowed(root: schema.Schema, loc: Loc) -> str | None:
    node = schema.node_at(root, loc)
    return None if node is None else schema.describe(root, node)


def _short(value: Any) -> Any:
    # A whole section in place of a number would bury the message.
    return MISSING if isinstance(value, dict) and value else value
