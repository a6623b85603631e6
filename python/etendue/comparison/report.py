"""The report: one HTML page that needs nothing but a browser."""

from __future__ import annotations

import json
import math
import shlex
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from ..display import tonemap
from ..film import resuming
from . import bias, crops, extras, figures, metrics, packing
from .bias import Bias
from .reference import Reference
from .repeats import Plan
from .tally import Invalid, Tally

_PAGE = Path(__file__).parent / "page"
_LARGE = 1 << 19
# p-values that make a histogram.
_FEWEST_TILES = 8
# Rows of the table: name, key in the results, what it means, and whether large is good (None: neither).
_ROWS: tuple[tuple[str, str, bool | None], ...] = (
    ("spp", "samples per pixel of one image", None),
    ("seconds", "rendering one image, on this machine", False),
    ("CPU seconds", "of all threads together", False),
    ("rays/s", "shadow rays included", True),
    ("rays/sample", "shadow rays included", False),
    ("mean path length", "edges, of 4,096 replayed paths", None),
    ("MSE", metrics.FORMULAS["MSE"], False),
    ("relMSE", metrics.FORMULAS["relMSE"], False),
    ("trimmed relMSE", metrics.FORMULAS["trimmed relMSE"], False),
    ("FLIP", metrics.FORMULAS["FLIP"], False),
    ("efficiency", "1 / (relMSE × seconds)", True),
    ("speed-up", "efficiency over that of the first", True),
)


def html(
    plan: Plan,
    reference: Reference,
    tallies: Sequence[Tally],
    verdicts: Sequence[Bias | None],
    results: dict[str, Any],
) -> str:
    """The page. Every name in it is escaped, and its policy lets it load nothing."""
    environment = extras.needed("jinja2").Environment(
        loader=extras.needed("jinja2").FileSystemLoader(_PAGE),
        autoescape=True,
        trim_blocks=True,
        lstrip_blocks=True,
        undefined=extras.needed("jinja2").StrictUndefined,
    )
    return str(
        environment.get_template("report.html").render(
            results=results,
            title=f"{results['scene']['name']}: {', '.join(tally.estimator.name for tally in tallies)}",
            settings=_settings(results),
            table=_table(results),
            curves=figures.curves([t.estimator.name for t in tallies], [t.curves for t in tallies]),
            verdicts=_verdicts(verdicts, results),
            level=bias.LEVEL,
            crops=_crops(plan, reference, tallies),
            pyramids=_pyramids(tallies),
            invalid=_invalid(plan, tallies),
            viewer=_viewer(plan, reference, tallies),
            flip_book=extras.flip_book_script(),
            style=(_PAGE / "report.css").read_text(encoding="utf-8"),
            script=(_PAGE / "report.js").read_text(encoding="utf-8"),
            shortly=shortly,
        )
    )


def shortly(value: float | None, digits: int = 3) -> str:
    """A number as people read it: 0.0123, 1.23 M."""
    if value is None or not math.isfinite(value):
        return "–"
    for factor, unit in ((1e9, " G"), (1e6, " M"), (1e4, " k")):
        if abs(value) >= factor:
            return f"{value / (1e3 if unit == ' k' else factor):.{digits}g}{unit}"
    if abs(value) >= 10 ** (digits - 1):
        return f"{value:.0f}"
    return f"{value:.{digits}g}"


def _settings(results: dict[str, Any]) -> list[tuple[str, list[str]]]:
    return [
        (key, ["–" if value is None else json.dumps(value, ensure_ascii=False) for value in values])
        for key, values in results["settings"].items()
    ]


def _table(results: dict[str, Any]) -> list[dict[str, Any]]:
    rows = []
    for name, meaning, large_is_good in _ROWS:
        cells = [estimator["table"][name] for estimator in results["estimators"]]
        known = [cell["value"] for cell in cells if cell["value"] is not None]
        best = None
        if large_is_good is not None and len(set(known)) > 1:
            best = max(known) if large_is_good else min(known)
        rows.append(
            {
                "name": name,
                "meaning": meaning,
                "cells": [
                    {
                        "value": shortly(cell["value"]),
                        "interval": _interval(cell),
                        "best": best is not None and cell["value"] == best,
                    }
                    for cell in cells
                ],
            }
        )
    return rows


def _interval(cell: dict[str, float | None]) -> str:
    if cell["low"] is None or cell["high"] is None or cell["low"] == cell["high"]:
        return ""
    return f"{shortly(cell['low'])} to {shortly(cell['high'])}"


