"""Scenes of configs that follow each other: what two have in common is loaded once."""

from __future__ import annotations

import threading
from collections.abc import Sequence
from os import PathLike

from .. import scene as loading
from ..config import Config
from ..scene import Scene


class Scenes:
    """The scenes of a window; several renders may ask for theirs at the same time."""

    def __init__(self, data_dirs: Sequence[str | PathLike[str]] = ()) -> None:
        self._data_dirs = data_dirs
        self._lock = threading.Lock()
        self._last: Scene | None = None

    def get(self, config: Config) -> Scene:
        """The scene of `config`; raises SceneError with every problem."""
        with self._lock:
            last = self._last
            self._last = loading.load(config, self._data_dirs) if last is None else last.changed(config)
            return self._last
