"""Light of a low sun in a spherical atmosphere: air, haze and ozone at three wavelengths.

Single scattering is integrated along the ray; all further orders enter as the isotropic series of Hillaire,
"A Scalable and Production Ready Sky and Atmosphere Rendering Technique" (2020), section 5.5.  Air scatters by
Rayleigh's phase function, haze by Henyey's and Greenstein's.  Lengths are km; colours are red, green and blue
at about 680, 550 and 440 nm; the sun above the atmosphere gives the irradiance 1.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from etendue.models.mesh import Floats, Ints

GROUND, TOP = 6360.0, 6440.0
AIR = np.array([5.802e-3, 13.558e-3, 33.1e-3])
AIR_HEIGHT = 8.0
OZONE = np.array([0.650e-3, 1.881e-3, 0.085e-3])


@dataclass(frozen=True)
class Scattered:
    """What comes along rays, apart from the phase functions: (n, 3) each."""

    air: Floats
    haze: Floats
    further: Floats
    transmittance: Floats


class Atmosphere:
    """The atmosphere over one place for one height of the sun.

    Args:
        sun_degrees: the sun's elevation.
        haze: scattering of the haze at the ground, per km.
        eye: height of the eye over the ground.
    """

    def __init__(self, sun_degrees: float, haze: float, eye: float = 0.03, haze_height: float = 1.2) -> None:
        self.sun = np.array([np.cos(np.radians(sun_degrees)), np.sin(np.radians(sun_degrees)), 0.0])
        self.eye = GROUND + eye
        # Haze is bluish smoke and salt: a little stronger towards blue.
        self._haze = haze * np.array([0.86, 1.0, 1.19])
        self._haze_height = haze_height
        self.asymmetry = 0.78
        self._heights = np.r_[0, np.geomspace(0.02, TOP - GROUND, 71)]
        grazing = np.linspace(-5.5, 8, 109)
        self._cosines = np.sin(np.radians(np.r_[np.linspace(-90, -6, 15), grazing, np.linspace(9, 90, 40)]))
        self._through = self._transmittances()
        self._series = self._further_orders()

    def transmittance(self, radius: Floats, cosine: Floats) -> Floats:
        """The share of light, (n, 3), that passes from outside to a radius along a cosine to the zenith."""
        h, i = _place(self._heights, radius - GROUND)
        c, j = _place(self._cosines, cosine)
        t, h, c = self._through, h[:, None], c[:, None]
        low = t[i, j] * (1 - c) + t[i, j + 1] * c
        high = t[i + 1, j] * (1 - c) + t[i + 1, j + 1] * c
        return np.asarray(low * (1 - h) + high * h)

    def scattered(self, directions: Floats, longest: float = np.inf, steps: int = 56) -> Scattered:
        """Along (n, 3) directions from the eye, to the ground, space, or at most `longest` km."""
        origin = np.array([0.0, self.eye, 0.0])
        far = np.minimum(_distance(np.full(len(directions), self.eye), directions[:, 1]), longest)
        air, haze, further = (np.zeros((len(directions), 3)) for _ in range(3))
        depth = np.zeros((len(directions), 3))
        # Steps grow with the distance, as the air thins out.
        edges = far[:, None] * np.linspace(0, 1, steps + 1) ** 2
        for k in range(steps):
            length = (edges[:, k + 1] - edges[:, k])[:, None]
            p = origin + (edges[:, k : k + 1] + length / 2) * directions
            radius = np.linalg.norm(p, axis=1)
            a, m, extinction = self._medium(radius)
            through = np.exp(-depth) * -np.expm1(-extinction * length) / extinction
            cosine = p @ self.sun / radius
            lit = self.transmittance(radius, cosine) * through
            air += a * lit
            haze += m * lit
            further += (a + m) * self._isotropic(radius, cosine) * through
            depth += extinction * length
        return Scattered(air, haze, further, np.exp(-depth))

    def radiance(self, s: Scattered, cosine: Floats) -> Floats:
        """The radiance of scattered light at cosines (n,) to the sun."""
        c, g = cosine[:, None], self.asymmetry
        air = 3 / (16 * np.pi) * (1 + c * c)
        aside = 1 + g * g - 2 * g * c
        haze = (1 - g * g) / (4 * np.pi * aside * np.sqrt(aside))
        return np.asarray(s.air * air + s.haze * haze + s.further)

    def _medium(self, radius: Floats) -> tuple[Floats, Floats, Floats]:
        """Scattering of air and of haze, and extinction, per km."""
        h = np.maximum(radius - GROUND, 0)[:, None]
        air = AIR * np.exp(-h / AIR_HEIGHT)
        haze = self._haze * np.exp(-h / self._haze_height)
        ozone = OZONE * np.maximum(0, 1 - np.abs(h - 25) / 15)
        return air, haze, air + haze / 0.93 + ozone

    def _transmittances(self) -> Floats:
        radius, cosine = _pairs(GROUND + self._heights, self._cosines)
        # Rays that meet the ground carry no sun.
        blocked = (cosine < 0) & (radius**2 * (1 - cosine**2) < GROUND**2)
        far = _distance(radius, np.where(blocked, 0, cosine))
        depth = np.zeros((len(radius), 3))
        for k in range(120):
            a, b = (k / 120) ** 2, ((k + 1) / 120) ** 2
            t = far * (a + b) / 2
            extinction = self._medium(np.sqrt(radius**2 + t**2 + 2 * radius * t * cosine))[2]
            depth += extinction * (far * (b - a))[:, None]
        through = np.where(blocked[:, None], 0, np.exp(-depth))
        return through.reshape(len(self._heights), len(self._cosines), 3)

    def _further_orders(self) -> Floats:
        """Radiance of all orders from the second on, over heights and cosines of the sun."""
        self._ms_heights = np.r_[0, np.geomspace(0.1, TOP - GROUND - 1, 15)]
        self._ms_cosines = np.sin(np.radians(np.r_[np.linspace(-20, 20, 41), np.linspace(25, 90, 8)]))
        radius, cosine = _pairs(GROUND + self._ms_heights, self._ms_cosines)
        n, steps = 8, 24
        u = np.arccos(1 - 2 * (np.arange(n) + 0.5) / n)
        v = 2 * np.pi * (np.arange(n) + 0.5) / n
        second, share = np.zeros((len(radius), 3)), np.zeros((len(radius), 3))
        sun = np.stack([np.sqrt(1 - cosine**2), cosine, 0 * cosine], 1)
        for theta in u:
            d = np.array([[np.sin(theta) * np.cos(p), np.cos(theta), np.sin(theta) * np.sin(p)] for p in v])
            far = _distance(radius, np.full(len(radius), d[0, 1]))
            depth = np.zeros((len(radius), 3))
            for k in range(steps):
                t0, t1 = far * (k / steps) ** 2, far * ((k + 1) / steps) ** 2
                t = ((t0 + t1) / 2)[:, None]
                r = np.sqrt(radius**2 + t[:, 0] ** 2 + 2 * radius * t[:, 0] * d[0, 1])
                a, m, extinction = self._medium(r)
                through = (a + m) * np.exp(-depth) * -np.expm1(-extinction * (t1 - t0)[:, None]) / extinction
                share += through * n / n**2
                for way in d:
                    p = np.array([0, 1.0, 0]) * radius[:, None] + t * way
                    second += through * self.transmittance(r, np.sum(p * sun, 1) / r) / (4 * np.pi) / n**2
                depth += extinction * (t1 - t0)[:, None]
        return (second / (1 - share)).reshape(len(self._ms_heights), len(self._ms_cosines), 3)

    def _isotropic(self, radius: Floats, cosine: Floats) -> Floats:
        h, i = _place(self._ms_heights, radius - GROUND)
        c, j = _place(self._ms_cosines, cosine)
        t, h, c = self._series, h[:, None], c[:, None]
        low = t[i, j] * (1 - c) + t[i, j + 1] * c
        return np.asarray(low * (1 - h) + (t[i + 1, j] * (1 - c) + t[i + 1, j + 1] * c) * h)


def _distance(radius: Floats, cosine: Floats) -> Floats:
    """From a radius along a cosine to the ground or, past it, to the top."""
    under = radius**2 * (1 - cosine**2)
    down = (cosine < 0) & (under < GROUND**2)
    to_ground = -radius * cosine - np.sqrt(np.maximum(GROUND**2 - under, 0))
    return np.where(down, np.maximum(to_ground, 0), -radius * cosine + np.sqrt(np.maximum(TOP**2 - under, 0)))


def _pairs(a: Floats, b: Floats) -> tuple[Floats, Floats]:
    """All pairs of two lists, the second running fastest."""
    return np.repeat(a, len(b)), np.tile(b, len(a))


def _place(grid: Floats, x: Floats) -> tuple[Floats, Ints]:
    """Where x lies between which grid points: (share, index)."""
    i = np.clip(np.searchsorted(grid, x) - 1, 0, len(grid) - 2)
    return np.clip((x - grid[i]) / (grid[i + 1] - grid[i]), 0, 1), i
