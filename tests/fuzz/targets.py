"""One target a format: bytes become a file, and what reads it must load it or raise EtendueError.

What loads is rendered as well, in a few pixels.
"""

from __future__ import annotations

import json
import shutil
import tempfile
import zlib
from pathlib import Path

from etendue import EtendueError, Scene, load
from etendue.config import Config
from etendue.loaders import load_image
from etendue.scene.parts import Parts

from . import seeds
from .formats import IMAGES
from .limits import limits, ran_out_of_memory


class Broken(AssertionError):
    """A file did what no file may."""


class Target:
    """A folder in which files of one format are tried; `with` it, so that the folder goes away."""

    def __init__(self, name: str) -> None:
        self.name = name

    def __enter__(self) -> Target:
        self.folder = Path(tempfile.mkdtemp(prefix="etendue-fuzz-"))
        (self.folder / "m.obj").write_bytes(seeds.OBJ)
        (self.folder / "m.mtl").write_bytes(seeds.MTL)
        (self.folder / "image.png").write_bytes(seeds.image("png"))
        (self.folder / "sky.hdr").write_bytes(seeds.image("hdr"))
        (self.folder / "scene.json").write_text(json.dumps(seeds.CONFIG))
        return self

    def __exit__(self, *_: object) -> None:
        shutil.rmtree(self.folder)

    def __call__(self, data: bytes) -> bool:
        """Whether the file loads. Raises Broken for anything but success and EtendueError."""
        file = self.folder / {"scene": "scene.json", "mtl": "m.mtl"}.get(self.name, f"file.{self.name}")
        file.write_bytes(data)
        try:
            with limits():
                self._read(file)
        except EtendueError as error:
            if ran_out_of_memory(error):
                raise Broken(f"{self.name}: more than 2 GiB of memory: {error}") from error
            if not str(error).strip():
                raise Broken(f"{self.name}: an error without a message") from error
            return False
        except BaseException as error:
            if isinstance(error, KeyboardInterrupt):
                raise
            raise Broken(f"{self.name}: {type(error).__name__}: {error}") from error
        return True

    def _read(self, file: Path) -> None:
        if self.name in IMAGES:
            for kind in ("colour", "linear", "normal", "environment"):
                load_image(file, kind, [])  # type: ignore[arg-type]
        elif self.name == "scene":
            self._render(load(file))
        else:
            name = "m.obj" if self.name == "mtl" else file.name
            config = Config.from_data({"scene": {"mesh_files": [str(self.folder / name)]}})
            # Building the hierarchy takes most of the time and sees arrays alone: for one file in eight.
            if zlib.crc32(file.read_bytes()) % 8 == 0:
                self._render(load(config))
            else:
                Parts(config, ())

    def _render(self, scene: Scene) -> None:
        scene.render(spp=1, size=(4, 3), threads=1, max_cam_path_length=8)
