"""JSON that remembers where everything stood.

The standard parser forgets lines and lets the second of two equal keys win in silence; a scene file's
errors need both. Numbers too large for a float and the words NaN and Infinity are read as such, so that
the scene's own rules can refuse them together with everything else.
"""

from __future__ import annotations

import re
from bisect import bisect_right
from dataclasses import dataclass, field
from json import JSONDecodeError, decoder
from os import PathLike
from typing import Any, NoReturn

from ..errors import Problem, SceneError

Loc = tuple[str | int, ...]

_SPACE = re.compile(r"[ \t\r\n]*")
_NUMBER = re.compile(r"-?(?:0|[1-9][0-9]*)(\.[0-9]+)?([eE][-+]?[0-9]+)?(?![0-9A-Za-z_.+-])")
_WORD = re.compile(r"[^\s,:\[\]{}\"]+")
_WORDS: dict[str, Any] = {
    "true": True,
    "false": False,
    "null": None,
    "NaN": float("nan"),
    "Infinity": float("inf"),
    "-Infinity": float("-inf"),
}
_DEEPEST = 64
_EXCERPT_WIDTH = 100


@dataclass
class LocatedJson:
    """A JSON value, the line (from 1) of every key and value in it, and the keys given twice.

    `duplicates` holds (place, line, line of the first one) for each key that repeats an earlier one.
    """

    value: Any
    key_lines: dict[Loc, int] = field(default_factory=dict)
    value_lines: dict[Loc, int] = field(default_factory=dict)
    duplicates: list[tuple[Loc, int, int]] = field(default_factory=list)

    def line(self, loc: Loc, key: bool = False) -> int | None:
        """The line of the value (or key) at `loc`, else of the innermost thing around it that exists."""
        first, second = (self.key_lines, self.value_lines) if key else (self.value_lines, self.key_lines)
        for length in range(len(loc), -1, -1):
            found = first.get(loc[:length], second.get(loc[:length]))
            if found is not None:
                return found
        return None


def parse(text: str, file: str | PathLike[str] | None = None) -> LocatedJson:
    """Parse `text`; raises SceneError with line, column and the line itself where it is not JSON."""
    return _Parser(text, file).parse()