def _verdicts(verdicts: Sequence[Bias | None], results: dict[str, Any]) -> list[dict[str, Any]]:
    found = []
    for verdict, estimator in zip(verdicts, results["estimators"], strict=True):
        if verdict is None:
            continue
        tiles = verdict.p_values.size
        found.append(
            {
                "name": estimator["name"],
                "state": {None: "unknown", True: "biased", False: "fine"}[verdict.is_biased],
                "numbers": estimator["bias"],
                "map": figures.bias_map(verdict) if tiles > 1 else "",
                "histogram": figures.p_values(verdict) if tiles >= _FEWEST_TILES else "",
            }
        )
    return found


def _crops(plan: Plan, reference: Reference, tallies: Sequence[Tally]) -> list[dict[str, Any]]:
    images = [tally.film.image for tally in tallies]
    found = []
    for crop in crops.chosen(images, reference.image):
        truth = crop.of(reference.image)
        columns = [{"name": "reference", "error": "", "image": _shown(truth, plan.exposure)}]
        for tally, image in zip(tallies, images, strict=True):
            error = float(metrics.relative_squared_error(crop.of(image), truth).mean())
            picture = _shown(crop.of(image), plan.exposure)
            columns.append({"name": tally.estimator.name, "error": shortly(error), "image": picture})
        found.append({"x": crop.x, "y": crop.y, "size": crop.size, "columns": columns})
    return found


def _shown(image: Any, exposure: float) -> str:
    return figures.png(tonemap(image, exposure))


def _pyramids(tallies: Sequence[Tally]) -> list[dict[str, Any]]:
    return [
        {
            "name": tally.estimator.name,
            "bars": figures.pyramid_bars(tally.techniques),
            "rows": [
                {
                    "edges": row.edges,
                    "gain": f"{row.gain:g}",
                    # In the order of the page: alone and weighted, for each technique.
                    "pictures": [figures.jpeg(row.pictures[w, t]) for t in (0, 1) for w in (1, 0)],
                }
                for row in tally.techniques
            ],
        }
        for tally in tallies
    ]


def _invalid(plan: Plan, tallies: Sequence[Tally]) -> list[dict[str, Any]]:
    return [
        {
            "name": tally.estimator.name,
            "count": tally.invalid_count,
            "samples": [
                {
                    "place": f"{i.x},{i.y}",
                    "sample": i.sample,
                    "seed": i.seed,
                    "command": replay(plan, tally, i),
                }
                for i in tally.invalid[:20]
            ],
        }
        for tally in tallies
        if tally.invalid_count
    ]


def replay(plan: Plan, tally: Tally, invalid: Invalid) -> str:
    """The command that tells the path of a sample of one of the repeats."""
    path = plan.scene.config.path
    words = [resuming.program(), "replay", "CONFIG" if path is None else str(path)]
    words += [
        "--pixel",
        f"{invalid.x},{invalid.y}",
        "--sample",
        str(invalid.sample),
        "--seed",
        str(invalid.seed),
    ]
    words += [word for folder in plan.scene.data_dirs for word in ("--data", str(folder))]
    settings = [f"{key}={json.dumps(value)}" for key, value in tally.estimator.settings.items()]
    words += [word for setting in [*plan.changes, *settings] for word in ("--set", setting)]
    return " ".join([words[0], *map(shlex.quote, words[1:])])


def _viewer(plan: Plan, reference: Reference, tallies: Sequence[Tally]) -> dict[str, Any]:
    """What the page's script shows: errors are computed there, from these."""
    height, width = reference.image.shape[:2]
    # Right to 0.25%; of large images to 0.5%, so that three estimators at 1024 x 1024 stay below 30 MB.
    bits = 8 if width * height <= _LARGE else 7
    estimators = []
    for tally in tallies:
        variance = tally.sample_variance
        known = variance[variance > 0]
        estimators.append(
            {
                "name": tally.estimator.name,
                "image": packing.packed(tally.film.image, bits),
                "variance": packing.packed(variance, bits=3),
                "variance_top": float(np.percentile(known, 99)) if known.size else 1.0,
                "samples": packing.packed(tally.film.sample_count),
                "samples_top": int(tally.film.sample_count.max()),
                "flip": packing.packed(np.round(tally.flip_map(reference.image, plan.exposure) * 100)),
            }
        )
    return {
        "width": width,
        "height": height,
        "exposure": plan.exposure,
        "epsilon": metrics.EPSILON,
        "reference": packing.packed(reference.image, bits),
        "estimators": estimators,
    }
