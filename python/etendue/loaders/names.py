"""Files that other files name, often from another operating system."""

from __future__ import annotations

import os
from pathlib import Path


def find_beside(folder: Path, name: str) -> Path | None:
    """The file that `name` means in a file of `folder`, or None.

    Tolerates quotes, backslashes, another case of letters, and absolute paths of another machine (of which
    the last part is then looked for in `folder`).
    """
    name = name.strip().strip('"')
    for candidate in dict.fromkeys((name, name.replace("\\", "/"))):
        if not candidate:
            continue
        try:
            found = folder / candidate
            if found.is_file():
                return found
        except (OSError, ValueError):
            continue
    plain = name.replace("\\", "/")
    is_absolute = plain.startswith("/") or plain[1:2] == ":"
    return _any_case(folder, plain.rsplit("/", 1)[-1] if is_absolute else plain)


def _any_case(folder: Path, name: str) -> Path | None:
    here = folder
    for part in name.split("/"):
        if part in ("", "."):
            continue
        if part == "..":
            here = here / part
            continue
        try:
            entries = sorted(os.listdir(here))
        except (OSError, ValueError):
            return None
        exact = part if part in entries else None
        match = exact or next((entry for entry in entries if entry.lower() == part.lower()), None)
        if match is None:
            return None
        here = here / match
    return here if here.is_file() else None
