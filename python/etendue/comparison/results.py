"""The numbers of a comparison, as results.json has them; docs/compare.md describes each field."""

from __future__ import annotations

import math
import platform
from collections.abc import Sequence
from typing import Any

from .. import machine
from ..film.origin import Origin
from ..scene import Scene
from . import bias, metrics, paths
from .bias import Bias
from .reference import Reference
from .repeats import Plan
from .statistics import CONFIDENCE, Estimate, product_of_means
from .tally import Tally

FORMAT = 1
# A reference whose own error is this part of a tested image's distorts what is measured.
REFERENCE_LIMIT = 0.1
_MOST_INVALID = 20


def of(
    plan: Plan,
    reference: Reference,
    tallies: Sequence[Tally],
    verdicts: Sequence[Bias | None],
    command: str,
) -> dict[str, Any]:
    """Everything but the images."""
    from .. import __version__

    config = plan.scene.config
    origin = Origin.of(config, plan.scene.contents, plan.scene.data_dirs)
    return {
        "format": FORMAT,
        "etendue": __version__,
        "command": command,
        "machine": {
            "system": platform.platform(),
            "processor": machine.processor()[0],
            "threads": machine.threads(),
            "python": platform.python_version(),
        },
        "scene": {
            "file": str(config.path or ""),
            "name": origin.scene_name,
            "hash": origin.scene_hash,
            "width": config.framebuffer.res_w,
            "height": config.framebuffer.res_h,
            "exposure": plan.exposure,
        },
        "goal": {"spp": plan.goal.spp, "seconds": plan.goal.seconds},
        "repeats": plan.repeats,
        "confidence": CONFIDENCE,
        "formulas": {**metrics.FORMULAS, "efficiency": "1 / (relMSE × seconds)"},
        "settings": differences(plan),
        "reference": _reference(reference, tallies),
        "estimators": [
            _estimator(tally, tallies[0], scene, verdict)
            for tally, scene, verdict in zip(tallies, plan.scenes, verdicts, strict=True)
        ],
    }


def differences(plan: Plan) -> dict[str, list[Any]]:
    """Each setting in which the estimators differ, with its value for each; None: it has none."""
    settings = []
    for scene in plan.scenes:
        settings.append(Origin.of(scene.config, scene.contents, scene.data_dirs).settings)
    keys = dict.fromkeys(key for each in settings for key in each)
    table = {key: [each.get(key) for each in settings] for key in keys}
    return {key: values for key, values in table.items() if any(value != values[0] for value in values)}


def table_of(tally: Tally, first: Tally, scene: Scene) -> dict[str, Estimate]:
    """The measured quantities of one estimator, each with its interval from the repeats."""
    pixels = tally.valid.size
    seconds, cpu, rays, spp = (tally.costs(name) for name in ("seconds", "cpu_seconds", "rays", "spp"))
    error, first_error = tally.errors("relMSE"), first.errors("relMSE")
    baseline = [(first_error, 1.0), (first.costs("seconds"), 1.0)]
    return {
        "spp": product_of_means([(spp, 1)]),
        "seconds": product_of_means([(seconds, 1)]),
        "CPU seconds": product_of_means([(cpu, 1)]),
        "rays/s": product_of_means([(rays, 1), (seconds, -1)]),
        "rays/sample": product_of_means([(rays / pixels, 1), (spp, -1)]),
        "mean path length": paths.mean_length(scene),
        **{name: product_of_means([(tally.errors(name), 1)]) for name in metrics.FORMULAS},
        "efficiency": product_of_means([(error, -1), (seconds, -1)]),
        "speed-up": product_of_means([*baseline, (error, -1), (seconds, -1)]),
    }


def _estimator(tally: Tally, first: Tally, scene: Scene, verdict: Bias | None) -> dict[str, Any]:
    return {
        "name": tally.estimator.name,
        "settings": dict(tally.estimator.settings),
        "seeds": tally.seeds,
        "table": {name: _estimate(value) for name, value in table_of(tally, first, scene).items()},
        "bias": None if verdict is None else _bias(verdict),
        "curves": [[point.as_dict() for point in curve] for curve in tally.curves],
        "invalid": {
            "count": tally.invalid_count,
            "samples": [invalid._asdict() for invalid in tally.invalid[:_MOST_INVALID]],
        },
    }


def _bias(verdict: Bias) -> dict[str, Any]:
    return {
        "verdict": verdict.words,
        "is_biased": verdict.is_biased,
        "level": bias.LEVEL,
        "ratio": _estimate(verdict.ratio),
        "p_mean": verdict.p_mean,
        "p_tiles": verdict.p_tiles,
        "p_worst": verdict.p_worst,
        "uniformity": verdict.uniformity,
        "tile": verdict.tile,
        "p_values": [[_number(p) for p in row] for row in verdict.p_values],
        "relative": [[_number(value) for value in row] for row in verdict.relative],
    }


def _reference(reference: Reference, tallies: Sequence[Tally]) -> dict[str, Any]:
    own = reference.own_errors
    shares = {
        tally.estimator.name: _number(own["relMSE"] / max(float(tally.errors("relMSE").mean()), 1e-300))
        for tally in tallies
        if own
    }
    return {
        "name": reference.name,
        "identity": reference.identity,
        "spp": reference.spp,
        "seconds": reference.seconds,
        "film": None if reference.film is None else str(reference.film),
        "errors": own,
        "share": shares,
        "too_near": [name for name, share in shares.items() if share is not None and share > REFERENCE_LIMIT],
    }


def _estimate(estimate: Estimate) -> dict[str, float | None]:
    return {name: _number(getattr(estimate, name)) for name in ("value", "low", "high")}


def _number(value: float) -> float | None:
    """For JSON, which knows no NaN and no infinity."""
    return float(value) if math.isfinite(value) else None
