"""Stone, marble, carpet and wood as images, and the relief of the masonry."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from etendue.models.mesh import Floats


def noise(
    random: np.random.Generator,
    shape: tuple[int, int],
    falloff: float,
    finest: float = 0.5,
    stretch: float = 1.0,
) -> Floats:
    """Seamless noise of mean 0 and deviation 1 whose amplitude falls with frequency to the power -falloff."""
    fy, fx = np.fft.fftfreq(shape[0])[:, None], np.fft.rfftfreq(shape[1])[None, :]
    f = np.hypot(fy * stretch, fx)
    f[0, 0] = 1
    spectrum = np.fft.rfft2(random.normal(size=shape)) * f**-falloff * np.exp(-((f / finest) ** 2))
    spectrum[0, 0] = 0
    field = np.fft.irfft2(spectrum, shape)
    return np.asarray(field / field.std())


def _mix(a: Floats, b: Floats, t: Floats) -> Floats:
    t = np.clip(t, 0, 1)[..., None]
    return a * (1 - t) + b * t


def _limestone(
    random: np.random.Generator, shape: tuple[int, int], base: tuple[float, float, float], contrast: float
) -> Floats:
    """Linear albedo of warm limestone: broad stains, fine grain, few dark pits."""
    broad, grain = noise(random, shape, 1.6), noise(random, shape, 0.6)
    pits = noise(random, shape, 0.9, 0.2) > 2.4
    tone = 1 + contrast * (0.45 * broad + 0.35 * grain)
    tone = tone * np.where(pits, 0.8, 1)
    warm = noise(random, shape, 1.8)[..., None] * contrast * np.array([0.08, 0.0, -0.16])
    return np.asarray(np.array(base) * (tone[..., None] + warm))


def _courses(random: np.random.Generator, size: int, courses: int, joint: float) -> tuple[Floats, Floats]:
    """Ashlar over a seamless square of `size` pixels.

    Returns the distance from the joints, 1 from `joint` pixels on, and the tone of each block.
    """
    distance = np.full((size, size), np.inf)
    tone = np.zeros((size, size))
    edges = np.round(
        np.linspace(0, size, courses + 1) + np.r_[0, random.normal(0, size / courses * 0.07, courses - 1), 0]
    ).astype(int)
    x = np.arange(size)
    for y0, y1 in zip(edges[:-1], edges[1:], strict=True):
        blocks = int(random.integers(5, 8) * courses / 10)
        widths = random.uniform(0.7, 1.3, blocks)
        stops = np.round(np.cumsum(widths) / widths.sum() * size + random.integers(size)).astype(int) % size
        stops.sort()
        gap = np.abs((x[:, None] - stops[None] + size / 2) % size - size / 2).min(1)
        rows = np.arange(y0, y1)
        from_bed = np.minimum(rows - y0, y1 - rows).astype(float)
        distance[y0:y1] = np.minimum(gap[None], from_bed[:, None])
        owner = np.searchsorted(stops, x, side="right") % blocks
        tone[y0:y1] = random.normal(0, 1, blocks)[owner][None]
    return np.clip(distance / joint, 0, 1), tone


def _normals(height: Floats, strength: float) -> Floats:
    """A tangent-space normal map (y up) of a seamless relief in pixels of height."""
    dx = (np.roll(height, -1, 1) - np.roll(height, 1, 1)) / 2
    dy = (np.roll(height, 1, 0) - np.roll(height, -1, 0)) / 2
    n = np.stack([-strength * dx, -strength * dy, np.ones_like(dx)], 2)
    n /= np.linalg.norm(n, axis=2, keepdims=True)
    return np.asarray(n / 2 + 0.5)


def _marble(
    random: np.random.Generator,
    shape: tuple[int, int],
    base: tuple[float, float, float],
    vein: tuple[float, float, float],
    amount: float,
) -> Floats:
    """Polished marble: clouds, and veins along the zero lines of warped noise."""
    cloud = noise(random, shape, 1.7)
    ridge = np.abs(noise(random, shape, 1.9, 0.2) + 0.35 * noise(random, shape, 1.2, 0.3))
    fine = np.abs(noise(random, shape, 1.5))
    veins = amount * np.exp(-ridge / 0.05) * (
        0.5 + 0.5 * np.tanh(noise(random, shape, 1.9))
    ) + 0.3 * amount * np.exp(-fine / 0.04)
    colour = np.array(base) * (1 + 0.09 * cloud + 0.03 * noise(random, shape, 0.7))[..., None]
    return _mix(colour, np.asarray(vein) * np.ones((*shape, 3)), veins)


def _carpet(random: np.random.Generator, size: int = 1024) -> Floats:
    """The runner over a square of its width: red field with a quiet ogee pattern, borders, weave."""
    v, u = np.meshgrid((np.arange(size) + 0.5) / size, (np.arange(size) + 0.5) / size, indexing="ij")
    red, deep, gold = (
        np.array([0.36, 0.022, 0.025]),
        np.array([0.2, 0.010, 0.016]),
        np.array([0.50, 0.29, 0.08]),
    )
    a, b = u * 5, v * 5
    lattice = np.abs(np.cos(np.pi * a) * np.cos(np.pi * b))
    figure = np.exp(-(((lattice - 0.3) / 0.06) ** 2)) + (lattice > 0.93)
    colour = _mix(red * np.ones((size, size, 3)), deep * np.ones((size, size, 3)), 0.75 * figure)
    edge = np.minimum(v, 1 - v)
    for low, high, tint in (
        (0.0, 0.035, deep),
        (0.05, 0.075, gold),
        (0.09, 0.145, deep),
        (0.16, 0.185, gold),
    ):
        colour = np.where(((edge >= low) & (edge < high))[..., None], tint, colour)
    weave = 1 + 0.10 * noise(random, (size, size), 0.0, 0.3) + 0.05 * noise(random, (size, size), 1.3)
    return np.asarray(colour * weave[..., None])


def _wood(random: np.random.Generator, size: int = 1024) -> Floats:
    grain = noise(random, (size, size), 1.3, 0.5, 0.06)
    fibre = noise(random, (size, size), 0.5, 0.5, 0.03)
    base = np.array([0.17, 0.085, 0.042])
    return np.asarray(base * np.exp(0.28 * grain + 0.12 * fibre)[..., None])


def write_textures(folder: Path) -> None:
    """All images of the church, seamless, as PNG files."""
    random = np.random.default_rng(1431)
    size = 1024
    distance, tone = _courses(random, size, 10, 3.0)
    wall = _limestone(random, (size, size), (0.64, 0.605, 0.54), 0.13)
    wall = (
        wall
        * (1 + 0.055 * tone + 0.02 * np.roll(tone, size // 3, 0))[..., None]
        * (1 + 0.04 * tone[..., None] * np.array([0.4, 0, -0.8]))
    )
    mortar = np.array([0.50, 0.45, 0.38]) * (1 + 0.1 * noise(random, (size, size), 0.7))[..., None]
    _write(folder / "zid.png", _mix(mortar, wall, (distance - 0.35) / 0.4))
    relief = (
        3.0 * np.sqrt(distance)
        + 0.35 * noise(random, (size, size), 1.2)
        + 0.12 * noise(random, (size, size), 0.4)
    )
    _write(folder / "zid_normal.png", _normals(relief, 0.35), linear=True)
    distance, tone = _courses(random, size, 20, 2.0)
    web = _limestone(random, (size, size), (0.68, 0.65, 0.59), 0.09) * (1 + 0.045 * tone)[..., None]
    _write(folder / "svod.png", web * (0.9 + 0.1 * distance)[..., None])
    _write(folder / "parapet.png", _limestone(random, (size, size), (0.68, 0.645, 0.58), 0.12))
    _write(folder / "stup.png", _marble(random, (size, size), (0.59, 0.545, 0.49), (0.40, 0.32, 0.27), 0.35))
    light = _marble(random, (1536, 768), (0.56, 0.50, 0.41), (0.36, 0.29, 0.22), 0.55)
    dark = _marble(random, (1536, 768), (0.105, 0.088, 0.085), (0.33, 0.28, 0.25), 0.4)
    _write(folder / "pod.png", np.concatenate([light, dark], 1))
    _write(folder / "tepih.png", _carpet(random))
    _write(folder / "drvo.png", _wood(random))


def _write(path: Path, pixels: Floats, linear: bool = False) -> None:
    """Writes linear colour as sRGB, or values as they are."""
    import OpenImageIO as oiio

    p = np.clip(pixels, 0, 1)
    if not linear:
        p = np.where(p <= 0.0031308, 12.92 * p, 1.055 * p ** (1 / 2.4) - 0.055)
    data = np.ascontiguousarray(np.round(p * 255).astype(np.uint8))
    spec = oiio.ImageSpec(data.shape[1], data.shape[0], data.shape[2], "uint8")
    spec.attribute("png:compressionLevel", 1)
    out = oiio.ImageOutput.create(str(path))
    if out is None or not out.open(str(path), spec) or not out.write_image(data) or not out.close():
        raise OSError(f"{path}: cannot be written")
