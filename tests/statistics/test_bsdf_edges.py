"""
Every BSDF at the edges of what it may be given: no infinity, no NaN, nothing negative, no direction that is
not unit.
"""

from __future__ import annotations

import itertools

import numpy as np
import pytest
from bsdf_cases import ROUGHNESS, VARIANTS, Case

from etendue import _core

LAST = np.float32(1) - np.float32(2) ** -24
NUMBERS = np.array(
    [0, 1e-30, 1e-10, 2.0**-32, 0.25, 0.5, np.float32(0.5) + np.float32(2) ** -24, 0.75, LAST],
    dtype=np.float32,
)
HEIGHTS = (1.0, 1 - 6e-8, 0.5, 1e-2, 1e-4, 1e-6)


def leaning(z: float, azimuth: float = 0.0) -> np.ndarray:
    r = np.sqrt(1 - float(np.float32(z)) ** 2)
    return np.array([r * np.cos(azimuth), r * np.sin(azimuth), z], dtype=np.float32)


EDGES = [Case(*c) for c in itertools.product(_core.bsdfs(), VARIANTS, ROUGHNESS)]


@pytest.mark.parametrize("name", _core.bsdfs())
def test_samples_at_the_edges(name: str) -> None:
    u = np.array(list(itertools.product(NUMBERS, repeat=3)), dtype=np.float32)
    for case in (case for case in EDGES if case.bsdf == name):
        bsdf = case.make()
        for z, azimuth in itertools.product(HEIGHTS, (0.0, 0.7, np.pi)):
            wo = np.repeat(leaning(z, azimuth)[None], len(u), axis=0)
            sample = bsdf.sample(wo, u)
            ok = sample["type"] > 0
            where = f"{case}, wo.z {z:g}, azimuth {azimuth:g}"
            for key in ("wi", "weight", "pdf", "eta2"):
                assert np.isfinite(sample[key]).all(), (
                    f"{key} of {where}: {u[~np.isfinite(sample[key]).reshape(len(u), -1).all(axis=1)]}"
                )
            assert (sample["weight"] >= 0).all(), where
            assert (sample["pdf"][ok] > 0).all(), where
            assert (sample["eta2"][ok] > 0).all(), where
            length = np.linalg.norm(sample["wi"][ok].astype(float), axis=1)
            assert np.abs(length - 1).max(initial=0) < 2e-6, where
            transmitted = (sample["type"][ok] & _core.BRDF_TRANSMISSION) > 0
            assert ((sample["wi"][ok, 2] < 0) == transmitted).all(), where


@pytest.mark.parametrize("name", _core.bsdfs())
def test_values_at_the_edges(name: str) -> None:
    heights = [sign * z for z in (*HEIGHTS, 0.0) for sign in (1, -1)]
    wi = np.array(
        [leaning(z, a) for z in heights for a in (0.0, 1e-4, 0.7, np.pi - 1e-6, np.pi)], dtype=np.float32
    )
    for case in (case for case in EDGES if case.bsdf == name):
        bsdf = case.make()
        for z in HEIGHTS:
            wo = np.repeat(leaning(z)[None], len(wi), axis=0)
            for value in (bsdf.f(wo, wi), bsdf.pdf(wo, wi)):
                assert np.isfinite(value).all(), (
                    f"{case}, wo.z {z:g}: {wi[~np.isfinite(value).reshape(len(wi), -1).all(axis=1)]}"
                )
                assert (value >= 0).all(), f"{case}, wo.z {z:g}"
