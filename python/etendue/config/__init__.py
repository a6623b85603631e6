"""The scene file: reading it, checking it, changing single keys of it.

`read_config(path)` gives a `Config` or raises a `SceneError` that holds every problem of the file at once.
"""

from __future__ import annotations

import functools
from collections import Counter
from collections.abc import Iterable, Sequence
from os import PathLike
from pathlib import Path
from typing import Annotated, Any, Literal, cast

from pydantic import Field, PrivateAttr, ValidationError, create_model

from ..errors import EtendueError, Problem, SceneError, nearest_name
from . import files as config_files
from . import overrides as config_overrides
from . import problems as config_problems
from .located_json import Loc, parse
from .overrides import Override
from .problems import Source
from .sections import (
    LONGEST_PATH,
    WHOLE,
    Camera,
    Framebuffer,
    Positive,
    SceneSection,
    Section,
)


class Config(Section):
    """A scene file that has passed every check; immutable.

    The parameters that algorithms register (such as `mis`) are fields as well, see `config_model`.
    """

    schema_url: str | None = Field(
        default=None,
        alias="$schema",
        title="JSON Schema",
        description="For editors: where the schema of this file is.",
    )
    algorithm: str = Field(
        default="Pathtracer", title="Algorithm", description="The estimator, see `etendue algorithms`."
    )
    max_cam_path_length: Annotated[int, Field(ge=1, le=LONGEST_PATH), WHOLE] = Field(
        default=10,
        title="Longest camera path",
        description="Light that arrived over at most so many edges (rays) counts.",
    )
    max_light_path_length: Annotated[int, Field(ge=0, le=LONGEST_PATH), WHOLE] = Field(
        default=5,
        title="Longest light path",
        description="For paths from a light, of algorithms that count these apart: none does.",
    )
    rr_min_path_length: Annotated[int, Field(ge=0, le=LONGEST_PATH), WHOLE] = Field(
        default=1,
        title="Bounces before roulette",
        description="Bounces before Russian roulette may end a path.",
    )
    rr_threshold: Annotated[float, Field(ge=0, le=1e6, allow_inf_nan=False)] = Field(
        default=0.25,
        title="Roulette threshold",
        description="Roulette acts where the path's throughput is below this; 0: never.",
    )
    auto_focus: bool = Field(
        default=True,
        title="Auto focus",
        description="Sets focal_depth to the geometric mean of the distances around the image's centre.",
    )
    beauty_render: bool = Field(
        default=False,
        title="Beauty render",
        description="Keep adding samples, worst tiles first, until the error is below error_eps; no sppx then.",
    )
    error_eps: Positive = Field(
        default=0.05,
        title="Error bound",
        description="The relative standard error that 95% of the tiles of a beauty render are to keep below.",
    )
    sampler: str = Field(default="sobol", title="Sampler", description="Where the random numbers come from.")
    filter: str = Field(
        default="blackman_harris", title="Pixel filter", description="How samples are spread around a pixel."
    )
    seed: Annotated[int, Field(ge=0, le=2**32 - 1), WHOLE] = Field(
        default=0,
        title="Seed",
        description="Other numbers give other noise; the same gives the same image, bit for bit.",
    )
    framebuffer: Framebuffer = Field(default=Framebuffer(), title="Framebuffer")
    camera: Camera = Field(default=Camera(), title="Camera")
    scene: SceneSection = Field(default=SceneSection(), title="Scene")

    _source: Source = PrivateAttr(default_factory=Source)
    _data: dict[str, Any] = PrivateAttr(default_factory=dict)

    @classmethod
    def from_data(cls, data: Any, path: str | PathLike[str] | None = None) -> Config:
        """A config from plain data (dict, list, numbers ...); `path` says beside which file its files are.

        Raises SceneError with every problem.
        """
        return _checked(data, Source(None if path is None else Path(path)))

    @property
    def path(self) -> Path | None:
        """The scene file; None for a config that came from plain data."""
        return None if self._source.file is None else Path(self._source.file)

    @property
    def folder(self) -> Path | None:
        """The folder of the scene file."""
        return None if self.path is None else self.path.parent

    @property
    def data(self) -> dict[str, Any]:
        """The scene file's plain data with the overrides in it, without defaults."""
        return self._data

    def with_overrides(self, overrides: Iterable[str | Override]) -> Config:
        """A config with `KEY=VALUE` changes applied; raises SceneError, as reading the changed file would."""
        return _checked(self._data, self._source, overrides)

    def parameters(self, algorithm: str | None = None) -> dict[str, Any]:
        """The values of the parameters that an algorithm (this config's own by default) declares."""
        from .. import _core

        wanted = algorithm or self.algorithm
        declared = [info.parameters for info in _core.algorithms() if info.name == wanted]
        return {
            parameter.name: getattr(self, parameter.name)
            for parameters in declared
            for parameter in parameters
        }

    def find_file(self, name: str, data_dirs: config_files.Folders = ()) -> Path:
        """The file that `name` means here; raises SceneError telling where it was looked for.

        Tried in this order: as given, beside the scene file, under each of `data_dirs`, under $ETENDUE_DATA,
        among the bundled scenes (the scene that has it is modelled into the user's cache on first use).
        """
        found = config_files.find(name, self.folder, data_dirs)
        if found is None:
            loc = next((loc for loc, other in config_files.named(self._data) if other == name), ())
            raise SceneError([config_files.not_found(name, loc, self._source, self.folder, data_dirs)])
        return found

    def scenes_to_build(self, data_dirs: config_files.Folders = ()) -> list[str]:
        """The bundled scenes that loading this one will model first, which takes some seconds each."""
        return config_files.to_build(self._data, self.folder, data_dirs)

    def problem(self, loc: Loc, message: str, **more: Any) -> Problem:
        """A problem or warning at `loc`, e.g. ("scene", "materials", 3), with file and line filled in."""
        return self._source.problem(loc, message, **more)

    def warnings(self) -> list[Problem]:
        """What is accepted but will not do what its author may expect."""
        found: list[Problem] = []
        for key in ("volume_path", "volume"):
            if getattr(self.scene, key) is not None:
                found.append(
                    self.problem(("scene", key), "volumes are not rendered; the scene is shown without it")
                )
        found += self._material_warnings()
        return sorted(found, key=lambda problem: problem.line or 0)

    def _material_warnings(self) -> list[Problem]:
        from .. import _core

        known = [part for kind in _core.material_types() for part in kind.matches if part] + ["default"]
        found: list[Problem] = []
        times = Counter(patch.name for patch in self.scene.materials)
        seen: Counter[str] = Counter()
        for index, patch in enumerate(self.scene.materials):
            loc: Loc = ("scene", "materials", index)
            seen[patch.name] += 1
            if 1 < times[patch.name] == seen[patch.name]:
                message = "an earlier patch has the same name; where both set a key, this one counts"
                found.append(self.problem((*loc, "name"), message, value=patch.name))
            if patch.type and not any(part in patch.type.lower() for part in known):
                message = 'contains no known type, so the material is "default"'
                near = nearest_name(patch.type, known)
                allowed = ", ".join(dict.fromkeys(known))
                found.append(
                    self.problem((*loc, "type"), message, value=patch.type, nearest=near, allowed=allowed)
                )
        return found


