"""Denoising with Intel's Open Image Denoise, a neural network that guesses the image behind the noise.

Its guess is biased: it looks right before it is, and no number of samples says how far it is off. So nothing is
denoised unless it was asked for, and what is denoised says so.
"""

from __future__ import annotations

import dataclasses
import importlib.util
import shlex
import sys
from collections.abc import Callable
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

from .errors import EtendueError

if TYPE_CHECKING:
    from types import ModuleType

    from .film import Film

Image = NDArray[np.float32]
# Takes the part that is done (0..1); what it raises ends the denoising.
Progress = Callable[[float], object]


class Denoised(NamedTuple):
    """image: float32 (height, width, 3). unknown: bool (height, width), the pixels that the network never saw."""

    image: Image
    unknown: NDArray[np.bool_]


def require() -> None:
    """EtendueError with the command that installs the library, where it is not there."""
    _library()


def is_installed() -> bool:
    """Whether the library is there, without loading it."""
    return importlib.util.find_spec("mitsuba_oidn") is not None


def _library() -> ModuleType:
    try:
        import mitsuba_oidn
    except ImportError as error:
        # In a checkout, too, this finds the package in place and adds the extra.
        raise EtendueError(
            f"denoising needs Open Image Denoise ({error}); install it with: "
            f'{shlex.quote(sys.executable)} -m pip install "etendue[denoise]"'
        ) from None
    return mitsuba_oidn


def denoise(
    image: Image,
    albedo: Image | None = None,
    normal: Image | None = None,
    known: NDArray[np.bool_] | None = None,
    threads: int = 0,
    progress: Progress | None = None,
) -> Denoised:
    """Denoise linear radiance, float32 (height, width, 3).

    albedo in 0..1 and normal in -1..1, of the same shape, say what is seen in each pixel, and may be noisy: they
    are denoised first, each by itself. Both are given, or neither.
    known: bool (height, width), which pixels hold an estimate at all; by default all.
    threads: 0 for all cores. progress(fraction): called a few times a second; an exception from it is raised.

    Pixels that are not known, or hold anything but finite numbers >= 0, are never shown to the network, which
    sees the mean of their neighbours there; they keep their value in the result, and `unknown` marks them.
    Raises EtendueError where the library is missing or fails, shapes differ, or no pixel is known.
    """
    library = _library()
    for name, guide in (("albedo", albedo), ("normal", normal)):
        if guide is not None and guide.shape != image.shape:
            raise EtendueError(f"{name}: of the image's shape {image.shape} is needed, not {guide.shape}")
    if image.ndim != 3 or image.shape[2] != 3:
        raise EtendueError(f"image: an array (height, width, 3) is needed, not {image.shape}")
    if (albedo is None) != (normal is None):
        raise EtendueError("albedo and normal guide together: both are needed, or neither")
    unknown: NDArray[np.bool_] = ~np.all(np.isfinite(image) & (image >= 0), axis=2)
    if known is not None:
        unknown = unknown | ~known
    if unknown.all():
        raise EtendueError("nothing to denoise: no pixel holds a finite radiance")
    guides = {
        name: np.ascontiguousarray(np.clip(np.nan_to_num(guide), low, 1), np.float32)
        for name, guide, low in (("albedo", albedo, 0), ("normal", normal, -1))
        if guide is not None
    }
    run = _Run(library, threads, 1 + len(guides), progress)
    # First hits are noisy as well, behind a lens, through glass and at edges.
    guides = {name: run.filtered({name: guide}) for name, guide in guides.items()}
    clean = run.filtered({"color": _filled(image, unknown), **guides}, hdr=True, clean_aux=bool(guides))
    clean[unknown] = image[unknown]
    return Denoised(clean, unknown)


def denoise_film(
    film: Film,
    albedo: Image | None = None,
    normal: Image | None = None,
    threads: int = 0,
    progress: Progress | None = None,
) -> tuple[Film, str | None]:
    """`film` with its image denoised, and what is to be said of pixels that were left out, if any were.

    The result says in its attributes that it is denoised. It has no layers, and no origin, so that it can be
    neither written as a film file nor gone on from nor merged; its sums are still those behind the noisy image.
    """
    known = film.sample_count > film.invalid_per_pixel
    image, unknown = denoise(film.image, albedo, normal, known, threads, progress)
    notes = {
        **film.attributes,
        "denoised": name() + (", guided by albedo and normal" if normal is not None else ""),
        "biased": 1,
    }
    said = None
    if unknown.any():
        (y, x), number = np.argwhere(unknown)[0], int(unknown.sum())
        said = f"pixels without a finite radiance were not denoised: {number}, the first at ({x}, {y})"
    return dataclasses.replace(film, image=image, attributes=notes, aovs={}, origin=None), said


def name() -> str:
    """The library and its version."""
    return f"Open Image Denoise {_library().oidn_version()}"


def _filled(image: Image, unknown: NDArray[np.bool_]) -> Image:
    """Unknown pixels as the mean of the known among their eight neighbours, or of all where there is none."""
    if not unknown.any():
        return np.ascontiguousarray(image, np.float32)
    filled = np.where(unknown[..., None], 0, image)
    padded = np.pad(filled.astype(np.float64), ((1, 1), (1, 1), (0, 0)))
    weights = np.pad((~unknown).astype(np.float64), 1)[..., None]
    height, width = unknown.shape
    around = [np.s_[y : y + height, x : x + width] for y in range(3) for x in range(3)]
    total = np.sum([padded[place] for place in around], axis=0)
    weight = np.sum([weights[place] for place in around], axis=0)
    everywhere = filled.sum(axis=(0, 1), dtype=np.float64) / (~unknown).sum()
    mean = np.where(weight > 0, total / np.maximum(weight, 1), everywhere)
    return np.where(unknown[..., None], mean, image).astype(np.float32)


class _Run:
    """Several filters of one size on one device, and their progress together."""

    def __init__(self, library: ModuleType, threads: int, filters: int, progress: Progress | None) -> None:
        self._library = library
        self._device = library.Device(library.DeviceType.CPU)
        self._device.num_threads = threads
        self._filters = filters
        self._done = 0
        self._progress = progress

    def filtered(self, images: dict[str, Image], hdr: bool = False, clean_aux: bool = False) -> Image:
        run = self._device.new_filter("RT")
        for role, image in images.items():
            run.set_image(role, image)
        result = np.empty_like(next(iter(images.values())))
        run.set_image("output", result)
        run.hdr, run.clean_aux, run.quality = hdr, clean_aux, self._library.Quality.High
        run.set_progress_monitor(self._report)
        try:
            run.execute()
        except self._library.Error as error:
            raise EtendueError(f"Open Image Denoise failed: {error}") from error
        self._done += 1
        return result

    def _report(self, fraction: float) -> bool:
        # It is this call that lets the interpreter see a Ctrl-C.
        if self._progress is not None:
            self._progress((self._done + fraction) / self._filters)
        return True
