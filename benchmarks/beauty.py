"""What a beauty render's bound is worth: `python -m benchmarks.beauty` writes the tables of docs/beauty-render.md.

How many samples a tile gets depends on its own first samples and the bound alone, so uniform renders, looked at after
each stage of the schedule, tell what beauty renders of any bound would have given; one real beauty render a scene is
compared with that, bit for bit. What is true is told by the renders with other seeds.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

import etendue
from etendue.film.error import TILE

ROOT = Path(__file__).resolve().parents[1]
PAGE = ROOT / "docs" / "beauty-render.md"
SCENES = ("box", "pots", "sibenik", "spz", "fireplace", "mis")
Floats = NDArray[np.float64]


def stages(most: int) -> list[int]:
    """16, 24, 32, 48, 64 ... to `most`."""
    found, octave = [], 16
    while octave <= most:
        found += [octave, octave * 3 // 2]
        octave *= 2
    return [stage for stage in found if stage <= most]


def tile_means(values: Floats) -> Floats:
    """(..., height, width, 3) to (..., tile), the mean over pixels and channels."""
    *outer, height, width, _ = values.shape
    cut = values.reshape(*outer, height // TILE, TILE, width // TILE, TILE, 3)
    return cut.mean(axis=(-4, -2, -1)).reshape(*outer, -1)


@dataclass
class Renders:
    """One scene at all stages, for all seeds.

    image: (seed, stage, height, width, 3). tile_error, of_squares: (seed, stage, tile), estimates from halves and
    from sums of squares. error: (seed, stage, 3), the film's with its interval.
    """

    name: str
    stages: list[int]
    image: Floats
    tile_error: Floats
    of_squares: Floats
    error: Floats

    @property
    def radiance(self) -> Floats:
        """Of the tiles, at least a hundredth of the image's."""
        mean = tile_means(self.image[:, -1]).mean(axis=0)
        return np.maximum(mean, mean.mean() / 100)

    def true_error(self, images: Floats) -> Floats:
        """(seed, tile): the relative root mean square error of one image a seed, against all other seeds."""
        last, seeds = self.image[:, -1], len(self.image)
        reference = (last.sum(axis=0) - last) / (seeds - 1)
        noise = tile_means(last.var(axis=0, ddof=1)) / (seeds - 1)
        squared = tile_means((images - reference) ** 2) - noise
        return np.sqrt(np.maximum(squared, 0)) / self.radiance


def render(name: str, size: int, seeds: int, most: int, say: Callable[[str], None]) -> Renders:
    """Uniform renders of a bundled scene, and their estimates at each stage."""
    scene = etendue.load(ROOT / "configs" / f"a04_{name}.json")
    rows: list[list[tuple[Floats, ...]]] = []
    for seed in range(seeds):
        film, row = None, []
        for stage in stages(most):
            film = scene.render(spp=stage, size=(size, size), seed=seed, resume=film)
            error = film.error
            squares = tile_means(film.variance / film.sample_count[..., None])
            row.append((film.image.astype(np.float64), error.tiles.ravel(), squares, np.array(error[:3])))
        rows.append(row)
        say(f"{name}: seed {seed + 1} of {seeds}")
    parts = [np.array([[step[part] for step in row] for row in rows]) for part in range(4)]
    found = Renders(name, stages(most), *parts)
    found.of_squares = np.sqrt(found.of_squares) / found.radiance
    bound = bounds(found)[0]
    film = scene.render(size=(size, size), seed=0, beauty_render=True, error_eps=bound)
    if not np.array_equal(film.image, stopped(found, bound)[0][0].astype(np.float32)):
        sys.exit(f"{name}: the beauty render is not what its stages say")
    return found