@functools.cache
def config_model() -> type[Config]:
    """`Config` with the algorithms, parameters, samplers and filters that this Étendue has."""
    from .. import _core

    fields: dict[str, Any] = {}
    for name, known in (
        ("algorithm", [info.name for info in _core.algorithms()]),
        ("sampler", _core.samplers()),
        ("filter", _core.filters()),
    ):
        fields[name] = (Literal[tuple(known)], Config.model_fields[name])
    for parameter in (parameter for info in _core.algorithms() for parameter in info.parameters):
        # Algorithms that share a parameter's name share its meaning, and the first one's declaration.
        if parameter.name not in Config.model_fields and parameter.name not in fields:
            fields[parameter.name] = _parameter_field(parameter)
    return cast(
        type[Config], create_model("Scene file", __base__=Config, __doc__="A scene for Étendue.", **fields)
    )


def json_schema() -> dict[str, Any]:
    """The JSON Schema of scene files, for editors and other programs."""
    schema = _json_schema()
    return {"$schema": "https://json-schema.org/draft/2020-12/schema", **schema, "title": "Étendue scene"}


def read_config(
    path: str | PathLike[str],
    overrides: Sequence[str | Override] = (),
    data_dirs: config_files.Folders | None = None,
) -> Config:
    """The config in the file `path`, with `KEY=VALUE` overrides applied before it is checked.

    With `data_dirs` (an empty list will do) the files that it names are looked for as well.
    Raises SceneError with every problem, EtendueError where the file cannot be read.
    """
    file = Path(path)
    try:
        text = file.read_text(encoding="utf-8-sig")
    except UnicodeDecodeError as error:
        raise EtendueError(f"{file}: not a text file in UTF-8 (byte {error.start} cannot be read)") from None
    except OSError as error:
        raise EtendueError(f"{file}: cannot be read: {error.strerror or error}") from None
    located = parse(text, file)
    return _checked(located.value, Source(file, located), overrides, data_dirs)


def _checked(
    data: Any,
    source: Source,
    overrides: Iterable[str | Override] = (),
    data_dirs: config_files.Folders | None = None,
) -> Config:
    data, places, problems = config_overrides.apply(data, overrides)
    source = Source(source.file, source.located, {**source.overridden, **places})
    problems = config_problems.duplicate_problems(source) + problems
    config = None
    try:
        config = config_model().model_validate(data)
    except ValidationError as error:
        problems += config_problems.problems_of(error.errors(include_url=False), _json_schema(), source)
    if data_dirs is not None:
        folder = None if source.file is None else Path(source.file).parent
        problems += config_files.missing(data, source, folder, data_dirs)
    if problems or config is None:
        problems.sort(key=lambda problem: problem.line or 0)
        raise SceneError(problems)
    config._source, config._data = source, data
    return config


@functools.cache
def _json_schema() -> dict[str, Any]:
    return config_model().model_json_schema()


def _parameter_field(parameter: Any) -> tuple[Any, Any]:
    title = parameter.name.replace("_", " ").capitalize()
    field = Field(default=parameter.default, title=title, description=parameter.summary)
    if parameter.kind == "choice":
        return Literal[tuple(parameter.choices)], field
    if parameter.kind == "bool":
        return bool, field
    limits = Field(ge=parameter.minimum, le=parameter.maximum)
    if parameter.kind == "int":
        return Annotated[int, limits, WHOLE], field
    return Annotated[float, limits, Field(allow_inf_nan=False)], field
