"""Étendue and its peers over the same scenes, in alternation."""

from __future__ import annotations

import statistics
import sys
from collections.abc import Sequence
from dataclasses import asdict, dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .contestants import Absent, Contestant
from .scenes import prepared
from .world import World

#: of radiance squared, so that dark pixels do not decide
EPSILON = 0.01
#: share of the worst pixels that the trimmed error leaves out
FIREFLIES = 1e-3


@dataclass
class Result:
    """One renderer over one scene. Lists have an entry a repeat; ratios are Étendue's over this renderer's."""

    scene: str
    name: str
    build_seconds: float
    peak_mb: float
    seconds: list[float]
    cpu_seconds: list[float]
    samples_per_second: list[float]
    rays_per_second: float | None
    rel_mse: float
    rel_mse_trimmed: float
    efficiency: float
    mean_over_reference: float
    own_reference: bool
    speed_ratio: list[float] = field(default_factory=list)
    processor_ratio: list[float] = field(default_factory=list)
    efficiency_ratio: list[float] = field(default_factory=list)

    def row(self) -> dict[str, Any]:
        """For JSON."""
        return asdict(self)


def rel_mse(images: NDArray[np.float32], reference: NDArray[np.float32], trim: float = 0) -> float:
    """Relative mean squared error of one of several independent images (n, h, w, 3).

    The variance between them over the square of the reference, so free of the reference's noise; a bias is not in it.
    """
    variance = images.astype(float).var(0, ddof=1)
    pixels = np.sort((variance / (reference.astype(float) ** 2 + EPSILON)).mean(2), axis=None)
    return float(pixels[: len(pixels) - int(trim * len(pixels))].mean())


def say(text: str) -> None:
    """Progress, where it does not mix with results."""
    print(text, file=sys.stderr, flush=True)


def compare(
    scene: str, names: Sequence[str], size: int, spp: int, repeats: int, threads: int, options: dict[str, Any]
) -> list[Result]:
    """Builds all, then renders turn by turn; the fixed cost of a call, seen at 1 spp, is not counted."""
    path = prepared(scene)
    world = World.read(path)
    if options.get("uncoated"):
        world = world.uncoated()
    running: list[Contestant] = []
    # Seconds, and those of the processor.
    fixed: dict[str, tuple[float, float]] = {}
    for name in names:
        try:
            contestant = Contestant(name, path, size, threads, options)
            contestant.render(1, 900)
            calls = [contestant.render(1, 901 + i)[:2] for i in range(2)]
            fixed[name] = min(call[0] for call in calls), min(call[1] for call in calls)
        except Absent as absent:
            say(f"{scene}: without {absent}")
            continue
        say(f"{scene}: {name} built in {contestant.build_seconds:.1f} s")
        running.append(contestant)
    seconds: dict[str, list[float]] = {c.name: [] for c in running}
    cpu: dict[str, list[float]] = {c.name: [] for c in running}
    images: dict[str, list[NDArray[np.float32]]] = {c.name: [] for c in running}
    for repeat in range(repeats):
        # Another goes first each time.
        for contestant in running[repeat % len(running) :] + running[: repeat % len(running)]:
            taken, taken_cpu, image = contestant.render(spp, repeat + 1)
            wall, processor = fixed[contestant.name]
            seconds[contestant.name].append(max(taken - wall, 1e-3) * spp / (spp - 1))
            cpu[contestant.name].append(max(taken_cpu - processor, 1e-3) * spp / (spp - 1))
            images[contestant.name].append(image)
            say(f"{scene}: {repeat + 1}/{repeats} {contestant.name} {taken:.2f} s")
    results = []
    common = np.mean(images["etendue"], 0) if "etendue" in images else None
    for contestant in running:
        stack = np.array(images[contestant.name])
        own = not world.is_common or common is None
        reference = stack.mean(0) if own else common
        assert reference is not None
        error, times = rel_mse(stack, reference), seconds[contestant.name]
        median = statistics.median(times)
        results.append(
            Result(
                scene,
                contestant.name,
                contestant.build_seconds,
                contestant.peak_mb,
                times,
                cpu[contestant.name],
                [size * size * spp / s for s in times],
                None if contestant.rays is None else contestant.rays / median,
                error,
                rel_mse(stack, reference, FIREFLIES),
                1 / (error * median),
                float(stack.mean() / (reference if common is None else common).mean()),
                own,
            )
        )
        contestant.close()
    ours = next((r for r in results if r.name == "etendue"), None)
    for result in results if ours is not None else []:
        assert ours is not None
        result.speed_ratio = [t / o for t, o in zip(result.seconds, ours.seconds, strict=True)]
        cpu_pairs = zip(result.cpu_seconds, ours.cpu_seconds, strict=True)
        result.processor_ratio = [t / o for t, o in cpu_pairs]
        error_ratio = result.rel_mse / ours.rel_mse
        result.efficiency_ratio = [error_ratio * r for r in result.speed_ratio]
    return results


def table(results: Sequence[Result]) -> str:
    """In Markdown: medians, and ratios with the range of the repeats."""

    def spread(values: Sequence[float]) -> str:
        if not values:
            return "-"
        return f"{statistics.median(values):.2f} ({min(values):.2f} to {max(values):.2f})"

    lines = [
        "| scene | renderer | Msamples/s | Mrays/s | build s | peak MB | relMSE | trimmed | 1/(relMSE s) "
        "| mean | Étendue's speed over it | by processor seconds | efficiency |",
        "|---|---|---|---|---|---|---|---|---|---|---|---|---|",
    ]
    for r in results:
        rays = "-" if r.rays_per_second is None else f"{r.rays_per_second / 1e6:.2f}"
        star = "*" if r.own_reference else ""
        lines.append(
            f"| {r.scene} | {r.name} | {statistics.median(r.samples_per_second) / 1e6:.3f} | {rays} "
            f"| {r.build_seconds:.2f} | {r.peak_mb:.0f} | {r.rel_mse:.3g}{star} | {r.rel_mse_trimmed:.3g} "
            f"| {r.efficiency:.3g} | {r.mean_over_reference:.3f} | {spread(r.speed_ratio)} "
            f"| {spread(r.processor_ratio)} | {spread(r.efficiency_ratio)} |"
        )
    if any(r.own_reference for r in results):
        lines.append(
            "\n*: against a reference of the renderer's own, as not all define the scene's materials alike."
        )
    return "\n".join(lines)
