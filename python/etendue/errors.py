"""Errors that a user can cause, and how they are told.

Every such error is an `EtendueError` whose `str()` is the whole message. The command prints it on
stderr and exits with code 2, without a traceback; from Python it is an ordinary exception.
"""

from __future__ import annotations

import difflib
import json
from collections.abc import Iterable
from dataclasses import dataclass
from os import PathLike
from typing import Any


class _Missing:
    """Says that a problem has no offending value; None and null are values."""

    def __repr__(self) -> str:
        return "<no value>"


MISSING: Any = _Missing()
_LONGEST_VALUE = 60


def show_value(value: Any) -> str:
    """`value` as it would stand in a scene file, shortened to one readable line."""
    try:
        text = json.dumps(value, ensure_ascii=False)
    except (TypeError, ValueError):
        text = repr(value)
    return text if len(text) <= _LONGEST_VALUE else text[: _LONGEST_VALUE - 4] + " ..."


def nearest_name(name: str, known: Iterable[str], cutoff: float = 0.6) -> str | None:
    """The known name that `name` was most likely meant to be, or None where none is as alike as `cutoff`."""
    by_lower_case: dict[str, str] = {}
    for candidate in known:
        by_lower_case.setdefault(candidate.lower(), candidate)
    wanted = name.lower()
    matches = difflib.get_close_matches(wanted, list(by_lower_case), n=1, cutoff=cutoff)
    if matches:
        return by_lower_case[matches[0]]
    # Somebody who writes "width" or "samples" for a longer name is helped by the part that agrees.
    inside = [
        known_name for lower, known_name in by_lower_case.items() if len(wanted) > 2 and wanted in lower
    ]
    return inside[0] if len(inside) == 1 else None


@dataclass(frozen=True)
class Problem:
    """One thing that is wrong, or, in a list of warnings, worth knowing.

    message: what is wrong, without a full stop.
    file, line, column: where it stands; line and column count from 1. `file` may also be "--set".
    path: the place inside the scene file, e.g. `scene.materials[3].roughness`.
    value: the offending value; allowed: what may stand there; nearest: the known name closest to it.
    excerpt: lines shown below the message, e.g. the line of a syntax error with a caret.
    """

    message: str
    file: str | PathLike[str] | None = None
    line: int | None = None
    path: str | None = None
    value: Any = MISSING
    allowed: str | None = None
    nearest: str | None = None
    column: int | None = None
    excerpt: str | None = None

    def __str__(self) -> str:
        place = "" if self.file is None else str(self.file)
        for number in (self.line, self.column):
            if place and number is not None:
                place += f":{number}"
        head = "".join(f"{part}: " for part in (place, self.path) if part)
        hints = []
        if self.value is not MISSING:
            hints.append(f"got {show_value(self.value)};")
        if self.nearest is not None:
            hints.append(f'did you mean "{self.nearest}"?')
        if self.allowed is not None:
            hints.append(f"allowed: {self.allowed}")
        text = head + self.message
        if hints:
            text += f" ({' '.join(hints).rstrip(';')})"
        return text if self.excerpt is None else f"{text}\n{self.excerpt}"


class EtendueError(Exception):
    """An error that a user can cause and mend; `str()` is the whole message, perhaps of several lines."""


class SceneError(EtendueError):
    """A scene that cannot be rendered as it is written. `problems` holds everything found, at once."""

    def __init__(self, problems: Iterable[Problem | str]) -> None:
        self.problems: list[Problem] = [
            problem if isinstance(problem, Problem) else Problem(problem) for problem in problems
        ]
        super().__init__("\n".join(str(problem) for problem in self.problems))
