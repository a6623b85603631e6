"""Films of disjoint samples of one scene added up to the film of all of them."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterable, Iterator
from os import PathLike
from pathlib import Path
from typing import NamedTuple

from ..errors import EtendueError
from . import MOST_INVALID_LISTED, Film, mean_of, sample_ranges
from . import file as film_file
from .origin import Origin, attributes_of


class _Part(NamedTuple):
    name: str
    header: Film
    origin: Origin
    path: Path | None

    def film(self) -> Film:
        """With its arrays; those of files are read in turn, so that one at a time is in memory."""
        return self.header if self.path is None else film_file.read(self.path)


def merge(films: Iterable[Film | str | PathLike[str]]) -> Film:
    """The film of all samples of `films`: `Film`s or film files, in any order.

    All must be of the same scene, settings and version, and hold different samples. Raises EtendueError, with
    what differs or which samples are there twice.
    """
    parts = [_part(film, index) for index, film in enumerate(films)]
    if not parts:
        raise EtendueError("merge: at least one film is needed")
    _require_same_origin(parts)
    _require_disjoint(parts)
    # Sums of doubles depend on their order a little; in this one, they do not depend on that of `films`.
    parts.sort(key=lambda part: part.header.held)
    films_in_order = (part.film() for part in parts)
    whole = _sum(films_in_order)
    whole.goal = sample_ranges.hull(part.header.goal for part in parts)
    whole.complete = whole.missing == 0
    whole.origin = dataclasses.replace(parts[0].origin, config=_config_of(whole, parts[0].origin))
    whole.attributes = attributes_of(whole)
    return whole


def _part(film: Film | str | PathLike[str], index: int) -> _Part:
    path = None if isinstance(film, Film) else Path(film)
    header = film if isinstance(film, Film) else film_file.read_header(film)
    name = f"film {index + 1}" if path is None else str(path)
    if header.origin is None:
        raise EtendueError(f"merge: {name} does not come from a render")
    return _Part(name, header, header.origin, path)


def _require_same_origin(parts: list[_Part]) -> None:
    first, *others = parts
    problems = []
    for part in others:
        refusal = f"{part.name}: not of the same scene and settings as {first.name}"
        try:
            part.origin.require_same(first.origin, refusal, f"in {part.name}", f"in {first.name}")
        except EtendueError as error:
            problems.append(str(error))
    if problems:
        raise EtendueError("\n".join(problems))


def _require_disjoint(parts: list[_Part]) -> None:
    problems = []
    for index, part in enumerate(parts):
        for other in parts[:index]:
            shared = sample_ranges.overlap(part.header.held, other.header.held)
            if shared is not None:
                twice = sample_ranges.text([shared])
                problems.append(f"{part.name}: the samples {twice} are in {other.name}, too")
    unfinished = [part for part in parts if part.header.partial is not None]
    if len(unfinished) > 1:
        problems += [
            f"{part.name}: an interrupted film, with samples that only some pixels have; of those that are "
            "merged one may be so, the others must be finished first, by --resume"
            for part in unfinished
        ]
    if problems:
        raise EtendueError("\n".join(problems))


def _sum(films: Iterator[Film]) -> Film:
    first = next(films)
    total = dataclasses.replace(
        first,
        **{name: getattr(first, name).copy() for name in _ARRAYS},
        contributions=None if first.contributions is None else first.contributions.copy(),
        aovs={},
        invalid=list(first.invalid),
        ranges=list(first.ranges),
        bound=None,
    )
    for film in films:
        for name in _ARRAYS:
            getattr(total, name)[...] += getattr(film, name)
        # Without those of all the samples, there is no sum.
        if total.contributions is not None and film.contributions is not None:
            total.contributions += film.contributions
        else:
            total.contributions = None
        total.invalid = [*total.invalid, *film.invalid][:MOST_INVALID_LISTED]
        total.invalid_count += film.invalid_count
        total.rays += film.rays
        total.seconds += film.seconds
        total.ranges = sample_ranges.union([*total.ranges, *film.ranges])
        total.partial = total.partial or film.partial
        total.interrupted = total.interrupted or film.interrupted
    total.image = mean_of(total.sum, total.sample_count, total.invalid_per_pixel)
    return total


_ARRAYS = ("sum", "sum_squares", "half_sum", "sample_count", "invalid_per_pixel", "half_count")


def _config_of(whole: Film, origin: Origin) -> dict[str, object]:
    """The scene file's data, asking for the samples of the whole, in every pixel."""
    first, end = whole.goal
    framebuffer = {**origin.config.get("framebuffer", {}), "sppx": min(end - first, sample_ranges.MOST)}
    beauty = {"beauty_render": False} if "beauty_render" in origin.config else {}
    return {**origin.config, "framebuffer": framebuffer, **beauty}
