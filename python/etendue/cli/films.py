"""What `etendue merge` and `etendue tonemap` do."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from .. import outputs
from ..display import tonemap as tonemapped
from ..errors import EtendueError
from ..film import Film, merging, sample_ranges, save_pixels
from ..film import file as film_file
from ..words import counted


def merge(parts: Sequence[Path], output: Path) -> str:
    """Writes the film of all samples of `parts`, and says what is in it."""
    if output.suffix.lower() != ".exr":
        raise EtendueError(f'{output}: a film file is an EXR image; its name must end with ".exr"')
    outputs.check([output])
    film = merging.merge(parts)
    film.write(output)
    said = [f"{counted(len(parts), 'film')}, samples {sample_ranges.text(film.held)}: {output}"]
    gaps = sample_ranges.gaps(film.goal, film.ranges)
    if gaps:
        said.append(f"missing: {sample_ranges.text(gaps)}; etendue render --resume {output} renders them")
    return "\n".join(said)


def tonemap(film_path: Path, output: Path, exposure: float | None, view: str) -> None:
    """Writes the image of a film, or another linear image, as a screen shows it."""
    require_display(output)
    if exposure is not None and not 0 < exposure < float("inf"):
        raise EtendueError(f"--exposure: a factor above 0 is needed, not {exposure:g}")
    try:
        film = film_file.read(film_path)
        image, exposure = film.image, film.exposure if exposure is None else exposure
    except film_file.NoFilm:
        from ..loaders.image import load_image

        image = load_image(film_path, "environment").pixels.astype("float32")
    save_pixels(output, tonemapped(image, exposure or 1.0, view), {})


def false_colour(film_path: Path, output: Path, name: str, scale: str | None) -> None:
    """Writes a quantity of a film in false colours, with their scale."""
    require_display(output)
    limits = None if scale is None else _limits(scale)
    false_colour_of(film_file.read(film_path), output, name, limits)


def false_colour_of(film: Film, output: Path, name: str, limits: tuple[float, float] | None = None) -> None:
    """As `false_colour`, of a film in memory."""
    from ..display import false_colour as colours

    values = colours.quantity(film, name)
    save_pixels(output, colours.picture(values, name.replace("-", " "), limits), {})


def require_display(output: Path) -> None:
    """EtendueError where `output` is no image for a screen, or cannot be written."""
    if output.suffix.lower() in (".exr", ".hdr"):
        raise EtendueError(f"{output}: {output.suffix} files stay linear; allowed here: .png, .jpg, .jpeg")
    outputs.check([output])


def _limits(text: str) -> tuple[float, float]:
    try:
        low, high = map(float, text.split(":"))
    except ValueError:
        low, high = 0.0, 0.0
    if not 0 < low < high < float("inf"):
        raise EtendueError(
            f'--scale: two numbers above 0, the smaller first, are needed, as in 0.01:1, not "{text}"'
        )
    return low, high
