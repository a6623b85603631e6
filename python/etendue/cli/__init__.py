"""The command `etendue`."""

from __future__ import annotations

from typing import Any


def main(arguments: list[str] | None = None) -> Any:
    """Run the command with `arguments` (those of the process by default) and exit with its code."""
    from . import commands  # noqa: F401 (they declare themselves)
    from .app import app

    return app(args=arguments, prog_name="etendue")
