"""The study of naive path tracing, NEE and MIS: `python -m benchmarks.mis` writes docs/mis.md and its pictures.

What has been measured is kept in build/studies, so that it goes on where it was stopped.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.figure import Figure

from etendue.comparison import techniques
from etendue.comparison.figures import COLOURS
from etendue.display import tonemap
from etendue.film import save_pixels

from .studies import (
    DOCS,
    SCENES,
    Measured,
    bias_cells,
    clear,
    conditions,
    filled,
    loaded,
    measured,
    shown,
    table,
    together,
    write,
)  # fmt: skip

PICTURES = DOCS / "pictures"
# The names of measurements that the study of roulette makes as well are the same there.
ESTIMATORS: dict[str, tuple[str, dict[str, Any]]] = {
    "naive": ("naive-threshold0.25-start1", {"algorithm": "NaivePathtracer"}),
    "NEE": ("NEE", {"algorithm": "Pathtracer", "mis": "none"}),
    "balance": ("balance", {"algorithm": "Pathtracer", "mis": "balance"}),
    "power": ("MIS-threshold0.25-start1", {"algorithm": "Pathtracer", "mis": "power"}),
}
_SIZE, _SPP = 160, 24


def found(scene: str, estimator: str) -> Measured:
    """An estimator as the scene file of the sheet has it."""
    name, keys = ESTIMATORS[estimator]
    roulette = {"rr_threshold": 0.25, "rr_min_path_length": 1}
    return measured(scene, {**keys, **roulette}, name)


def side_by_side(scene: str, name: str) -> None:
    """Naive, NEE and MIS at equal samples, as figures 2 and 3 of the sheet show them."""
    base = loaded(scene, _SIZE)
    pictures = []
    for estimator in ("naive", "NEE", "power"):
        film = base.changed(base.config).render(spp=_SPP, **ESTIMATORS[estimator][1])
        pictures.append(tonemap(film.image, base.config.framebuffer.exposure).repeat(2, 0).repeat(2, 1))
    save_pixels(PICTURES / name, np.concatenate(pictures, axis=1), {})


def pyramid(scene: str, name: str) -> None:
    """What each technique finds over 1, 2, 3 rays, alone and weighted."""
    base = loaded(scene, _SIZE)
    config = base.config.with_overrides(["algorithm=Pathtracer", "mis=power"])
    rows = techniques.measured(base.changed(config), lambda _: None)[:3]
    drawn = Figure(figsize=(9.2, 7.2), layout="constrained")
    axes = drawn.subplots(len(rows), 4)
    for line, row in zip(axes, rows, strict=True):
        cells = [(weighted, technique) for technique in (0, 1) for weighted in (1, 0)]
        for axis, (weighted, technique) in zip(line, cells, strict=True):
            axis.imshow(row.pictures[weighted, technique], interpolation="nearest")
            axis.set_xticks([])
            axis.set_yticks([])
            axis.set_xlabel(f"variance {row.variance[weighted, technique]:.2g}", fontsize=8)
            if row is rows[0]:
                axis.set_title(
                    f"{techniques.NAMES[technique]}, {('weighted', 'alone')[weighted]}", fontsize=10
                )
        rays = f"{row.edges} ray{'' if row.edges == '1' else 's'}"
        line[0].set_ylabel(rays if row.gain == 1 else f"{rays}, {row.gain:g}× brighter", fontsize=10)
    drawn.savefig(PICTURES / name, dpi=100)


def efficiencies(name: str) -> None:
    """Efficiency over naive path tracing on each scene."""
    drawn = Figure(figsize=(8, 3.2), layout="constrained")
    axis = drawn.subplots()
    places = np.arange(len(SCENES))
    for index, estimator in enumerate(("NEE", "balance", "power")):
        gains = [found(scene, estimator).gain(found(scene, "naive"), "rays") for scene in SCENES]
        values = np.array([(g.value, g.value - g.low, g.high - g.value) for g in gains]).T
        axis.bar(
            places + 0.27 * (index - 1), values[0], 0.25, yerr=values[1:], label=estimator,
            color=COLOURS[index], error_kw={"lw": 0.8},
        )  # fmt: skip
    axis.axhline(1, color="black", lw=0.7)
    axis.set_yscale("log")
    axis.set_xticks(places, SCENES)
    axis.set_ylabel("efficiency over naive")
    axis.legend(fontsize=8, ncols=3)
    axis.spines[["top", "right"]].set_visible(False)
    drawn.savefig(PICTURES / name, dpi=110)


def document() -> str:
    """The study, with the numbers in it."""
    rows, bias = [], []
    for scene in SCENES:
        naive = found(scene, "naive")
        for estimator in ESTIMATORS:
            each = found(scene, estimator)
            variance = f"{np.mean(each.variance):.3g}"
            rays, seconds = f"{np.mean(each.rays):.2f}", f"{np.mean(each.seconds) * 1e6:.1f}"
            gains = [
                shown(each.gain(naive, cost)) if each is not naive else "1" for cost in ("rays", "seconds")
            ]
            rows.append([scene, estimator, variance, rays, seconds, *gains])
            bias.append([scene, estimator, *bias_cells(each)])
    against = {
        (a, b): [found(s, a).gain(found(s, b), "rays") for s in SCENES]
        for a, b in (("NEE", "naive"), ("power", "naive"), ("power", "NEE"), ("power", "balance"))
    }
    summary = [
        [f"{a} over {b}", together(gains), f"{min(g.value for g in gains):.3g} to {max(g.value for g in gains):.3g}",
         *map(str, clear(gains))]
        for (a, b), gains in against.items()
    ]  # fmt: skip
    return filled(
        "mis.md",
        conditions=conditions(),
        spp=_SPP,
        table=table(
            [
                "scene",
                "estimator",
                "variance",
                "rays per sample",
                "CPU µs per sample",
                "efficiency by rays, over naive",
                "by CPU time",
            ],
            rows,
        ),
        summary_table=table(
            ["", "geometric mean", "range", "scenes clearly above 1", "clearly below 1"], summary
        ),
        bias_table=table(
            ["scene", "estimator", "mean over reference's", "p mean", "p tiles", "p worst", "bias"], bias
        ),
    )


if __name__ == "__main__":
    text = document()
    efficiencies("mis-efficiency.png")
    side_by_side("mis", "mis-plates.png")
    side_by_side("pots", "mis-pots.png")
    pyramid("mis", "mis-techniques.png")
    write(DOCS / "mis.md", text)
