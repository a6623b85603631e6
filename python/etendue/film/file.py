"""The film file: an OpenEXR image that holds the exact sums as well, docs/films.md says how.

OpenEXR has no double and no 64-bit integer, so each is two channels of 32 bits, `high` and `low`.
"""

from __future__ import annotations

import json
import zlib
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ..errors import EtendueError
from . import MOST_INVALID_LISTED, Film, exr, sample_ranges
from . import replacing as film_replacing
from .origin import Origin, attributes_of

if TYPE_CHECKING:
    from os import PathLike

FORMAT = 2


class NoFilm(EtendueError):
    """The file is an image, but no film."""


_COLOURS = ("R", "G", "B")
_SUMS = ("sum", "sum_squares", "half_sum")
_COUNTS = ("sample_count", "invalid_per_pixel", "half_count")
# In the order of the words in memory.
_WORDS = (
    *(f"{name}.{half}.{colour}" for name in _SUMS for colour in _COLOURS for half in ("low", "high")),
    *(f"{name}.{half}" for name in _COUNTS for half in ("low", "high")),
)
# Likewise, of films whose contributions were kept apart.
_MORE_WORDS = tuple(
    f"{technique}.{part}.{half}.{colour}"
    for technique in ("bsdf_sampling", "light_sampling")
    for part in ("direct", "indirect")
    for colour in _COLOURS
    for half in ("low", "high")
)
_INTEGERS = {*_WORDS, *_MORE_WORDS}


def write(film: Film, path: Path, compressed: bool = True) -> None:
    """Write `film`; raises EtendueError, with a file that was there before untouched."""
    if film.origin is None:
        raise EtendueError(f"{path}: a film that no render gave cannot be written as a film file")
    if path.suffix.lower() != ".exr":
        raise EtendueError(f'{path}: a film file is an EXR image; its name must end with ".exr"')
    data = np.concatenate([_words(film.image), *map(_words, _arrays(film))], axis=2)
    notes = {**film.attributes, **_header(film, film.origin), "checksum": f"{zlib.crc32(data.data):08x}"}
    try:
        with exr.encoded(
            data, _channels(notes), _INTEGERS, notes, "zip:1" if compressed else "none"
        ) as encoded:
            film_replacing.replace(path, encoded)
    except OSError as error:
        raise EtendueError(f"{path}: cannot be written: {error.strerror or error}") from error


def read(path: str | PathLike[str]) -> Film:
    """The film in a file that `Film.write` or `etendue render --film` wrote.

    Raises EtendueError for a file that is none, or is damaged.
    """
    file = Path(path)
    notes, data = exr.decoded(file, _channels, _INTEGERS, refuse_others=_refuse_strangers)
    if f"{zlib.crc32(data.data):08x}" != notes.get("checksum"):
        raise EtendueError(f"{file}: the film is damaged (its checksum does not fit)")
    film = _film(file, notes)
    film.image = data[..., :3].view(np.float32).copy()
    position = 3
    for name in _SUMS:
        setattr(film, name, np.ascontiguousarray(data[..., position : position + 6]).view(np.float64))
        position += 6
    for name in _COUNTS:
        setattr(film, name, np.ascontiguousarray(data[..., position : position + 2]).view(np.uint64)[..., 0])
        position += 2
    if notes.get("contributions"):
        more = np.ascontiguousarray(data[..., position:]).view(np.float64)
        film.contributions = more.reshape(*more.shape[:2], 2, 2, 3)
    film.attributes = attributes_of(film)
    return film


def read_header(path: str | PathLike[str]) -> Film:
    """As `read`, but without the arrays: what the film is of and which samples it has."""
    file = Path(path)
    return _film(file, exr.attributes(file, refuse_others=_refuse_strangers))


def _channels(notes: dict[str, Any]) -> tuple[str, ...]:
    return (*_COLOURS, *_WORDS, *(_MORE_WORDS if notes.get("contributions") else ()))


def _arrays(film: Film) -> list[NDArray[Any]]:
    arrays = [*(getattr(film, name) for name in _SUMS), *(getattr(film, name)[..., None] for name in _COUNTS)]
    if film.contributions is not None:
        arrays.append(film.contributions.reshape(*film.contributions.shape[:2], -1))
    return arrays


def _words(array: NDArray[Any]) -> NDArray[np.uint32]:
    """The 32-bit words of an array (height, width, n), little end first."""
    little = array.astype(array.dtype.newbyteorder("<"), copy=False)
    return np.ascontiguousarray(little).view(np.uint32)


def _refuse_strangers(file: Path, notes: dict[str, Any]) -> None:
    version = notes.get("film")
    if version is None:
        raise NoFilm(f"{file}: an image, but no film; films are written with --film")
    if version != FORMAT:
        raise EtendueError(f"{file}: a film of format {version}; this Étendue reads format {FORMAT}")


def _header(film: Film, origin: Origin) -> dict[str, Any]:
    """Texts but for the format: integers of OpenEXR have 32 bits, those of JSON as many as it takes."""
    return {
        "film": FORMAT,
        "contributions": int(film.contributions is not None),
        "ranges": json.dumps(film.ranges),
        "partial": json.dumps(film.partial),
        "goal": json.dumps(film.goal),
        "bound": json.dumps(film.bound),
        "complete": int(film.complete),
        "rays": json.dumps(film.rays),
        "seconds": json.dumps(film.seconds),
        "invalid": json.dumps(film.invalid[:MOST_INVALID_LISTED]),
        "invalid_samples": json.dumps(film.invalid_count),
        "exposure": json.dumps(film.exposure),
        "interrupted": json.dumps(film.interrupted),
        "version": origin.version,
        "config": json.dumps(origin.config, ensure_ascii=False),
        "scene_file": origin.scene_file,
        "data_folders": json.dumps(origin.data_dirs, ensure_ascii=False),
        "settings": json.dumps(origin.settings, ensure_ascii=False),
        "files": json.dumps(origin.files, ensure_ascii=False),
        "scene_hash": origin.scene_hash,
    }


def _film(file: Path, notes: dict[str, Any]) -> Film:
    try:
        origin = Origin(
            json.loads(notes["config"]),
            # OpenEXR drops empty texts.
            notes.get("scene_file", ""),
            tuple(json.loads(notes["data_folders"])),
            json.loads(notes["settings"]),
            json.loads(notes["files"]),
            notes["version"],
        )
        partial = json.loads(notes["partial"])
        film = Film.empty(
            0,
            0,
            rays=json.loads(notes["rays"]),
            seconds=float(json.loads(notes["seconds"])),
            invalid=[(x, y, sample) for x, y, sample in json.loads(notes["invalid"])],
            invalid_count=json.loads(notes["invalid_samples"]),
            exposure=float(json.loads(notes["exposure"])),
            interrupted=json.loads(notes["interrupted"]),
            ranges=[(first, end) for first, end in json.loads(notes["ranges"])],
            partial=None if partial is None else (partial[0], partial[1]),
            goal=sample_ranges.hull([json.loads(notes["goal"])]),
            bound=json.loads(notes["bound"]),
            origin=origin,
        )
        # Whether a bound is kept shows from the arrays alone.
        film.complete = film.missing == 0 and (film.bound is None or bool(notes["complete"]))
    except (KeyError, TypeError, ValueError) as error:
        raise EtendueError(f"{file}: the film's attributes are damaged ({error})") from None
    return film
