"""The sunset: an equirectangular sky with the sun, over a hazy sea with hills at the horizon."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from etendue.models._pots_atmosphere import Atmosphere
from etendue.models._pots_sea import glitter, mirrored_sky, swell
from etendue.models.mesh import Floats

WIDTH, HEIGHT = 2048, 1024
SUN_ELEVATION, SUN_AZIMUTH = 1.6, 114.0  # degrees; the azimuth is phi of the format's mapping
SUN_RADIUS = 0.2665
# A shallow evening haze: per km at the ground, and km in which it thins to 1 / e.  It dims the sun to a disc
# that one could look at, so that the picture is lit by the glow.
HAZE, HAZE_HEIGHT = 0.38, 0.4
EYE = 0.06  # km above the sea
HILLS = np.array([0.10, 0.09, 0.07])  # reflectance
# The sun's irradiance above the atmosphere in the scene's units: what suits `intensity` 10 and exposure 1.
SUN = 3.2 * np.array([1.03, 1.0, 0.93])


def write_sunset(path: Path) -> None:
    """Writes the sky as a Radiance HDR file."""
    import OpenImageIO as oiio

    path.parent.mkdir(parents=True, exist_ok=True)
    pixels = np.ascontiguousarray(sunset(), np.float32)
    image = oiio.ImageBuf(oiio.ImageSpec(WIDTH, HEIGHT, 3, "float"))
    image.set_pixels(oiio.ROI(0, WIDTH, 0, HEIGHT), pixels)
    if not image.write(str(path)):
        raise OSError(f"{path}: {image.geterror()}")


def sunset() -> Floats:
    """Radiance, (1024, 2048, 3), row 0 towards the zenith."""
    atmosphere = Atmosphere(SUN_ELEVATION, HAZE, EYE, HAZE_HEIGHT)
    elevation = 90 - (np.arange(HEIGHT) + 0.5) * 180 / HEIGHT
    turn = np.mod((np.arange(WIDTH) + 0.5) * 360 / WIDTH - SUN_AZIMUTH + 180, 360) - 180
    sky = _sky(atmosphere, elevation, turn)
    _add_hills(sky, atmosphere, elevation, turn)
    sun = _sun_share(elevation, turn)
    disc = _sunlight(atmosphere) / (2 * np.pi * (1 - np.cos(np.radians(SUN_RADIUS))))
    return np.asarray((sky + sun[:, :, None] * disc) * SUN)


def _sky(atmosphere: Atmosphere, elevation: Floats, turn: Floats) -> Floats:
    """Scattered light and the sea's, interpolated between tabled directions; phase functions are exact."""
    below = np.r_[np.linspace(-90, -8, 16), np.linspace(-6, -0.6, 10)]
    rows = np.r_[below, np.linspace(-0.4, 12, 63), np.linspace(13, 90, 40)]
    columns = np.linspace(0, 180, 37)
    table = atmosphere.scattered(_directions(rows, columns).reshape(-1, 3))
    shape = (len(rows), len(columns), 3)
    full = [
        _resampled(x.reshape(shape), rows, columns, elevation, np.abs(turn)).reshape(-1, 3)
        for x in (table.air, table.haze, table.further, table.transmittance)
    ]
    directions = _directions(elevation, turn).reshape(-1, 3)
    light = atmosphere.radiance(type(table)(*full), directions @ atmosphere.sun)
    down = directions[:, 1] < 0
    light[down] += full[3][down] * _sea(atmosphere, elevation, turn)
    return light.reshape(HEIGHT, WIDTH, 3)


def _sea(atmosphere: Atmosphere, elevation: Floats, turn: Floats) -> Floats:
    """The water's radiance in all directions below the horizon, as a list."""
    up, across = np.r_[np.linspace(0.3, 12, 40), np.linspace(14, 90, 39)], np.linspace(0, 180, 46)
    d = _directions(up, across).reshape(-1, 3)
    tabled = atmosphere.radiance(atmosphere.scattered(d, steps=32), d @ atmosphere.sun)
    tabled = tabled.reshape(len(up), len(across), 3)

    def sky(way: Floats) -> Floats:
        high = np.degrees(np.arcsin(np.clip(way[:, 1], 0, 1)))
        return _looked_up(tabled, up, across, high, np.degrees(np.abs(np.arctan2(way[:, 2], way[:, 0]))))

    rows = np.r_[np.linspace(-90, -8, 30), np.linspace(-7.5, -0.1, 40)]
    view = _directions(rows, across).reshape(-1, 3)
    water = mirrored_sky(view, sky, _irradiance(atmosphere)).reshape(len(rows), len(across), 3)
    below = elevation[elevation < 0]
    full = _resampled(water, rows, across, below, np.abs(turn)).reshape(-1, 3)
    directions = _directions(below, turn).reshape(-1, 3)
    full += glitter(directions, atmosphere.sun) * _sunlight(atmosphere)
    return np.asarray(full * swell(directions, 1000 * EYE, np.pi / HEIGHT))


def _irradiance(atmosphere: Atmosphere) -> Floats:
    """What sun and sky give to level ground."""
    up = _directions(np.linspace(1, 89, 23), np.linspace(4, 176, 22)).reshape(-1, 3)
    sky = atmosphere.radiance(atmosphere.scattered(up, steps=32), up @ atmosphere.sun)
    weight = up[:, 1:2] * np.sqrt(1 - up[:, 1:2] ** 2)
    return np.asarray(
        np.pi * np.sum(sky * weight, 0) / np.sum(weight) + _sunlight(atmosphere) * atmosphere.sun[1]
    )


