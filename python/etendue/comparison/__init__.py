"""Estimators compared on one scene: how noisy, how fast, and whether they agree with the reference.

comparison = etendue.compare("configs/a04_mis.json", ["naive", "nee", "mis"], spp=16)
comparison.results              # every number, as in results.json
comparison                      # in Jupyter: the report
comparison.write("compared")    # index.html and results.json
"""

from __future__ import annotations

import functools
import html
import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any

from .. import outputs
from ..config import Config
from ..config.overrides import Override
from ..errors import EtendueError
from . import bias, extras, repeats, report, results
from . import reference as references
from .bias import Bias
from .estimators import DEFAULT, Choice, chosen
from .folder import Folder
from .goal import Goal
from .reference import Reference
from .repeats import Plan
from .tally import Tally
from .work import Report

if TYPE_CHECKING:
    from ..scene import Scene

REPEATS = 8
MOST_REPEATS = 1000


@dataclass
class Comparison:
    """What `compare` gives. results: all numbers, plain data as in results.json."""

    plan: Plan
    reference: Reference
    tallies: list[Tally]
    verdicts: list[Bias | None]
    results: dict[str, Any] = field(default_factory=dict)

    def exceeds(self, limits: Mapping[str, float]) -> list[str]:
        """A line for each estimator and metric whose mean is above its limit, or could not be computed."""
        found = []
        for estimator in self.results["estimators"]:
            for metric, limit in limits.items():
                value = estimator["table"][metric]["value"]
                if value is None or not value <= limit:
                    shown = "not a number" if value is None else f"{value:.4g}"
                    found.append(f"{estimator['name']}: {metric} is {shown}, above {limit:g}")
        return found

    @functools.cached_property
    def html(self) -> str:
        """The report: a page that needs nothing but a browser."""
        return report.html(self.plan, self.reference, self.tallies, self.verdicts, self.results)

    def write(self, folder: str | PathLike[str]) -> None:
        """Write index.html and results.json into a folder that is new, empty or of a comparison.

        Raises EtendueError for what keeps them from being written.
        """
        place = Folder.open(Path(folder))
        outputs.write(place.results, lambda path: path.write_text(json.dumps(self.results, indent=1)))
        outputs.write(place.index, lambda path: path.write_text(self.html, encoding="utf-8"))

    def _repr_html_(self) -> str:
        """For Jupyter: the report in a frame of its own, whose style and script stay inside."""
        page = html.escape(self.html, quote=True)
        return f'<iframe srcdoc="{page}" style="width:100%;height:60rem;border:0"></iframe>'

    def __str__(self) -> str:
        names = ", ".join(tally.estimator.name for tally in self.tallies)
        return f"comparison of {names} on {self.results['scene']['name']}"


def compare(
    source: str | PathLike[str] | Config | dict[str, Any] | Scene,
    estimators: Sequence[Choice] | Mapping[str, Mapping[str, Any]] = DEFAULT,
    spp: int | None = None,
    time: float | None = None,
    reference: str | PathLike[str] | None = None,
    repeats: int = REPEATS,
    output: str | PathLike[str] | None = None,
    size: tuple[int, int] | None = None,
    threads: int = 0,
    data_dirs: Sequence[str | PathLike[str]] = (),
    reference_spp: int | None = None,
    progress: Report | None = None,
    command: str | None = None,
) -> Comparison:
    """Render a scene with several estimators, several times each, and compare them with a reference.

    source: what `etendue.load` takes, or a loaded Scene. estimators: names (naive, nee, mis, balance, or an
    algorithm), or {"name": {"key": value}} with keys of the scene file as in --set. spp: samples per pixel of each
    image, by default the scene file's; time: instead, seconds of rendering for each image.
    reference: an image or film; without it one is rendered, with independent samples and 16 times the samples
    or time (1,024 samples per pixel at least), or `reference_spp`, and cached. repeats: renders of each estimator
    under independent random numbers, 2 at least for intervals. output: a folder for the report, which also
    keeps finished repeats, so that the same call goes on after Ctrl-C.
    progress(part, seconds_left, what): called often. command: how people repeat it, for the report.

    Raises EtendueError for what is not allowed or installed, and KeyboardInterrupt on Ctrl-C.
    """
    extras.require()
    plan = plan_of(
        source, estimators, spp, time, reference, repeats, output, size, threads, data_dirs, reference_spp
    )
    return finish(plan, progress, command or "etendue.compare(...)")


def plan_of(
    source: str | PathLike[str] | Config | dict[str, Any] | Scene,
    estimators: Sequence[Choice] | Mapping[str, Mapping[str, Any]],
    spp: int | None,
    time: float | None,
    reference: str | PathLike[str] | None,
    repeats: int,
    output: str | PathLike[str] | None,
    size: tuple[int, int] | None,
    threads: int,
    data_dirs: Sequence[str | PathLike[str]],
    reference_spp: int | None,
    changes: Sequence[str] = (),
) -> Plan:
    """What `compare` is to render, with everything checked before anything is rendered.

    changes: KEY=VALUE that the source differs by from its file.
    """
    from ..scene import Scene, load

    if not 1 <= repeats <= MOST_REPEATS:
        raise EtendueError(f"compare: 1 to {MOST_REPEATS} repeats are needed, not {repeats}")
    if reference_spp is not None and reference_spp < 2:
        raise EtendueError(f"compare: a reference needs 2 samples per pixel at least, not {reference_spp}")
    if reference_spp is not None and reference is not None:
        raise EtendueError("compare: a given reference and reference_spp exclude each other")
    wanted = chosen(estimators)
    scene = source if isinstance(source, Scene) else load(source, data_dirs)
    width, height = size or (None, None)
    keys = {"framebuffer.sppx": spp, "framebuffer.res_w": width, "framebuffer.res_h": height}
    changed = [Override(key, value, "compare") for key, value in keys.items() if value is not None]
    config = scene.config.with_overrides(changed)
    scene = scene.changed(config)
    for estimator in wanted:
        estimator.config(config)
    goal = Goal.of(spp, time, config.framebuffer.sppx)
    given = None
    if reference is not None:
        given = references.given(Path(reference), config.framebuffer.res_w, config.framebuffer.res_h)
    folder = None if output is None else Folder.open(Path(output))
    told = [f"{change.key}={change.value}" for change in changed if change.key != "framebuffer.sppx"]
    better = goal.of_reference(reference_spp)
    return Plan(scene, wanted, goal, repeats, threads, better, given, folder, [*changes, *told])


def finish(plan: Plan, progress: Report | None, command: str) -> Comparison:
    """Render what `plan` says, compare, and write the report into its folder, if it has one."""
    reference, tallies = repeats.carry_out(plan, progress)
    verdicts = [bias.judge(tally, reference) if plan.repeats > 1 else None for tally in tallies]
    numbers = results.of(plan, reference, tallies, verdicts, command)
    comparison = Comparison(plan, reference, tallies, verdicts, numbers)
    if plan.folder is not None:
        comparison.write(plan.folder.path)
    return comparison
