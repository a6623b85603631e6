"""All that the window shows and does, but for the window itself."""

from __future__ import annotations

import dataclasses
import json
import os
import threading
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np

from .. import _core, outputs
from .. import denoise as denoiser
from ..config import read_config
from ..config.overrides import Override
from ..errors import EtendueError
from ..film import Film
from ..replay import Replay
from .document import Document
from .navigation import unit
from .pictures import Look
from .scenes import Scenes
from .session import Session
from .split import Split
from .status import State

MESHES = (".obj", ".ply", ".stl", ".gltf", ".glb")
IMAGES = (".hdr", ".exr", ".png", ".jpg", ".jpeg", ".tif", ".tiff")
CONFIGS = (".json",)
_MESSAGE_SECONDS = 6.0
_PATHS_SHOWN = 8


@dataclass
class Question:
    """A file that is asked for: of one of these extensions, to be written where `saves`, and what it is for."""

    title: str
    text: str
    suffixes: Sequence[str]
    action: Callable[[Path], object]
    saves: bool = False
    problem: str = ""


class Viewer:
    """The scene file, its render, and how it is shown."""

    def __init__(
        self,
        paths: Sequence[str | PathLike[str]] = (),
        data_dirs: Sequence[str | PathLike[str]] = (),
        overrides: Sequence[str | Override] = (),
        threads: int = 0,
    ) -> None:
        """Raises EtendueError for files that cannot be shown."""
        self.document = Document()
        self._data_dirs = data_dirs
        self._overrides = overrides
        self.open(paths)
        self.threads = threads
        self._scenes = Scenes(data_dirs)
        self.session = Session(self._scenes, self._share())
        self.split: Split | None = None
        self.look = Look()
        self.page: str | None = "Camera"
        self.speed = 1.0
        self.inspecting = False
        self.pixel: tuple[int, int] | None = None
        self.material: str | None = None
        self._strengths: dict[str, float | None] = {}
        self.question: Question | None = None
        self._message = ("", False, 0.0)
        self._tasks: list[threading.Thread] = []
        self._replays: tuple[Any, list[Replay]] = (None, [])

    # Changes.

    def update(self) -> None:
        """What follows from what was changed since the last time; called once a frame."""
        self.look = dataclasses.replace(self.look, exposure=self.document.config.framebuffer.exposure)
        self.session.show(self.document.config)
        self.session.look(self.look)
        if self.split is not None:
            self.split.session.show(self.split.config(self.document.config))
            self.split.session.look(self.look)
        for session in self.sessions:
            trouble = session.take_trouble()
            if trouble is not None:
                self.say(trouble, failed=True)
                self.look = dataclasses.replace(self.look, denoised=False)

    def denoise(self, wanted: bool) -> None:
        """Shows the image denoised, or as it is; raises EtendueError where the denoiser is not installed."""
        if wanted:
            denoiser.require()
        self.look = dataclasses.replace(self.look, denoised=wanted)

    def attempt(self, action: Callable[[], object]) -> bool:
        """Does something that may not be possible, and tells why it is not. Whether it was."""
        try:
            action()
        except EtendueError as error:
            self.say(str(error), failed=True)
            return False
        return True

    def open(self, paths: Sequence[str | PathLike[str]]) -> None:
        """Shows a scene file, and adds meshes and an environment map to it. Raises EtendueError."""
        for path in map(Path, paths):
            suffix = path.suffix.lower()
            if suffix in CONFIGS:
                self.document.open(read_config(path, self._overrides, self._data_dirs))
            elif suffix in MESHES:
                self.add_mesh(path)
            elif suffix in IMAGES:
                self.set_environment(path)
            else:
                allowed = ", ".join((*CONFIGS, *MESHES, *IMAGES))
                raise EtendueError(
                    f"{path}: neither a scene file nor a mesh nor an image (allowed: {allowed})"
                )

    def add_mesh(self, path: Path) -> None:
        """Adds a mesh file to the scene; raises EtendueError where there is none."""
        files = [*self.document.config.scene.mesh_files, self._readable(path)]
        self.document.set({("scene", "mesh_files"): files})

    def set_environment(self, path: Path) -> None:
        """Lights the scene by an image; raises EtendueError where there is none."""
        self.document.set({("scene", "sky", "envmap"): self._readable(path)})

    def clear(self) -> None:
        """Leaves nothing of the scene but a white sky."""
        self.document.set({("scene",): {"mesh_files": [], "materials": [], "sky": {"intensity": 1.0}}})

    def switch_light(self, name: str, lit: bool) -> None:
        """Extinguishes a material, or lights it as it was."""
        strength = self._strengths.pop(name, None) if lit else 0.0
        if not lit:
            patches = [patch for patch in self.document.config.scene.materials if patch.name == name]
            self._strengths[name] = patches[-1].emissive_strength if patches else None
        self.document.set_material(name, {"emissive_strength": strength})

    def paste_camera(self, text: str) -> None:
        """Takes the camera from JSON, as `copied_camera` gives it; raises EtendueError."""
        try:
            found = json.loads(text)
        except ValueError:
            found = None
        if not isinstance(found, dict):
            raise EtendueError("what is on the clipboard is no camera in JSON")
        self.document.set({("camera",): found.get("camera", found)})

    def copied_camera(self) -> str:
        """The camera as JSON."""
        return json.dumps({"camera": self.document.config.camera.model_dump()})

    def use_threads(self, threads: int) -> None:
        """Render by so many threads; 0: one for each core."""
        self.threads = threads
        self._share_threads()

    def toggle_split(self) -> None:
        """Shows a second estimator beside the first, or no longer."""
        if self.split is None:
            self.split = Split(self._scenes, self._share(2))
        else:
            self.split.session.close()
            self.split = None
        self._share_threads()

    def restart(self) -> None:
        """Renders from the first sample on."""
        for session in self.sessions:
            session.restart()

    def pause(self) -> None:
        """Stops, or goes on."""
        paused = self.session.status.state is State.PAUSED
        for session in self.sessions:
            session.pause(not paused)

    def abort(self) -> None:
        """Stops for good."""
        for session in self.sessions:
            session.abort()

    @property
    def sessions(self) -> list[Session]:
        """The renders that go on."""
        return [self.session, *([self.split.session] if self.split is not None else [])]

    def _share(self, parts: int = 1) -> int:
        return max((self.threads or os.cpu_count() or 1) // parts, 1)

    def _share_threads(self) -> None:
        for session in self.sessions:
            session.restart(self._share(len(self.sessions)))

    def _readable(self, path: Path) -> str:
        if not path.is_file():
            raise EtendueError(f"{path}: there is no such file")
        return str(path.resolve())

    # What is in the picture.

    def focus(self, x: float, y: float) -> None:
        """Focuses on what is seen at a point of the image, in pixels, and names it."""
        scene = self.session.scene
        if scene is None:
            return
        camera = scene.camera()
        middle = np.full((1, 2), 0.5, np.float32)
        origin, direction = camera.rays(np.array([[x, y]], np.float32), middle)
        seen = scene.core.intersect(origin, direction)
        distance = float(seen["distance"][0])
        if not np.isfinite(distance):
            self.say("the sky")
            return
        self.material = scene.surfaces.of_meshes[int(seen["material"][0])].material.name
        depth = distance * float(direction[0] @ unit(scene.config.camera.dir))
        if depth > 0:
            self.document.set({("auto_focus",): False, ("camera", "focal_depth"): float(f"{depth:.6g}")})
        self.say(f"{self.material}, {distance:.4g} away")

    def replays(self) -> list[Replay]:
        """The last paths through the pixel that is looked at, the newest first."""
        scene, renderer, status = self.session.scene, self.session.renderer, self.session.status
        if scene is None or renderer is None or self.pixel is None:
            return []
        x, y = self.pixel
        taken = int(status.spp)
        key = (id(renderer), self.pixel, taken if status.state is not State.RENDERING else taken // 16)
        if self._replays[0] != key:
            numbers = range(max(taken - _PATHS_SHOWN, 0), max(taken, 1))
            algorithm = scene.config.algorithm
            found = [
                Replay(self.pixel, number, algorithm, _core.replay(renderer, x, y, number, with_lights=False))
                for number in reversed(numbers)
            ]
            self._replays = (key, found)
        return self._replays[1]

    # Files.

    def save_film(self, path: Path, write: Callable[[Film, Path], object]) -> None:
        """Writes the render as it is now, while the window goes on; raises EtendueError where there is none."""
        outputs.check([path])
        film = self.session.film()
        if film is None:
            raise EtendueError("there is no render to save yet")

        def work() -> None:
            if self.attempt(lambda: write(film, path)):
                self.say(f"{path}: {film.spp:.6g} spp saved")

        self._tasks = [task for task in self._tasks if task.is_alive()]
        self._tasks.append(threading.Thread(target=work, name="etendue-save"))
        self._tasks[-1].start()

    def save_rendering(self, path: Path) -> None:
        """Saves the image, .png or .jpg as it is shown, .exr and .hdr as linear radiance."""
        look = self.look
        self.save_film(path, lambda film, place: film.save(place, look.exposure, view=look.view))

    def save_config(self, path: Path) -> None:
        """Saves a scene file that renders the same from the command line."""
        self.document.save(path)
        self.say(f"{path}: saved")

    def close(self) -> None:
        """Ends all that goes on; returns once it has."""
        for session in self.sessions:
            session.close()
        for task in self._tasks:
            task.join()

    # Messages and questions.

    def ask(
        self,
        title: str,
        text: str,
        suffixes: Sequence[str],
        action: Callable[[Path], object],
        saves: bool = False,
    ) -> None:
        """Asks for a file, with `text` as a first answer, and does something with it."""
        self.question = Question(title, text, suffixes, action, saves)

    def answer(self) -> None:
        """Does what the file was asked for; the question stays where that is not possible."""
        question = self.question
        if question is None:
            return
        try:
            question.action(Path(question.text).expanduser())
        except EtendueError as error:
            question.problem = str(error)
        else:
            self.question = None

    def say(self, text: str, failed: bool = False) -> None:
        """Tells something for a while."""
        self._message = (text, failed, time.monotonic() + _MESSAGE_SECONDS)

    @property
    def message(self) -> tuple[str, bool] | None:
        """What is to be told, and whether it is of something that failed."""
        text, failed, until = self._message
        return (text, failed) if text and time.monotonic() < until else None
