"""The study of Russian roulette: `python -m benchmarks.roulette` writes docs/russian-roulette.md and its figure.

What has been measured is kept in build/studies, so that it goes on where it was stopped.
"""

from __future__ import annotations

from typing import Any

from matplotlib.figure import Figure

from etendue.comparison.figures import COLOURS
from etendue.comparison.statistics import Estimate, uniformity

from .studies import (
    DOCS,
    SCENES,
    Measured,
    bias_cells,
    clear,
    conditions,
    filled,
    measured,
    shown,
    table,
    together,
    write,
)  # fmt: skip

TRACERS: dict[str, dict[str, Any]] = {
    "naive": {"algorithm": "NaivePathtracer"},
    "MIS": {"algorithm": "Pathtracer", "mis": "power"},
}
THRESHOLDS = (0.0625, 0.25, 1.0, 4.0)
STARTS = (0, 1, 3)
DEFAULT = (0.25, 1)


def found(scene: str, tracer: str, threshold: float, start: int) -> Measured:
    """The tracer with these roulette settings; a threshold of 0: without."""
    name = f"{tracer}-threshold{threshold:g}-start{start}"
    return measured(scene, {**TRACERS[tracer], "rr_threshold": threshold, "rr_min_path_length": start}, name)


def off(scene: str, tracer: str) -> Measured:
    """The tracer without roulette."""
    return found(scene, tracer, 0, 1)


def against(scene: str, tracer: str, threshold: float, start: int, cost: str | None) -> Estimate:
    """The gain of roulette over none."""
    return found(scene, tracer, threshold, start).gain(off(scene, tracer), cost)


def bias_rows() -> list[list[str]]:
    """Each scene and tracer with the default roulette and the strongest."""
    rows = []
    for scene in SCENES:
        for tracer in TRACERS:
            for threshold in (DEFAULT[0], THRESHOLDS[-1]):
                each = found(scene, tracer, threshold, DEFAULT[1])
                rows.append([scene, tracer, f"{threshold:g}", *bias_cells(each)])
    return rows


def bias_words() -> str:
    """The count of verdicts, and whether p-values are uniform."""
    every = [
        found(scene, tracer, threshold, DEFAULT[1])
        for scene in SCENES
        for tracer in TRACERS
        for threshold in (DEFAULT[0], THRESHOLDS[-1])
    ]
    biased = sum(each.is_biased is True for each in every)
    unknown = sum(each.is_biased is None for each in every)
    p = [p for each in every for p in each.p_values]
    return (
        f"Of {len(every)} combinations of scene, tracer and threshold, {biased} are called biased at the level of 0.1% "
        f"and {unknown} are too noisy to tell. The {len(p)} p-values of single tiles are uniform by Kolmogorov "
        f"and Smirnov with p = {uniformity(p):.2g}."
    )


def default_rows() -> list[list[str]]:
    """Variance, cost and efficiency of the default over none."""
    rows = []
    for scene in SCENES:
        for tracer in TRACERS:
            with_it, without = found(scene, tracer, *DEFAULT), off(scene, tracer)
            variance = without.gain(with_it, None)
            savings = [shown(with_it.saving(without, cost)) for cost in ("rays", "seconds")]
            gains = [shown(with_it.gain(without, cost)) for cost in ("rays", "seconds")]
            rows.append([scene, tracer, shown(variance), *savings, *gains])
    return rows


def sweep_rows(tracer: str) -> list[list[str]]:
    """Efficiency over none for each threshold and start, the geometric mean of the scenes."""
    rows = []
    for start in STARTS:
        gains = [[against(s, tracer, threshold, start, "rays") for s in SCENES] for threshold in swept(start)]
        cells = dict(zip(swept(start), map(together, gains), strict=True))
        rows.append([str(start), *(cells.get(threshold, "") for threshold in THRESHOLDS)])
    return rows


def swept(start: int) -> tuple[float, ...]:
    """Thresholds that are measured with this start: all with the default's, and the default with others."""
    return THRESHOLDS if start == DEFAULT[1] else DEFAULT[:1]


