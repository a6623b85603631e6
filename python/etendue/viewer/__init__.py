"""The interactive window: `etendue view`.

`session`, `viewer` and what they use know no window, and can be used without one; `window` and the rest need
the extra etendue[viewer], which nothing else imports.
"""

from __future__ import annotations

import importlib.util
import sys

from ..errors import EtendueError

_NEEDED = ("imgui_bundle", "glfw")
_OLDEST = (3, 11)  # that Dear ImGui's package is made for


def require_extra() -> None:
    """Raises EtendueError with the command that installs it where the extra etendue[viewer] is missing."""
    if sys.version_info < _OLDEST:
        raise EtendueError("view: the window needs Python 3.11 or newer")
    missing = [name for name in _NEEDED if importlib.util.find_spec(name) is None]
    if missing:
        raise EtendueError(
            f"view: {' and '.join(missing)} not installed; the command that installs what the viewer needs is: "
            'pip install "etendue[viewer]"'
        )
