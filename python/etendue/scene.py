"""A scene ready to be rendered: the scene file and the files that it names, in the compiled core."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any

from .config import Config, read_config
from .config_overrides import Override
from .errors import EtendueError, Problem, SceneError
from .film import Attribute, Film

if TYPE_CHECKING:
    from . import _core

# Called with the part that is done (0..1) and the samples per pixel so far.
Progress = Callable[[float, float], object]
_SECTIONS = ("framebuffer", "camera", "scene")


@dataclass
class Scene:
    """A scene in memory; made by `load`.

    config: the scene file. core: the compiled core's scene. focal_depth: the camera's, after auto focus.
    warnings: what will not look as its author may expect. load_seconds: time that loading took.
    """

    config: Config
    core: _core.Scene
    focal_depth: float
    warnings: list[Problem] = field(default_factory=list)
    load_seconds: float = 0.0

    @property
    def lights(self) -> list[_core.Light]:
        """The lights, area lights in the order of their meshes."""
        return self.core.lights

    def camera(self, size: tuple[int, int] | None = None) -> _core.Camera:
        """The camera for an image of `size`, (width, height), by default the scene file's."""
        return _camera(self.config, self.focal_depth, size)

    def render(
        self,
        spp: int | None = None,
        size: tuple[int, int] | None = None,
        algorithm: str | None = None,
        threads: int = 0,
        seed: int | None = None,
        time_limit: float | None = None,
        progress: Progress | None = None,
        **parameters: Any,
    ) -> Film:
        """Render the scene.

        spp: samples per pixel. size: (width, height). algorithm: name of the estimator, and `parameters` what
        it takes, such as mis="balance", rr_threshold=0.5 or sampler="independent". Whatever is not given is
        as the scene file says. threads: 0 for all cores; the image does not depend on it. time_limit: seconds
        after which the film is returned as far as it is (`film.complete` is false then).
        progress(fraction, samples_per_pixel): called about 20 times a second; an exception from it ends the
        render and is raised.

        Ctrl-C returns the film with what is done and `film.interrupted` set, and raises KeyboardInterrupt
        only where nothing is done yet. Raises SceneError for a value that is not allowed.
        """
        from . import _core

        config = self._changed(spp, size, algorithm, seed, parameters)
        if threads < 0:
            raise EtendueError(f"threads: 0 or a number of threads is needed, not {threads}")
        framebuffer = config.framebuffer
        try:
            renderer = _core.Renderer(
                self.core,
                _camera(config, self.focal_depth),
                config.algorithm,
                config.parameters(),
                config.sampler,
                config.filter,
                config.seed,
                threads,
            )
        except ValueError as error:
            raise EtendueError(str(error)) from error
        interrupted = False
        try:
            complete = renderer.render(framebuffer.sppx, progress, time_limit)
        except KeyboardInterrupt:
            complete, interrupted = False, True
        film = Film.of(
            renderer,
            complete=complete,
            interrupted=interrupted,
            exposure=framebuffer.exposure,
        )
        film.attributes = _attributes(config, film)
        if interrupted and film.samples == 0:
            raise KeyboardInterrupt
        return film

    def _changed(
        self,
        spp: int | None,
        size: tuple[int, int] | None,
        algorithm: str | None,
        seed: int | None,
        parameters: dict[str, Any],
    ) -> Config:
        """The config with the arguments of `render` in it, checked like a scene file's values."""
        width, height = size or (None, None)
        changes = {
            "algorithm": algorithm,
            "framebuffer.sppx": spp,
            "framebuffer.res_w": width,
            "framebuffer.res_h": height,
            "seed": seed,
            **parameters,
        }
        wrong = [key for key in parameters if key in _SECTIONS]
        if wrong:
            raise EtendueError(
                f"render: {wrong[0]} cannot be changed for one render; load a changed scene instead"
            )
        overrides = [
            # Numbers of numpy are welcome, although a file cannot hold them.
            Override(key, value.item() if hasattr(value, "item") else value, "render")
            for key, value in changes.items()
            if value is not None
        ]
        return self.config.with_overrides(overrides) if overrides else self.config


def load(
    source: str | PathLike[str] | Config | dict[str, Any],
    data_dirs: Sequence[str | PathLike[str]] = (),
    warnings: list[Problem] | None = None,
) -> Scene:
    """Load a scene file, a Config, or plain data in the form of a scene file.

    data_dirs: folders in which meshes and images are looked for as well. Warnings are in `Scene.warnings`,
    and are appended to `warnings` too. Raises SceneError with every problem found.
    """
    from . import _core
    from .scene_parts import Parts

    start = time.perf_counter()
    if isinstance(source, Config):
        config = source
    elif isinstance(source, dict):
        config = Config.from_data(source)
    else:
        config = read_config(source, data_dirs=data_dirs)
    found = config.warnings()
    parts = Parts(config, data_dirs)
    found += parts.warnings
    try:
        core = _core.Scene(parts.meshes, parts.materials, parts.textures, parts.sky)
    except (ValueError, MemoryError) as error:
        raise SceneError([Problem(str(error) or "not enough memory", config.path)]) from error
    if not any(light.power > 0 for light in core.lights):
        message = (
            "no light: the image will be black; a material with emissive_strength above 0, or whose name or "
            'type contains "light", shines, and so does a sky'
        )
        found.append(config.problem(("scene",), message))
    focal_depth = config.camera.focal_depth
    if config.auto_focus and config.camera.perspective:
        focal_depth = _core.auto_focus(core, _camera(config, focal_depth))
    if warnings is not None:
        warnings += found
    return Scene(config, core, focal_depth, found, time.perf_counter() - start)


def _camera(config: Config, focal_depth: float, size: tuple[int, int] | None = None) -> _core.Camera:
    from . import _core

    camera, framebuffer = config.camera, config.framebuffer
    width, height = size or (framebuffer.res_w, framebuffer.res_h)
    try:
        return _core.Camera(
            camera.pos,
            camera.dir,
            camera.up,
            camera.fov,
            camera.lens_radius,
            focal_depth,
            camera.perspective,
            width,
            height,
        )
    except ValueError as error:
        raise SceneError([config.problem(("camera",), str(error))]) from error


def _attributes(config: Config, film: Film) -> dict[str, Attribute]:
    """How the film was made, for its file."""
    import hashlib
    import json

    from . import __version__

    text = json.dumps(config.data, ensure_ascii=False)
    parameters = config.parameters()
    return {
        "version": __version__,
        "scene": str(Path(config.path).name) if config.path else "",
        "config": text,
        "config_sha256": hashlib.sha256(text.encode()).hexdigest(),
        "algorithm": config.algorithm,
        "parameters": json.dumps(parameters),
        "sampler": config.sampler,
        "filter": config.filter,
        "seed": config.seed,
        "spp": float(film.spp),
        "rays": film.rays,
        "seconds": float(film.seconds),
        "invalid_samples": film.invalid_count,
        "complete": int(film.complete),
    }
