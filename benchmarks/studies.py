"""What the studies in docs/ share: estimators measured on the six scenes, and kept, so that a study can go on.

A measurement is a number of renders of one estimator under independent random numbers. Its variance is that of
single samples, which the film estimates without a reference; its cost is rays, which no other program disturbs,
with the processor's seconds beside it.
"""

from __future__ import annotations

import dataclasses
import json
import sys
import textwrap
import time
from collections.abc import Mapping, Sequence
from functools import cache
from pathlib import Path
from typing import Any

import jinja2
import numpy as np

import etendue
from etendue.comparison import bias, metrics, repeats
from etendue.comparison import reference as references
from etendue.comparison.estimators import Estimator
from etendue.comparison.goal import Goal
from etendue.comparison.reference import Reference
from etendue.comparison.statistics import Estimate, product_of_means
from etendue.comparison.tally import Point, Repeat, Tally

ROOT = Path(__file__).resolve().parent.parent
DOCS = ROOT / "docs"
KEPT = ROOT / "build" / "studies"
SCENES = ("box", "pots", "sibenik", "spz", "fireplace", "mis")
SIZE, SPP, REPEATS, REFERENCE_SPP = 64, 8, 8, 512
# Errors are those of independent samples: what a sampler gains on top depends on the scene.
SHARED: dict[str, Any] = {"sampler": "independent"}


@dataclasses.dataclass(frozen=True)
class Measured:
    """One estimator on one scene; lists have a number for each render.

    variance: of one sample, relative: mean over the pixels of Var / (R² + 0.01), R the reference. rays, seconds: for
    each sample, seconds those of the processor.
    """

    variance: list[float]
    rays: list[float]
    seconds: list[float]
    verdict: str
    is_biased: bool | None
    ratio: list[float]
    p_tiles: float
    p_worst: float
    p_mean: float
    p_values: list[float]

    def gain(self, other: Measured, cost: str | None) -> Estimate:
        """Efficiency 1 / (variance x cost) over that of `other`, or without a cost 1 / variance over the other's."""
        factors: list[tuple[Any, float]] = [(self.variance, -1.0), (other.variance, 1.0)]
        if cost is not None:
            factors += [(getattr(self, cost), -1.0), (getattr(other, cost), 1.0)]
        return product_of_means(factors)

    def saving(self, other: Measured, cost: str) -> Estimate:
        """The other's cost over this one's."""
        return product_of_means([(getattr(self, cost), -1.0), (getattr(other, cost), 1.0)])


def measured(scene: str, settings: Mapping[str, Any], name: str) -> Measured:
    """From the folder of kept measurements, or made and kept there."""
    keys = {**SHARED, **settings}
    path = KEPT / f"{scene}-{name}.json"
    stamp = {"settings": keys, "size": SIZE, "spp": SPP, "repeats": REPEATS, "reference": REFERENCE_SPP}
    if path.exists():
        kept = json.loads(path.read_text())
        if kept["of"] == stamp:
            return Measured(**kept["measured"])
    print(f"{scene}: {name}", file=sys.stderr, flush=True)
    found = _measure(loaded(scene), keys, reference(scene))
    KEPT.mkdir(parents=True, exist_ok=True)
    path.write_text(json.dumps({"of": stamp, "measured": dataclasses.asdict(found)}))
    return found


@cache
def loaded(scene: str, size: int = SIZE) -> etendue.Scene:
    """A scene of the sheet, in a square of `size` pixels."""
    config = etendue.read_config(
        ROOT / "configs" / f"a04_{scene}.json", [f"framebuffer.res_w={size}", f"framebuffer.res_h={size}"]
    )
    return etendue.load(config)


@cache
def reference(scene: str) -> Reference:
    """MIS without roulette, cached as those of `etendue compare` are."""
    print(f"{scene}: reference", file=sys.stderr, flush=True)
    base = loaded(scene)
    plain = base.changed(base.config.with_overrides(["rr_threshold=0"]))
    return references.made(plain, Goal(spp=REFERENCE_SPP), 0, lambda _: None)


