"""A scene ready to be rendered: the scene file and the files that it names, in the compiled core."""

from __future__ import annotations

import dataclasses
import math
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from os import PathLike
from typing import TYPE_CHECKING, Any

from ..config import Config, read_config
from ..config.overrides import Override
from ..config.sections import Vec3
from ..errors import EtendueError, Problem, SceneError
from ..film import Film, sample_ranges
from ..film import aovs as film_aovs
from ..film.origin import Origin
from ..film.progressive import Progress, Steps, go_on
from ..film.sample_ranges import Range, hull
from . import beside

if TYPE_CHECKING:
    from .. import _core
    from ..film.fingerprint import Contents
    from ..replay import Replay
    from .surfaces import Surfaces

_SECTIONS = ("framebuffer", "camera", "scene")


@dataclass
class Scene:
    """A scene in memory; made by `load`.

    config: the scene file. core: the compiled core's scene. focal_depth: the camera's, after auto focus.
    surfaces: materials and sky as the files have them.
    warnings: what will not look as its author may expect. load_seconds: time that loading took.
    contents: name and digest of what files brought in. data_dirs: folders in which they were looked for.
    """

    config: Config
    core: _core.Scene
    focal_depth: float
    surfaces: Surfaces
    warnings: list[Problem] = field(default_factory=list)
    load_seconds: float = 0.0
    contents: Contents = field(default_factory=dict)
    data_dirs: tuple[str | PathLike[str], ...] = ()

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
        samples: Sequence[int] | None = None,
        resume: Film | None = None,
        checkpoint: Callable[[Film], object] | None = None,
        checkpoint_seconds: float = 30.0,
        aovs: Sequence[str] = (),
        error: Callable[[float], object] | None = None,
        **parameters: Any,
    ) -> Film:
        """Render the scene.

        spp: samples per pixel. size: (width, height). algorithm: name of the estimator, and `parameters` what
        it takes, such as mis="balance", rr_threshold=0.5 or sampler="independent". Whatever is not given is
        as the scene file says. threads: 0 for all cores; the image does not depend on it. time_limit: seconds
        after which the film is returned as far as it is (`film.complete` is false then).
        progress(fraction, samples_per_pixel): called about 20 times a second; an exception from it ends the
        render and is raised. error(estimate): called before it with the film's error (`Film.error`) where there is
        an estimate.

        samples: instead of spp, the samples with the indices [first, end), or a range of step 1; films of
        different ones can be merged. resume: a film of this scene and these settings to go on from, which
        itself stays as it is; without spp, to where it was to go.
        checkpoint(film): called every checkpoint_seconds with the film so far.
        aovs: names of `etendue.film.aovs.AOVS`, to be found in `film.aovs` afterwards.

        A beauty render (beauty_render=True, here or in the scene file, and neither spp nor samples) adds samples,
        worst tiles first, until the film's error is at most error_eps: docs/beauty-render.md.

        Ctrl-C returns the film with what is done and `film.interrupted` set, and raises KeyboardInterrupt
        only where nothing is done yet; a film that it ended has no AOVs of surfaces. Raises SceneError for a
        value that is not allowed, EtendueError for a name in `aovs` that is none, and for a film to resume that
        is of something else, with all that differs.
        """
        aovs = film_aovs.checked(aovs)
        beauty = self._is_beauty(parameters, spp, samples)
        goal = self._goal(spp, samples, resume)
        if beauty:
            goal = hull([] if resume is None else resume.ranges)
        wanted = None if beauty or goal is None else goal[1] - goal[0]
        if wanted is not None and resume is not None:
            # A merged film may have more than a scene file can ask for.
            wanted = min(wanted, sample_ranges.MOST)
        decided = {} if beauty == self.config.beauty_render else {"beauty_render": beauty}
        config = self._changed(wanted, size, algorithm, seed, {**parameters, **decided})
        if threads < 0:
            raise EtendueError(f"threads: 0 or a number of threads is needed, not {threads}")
        if not checkpoint_seconds > 0:
            raise EtendueError(f"checkpoint_seconds: above 0 is needed, not {checkpoint_seconds}")
        origin = Origin.of(config, self.contents, self.data_dirs)
        framebuffer = config.framebuffer
        if resume is None:
            start = Film.empty(framebuffer.res_w, framebuffer.res_h)
        elif resume.origin is None:
            raise EtendueError("resume: a film that does not come from a render cannot be gone on from")
        else:
            refusal = "the film is of another scene or other settings"
            origin.require_same(resume.origin, refusal, "here", "in the film")
            start = resume
        if film_aovs.from_source(aovs, "contributions"):
            start = beside.split(start, config.algorithm)
        start = dataclasses.replace(
            start,
            goal=goal if goal is not None else (0, framebuffer.sppx),
            bound=config.error_eps if beauty else None,
            origin=origin,
            exposure=framebuffer.exposure,
        )
        steps = Steps(progress, error, checkpoint, checkpoint_seconds, time_limit)
        film = go_on(start, lambda first: self._renderer(config, threads, first), steps)
        if film.interrupted and film.samples == 0:
            raise KeyboardInterrupt
        if film.interrupted:
            aovs = tuple(name for name in aovs if film_aovs.AOVS[name].source != "surfaces")
        return self.with_aovs(film, aovs, threads) if aovs else film

    def replay(
        self,
        pixel: tuple[int, int],
        sample: int,
        algorithm: str | None = None,
        seed: int | None = None,
        size: tuple[int, int] | None = None,
        **parameters: Any,
    ) -> Replay:
        """The path of one sample of a pixel, vertex by vertex, as `render` with the same arguments takes it.

        pixel: (x, y) from the top left corner. sample: its index, from 0. Raises EtendueError where the image
        has no such pixel, SceneError for a value that is not allowed.
        """
        from .. import _core
        from ..replay import Replay

        config = self._changed(None, size, algorithm, seed, parameters)
        (x, y), framebuffer = pixel, config.framebuffer
        if not (0 <= x < framebuffer.res_w and 0 <= y < framebuffer.res_h):
            raise EtendueError(
                f"pixel {x},{y}: the image is {framebuffer.res_w}x{framebuffer.res_h}, so x is 0 to "
                f"{framebuffer.res_w - 1} and y 0 to {framebuffer.res_h - 1}"
            )
        if not 0 <= sample < 2**63:
            raise EtendueError(f"sample {sample}: an index from 0 to 2^63 - 1 is needed")
        path = _core.replay(self._renderer(config, 0, 0), x, y, sample)
        return Replay((x, y), sample, config.algorithm, path)

    def renderer(
        self,
        threads: int = 0,
        first_sample: int = 0,
        films: _core.Films | None = None,
        prepares: bool = True,
    ) -> _core.Renderer:
        """A renderer of what the scene file says, without samples yet; for who renders in steps of his own.

        films: memory that renderers which follow each other share. prepares: False for a first picture at once, whose
        estimator learns nothing before, and has other noise.
        """
        return self._renderer(self.config, threads, first_sample, films, prepares)

    def empty_film(self) -> Film:
        """The film that `renderer` begins with: no samples, and where they are going to come from."""
        framebuffer = self.config.framebuffer
        origin = Origin.of(self.config, self.contents, self.data_dirs)
        film = Film.empty(framebuffer.res_w, framebuffer.res_h)
        return dataclasses.replace(
            film,
            goal=(0, 0 if self.config.beauty_render else framebuffer.sppx),
            bound=self.config.error_eps if self.config.beauty_render else None,
            origin=origin,
            exposure=framebuffer.exposure,
        )

    def changed(self, config: Config) -> Scene:
        """The scene of another config, which keeps what it has of the same files.

        Camera, settings, materials and the sky's strength change without reading a file or building an
        acceleration structure. Raises SceneError with every problem.
        """
        before, after = self.config.scene, config.scene
        files = [(s.mesh_files, s.sky and s.sky.envmap) for s in (before, after)]
        if files[0] != files[1] or self.config.folder != config.folder:
            return load(config, self.data_dirs)
        core = self.core
        if before != after:
            core = core.with_materials(self.surfaces.materials(after), self.surfaces.sky(after.sky))
        focal_depth = config.camera.focal_depth
        if config.camera.lens_radius > 0:  # a pinhole has no focus
            focal_depth = _focal_depth(config, core)
        return dataclasses.replace(self, config=config, core=core, focal_depth=focal_depth)

    def with_aovs(
        self,
        film: Film,
        names: Sequence[str],
        threads: int = 0,
        progress: Callable[[float], object] | None = None,
    ) -> Film:
        """A film of this scene with what else is known of its pixels in `aovs`; names: of `film.aovs.AOVS`.

        Arrays are float32 (height, width, channels), or (height, width) of a single channel, int32 for ids; row 0 is
        at the top. What camera rays hit is found anew, with the film's own rays of its first 64 samples;
        progress(fraction) is called meanwhile, about 20 times a second. Raises EtendueError for a name that is
        none, a film of another scene, and contributions that were not kept apart.
        """
        found = beside.aovs_of(self, film, film_aovs.checked(names), threads, progress)
        return dataclasses.replace(
            film, aovs=found, attributes={**film.attributes, **beside.attributes(self, film, found)}
        )

    def denoise(
        self,
        film: Film,
        threads: int = 0,
        progress: Callable[[float], object] | None = None,
        warnings: list[str] | None = None,
    ) -> Film:
        """A film of this scene with its image denoised by Open Image Denoise, guided by albedo and normal.

        The result is biased, and says so in its attributes. It has no origin, so that it can be neither written
        as a film file nor gone on from; its sums are those of the noisy film, which itself stays as it is.
        progress(fraction): called a few times a second. warnings: is told of pixels that were left out, for want
        of a finite radiance. Raises EtendueError where the extra "denoise" is not installed, or the film is of
        another scene.
        """
        from .. import denoise

        denoise.require()
        guides = beside.guides(
            self, film, threads, None if progress is None else lambda part: progress(part / 2)
        )
        report = None if progress is None else lambda part: progress((1 + part) / 2)
        denoised, said = denoise.denoise_film(film, *guides, threads, report)
        if said is not None and warnings is not None:
            warnings.append(said)
        return denoised

    def config_of(self, film: Film) -> Config:
        """The config that gave a film of this scene; EtendueError for a film of another one."""
        if film.origin is None:
            raise EtendueError("a film that does not come from a render says nothing of its scene")
        settings = film.origin.settings
        size = settings["framebuffer.res_w"], settings["framebuffer.res_h"]
        given = {key: value for key, value in settings.items() if "." not in key}
        config = self._changed(None, size, given.pop("algorithm"), given.pop("seed"), given)
        origin = Origin.of(config, self.contents, self.data_dirs)
        origin.require_same(film.origin, "the film is of another scene", "here", "in the film")
        return config

    def _is_beauty(self, parameters: dict[str, Any], spp: int | None, samples: Sequence[int] | None) -> bool:
        """Whether the error decides how many samples there will be. What is asked for here counts first."""
        given = "spp" if spp is not None else "samples" if samples is not None else None
        if given is None:
            return bool(parameters.get("beauty_render", self.config.beauty_render))
        if parameters.get("beauty_render"):
            raise EtendueError(f"render: beauty_render and {given} exclude each other")
        return False

    def _goal(self, spp: int | None, samples: Sequence[int] | None, resume: Film | None) -> Range | None:
        """The range of samples to reach; None: what the scene file says."""
        if samples is not None:
            for other, name in ((spp, "spp"), (resume, "resume")):
                if other is not None:
                    raise EtendueError(f"render: samples and {name} exclude each other")
            return sample_ranges.checked(samples, "samples")
        if resume is None:
            return None if spp is None else (0, int(spp))
        first = resume.goal[0]
        return resume.towards(resume.goal if spp is None else (first, first + int(spp)))

    def _renderer(
        self,
        config: Config,
        threads: int,
        first_sample: int,
        films: _core.Films | None = None,
        prepares: bool = True,
    ) -> _core.Renderer:
        from .. import _core

        try:
            return _core.Renderer(
                self.core,
                _camera(config, self.focal_depth),
                config.algorithm,
                config.parameters(),
                config.sampler,
                config.filter,
                config.seed,
                threads,
                first_sample % 2**64,
                films,
                prepares,
            )
        except ValueError as error:
            raise EtendueError(str(error)) from error

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
    from .. import _core
    from .parts import Parts

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
    focal_depth = _focal_depth(config, core)
    if warnings is not None:
        warnings += found
    seconds = time.perf_counter() - start
    return Scene(config, core, focal_depth, parts.surfaces, found, seconds, parts.contents, tuple(data_dirs))


def _focal_depth(config: Config, core: _core.Scene) -> float:
    from .. import _core

    focal_depth = config.camera.focal_depth
    if not (config.auto_focus and config.camera.perspective):
        return focal_depth
    return _core.auto_focus(core, _camera(config, focal_depth))


def _unit(direction: Vec3) -> Vec3:
    """In double precision, as the file may give any length that single precision could not square."""
    length = math.hypot(*direction)
    return direction[0] / length, direction[1] / length, direction[2] / length


def _camera(config: Config, focal_depth: float, size: tuple[int, int] | None = None) -> _core.Camera:
    from .. import _core

    camera, framebuffer = config.camera, config.framebuffer
    width, height = size or (framebuffer.res_w, framebuffer.res_h)
    try:
        return _core.Camera(
            camera.pos,
            _unit(camera.dir),
            _unit(camera.up),
            camera.fov,
            camera.lens_radius,
            focal_depth,
            camera.perspective,
            width,
            height,
        )
    except ValueError as error:
        raise SceneError([config.problem(("camera",), str(error))]) from error