def bounds(renders: Renders) -> tuple[float, float]:
    """An easy and a hard bound: what uniform sampling keeps with a quarter and with half of the samples."""
    most = renders.stages[-1]
    errors = [renders.error[0, renders.stages.index(most // part), 0] for part in (4, 2)]
    easy, hard = (float(f"{1.05 * error:.2g}") for error in errors)
    return easy, hard


def stopped(renders: Renders, bound: float) -> tuple[Floats, NDArray[np.int64], Floats]:
    """Beauty renders of all seeds: images, the stage of each tile, and for each seed the film's error and interval."""
    seeds, count, tiles = renders.tile_error.shape
    enough = -(-95 * tiles // 100)
    images = np.empty_like(renders.image[:, 0])
    ends = np.empty((seeds, tiles), np.int64)
    for seed in range(seeds):
        within = renders.tile_error[seed] <= bound
        need = np.where(within.any(axis=0), within.argmax(axis=0), count - 1)
        last = np.sort(need)[enough - 1]
        ends[seed] = np.minimum(need, last)
        where = ends[seed].reshape(images.shape[1] // TILE, -1).repeat(TILE, 0).repeat(TILE, 1)
        images[seed] = np.take_along_axis(renders.image[seed], where[None, :, :, None], axis=0)[0]
    errors = np.take_along_axis(renders.tile_error, ends[:, None], axis=1)[:, 0]
    return images, ends, np.sort(errors, axis=1)[:, enough - 1]


def true_film_error(tiles: Floats) -> Floats:
    """(seed,): what 95% of the tiles do not exceed."""
    return np.sort(tiles, axis=1)[:, -(-95 * tiles.shape[1] // 100) - 1]


def estimate_rows(all_renders: list[Renders]) -> Iterator[tuple[str, ...]]:
    """Estimated over true error of tiles at several stages, the median over tiles."""
    yield "scene", "samples", "from halves", "from sums of squares"
    for renders in all_renders:
        for stage in (16, renders.stages[-1]):
            at = renders.stages.index(stage)
            truth = np.sqrt(tile_means(renders.image[:, at].var(axis=0, ddof=1))) / renders.radiance
            ratios = [
                np.median(np.sqrt((estimate[:, at] ** 2).mean(axis=0)) / truth)
                for estimate in (renders.tile_error, renders.of_squares)
            ]
            yield renders.name, str(stage), *(f"{ratio:.2f}" for ratio in ratios)


def bound_rows(all_renders: list[Renders]) -> Iterator[tuple[str, ...]]:
    """How the bounds are kept, and at what cost and bias."""
    yield (
        "scene",
        "`error_eps`",
        "tiles that keep it",
        "true error",
        "in interval",
        "samples",
        "uniform, same bound",
        "uniform, same true error",
        "bias of the image",
        "bias of a tile",
    )
    for renders in all_renders:
        for bound in bounds(renders):
            yield renders.name, f"{bound:g}", *_row(renders, bound)


def _row(renders: Renders, bound: float) -> Iterator[str]:
    images, ends, estimates = stopped(renders, bound)
    counts = np.array(renders.stages)
    truth = renders.true_error(images)
    film_truth = true_film_error(truth)
    spreads = renders.error[:, :, 1:] / renders.error[:, :, :1]
    last = ends.max(axis=1)
    interval = np.take_along_axis(spreads, last[:, None, None], axis=1)[:, 0] * estimates[:, None]
    inside = (interval[:, 0] <= film_truth) & (film_truth <= interval[:, 1])
    spp = counts[ends].mean()
    uniform = counts[last].mean()
    by_stage = [true_film_error(renders.true_error(renders.image[:, k])).mean() for k in range(len(counts))]
    # Both fall along the stages; between two, with a power of the samples.
    equal = np.exp(np.interp(-np.log(film_truth.mean()), -np.log(by_stage), np.log(counts)))
    yield f"{(truth <= bound).mean():.1%}"
    yield f"{film_truth.mean():.3g}"
    yield f"{inside.sum()} of {len(inside)}"
    yield f"{spp:.0f}"
    yield f"{uniform:.0f} ({spp / uniform:.0%})"
    yield f"{equal:.0f} ({spp / equal:.0%})"
    # Against the same seeds' full renders, which share most of the noise.
    difference = tile_means(images) - tile_means(renders.image[:, -1])
    for relative in (
        difference.mean(axis=1) / tile_means(renders.image[:, -1]).mean(),
        (difference / renders.radiance).mean(axis=1),
    ):
        yield f"{100 * relative.mean():+.2f} ± {100 * relative.std(ddof=1) / len(relative) ** 0.5:.2f}%"


def table(rows: Iterator[tuple[str, ...]]) -> str:
    """In Markdown."""
    head, *body = rows
    lines = [head, ("---",) * len(head), *body]
    return "\n".join("| " + " | ".join(line) + " |" for line in lines)


def put(page: str, name: str, text: str) -> str:
    """The page with `text` between the marks of this name."""
    first, last = f"<!-- {name} -->\n", f"<!-- end of {name} -->"
    before, rest = page.split(first)
    return f"{before}{first}{text}\n{last}{rest.split(last)[1]}"


def main() -> None:
    """Measure, and write the tables into the page."""
    options = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    options.add_argument(
        "--size", type=int, default=128, help="width and height of the images (a multiple of 16)"
    )
    options.add_argument("--seeds", type=int, default=4, help="renders of each scene")
    options.add_argument("--samples", type=int, default=128, help="most samples per pixel (a power of two)")
    options.add_argument("--scenes", nargs="+", default=SCENES, choices=SCENES)
    options.add_argument("--print", action="store_true", help="print the tables instead")
    chosen = options.parse_args()

    def say(text: str) -> None:
        print(text, file=sys.stderr, flush=True)

    found = [render(name, chosen.size, chosen.seeds, chosen.samples, say) for name in chosen.scenes]
    how = f"{chosen.size} x {chosen.size} pixels, {chosen.seeds} seeds of up to {chosen.samples} samples per pixel.\n\n"
    tables = {"estimates": table(estimate_rows(found)), "bounds": table(bound_rows(found))}
    page = PAGE.read_text(encoding="utf-8") if not chosen.print else ""
    for name, text in tables.items():
        if chosen.print:
            print(how + text + "\n")
        else:
            page = put(page, name, how + text)
    if not chosen.print:
        PAGE.write_text(page, encoding="utf-8")


if __name__ == "__main__":
    main()
