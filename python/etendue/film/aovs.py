"""What may be written beside the image: arbitrary output variables (AOVs), each a layer of the EXR file.

docs/films.md says what each holds.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..errors import EtendueError, nearest_name
from . import mean_of

if TYPE_CHECKING:
    from .. import _core
    from . import Film

_RGB, _XYZ, _ONE = ("R", "G", "B"), ("X", "Y", "Z"), ("X",)


class Aov(NamedTuple):
    """channels: those of its layer, in the order of the array's last axis; without one where it is a single one.

    source: "surfaces" that camera rays hit, found in a pass of its own; the "film"; or the film's
    "contributions", which must be kept apart while it is rendered.
    """

    channels: tuple[str, ...]
    source: str


AOVS = {
    "albedo": Aov(_RGB, "surfaces"),
    "normal": Aov(_XYZ, "surfaces"),
    "depth": Aov(("Z",), "surfaces"),
    "position": Aov(_XYZ, "surfaces"),
    "object_id": Aov(_ONE, "surfaces"),
    "material_id": Aov(_ONE, "surfaces"),
    "denoising_albedo": Aov(_RGB, "surfaces"),
    "denoising_normal": Aov(_XYZ, "surfaces"),
    "sample_count": Aov(_ONE, "film"),
    "variance": Aov(_RGB, "film"),
    "direct": Aov(_RGB, "contributions"),
    "indirect": Aov(_RGB, "contributions"),
    "bsdf_sampling": Aov(_RGB, "contributions"),
    "light_sampling": Aov(_RGB, "contributions"),
}

# What guides the denoiser.
GUIDES = ("denoising_albedo", "denoising_normal")

# Of a longer render the first samples must do: what is seen first is hardly noisy.
MOST_SAMPLES = 64


def checked(names: Iterable[str]) -> tuple[str, ...]:
    """The names, each once; EtendueError with those that are none."""
    wanted = tuple(dict.fromkeys(names))
    problems = []
    for name in wanted:
        if name not in AOVS:
            near = nearest_name(name, AOVS)
            hint = f'did you mean "{near}"? ' if near else ""
            problems.append(f'there is no AOV "{name}" ({hint}allowed: {", ".join(AOVS)})')
    if problems:
        raise EtendueError("\n".join(problems))
    return wanted


def from_source(names: Iterable[str], source: str) -> tuple[str, ...]:
    """Those of the names that come from a source of `Aov.source`."""
    return tuple(name for name in names if AOVS[name].source == source)


def samples_of(film: Film) -> tuple[int, int]:
    """The index of the first sample, and of how many the surfaces are shown: the first that the film has."""
    if not film.held:
        return 0, 0
    first, end = film.held[0]
    return first, min(end - first, MOST_SAMPLES)


def of_surface(name: str, found: _core.AovPass) -> NDArray[Any]:
    """What a finished pass found, float32 or, of ids, int32."""
    return getattr(found, name)()


def of_film(name: str, film: Film) -> NDArray[np.float32]:
    """What the film itself knows."""
    if name == "sample_count":
        return film.sample_count.astype(np.float32)
    if name == "variance":
        with np.errstate(divide="ignore", invalid="ignore"):
            return (film.variance / film.sample_count[..., None]).astype(np.float32)
    contributions = require_contributions(film)
    techniques = {"bsdf_sampling": (0,), "light_sampling": (1,)}.get(name, (0, 1))
    parts = {"direct": (0,), "indirect": (1,)}.get(name, (0, 1))
    total = contributions[:, :, techniques][:, :, :, parts].sum(axis=(2, 3))
    return mean_of(total, film.sample_count, film.invalid_per_pixel)


def require_contributions(film: Film) -> NDArray[np.float64]:
    """`film.contributions`; EtendueError where there are none."""
    if film.contributions is None:
        kinds = ", ".join(from_source(AOVS, "contributions"))
        raise EtendueError(
            f"the film was rendered without keeping contributions apart ({kinds}); to have them, ask for them from "
            "its first sample on"
        )
    return film.contributions


def layers(aovs: dict[str, NDArray[Any]]) -> tuple[list[str], list[NDArray[np.float32]]]:
    """Names of channels and their values, (height, width, n) for each AOV; ids are exact up to 2^24."""
    names = [f"{name}.{channel}" for name in aovs for channel in AOVS[name].channels]
    arrays = [np.atleast_3d(array).astype(np.float32) for array in aovs.values()]
    return names, arrays
