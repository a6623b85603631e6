"""The subcommands: the options of each. What they do stands in the modules one folder up.

Nothing heavy is imported before a command needs it, so that `--help` and mistyped options answer at once.
"""

# In the order of `etendue --help`.
from . import render, view, compare, films, denoise, replay, information  # noqa: F401, I001