def _measure(base: etendue.Scene, keys: Mapping[str, Any], truth: Reference) -> Measured:
    estimator = Estimator("measured", keys)
    scene = base.changed(estimator.config(base.config))
    tally = Tally(estimator)
    weight = np.square(truth.image, dtype=np.float64) + metrics.EPSILON
    variance, rays, seconds = [], [], []
    for repeat in range(REPEATS):
        start = time.process_time()
        film = repeats.with_seed(scene, repeat).render(spp=SPP)
        seconds.append((time.process_time() - start) / film.samples)
        rays.append(film.rays / film.samples)
        variance.append(float((film.variance / weight).mean()))
        tally.add(Repeat(film, [Point(SPP, film.seconds, 0, film.rays, {})]), repeat)
    verdict = bias.judge(tally, truth)
    ratio = [verdict.ratio.value, verdict.ratio.low, verdict.ratio.high]
    p_values = verdict.p_values.ravel().tolist()
    return Measured(
        variance, rays, seconds, verdict.words, verdict.is_biased, ratio, verdict.p_tiles, verdict.p_worst,
        verdict.p_mean, p_values,
    )  # fmt: skip


def bias_cells(found: Measured) -> list[str]:
    """The ratio of means with its interval, the three p-values, and the verdict in a word or two."""
    verdict = {None: "cannot tell", True: "biased", False: "none detectable"}[found.is_biased]
    if found.is_biased is None:
        return ["–"] * 4 + [verdict]
    value, low, high = (f"{x:.4f}" for x in found.ratio)
    tests = [f"{p:.2g}" for p in (found.p_mean, found.p_tiles, found.p_worst)]
    return [f"{value} ({low} to {high})", *tests, verdict]


def shown(estimate: Estimate) -> str:
    """2.31 (2.1 to 2.5), as tables have it."""
    return f"{estimate.value:.3g} ({estimate.low:.3g} to {estimate.high:.3g})"


def table(head: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    """A table in Markdown."""
    lines = [head, ["---"] * len(head), *rows]
    return "\n".join(f"| {' | '.join(line)} |" for line in lines)


def together(estimates: Sequence[Estimate]) -> str:
    """The geometric mean of estimates, as text."""
    return f"{float(np.exp(np.mean([np.log(e.value) for e in estimates]))):.3g}"


def clear(estimates: Sequence[Estimate]) -> tuple[int, int]:
    """How many intervals are above 1, and how many below."""
    return sum(e.low > 1 for e in estimates), sum(e.high < 1 for e in estimates)


def conditions() -> str:
    """The sentence that says how all numbers came about."""
    return (
        f"{SIZE} x {SIZE} pixels, {REPEATS} renders of {SPP} independent samples per pixel for each number, under "
        "seeds of their own; intervals are 95%, Student's on the logarithm of the ratio of means, with renders of "
        "one seed paired."
    )


def filled(name: str, **values: object) -> str:
    """The text of that name in texts/ with the values in their places."""
    folder = jinja2.FileSystemLoader(Path(__file__).parent / "texts")
    environment = jinja2.Environment(
        loader=folder, undefined=jinja2.StrictUndefined, keep_trailing_newline=True
    )
    paragraphs = environment.get_template(name).render(values).split("\n\n")
    return "\n\n".join(
        each if each.startswith(("|", "#", "!", "-")) else wrapped(each) for each in paragraphs
    )


def wrapped(paragraph: str) -> str:
    """Its words in lines of the usual length."""
    end = "\n" if paragraph.endswith("\n") else ""
    return (
        textwrap.fill(" ".join(paragraph.split()), 118, break_long_words=False, break_on_hyphens=False) + end
    )


def write(path: Path, text: str) -> None:
    """Puts the document in its place and says so."""
    path.write_text(text, encoding="utf-8")
    print(path.relative_to(ROOT), file=sys.stderr)
