"""Pictures of the atrium's cloth, leaves and painted vases."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np

from etendue.models._spz_noise import Field, cloud, grid, mix, save, step

SHAPE = (1024, 512)
GOLD, CREAM = (0.52, 0.34, 0.11), (0.62, 0.56, 0.46)
CRIMSON, BLUE, GREEN, MADDER = (
    (0.33, 0.018, 0.026),
    (0.025, 0.06, 0.22),
    (0.022, 0.12, 0.06),
    (0.20, 0.03, 0.022),
)


def paint(folder: Path) -> None:
    """Writes the seven fabrics, the leaves with their mask, and the painted ware into `folder`."""
    for letter, ground, emblem in (("a", CRIMSON, _lily), ("b", BLUE, _star), ("c", GREEN, _cross)):
        save(folder / f"fabric_{letter}.png", _banner(ground, emblem))
    save(folder / "fabric_d.png", _carpet(MADDER, (0.05, 0.06, 0.13)))
    save(folder / "fabric_e.png", _carpet((0.035, 0.07, 0.16), MADDER))
    save(folder / "fabric_f.png", _damask((0.58, 0.52, 0.41), (0.66, 0.61, 0.51)))
    save(folder / "fabric_g.png", _damask((0.23, 0.018, 0.022), (0.34, 0.045, 0.042)))
    leaves(folder)
    majolica(folder)


def _woven(colour: Field) -> Field:
    """The colours with the threads' pattern and wear."""
    h, w = colour.shape[:2]
    y, x = np.mgrid[0:h, 0:w]
    thread = np.where((x // 2 + y // 2) % 2 == 0, 1.035, 0.965).astype(np.float32)
    slub = cloud((h, w), 81, 1.0, 20, 300, stretch=(1, 10)) + cloud((h, w), 82, 1.0, 20, 300, stretch=(10, 1))
    faded = cloud((h, w), 83, 1.8, 1, 40)
    return colour * (thread * (1 + 0.03 * slub + 0.06 * faded))[..., None]


def _ogee(x: Field, y: Field) -> Field:
    """A damask's figure on a lattice of unit cells: ovals around palmettes; 1 in the figure."""
    figure = np.zeros(x.shape, np.float32)
    for dx, dy in ((0.0, 0.0), (0.5, 0.5)):
        a, b = (x + dx + 0.5) % 1 - 0.5, (y + dy + 0.5) % 1 - 0.5
        r, phi = np.hypot(a, b * 0.8), np.arctan2(a, b)
        petal = 0.105 * (1 + 0.42 * np.cos(6 * phi) + 0.22 * np.cos(3 * phi))
        figure = np.maximum(figure, step(0.008, -0.008, r - petal))
        figure = np.maximum(figure, step(0.010, -0.004, np.abs(r - 0.165 - 0.02 * np.cos(12 * phi)) - 0.008))
    line = np.abs(np.abs((x + 0.5) % 1 - 0.5) - 0.25 - 0.2 * np.cos(2 * np.pi * y))
    return np.maximum(figure, step(0.040, 0.026, line * (1 + 0.3 * np.cos(16 * np.pi * y))))


def _damask(ground: tuple[float, float, float], figure: tuple[float, float, float]) -> Field:
    u, v = grid(SHAPE)
    return _woven(mix(ground, figure, _ogee(u * 4, v * 6)))


def _banner(ground: tuple[float, float, float], emblem: Callable[[Field, Field], Field]) -> Field:
    """A banner 1.1 wide and 3.2 high: damask ground, gold borders, an embroidered field with an emblem."""
    u, v = grid(SHAPE)
    x, y = u * 1.1, v * 3.2
    side = np.minimum(np.minimum(x, 1.1 - x), np.minimum(y, 3.2 - y))
    g = np.array(ground, np.float32)
    colour = mix(g, g * 1.45 + 0.01, _ogee(x * 3.6, y * 2.4))
    gold = np.maximum(step(0.012, 0.008, np.abs(side - 0.055)), step(0.007, 0.004, np.abs(side - 0.085)))
    for centre, size in ((2.35, 0.33), (0.85, 0.2)):
        a, b = (x - 0.55) / size, (y - centre) / size
        r = np.hypot(a, b)
        colour = mix(colour, CREAM, step(1.02, 1.0, r) if size > 0.3 else np.zeros_like(r))
        gold = np.maximum(gold, step(0.05, 0.035, np.abs(r - 1.03)))
        drawn = emblem(a * 1.25, b * 1.25)
        colour = mix(colour, g if size > 0.3 else GOLD, drawn)
    for centre in (1.25, 1.72):
        gold = np.maximum(
            gold,
            step(0.008, 0.004, np.abs(np.abs(y - centre) - 0.035 - 0.018 * np.sin(x / 1.1 * 2 * np.pi * 8))),
        )
    stitch = 1 + 0.25 * np.sin((x + y) * 260)
    return _woven(mix(colour, np.array(GOLD, np.float32) * stitch[..., None], gold))


def _lily(a: Field, b: Field) -> Field:
    middle = step(0.02, -0.02, np.abs(a) - 0.20 * np.clip(1 - np.abs((b - 0.18) / 0.72) ** 1.6, 0, 1)) * (
        np.abs(b - 0.18) < 0.72
    )
    r = np.hypot(np.abs(a) - 0.36, b - 0.14)
    side = (
        step(0.03, -0.03, np.abs(r - 0.24) - 0.085 * step(-0.75, 0.6, b + np.abs(a) * 0.4))
        * (np.abs(a) > 0.1)
        * (b > -0.18)
    )
    bar = step(0.02, -0.02, np.maximum(np.abs(a) - 0.36, np.abs(b + 0.20) - 0.06))
    foot = step(0.02, -0.02, np.abs(a) - 0.07 - 0.28 * np.clip(-0.26 - b, 0, 1)) * (b < -0.2) * (b > -0.72)
    return np.asarray(np.maximum(np.maximum(middle, side), np.maximum(bar, foot)), np.float32)


def _star(a: Field, b: Field) -> Field:
    r, phi = np.hypot(a, b), np.arctan2(a, b)
    rays = 0.20 + 0.42 * np.abs(np.cos(4 * phi)) ** 3 + 0.18 * np.abs(np.cos(2 * phi)) ** 8
    return np.maximum(step(0.02, -0.02, r - rays) - step(0.02, -0.02, r - 0.13), step(0.02, -0.02, r - 0.07))


def _cross(a: Field, b: Field) -> Field:
    p, q = np.maximum(np.abs(a), np.abs(b)), np.minimum(np.abs(a), np.abs(b))
    return step(0.02, -0.02, np.maximum(q - 0.06 - 0.30 * p**2, p - 0.78 + 0.5 * q))


def _carpet(field: tuple[float, float, float], border: tuple[float, float, float]) -> Field:
    """A knotted carpet: three borders of running figures and a field of rosettes."""
    u, v = grid(SHAPE)
    x, y = u * 1.6, v * 3.2
    side = np.minimum(np.minimum(x, 1.6 - x), np.minimum(y, 3.2 - y))
    run = np.where(np.minimum(x, 1.6 - x) < np.minimum(y, 3.2 - y), y, x)
    colour = mix(field, (0.42, 0.26, 0.12), _ogee(x * 2.5, y * 2.5))
    dots = step(0.55, 0.75, np.cos(x * 5 * np.pi) * np.cos(y * 5 * np.pi))
    colour = mix(colour, border, dots)
    wave = step(0.018, 0.010, np.abs(side - 0.15 - 0.045 * np.sin(run * 20 * np.pi / 1.6)))
    band = mix(border, (0.50, 0.40, 0.25), wave)
    rosette = step(0.3, 0.6, np.cos(run * 20 * np.pi / 1.6 * 2) - 40 * np.abs(side - 0.15))
    band = mix(band, (0.36, 0.06, 0.04), rosette)
    colour = np.where((side < 0.24)[..., None], band, colour)
    lines = np.maximum(step(0.010, 0.006, np.abs(side - 0.24)), step(0.010, 0.006, np.abs(side - 0.06)))
    colour = mix(colour, CREAM, lines)
    colour = np.where((side < 0.05)[..., None], np.array(field, np.float32), colour)
    return _woven(colour)


def leaves(folder: Path, size: int = 512) -> None:
    """A twig of lemon leaves, its tip at the top of the picture, with the mask that cuts it out."""
    u, v = grid((size, size))
    fine = cloud((size, size), 91, 1.2, 8, 200)
    colour = np.broadcast_to(np.array([0.045, 0.10, 0.022], np.float32), (size, size, 3)).copy()
    mask = step(0.012, 0.006, np.abs(u - 0.5 - 0.02 * np.sin(5 * v))) * (v < 0.8)
    colour = mix(colour, (0.09, 0.075, 0.03), mask)
    rng = np.random.default_rng(92)
    spots = [(0.06 + 0.10 * k, (1 if k % 2 else -1) * (48 + 14 * rng.random())) for k in range(7)] + [
        (0.655, 5.0)
    ]
    for foot, degrees in spots:
        t = np.radians(degrees)
        dx, dy = u - 0.5, v - foot
        along, across = (dx * np.sin(t) + dy * np.cos(t)) / 0.33, (dx * np.cos(t) - dy * np.sin(t)) / 0.33
        bend = across - 0.10 * np.sin(np.pi * along) * np.sign(degrees)
        half = 0.205 * np.sin(np.pi * np.clip(along, 0, 1) ** 0.82) ** 0.85
        inside = step(0.01, -0.01, np.abs(bend) - half) * (along > 0) * (along < 1)
        tone = rng.random()
        green = np.array([0.035 + 0.07 * tone, 0.105 + 0.10 * tone, 0.014 + 0.012 * tone], np.float32)
        veins = np.exp(-np.abs(bend) / 0.012) + 0.5 * np.exp(
            -np.abs((along - 1.3 * np.abs(bend)) * 9 % 1 - 0.5) / 0.06
        ) * (np.abs(bend) < half)
        leaf = green * (1 + 0.12 * fine + 0.35 * step(0.2, -0.2, bend))[..., None] + 0.05 * veins[
            ..., None
        ] * np.array([0.9, 1.2, 0.4], np.float32)
        colour = mix(colour, leaf, inside)
        mask = np.maximum(mask, inside)
    save(folder / "leaves.png", colour)
    save(folder / "leaves_mask.png", np.repeat((mask > 0.5).astype(np.float32)[..., None], 3, 2), linear=True)


def majolica(folder: Path, shape: tuple[int, int] = (512, 1024)) -> None:
    """Tin-glazed ware, cobalt and ochre on white, for turned vases: u around, v up."""
    u, v = grid(shape)
    brush = cloud(shape, 95, 1.3, 4, 200)
    colour = np.broadcast_to(np.array([0.66, 0.65, 0.60], np.float32), (*shape, 3)).copy()
    vine = _ogee(u * 8 + 0.02 * brush, v * 4 + 0.02 * brush)
    zone = step(0.28, 0.30, v) * step(0.80, 0.78, v)
    colour = mix(colour, (0.025, 0.06, 0.26), vine * zone * (0.8 + 0.15 * brush))
    for at, width in (
        (0.27, 0.008),
        (0.25, 0.003),
        (0.81, 0.008),
        (0.83, 0.003),
        (0.12, 0.006),
        (0.93, 0.01),
    ):
        colour = mix(colour, (0.03, 0.07, 0.27), step(width + 0.003, width, np.abs(v - at + 0.002 * brush)))
    tongue = (
        step(0.02, -0.02, np.abs((u * 32) % 1 - 0.5) - 0.38 * np.sqrt(np.clip((v - 0.13) / 0.11, 0, 1)))
        * (v > 0.13)
        * (v < 0.24)
    )
    colour = mix(colour, (0.50, 0.27, 0.05), tongue * 0.85)
    bead = step(0.1, -0.1, np.hypot((u * 40) % 1 - 0.5, (v - 0.87) * 20) - 0.36)
    save(folder / "majolica.png", mix(colour, (0.50, 0.27, 0.05), bead))