def figure() -> None:
    """Cost, variance and efficiency over thresholds, each over none: a line for each scene."""
    drawn = Figure(figsize=(10, 6.4), layout="constrained")
    axes = drawn.subplots(2, 3, sharex=True)
    for row, tracer in enumerate(TRACERS):
        for column, title in enumerate(("rays of a sample", "variance of a sample", "efficiency")):
            axis = axes[row][column]
            for colour, scene in zip(COLOURS, SCENES, strict=False):
                values = []
                for threshold in THRESHOLDS:
                    with_it, without = found(scene, tracer, threshold, DEFAULT[1]), off(scene, tracer)
                    quantity = (
                        without.saving(with_it, "rays"),
                        without.gain(with_it, None),
                        with_it.gain(without, "rays"),
                    )[column]
                    values.append((quantity.value, quantity.low, quantity.high))
                middle, low, high = zip(*values, strict=True)
                axis.plot(THRESHOLDS, middle, color=colour, marker="o", ms=3, label=scene)
                axis.fill_between(THRESHOLDS, low, high, color=colour, alpha=0.15, lw=0)
            axis.axhline(1, color="black", lw=0.7, ls=":")
            axis.set_xscale("log", base=2)
            axis.set_xticks(THRESHOLDS, [f"{threshold:g}" for threshold in THRESHOLDS])
            axis.set_yscale("log")
            axis.set_title(f"{tracer}: {title}", fontsize=10)
            axis.spines[["top", "right"]].set_visible(False)
    for axis in axes[1]:
        axis.set_xlabel("rr_threshold")
    axes[0][0].set_ylabel("with roulette / without")
    axes[1][0].set_ylabel("with roulette / without")
    axes[0][0].legend(fontsize=8)
    drawn.savefig(DOCS / "pictures" / "russian-roulette.png", dpi=110)


def document() -> str:
    """The study, with the numbers in it."""
    pairs = [(scene, tracer) for scene in SCENES for tracer in TRACERS]
    default = [found(s, t, *DEFAULT) for s, t in pairs]
    without = [off(s, t) for s, t in pairs]
    variances = [w.gain(d, None) for d, w in zip(default, without, strict=True)]
    savings = [d.saving(w, "rays") for d, w in zip(default, without, strict=True)]
    gains = [d.gain(w, "rays") for d, w in zip(default, without, strict=True)]
    more, less = clear(variances)
    better, worse = clear(gains)
    by_tracer = {
        t: together([g for g, (_, of) in zip(gains, pairs, strict=True) if of == t]) for t in TRACERS
    }
    strong = {t: [against(s, t, 4.0, 1, "rays") for s in SCENES] for t in TRACERS}
    head = ["bounces before it", *(f"threshold {threshold:g}" for threshold in THRESHOLDS)]
    return filled(
        "russian-roulette.md",
        conditions=conditions(),
        bias_words=bias_words(),
        threshold=f"{DEFAULT[0]:g}",
        strongest=f"{THRESHOLDS[-1]:g}",
        bias_table=table(
            ["scene", "tracer", "threshold", "mean over reference's", "p mean", "p tiles", "p worst", "bias"],
            bias_rows(),
        ),
        variance=together(variances),
        more=more,
        less=less,
        cases=len(pairs),
        saving=together(savings),
        default_table=table(
            [
                "scene",
                "tracer",
                "variance, with / without",
                "fewer rays",
                "less CPU time",
                "efficiency by rays",
                "efficiency by CPU time",
            ],
            default_rows(),
        ),
        start=DEFAULT[1],
        sweep_naive=table(head, sweep_rows("naive")),
        sweep_mis=table(head, sweep_rows("MIS")),
        speed_up_naive=by_tracer["naive"],
        speed_up_mis=by_tracer["MIS"],
        better=better,
        worse=worse,
        strong_naive_least=f"{min(e.value for e in strong['naive']):.2g}",
        strong_naive_most=f"{max(e.value for e in strong['naive']):.2g}",
        strong_mis_least=f"{min(e.value for e in strong['MIS']):.2g}",
        strong_mis_most=f"{max(e.value for e in strong['MIS']):.2g}",
    )


if __name__ == "__main__":
    text = document()
    figure()
    write(DOCS / "russian-roulette.md", text)