class _Parser:
    def __init__(self, text: str, file: str | PathLike[str] | None) -> None:
        self.text = text
        self.file = file
        self.line_starts = [0, *(match.end() for match in re.finditer(r"\r\n|\n|\r", text))]
        self.result = LocatedJson(None)

    def parse(self) -> LocatedJson:
        start = self.skip(0)
        if start == len(self.text):
            self.fail(start, "the file is empty, a scene is an object in { }")
        self.result.value, end = self.read_value(start, ())
        end = self.skip(end)
        if end < len(self.text):
            self.fail(end, "something follows after the end of the scene")
        return self.result

    def read_value(self, pos: int, loc: Loc) -> tuple[Any, int]:
        if len(loc) > _DEEPEST:
            self.fail(pos, f"nested more than {_DEEPEST} levels deep")
        self.result.value_lines[loc] = self.line_of(pos)
        character = self.text[pos : pos + 1]
        if character == "{":
            return self.read_object(pos, loc)
        if character == "[":
            return self.read_list(pos, loc)
        if character == '"':
            return self.read_string(pos)
        return self.read_word(pos)

    def read_object(self, start: int, loc: Loc) -> tuple[dict[str, Any], int]:
        members: dict[str, Any] = {}
        pos = self.skip(start + 1)
        if self.text[pos : pos + 1] == "}":
            return members, pos + 1
        while True:
            if self.text[pos : pos + 1] != '"':
                self.fail_at_key(pos, start)
            key_line = self.line_of(pos)
            key, pos = self.read_string(pos)
            here = (*loc, key)
            if key in members:
                self.result.duplicates.append((here, key_line, self.result.key_lines[here]))
            else:
                self.result.key_lines[here] = key_line
            pos = self.skip(pos)
            if self.text[pos : pos + 1] != ":":
                self.fail(pos, f'expected ":" after the key "{key}"')
            members[key], pos = self.read_value(self.skip(pos + 1), here)
            pos, closed = self.read_separator(pos, start, "}")
            if closed:
                return members, pos

    def read_list(self, start: int, loc: Loc) -> tuple[list[Any], int]:
        items: list[Any] = []
        pos = self.skip(start + 1)
        if self.text[pos : pos + 1] == "]":
            return items, pos + 1
        while True:
            item, pos = self.read_value(pos, (*loc, len(items)))
            items.append(item)
            pos, closed = self.read_separator(pos, start, "]")
            if closed:
                return items, pos

    def read_separator(self, pos: int, start: int, closing: str) -> tuple[int, bool]:
        end_of_value, pos = pos, self.skip(pos)
        character = self.text[pos : pos + 1]
        if character == closing:
            return pos + 1, True
        if character == ",":
            following = self.skip(pos + 1)
            if self.text[following : following + 1] == closing:
                self.fail(pos, f'a comma before "{closing}" is one too many')
            return following, False
        if not character:
            self.fail_unclosed(start)
        if character in '"{[' or character.isalnum() or character == "-":
            self.fail(end_of_value, "a comma is missing here")
        self.fail(pos, f'expected "," or "{closing}"')

    def read_string(self, pos: int) -> tuple[str, int]:
        try:
            text, end = decoder.scanstring(self.text, pos + 1, True)  # type: ignore[attr-defined]
            return text, end
        except JSONDecodeError as error:
            reason = error.msg.lower()
            if "unterminated" in reason:
                self.fail(pos, "the text that starts here has no closing quote")
            if "control character" in reason:
                self.fail(
                    error.pos, "a line break or control character inside a text: a closing quote is missing"
                )
            self.fail(error.pos, "a backslash in a text is written \\\\ (or use / in paths)")

    def read_word(self, pos: int) -> tuple[Any, int]:
        match = _NUMBER.match(self.text, pos)
        if match:
            text = match.group()
            whole = match.group(1) is None and match.group(2) is None
            return (int(text) if whole and len(text) < 400 else float(text)), match.end()
        word = _WORD.match(self.text, pos)
        if word and word.group() in _WORDS:
            return _WORDS[word.group()], word.end()
        self.fail_at_value(pos, word.group() if word else self.text[pos : pos + 1])

    def fail_at_value(self, pos: int, found: str) -> NoReturn:
        if not found:
            self.fail(pos, "the file ends where a value is expected")
        if found.startswith(("//", "/*", "#")):
            self.fail(pos, "JSON has no comments")
        if found.startswith("'"):
            self.fail(pos, 'texts stand in double quotes ("), not single ones')
        if found.lower() in ("true", "false", "null", "none"):
            correct = "null" if found.lower() == "none" else found.lower()
            self.fail(pos, f'"{found}" is written {correct}')
        if found[0].isdigit() or found[0] in "+-.":
            self.fail(pos, f'"{found}" is not a number as JSON writes it (0.5, -2, 1e-3)')
        if found in (",", ":", "}", "]"):
            self.fail(pos, f'a value is expected before "{found}"')
        self.fail(
            pos, "a value is expected: a number, true, false, null, a text in double quotes, [ ] or { }"
        )

    def fail_at_key(self, pos: int, start: int) -> NoReturn:
        character = self.text[pos : pos + 1]
        if not character:
            self.fail_unclosed(start)
        if self.text.startswith(("//", "/*", "#"), pos):
            self.fail(pos, "JSON has no comments")
        if character == ",":
            self.fail(pos, "this comma is one too many")
        self.fail(pos, "a key in double quotes is expected")

    def fail_unclosed(self, start: int) -> NoReturn:
        self.fail(start, f'this "{self.text[start]}" is never closed')

    def fail(self, pos: int, message: str) -> NoReturn:
        line = self.line_of(pos)
        start = self.line_starts[line - 1]
        content = re.split(r"[\r\n]", self.text[start:], maxsplit=1)[0].replace("\t", " ")
        column = min(pos - start, len(content))
        first = max(0, column - _EXCERPT_WIDTH // 2)
        excerpt = (
            f"    {content[first : first + _EXCERPT_WIDTH]}\n    {' ' * (column - first)}^"
            if content
            else None
        )
        raise SceneError([Problem(message, self.file, line, column=column + 1, excerpt=excerpt)])

    def skip(self, pos: int) -> int:
        match = _SPACE.match(self.text, pos)
        return match.end() if match else pos

    def line_of(self, pos: int) -> int:
        return bisect_right(self.line_starts, pos)
