"""What `etendue render` makes beside the image: the layers of --aov, and the image of --denoise."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from .. import outputs
from ..errors import EtendueError
from ..film import aovs
from . import stages

if TYPE_CHECKING:
    from ..film import Film
    from ..scene import Scene


class Wanted(NamedTuple):
    """names: of AOVs. denoised: where denoised images go."""

    names: tuple[str, ...] = ()
    denoised: tuple[Path, ...] = ()

    @property
    def bytes_per_pixel(self) -> int:
        """Of memory: sums in double precision, and the layers' arrays."""
        kept_apart = 192 if self.kept_apart else 0
        surfaces = 176 if self.denoised or aovs.from_source(self.names, "surfaces") else 0
        return kept_apart + surfaces + 24 * len(self.names) + (96 if self.denoised else 0)

    @property
    def takes_time(self) -> bool:
        """Whether there is something to do after the render."""
        return bool(self.names or self.denoised)

    @property
    def kept_apart(self) -> tuple[str, ...]:
        """The AOVs that the render itself must see to."""
        return aovs.from_source(self.names, "contributions")


def wanted(names: Sequence[str], images: Sequence[Path], denoise: bool, if_installed: bool = False) -> Wanted:
    """What --aov and --denoise ask for, where `images` are written; EtendueError where it cannot be had.

    if_installed: without a denoiser there is no denoised image, and that is fine.
    """
    checked = aovs.checked(names)
    if checked and not any(path.suffix.lower() == ".exr" for path in images):
        raise EtendueError("--aov: only EXR images have layers; -o NAME.exr names one")
    if not denoise:
        return Wanted(checked)
    from ..denoise import is_installed, require

    if if_installed and not is_installed():
        return Wanted(checked)
    require()
    beside = outputs.check(denoised_path(path) for path in images)
    if taken := [path for path in beside if path in images]:
        raise EtendueError(f"{taken[0]}: cannot be both the image and the denoised one")
    return Wanted(checked, tuple(beside))


def denoised_path(image: Path) -> Path:
    """Where the denoised version of an image goes, as box.denoised.png."""
    return image.with_name(f"{image.stem}.denoised{image.suffix}")


class Made(NamedTuple):
    """The film with its layers, the denoised one, what Ctrl-C left out, and what failed: the film is to be saved."""

    film: Film
    denoised: Film | None = None
    left_out: str | None = None
    problem: str | None = None


def made(
    scene: Scene, film: Film, what: Wanted, threads: int, say: Callable[[str], None], quiet: bool
) -> Made:
    """Makes what is wanted of a film that is rendered."""
    left_out = [f"the layers {', '.join(what.names)}"] if what.names else []
    left_out += ["the denoised image"] if what.denoised else []
    if film.interrupted or not left_out:
        return Made(film, None, " and ".join(left_out) or None)
    try:
        # One pass for the layers and for the denoiser's guides.
        names = dict.fromkeys((*what.names, *(aovs.GUIDES if what.denoised else ())))
        with stages.shown("AOVs", say, quiet) as report:
            known = scene.with_aovs(film, tuple(names), threads, report)
        film = dataclasses.replace(known, aovs={name: known.aovs[name] for name in what.names})
        if not what.denoised:
            return Made(film)
        left_out = left_out[-1:]
        warnings: list[str] = []
        with stages.shown("denoising", say, quiet) as report:
            denoised = scene.denoise(known, threads, report, warnings)
    except KeyboardInterrupt:
        return Made(film, None, " and ".join(left_out))
    except (EtendueError, MemoryError) as error:
        reason = str(error) or "not enough memory"
        return Made(film, None, None, f"{' and '.join(left_out)} could not be made: {reason}")
    for warning in warnings:
        say(f"warning: {warning}")
    return Made(film, denoised)
