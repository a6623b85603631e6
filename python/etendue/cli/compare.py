"""What `etendue compare` does, around the comparison itself."""

from __future__ import annotations

import shlex
import sys
import time
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..comparison import Comparison, estimators, extras, finish, metrics, plan_of
from ..comparison.repeats import Interrupted
from ..comparison.work import Report
from ..config import read_config
from ..errors import EtendueError, nearest_name
from ..film import resuming
from ..words import clock
from . import memory
from .interrupts import Interrupts

if TYPE_CHECKING:
    from ..config.overrides import Override

FAILED = 1


@dataclass(frozen=True)
class Job:
    """One call of `etendue compare`."""

    config: Path
    estimators: str
    overrides: Sequence[str | Override]
    output: Path
    spp: int | None
    time: float | None
    repeats: int
    reference: Path | None
    reference_spp: int | None
    threads: int
    data_dirs: Sequence[Path]
    limits: Mapping[str, float]
    fail_if_biased: bool
    quiet: bool

    def say(self, text: str) -> None:
        """A line for people."""
        if not self.quiet:
            print(text, file=sys.stderr, flush=True)


def limits(texts: Sequence[str]) -> dict[str, float]:
    """The values of --fail-above by metric."""
    known = {name.lower(): name for name in metrics.FORMULAS}
    found = {}
    for text in texts:
        name, _, value = text.partition("=")
        metric = known.get(name.strip().lower())
        if metric is None:
            near = nearest_name(name, metrics.FORMULAS)
            hint = f'did you mean "{near}"? ' if near else ""
            allowed = ", ".join(metrics.FORMULAS)
            raise EtendueError(f'--fail-above: there is no metric "{name}" ({hint}allowed: {allowed})')
        try:
            found[metric] = float(value)
        except ValueError:
            raise EtendueError(
                f"--fail-above: METRIC=VALUE is needed, as in relMSE=0.01, not {text}"
            ) from None
        if not found[metric] >= 0:
            raise EtendueError(f"--fail-above: a value of 0 or more is needed, not {text}")
    return found


def run(job: Job) -> int:
    """Compare as `job` says; the exit code: 0, 1 where a limit is exceeded, or 130 or 143 after a signal."""
    with Interrupts() as interrupts:
        try:
            return _run(job)
        except Interrupted as interrupted:
            done = f"{interrupted.done} of {interrupted.whole} renders are done"
            job.say(
                f"interrupted: {done} and kept in {job.output / 'parts'}; the same command goes on from them"
            )
            return interrupts.exit_code
        except KeyboardInterrupt:
            print("interrupted", file=sys.stderr)
            return interrupts.exit_code


def _run(job: Job) -> int:
    from ..scene import load

    extras.require()
    chosen = estimators.parse(job.estimators)
    config = read_config(job.config, job.overrides, job.data_dirs)
    memory.require(config)
    for name in config.scenes_to_build(job.data_dirs):
        job.say(f"building the bundled scene {name}, this once")
    scene = load(config, data_dirs=job.data_dirs)
    for warning in scene.warnings:
        job.say(f"warning: {warning}")
    plan = plan_of(
        scene, chosen, job.spp, job.time, job.reference, job.repeats, job.output, None, job.threads,
        job.data_dirs, job.reference_spp, _changes(job.overrides),
    )  # fmt: skip
    with _shown(job.quiet) as report:
        comparison = finish(plan, report, shlex.join([resuming.program(), *sys.argv[1:]]))
    for line in _closing(comparison):
        job.say(line)
    job.say(str(job.output / "index.html"))
    failures = comparison.exceeds(job.limits)
    if job.fail_if_biased:
        failures += [
            f"{each['name']}: {each['bias']['verdict']}"
            for each in comparison.results["estimators"]
            if each["bias"] is not None and each["bias"]["is_biased"]
        ]
    for failure in failures:
        print(failure, file=sys.stderr)
    return FAILED if failures else 0


def _changes(overrides: Sequence[str | Override]) -> list[str]:
    """As for --set; each repeat has a seed of its own."""
    texts = [each if isinstance(each, str) else f"{each.key}={each.value}" for each in overrides]
    return [text for text in texts if not text.startswith("seed=")]


def _closing(comparison: Comparison) -> Iterator[str]:
    found = comparison.results
    width = max(len(each["name"]) for each in found["estimators"])
    for each in found["estimators"]:
        table = each["table"]
        verdict = "one repeat: no verdict" if each["bias"] is None else each["bias"]["verdict"]
        yield (
            f"{each['name']:<{width}}  relMSE {_shortly(table['relMSE'])}  {clock(table['seconds']['value'])}  "
            f"speed-up {_shortly(table['speed-up'])}  {verdict}"
        )
    for name in found["reference"]["too_near"]:
        share = found["reference"]["share"][name]
        yield f"warning: the reference's own error is {share:.0%} of that of {name}; --reference-spp gives it more"


def _shortly(estimate: dict[str, float | None]) -> str:
    value, low, high = (estimate[name] for name in ("value", "low", "high"))
    if value is None:
        return "-"
    return f"{value:.3g}" if low is None or high is None else f"{value:.3g} ({low:.3g} to {high:.3g})"


@contextmanager
def _shown(quiet: bool) -> Iterator[Report | None]:
    """A report that is shown on stderr: as a bar in a terminal, as a line every tenth in a log."""
    if quiet:
        yield None
    elif sys.stderr.isatty():
        with _bar() as report:
            yield report
    else:
        yield _lines()


def _lines() -> Report:
    tenths = 0

    def report(part: float, left: float | None, what: str) -> None:
        nonlocal tenths
        if int(part * 10) > tenths:
            tenths = int(part * 10)
            print(f"{_words(part, left)}  {what}", file=sys.stderr, flush=True)

    return report


@contextmanager
def _bar() -> Iterator[Report]:
    from rich.console import Console
    from rich.progress import BarColumn, Progress, TextColumn

    columns = [
        BarColumn(),
        TextColumn("{task.fields[words]}"),
        TextColumn("{task.description}", markup=False),
    ]
    shown_at = 0.0
    # Drawn by the renderer's own reports; a refreshing thread would take time from the rendering.
    with Progress(*columns, console=Console(stderr=True), auto_refresh=False, transient=True) as progress:
        blank: dict[str, Any] = {"words": ""}
        task = progress.add_task("", total=1.0, **blank)

        def report(part: float, left: float | None, what: str) -> None:
            nonlocal shown_at
            if time.monotonic() - shown_at > 0.1:
                shown_at = time.monotonic()
                progress.update(
                    task, completed=part, description=what, words=_words(part, left), refresh=True
                )

        yield report


def _words(part: float, left: float | None) -> str:
    return f"{min(int(part * 100), 99)}%" + (f"  {clock(left)} left" if left is not None else "")
