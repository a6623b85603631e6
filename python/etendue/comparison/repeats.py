"""Rendering: the reference, then every estimator again and again, each time with other random numbers."""

from __future__ import annotations

import dataclasses
import functools
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass

from ..config.overrides import Override
from ..film import Film
from ..film.origin import Origin
from ..scene import Scene
from . import metrics, techniques
from . import reference as references
from .estimators import Estimator
from .folder import Folder
from .goal import Goal
from .reference import Reference
from .tally import Curve, Point, Repeat, Tally
from .work import Report, Task, Work


@dataclass(frozen=True)
class Plan:
    """What is to be rendered.

    folder: where finished repeats are kept; None: nowhere. changes: KEY=VALUE of what differs from the scene file.
    """

    scene: Scene
    estimators: Sequence[Estimator]
    goal: Goal
    repeats: int
    threads: int
    reference_goal: Goal
    given: Reference | None = None
    folder: Folder | None = None
    changes: Sequence[str] = ()

    @functools.cached_property
    def scenes(self) -> list[Scene]:
        """The scene as each estimator renders it."""
        base = self.scene
        return [base.changed(estimator.config(base.config)) for estimator in self.estimators]

    @property
    def exposure(self) -> float:
        """Of all images that are shown."""
        return self.scene.config.framebuffer.exposure


class Interrupted(KeyboardInterrupt):
    """Ctrl-C came when `done` of `whole` repeats were finished."""

    def __init__(self, done: int, whole: int) -> None:
        super().__init__()
        self.done, self.whole = done, whole


def carry_out(plan: Plan, report: Report | None = None) -> tuple[Reference, list[Tally]]:
    """Renders all that is missing. Ctrl-C raises Interrupted; what is finished is in the folder, and what
    there is of the reference in the cache.

    Repeats take turns, so that a machine that is slower for a while is so for every estimator.
    """
    scenes = plan.scenes
    turns = [(repeat, index) for repeat in range(plan.repeats) for index in range(len(scenes))]
    tasks = {
        (repeat, index): Task(
            plan.estimators[index].name,
            plan.goal.amount,
            f"{plan.estimators[index].name}, repeat {repeat + 1} of {plan.repeats}",
        )
        for repeat, index in turns
    }
    needed = 0.0 if plan.given is not None else references.missing(plan.scene, plan.reference_goal)
    first = [Task("reference", needed, "reference")] if needed > 0 else []
    splits = [
        Task(f"techniques of {each.name}", 1.0, f"{each.name}, split by technique")
        for each in plan.estimators
    ]
    work = Work([*first, *splits, *tasks.values()], report)
    tallies = [Tally(estimator) for estimator in plan.estimators]
    try:
        reference = _reference(plan, work, first)
        for tally, scene, task in zip(tallies, scenes, splits, strict=True):
            work.begin(task)
            tally.techniques = techniques.measured(scene, work.advance)
            work.finish()
        for repeat, index in turns:
            task = tasks[repeat, index]
            scene = with_seed(scenes[index], repeat)
            origin = Origin.of(scene.config, scene.contents, scene.data_dirs)
            found = None
            if plan.folder is not None:
                found = plan.folder.find(task.kind, origin, plan.goal.label, reference.identity)
            if found is not None:
                work.skip(task)
            else:
                work.begin(task)
                found = render(scene, plan, reference, work.advance)
                if plan.folder is not None:
                    plan.folder.keep(task.kind, found, plan.goal.label, reference.identity)
                work.finish()
            tallies[index].add(found, scene.config.seed)
    except KeyboardInterrupt:
        raise Interrupted(sum(tally.repeats for tally in tallies), len(turns)) from None
    return reference, tallies


def with_seed(scene: Scene, repeat: int) -> Scene:
    """The scene with the random numbers of a repeat; those of repeat 0 are the scene file's."""
    seed = (scene.config.seed + repeat) % 2**32
    return dataclasses.replace(scene, config=scene.config.with_overrides([Override("seed", seed, "repeats")]))


def render(scene: Scene, plan: Plan, reference: Reference, progress: Callable[[float], object]) -> Repeat:
    """One repeat, with its errors whenever the samples have doubled. Only rendering counts as time."""
    goal = plan.goal
    film: Film | None = None
    curve: Curve = []
    cpu, spp = 0.0, 1
    while True:
        spent = 0.0 if film is None else film.seconds
        target = min(spp, goal.spp) if goal.spp is not None else spp
        left = None if goal.seconds is None else goal.seconds - spent

        def report(_: float, done: float, spent: float = spent, began: float = time.monotonic()) -> None:
            now = spent + time.monotonic() - began
            progress(done / goal.spp if goal.spp is not None else min(now / goal.amount, 1.0))

        before = time.process_time()
        film = scene.render(spp=target, resume=film, threads=plan.threads, time_limit=left, progress=report)
        cpu += time.process_time() - before
        if film.interrupted:
            raise KeyboardInterrupt
        is_last = film.spp >= goal.spp if goal.spp is not None else film.seconds >= 0.98 * goal.amount
        errors = metrics.quick(film.image, reference.image)
        curve.append(Point(film.spp, film.seconds, cpu, film.rays, errors))
        if is_last:
            flip = metrics.flip_map(film.image, reference.image, plan.exposure)
            errors["FLIP"] = float(flip.mean())
            return Repeat(film, curve, flip)
        spp *= 2


def _reference(plan: Plan, work: Work, tasks: list[Task]) -> Reference:
    if plan.given is not None:
        return plan.given
    for task in tasks:
        work.begin(task)
    reference = references.made(plan.scene, plan.reference_goal, plan.threads, work.advance)
    if tasks:
        work.finish()
    return reference
