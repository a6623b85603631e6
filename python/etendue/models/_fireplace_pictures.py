"""The pictures on the walls, painted with numpy: an abstract painting and three small sheets, one texture."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from etendue.models._fireplace_textures import PICTURES, cloudy, noise_image, ramp
from etendue.models.mesh import Floats

Painter = Callable[[int, int, np.random.Generator], Floats]


def sheet(rng: np.random.Generator) -> Floats:
    """All pictures, each in its rectangle of `PICTURES`: float64 (1024, 1638, 3) of display values."""
    height, width = 800, 1280
    image = np.ones((height, width, 3)) * 0.9
    for name, (paint, mat) in _PAINTERS.items():
        left, bottom, right, top = PICTURES[name]
        rows = slice(round((1 - top) * height), round((1 - bottom) * height))
        columns = slice(round(left * width), round(right * width))
        place = image[rows, columns]
        image[rows, columns] = _mat(place.shape[0], place.shape[1], rng, paint, mat)
    return np.clip(image, 0, 1)


def _over(image: Floats, colour: Floats, cover: Floats) -> Floats:
    return np.asarray(image + (colour - image) * np.clip(cover, 0, 1)[..., None])


def _painting(height: int, width: int, rng: np.random.Generator) -> Floats:
    """Broad fields with dry brush edges: chalk, slate, ochre, a low horizon and a disc."""
    y, x = np.mgrid[:height, :width]
    x, y = x / width, 1 - y / height
    weave = noise_image(height, width, height // 2, width // 2, rng)
    brush = noise_image(height, width, 220, 12, rng)
    edge = 0.05 * (cloudy(height, width, 4, 6, rng) - 0.5) * 2 + 0.022 * (brush - 0.5)
    image = ramp(
        0.6 * cloudy(height, width, 3, 4, rng) + 0.4 * brush, [[0.80, 0.78, 0.73], [0.93, 0.92, 0.89]]
    )
    fields: tuple[tuple[tuple[float, float, float], Floats], ...] = (
        ((0.16, 0.24, 0.30), (0.34 + edge - y) / 0.012),
        ((0.36, 0.45, 0.50), np.minimum((0.46 + 1.4 * edge - y) / 0.02, (y - 0.30 - edge) / 0.02)),
        (
            (0.76, 0.53, 0.22),
            (np.minimum((0.375 + edge - y) / 0.006, (y - 0.335 - 0.7 * edge) / 0.006) * (x > 0.18 + edge)),
        ),
        (
            (0.10, 0.12, 0.14),
            np.minimum((x - 0.56 - 1.2 * edge) / 0.01, (0.24 + 2 * edge - y) / 0.015),
        ),
        (
            (0.62, 0.30, 0.19),
            (0.105 + 0.35 * edge - np.hypot((x - 0.66) * width / height, y - 0.66)) / 0.006,
        ),
        (
            (0.86, 0.83, 0.77),
            np.minimum((0.12 + edge - np.abs(y - 0.13) * 3) / 0.03, (0.42 + edge - x) / 0.02),
        ),
    )
    for colour, cover in fields:
        dry = 0.72 + 0.55 * noise_image(height, width, 260, 9, rng) - 0.25 * weave
        tone = np.asarray(colour) * (0.82 + 0.36 * cloudy(height, width, 5, 5, rng)[..., None])
        image = _over(image, tone, np.clip(cover, 0, 1) * np.clip(dry, 0, 1))
    return image * (0.95 + 0.1 * weave[..., None])


def _mat(height: int, width: int, rng: np.random.Generator, paint: Painter, share: float) -> Floats:
    """A picture in a passe-partout that takes `share` of the shorter side."""
    border = round(share * min(height, width))
    image = np.ones((height, width, 3)) * np.array([0.90, 0.89, 0.86])
    inside = slice(border, height - border), slice(border, width - border)
    image[inside] = paint(height - 2 * border, width - 2 * border, rng)
    return image


def _tall(height: int, width: int, rng: np.random.Generator) -> Floats:
    """Three stones, one on the other, in ink wash."""
    y, x = np.mgrid[:height, :width]
    x, y = x / width - 0.5, 1 - y / height
    picture = ramp(cloudy(height, width, 4, 3, rng), [[0.80, 0.79, 0.76], [0.88, 0.87, 0.84]])
    wobble = 0.03 * (cloudy(height, width, 5, 4, rng) - 0.5)
    for cx, cy, rx, ry, tone in (
        (0.0, 0.30, 0.24, 0.085, 0.22),
        (0.04, 0.45, 0.18, 0.072, 0.40),
        (-0.02, 0.585, 0.12, 0.06, 0.56),
    ):
        inside = 1 - np.hypot((x - cx) / rx, (y - cy) / ry) + 2 * wobble
        ink = tone * (0.7 + 0.7 * cloudy(height, width, 6, 6, rng))[..., None] * np.array([0.96, 1.0, 1.05])
        picture = _over(picture, ink, inside / 0.05)
    return picture


def _dark(height: int, width: int, rng: np.random.Generator) -> Floats:
    """A pale arc on night blue."""
    y, x = np.mgrid[:height, :width]
    x, y = x / width - 0.5, 1 - y / height
    picture = ramp(cloudy(height, width, 4, 4, rng), [[0.10, 0.13, 0.17], [0.19, 0.24, 0.29]])
    away = np.hypot(x, (y - 0.40) * height / width)
    for radius, size, colour in (
        (0.30, 0.045, (0.84, 0.80, 0.72)),
        (0.20, 0.03, (0.72, 0.51, 0.24)),
        (0.12, 0.022, (0.55, 0.60, 0.62)),
    ):
        picture = _over(picture, np.asarray(colour), (size / 2 - np.abs(away - radius)) / 0.006 * (y > 0.40))
    return picture


def _wide(height: int, width: int, rng: np.random.Generator) -> Floats:
    """A shore in the mist."""
    y = 1 - np.mgrid[:height, :width][0] / height
    picture = ramp(
        np.clip(y + 0.1 * (cloudy(height, width, 3, 5, rng) - 0.5), 0, 1),
        [[0.55, 0.57, 0.57], [0.80, 0.80, 0.78], [0.70, 0.74, 0.77], [0.83, 0.84, 0.84]],
    )
    for level, tone, rough in ((0.56, 0.62, 0.10), (0.50, 0.45, 0.08), (0.43, 0.30, 0.06)):
        line = noise_image(1, width, 4, 7, rng)[0] * 0.7 + noise_image(1, width, 4, 40, rng)[0] * 0.3
        ridge = level + rough * (line - 0.5) * 2
        picture = _over(
            picture,
            tone * np.array([0.95, 1.0, 1.03]),
            np.minimum((ridge[None] - y) / 0.01, (y - level + 0.13) / 0.10),
        )
    return picture


# Each picture's painter, and the share of its shorter side that a passe-partout takes.
_PAINTERS: dict[str, tuple[Painter, float]] = {
    "painting": (_painting, 0),
    "tall": (_tall, 0.16),
    "dark": (_dark, 0.13),
    "wide": (_wide, 0.1),
}
