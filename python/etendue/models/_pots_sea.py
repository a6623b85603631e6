"""The light that a sea returns to an eye above it: the sky and the low sun, mirrored by sloping waves."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from etendue.models.mesh import Floats

# Standard deviation of the waves' slopes: a light breeze (Cox and Munk 1954).
ROUGHNESS = 0.10
INDEX = 1.34
# What light that enters the water comes back with, per unit of irradiance.
DEEP = np.array([0.004, 0.014, 0.018])


def mirrored_sky(view: Floats, sky: Callable[[Floats], Floats], irradiance: Floats) -> Floats:
    """The radiance, (n, 3), of the water where the eye looks along (n, 3) downward directions.

    `sky` gives the radiance of upward directions, `irradiance` (3,) is what falls on the water.
    """
    nodes, weights = np.polynomial.hermite_e.hermegauss(9)
    total, mirrored = np.zeros((len(view), 1)), np.zeros((len(view), 1))
    light = np.zeros((len(view), 3))
    for sx, wx in zip(nodes, weights, strict=True):
        for sz, wz in zip(nodes, weights, strict=True):
            n = np.array([-ROUGHNESS * sx, 1.0, -ROUGHNESS * sz])
            n /= np.linalg.norm(n)
            cosine = np.maximum(-view @ n, 0)[:, None]
            way = view + 2 * cosine * n
            # Rays that start into the next wave end, after more mirrors, not far above the horizon.
            way[:, 1] = np.abs(way[:, 1])
            share = wx * wz * cosine / n[1]
            fresnel = _fresnel(cosine)
            light += share * fresnel * sky(way)
            mirrored += share * fresnel
            total += share
    entering = 1 - mirrored / total
    return light / total + entering * DEEP * irradiance


def glitter(view: Floats, sun: Floats) -> Floats:
    """The radiance, (n, 1), of the sun's path on the water, for a sun of irradiance 1 across its rays."""
    half = sun - view
    half /= np.linalg.norm(half, axis=1, keepdims=True)
    slope2 = 1 / half[:, 1] ** 2 - 1
    variance = 2 * ROUGHNESS**2
    density = np.exp(-slope2 / variance) / (np.pi * variance)
    visible = _seen(-view[:, 1]) * _seen(np.array([sun[1]]))
    fresnel = _fresnel(np.sum(half * sun, 1))
    return (fresnel * density * visible / (4 * np.maximum(-view[:, 1], 1e-3) * half[:, 1] ** 4))[:, None]


def swell(view: Floats, height: float, pixel: float, seed: int = 4) -> Floats:
    """A modulation about 1, (n, 1), by long waves on the water `height` m below; `pixel` is in radians."""
    rng = np.random.default_rng(seed)
    out = np.ones((len(view), 1))
    # Nearer water, which the terrace hides, stays smooth.
    far = np.flatnonzero(view[:, 1] > -0.5)
    view = view[far]
    down = np.maximum(-view[:, 1], 1e-4)
    x, z = view[:, 0] * height / down, view[:, 2] * height / down
    footprint = height * pixel / down**2
    waves = np.zeros(len(view))
    for length in np.geomspace(12, 130, 22):
        angle = rng.normal(0.25, 0.45)
        phase = 2 * np.pi * (x * np.cos(angle) + z * np.sin(angle)) / length + rng.uniform(0, 2 * np.pi)
        waves += np.sin(phase) * np.exp(-np.square(1.5 * footprint / length))
    out[far, 0] += 0.035 * waves * np.clip((0.5 - down) / 0.2, 0, 1)
    return out


def _fresnel(cosine: Floats) -> Floats:
    """Unpolarised reflectance of water from above."""
    c = np.clip(cosine, 0, 1)
    t = np.sqrt(1 - (1 - c * c) / INDEX**2)
    return np.asarray(
        (((c - INDEX * t) / (c + INDEX * t)) ** 2 + ((t - INDEX * c) / (t + INDEX * c)) ** 2) / 2
    )


def _seen(cosine: Floats) -> Floats:
    """The share of waves that others do not hide (Smith; fit by Walter et al. 2007)."""
    c = np.clip(cosine, 1e-4, 0.9999)
    a = c / np.sqrt(1 - c * c) / (np.sqrt(2) * ROUGHNESS)
    return np.where(a < 1.6, (3.535 * a + 2.181 * a**2) / (1 + 2.276 * a + 2.577 * a**2), 1)
