"""The scene file that the window shows and changes."""

from __future__ import annotations

import copy
import json
import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from .. import outputs
from ..config import Config, json_schema
from ..config.files import named
from ..config.located_json import Loc
from ..config.schema import Schema, node_at, resolve
from .history import History

EMPTY: dict[str, Any] = {"scene": {"mesh_files": [], "sky": {"intensity": 1.0}}}


class Document:
    """A config and its history. A change is a change of the scene file's plain data, checked like the file.

    A change that is not allowed raises SceneError and leaves everything as it was.
    """

    def __init__(self, config: Config | None = None) -> None:
        self._history = History(config or Config.from_data(EMPTY))
        self._saved = self.config
        self._schema = json_schema()

    @property
    def config(self) -> Config:
        """The config as it is now."""
        return self._history.state

    @property
    def name(self) -> str:
        """The scene file's name without folder and extension."""
        return self.config.path.stem if self.config.path is not None else "scene"

    @property
    def is_changed(self) -> bool:
        """Whether there is something to save."""
        return self.config.data != self._saved.data

    def schema(self, loc: Loc) -> Schema:
        """The JSON Schema of the value at `loc`, with its title, description and limits."""
        node = node_at(self._schema, loc)
        if node is None:
            raise KeyError(loc)
        return {**resolve(self._schema, node), **node}

    def limits(self, loc: Loc) -> Schema:
        """The JSON Schema of one number of the value at `loc`."""
        inner = resolve(self._schema, self.schema(loc))
        items = inner.get("prefixItems")
        return resolve(self._schema, items[0]) if items else inner

    def keys_of(self, loc: Loc = ()) -> list[str]:
        """The keys that the object at `loc` may have."""
        node = node_at(self._schema, loc) or {}
        return list(resolve(self._schema, node).get("properties", {}))

    def value(self, loc: Loc) -> Any:
        """The value at `loc`, its default where the file does not give it."""
        here: Any = self.config
        for step in loc:
            here = here[step] if isinstance(step, int) else getattr(here, step)
        return here

    def set(self, changes: Mapping[Loc, Any], gesture: object = None) -> None:
        """Set values; changes with the same `gesture` that follow each other are undone together."""
        data = copy.deepcopy(self.config.data)
        for loc, value in changes.items():
            _put(data, loc, value)
        self.replace(Config.from_data(data, self.config.path), gesture)

    def set_material(self, name: str, changes: Mapping[str, Any], gesture: object = None) -> None:
        """Set keys of the patch of a material, made where there is none; None: as the mesh file has it."""
        patches = [patch.name for patch in self.config.scene.materials]
        index = len(patches) if name not in patches else len(patches) - 1 - patches[::-1].index(name)
        place: Loc = ("scene", "materials", index)
        new = {} if index < len(patches) else {(*place, "name"): name}
        self.set({**new, **{(*place, key): value for key, value in changes.items()}}, gesture)

    def replace(self, config: Config, gesture: object = None) -> None:
        """Another config in this one's place, as a change that can be undone."""
        if config.data != self.config.data or config.path != self.config.path:
            self._history.push(config, gesture)

    def end_gesture(self) -> None:
        """What comes next is a change of its own."""
        self._history.end_gesture()

    @property
    def can_undo(self) -> bool:
        """Whether there is a change to undo."""
        return self._history.can_undo

    @property
    def can_redo(self) -> bool:
        """Whether there is a change to do again."""
        return self._history.can_redo

    def undo(self) -> None:
        """Take the last change back."""
        self._history.undo()

    def redo(self) -> None:
        """Do it again."""
        self._history.redo()

    def open(self, config: Config) -> None:
        """Show a scene file as it was read."""
        self.replace(config)
        self._saved = config

    def save(self, path: Path) -> None:
        """Write a scene file that renders the same from wherever it lies."""
        data = copy.deepcopy(self.config.data)
        for loc, name in named(data):
            _put(data, loc, self._name_from(path.resolve().parent, name))
        text = json.dumps(data, indent=2, ensure_ascii=False) + "\n"
        outputs.write(path, lambda temporary: temporary.write_text(text, encoding="utf-8"))
        saved = Config.from_data(data, path)
        self.replace(saved)
        self._saved = saved

    def _name_from(self, folder: Path, name: str) -> str:
        """The name that a scene file in `folder` calls a file of this one by."""
        beside = None if self.config.folder is None else self.config.folder / name
        if beside is None or Path(name).is_absolute() or Path(name).is_file() or not beside.is_file():
            # As given from where one stands, or among the bundled scenes: no folder of the scene file is in it.
            return str(Path(name).resolve()) if Path(name).is_file() else name
        return Path(os.path.relpath(beside.resolve(), folder)).as_posix()


def _put(data: Any, loc: Loc, value: Any) -> None:
    here = data
    for step, following in zip(loc, loc[1:], strict=False):
        if isinstance(step, int):
            while len(here) <= step:
                here.append({})
        elif here.get(step) is None:
            here[step] = [] if isinstance(following, int) else {}
        here = here[step]
    last = loc[-1]
    if isinstance(here, list) and isinstance(last, int) and last == len(here):
        here.append(value)
    elif value is None and isinstance(here, dict) and len(loc) > 1:
        here.pop(last, None)
    else:
        here[last] = value