def _sunlight(atmosphere: Atmosphere) -> Floats:
    """The sun's irradiance across its rays, (3,)."""
    return atmosphere.transmittance(np.array([atmosphere.eye]), atmosphere.sun[1:2])[0]


def _add_hills(sky: Floats, atmosphere: Atmosphere, elevation: Floats, turn: Floats) -> None:
    """Ranges of hills from the farthest to the nearest, paler with their distance; low under the sun."""
    rng = np.random.default_rng(5)
    x = np.radians(turn)
    pitch = 180 / HEIGHT
    for distance, height in ((9.0, 1.15), (5.0, 0.75), (2.5, 0.45)):
        ridge = np.zeros(WIDTH)
        for k in range(3, 90):
            ridge += np.sin(k * x + rng.uniform(0, 2 * np.pi)) * k**-1.15
        ridge = height * (0.75 + 0.45 * ridge) * (1 - 0.45 * np.exp(-np.square(turn / 9)))
        cover = np.clip((ridge - elevation[:, None]) / pitch + 0.5, 0, 1) * (elevation[:, None] > -0.3)
        band = np.flatnonzero(cover.any(1))
        columns = np.linspace(0, 180, 61)
        d = _directions(np.array([0.3]), columns).reshape(-1, 3)
        part = atmosphere.scattered(d, longest=distance, steps=24)
        near = [
            np.stack([np.interp(np.abs(turn), columns, c) for c in v.T], 1)
            for v in (part.air, part.haze, part.further, part.transmittance)
        ]
        cosine = _directions(np.array([0.3]), turn)[0] @ atmosphere.sun
        colour = atmosphere.radiance(type(part)(*near), cosine) + near[3] * HILLS / np.pi * 0.6 * _irradiance(
            atmosphere
        )
        sky[band] += cover[band, :, None] * (colour - sky[band])


def _sun_share(elevation: Floats, turn: Floats) -> Floats:
    """The share of each pixel that the sun's disc covers, scaled so that its solid angle is exact."""
    share = np.zeros((HEIGHT, WIDTH))
    pitch, n = 180 / HEIGHT, 16
    rows = np.flatnonzero(np.abs(elevation - SUN_ELEVATION) < SUN_RADIUS + pitch)
    columns = np.flatnonzero(np.abs(turn) < SUN_RADIUS + 2 * pitch)
    sub = ((np.arange(n) + 0.5) / n - 0.5) * pitch
    e = (elevation[rows][:, None] + sub).ravel()
    t = (turn[columns][:, None] + sub).ravel()
    toward = np.array([np.cos(np.radians(SUN_ELEVATION)), np.sin(np.radians(SUN_ELEVATION)), 0])
    inside = _directions(e, t) @ toward > np.cos(np.radians(SUN_RADIUS))
    part = inside.reshape(len(rows), n, len(columns), n).mean((1, 3))
    solid = np.cos(np.radians(elevation[rows]))[:, None] * np.radians(pitch) ** 2
    exact = 2 * np.pi * (1 - np.cos(np.radians(SUN_RADIUS)))
    share[np.ix_(rows, columns)] = part * exact / np.sum(part * solid)
    return share


def _directions(elevation: Floats, turn: Floats) -> Floats:
    """Unit vectors (rows, columns, 3), y up, the sun's azimuth along x."""
    e, t = np.radians(elevation)[:, None], np.radians(turn)[None]
    return np.stack(np.broadcast_arrays(np.cos(e) * np.cos(t), np.sin(e), np.cos(e) * np.sin(t)), -1)


def _resampled(table: Floats, rows: Floats, columns: Floats, elevation: Floats, turn: Floats) -> Floats:
    i = np.clip(np.searchsorted(rows, elevation) - 1, 0, len(rows) - 2)
    a = np.clip((elevation - rows[i]) / (rows[i + 1] - rows[i]), 0, 1)[:, None, None]
    tall = table[i] * (1 - a) + table[i + 1] * a
    j = np.clip(np.searchsorted(columns, turn) - 1, 0, len(columns) - 2)
    b = np.clip((turn - columns[j]) / (columns[j + 1] - columns[j]), 0, 1)[None, :, None]
    return np.asarray(tall[:, j] * (1 - b) + tall[:, j + 1] * b)


def _looked_up(table: Floats, rows: Floats, columns: Floats, elevation: Floats, turn: Floats) -> Floats:
    """A table's values at (n,) places."""
    i = np.clip(np.searchsorted(rows, elevation) - 1, 0, len(rows) - 2)
    j = np.clip(np.searchsorted(columns, turn) - 1, 0, len(columns) - 2)
    a = np.clip((elevation - rows[i]) / (rows[i + 1] - rows[i]), 0, 1)[:, None]
    b = np.clip((turn - columns[j]) / (columns[j + 1] - columns[j]), 0, 1)[:, None]
    low = table[i, j] * (1 - b) + table[i, j + 1] * b
    return np.asarray(low * (1 - a) + (table[i + 1, j] * (1 - b) + table[i + 1, j + 1] * b) * a)
