"""Pixel filters: offsets drawn from them have their density."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray
from stats import chi_square, sidak

from etendue import _core

COEFFICIENTS = (0.35875, 0.48829, 0.14128, 0.01168)  # Harris 1978, the minimum four-term window


def blackman_harris(x: NDArray[np.float64]) -> NDArray[np.float64]:
    """Its cumulative distribution over [-1.5, 1.5], by summing the window at a million places."""
    at = np.linspace(-1.5, 1.5, 1_000_001)
    window = sum(a * np.cos(2 * np.pi * i * at / 3) for i, a in enumerate(COEFFICIENTS))
    total = np.concatenate([[0], np.cumsum((window[1:] + window[:-1]) / 2)])
    return np.interp(x, at, total / total[-1])


FILTERS = {"blackman_harris": (blackman_harris, 1.5), "box": (lambda x: np.clip(x + 0.5, 0, 1), 0.5)}


def test_every_filter_is_covered() -> None:
    assert set(_core.filters()) == set(FILTERS)


@pytest.mark.parametrize("name", _core.filters())
def test_offsets_have_the_density_of_the_filter(name: str) -> None:
    cumulative, radius = FILTERS[name]
    n = 1_000_000
    offsets = _core.filter_offsets(name, np.random.default_rng(1).random((n, 2), dtype=np.float32)).astype(
        float
    )
    assert np.abs(offsets).max() <= radius
    edges = np.linspace(-radius, radius, 61)
    expected = np.diff(cumulative(edges)) * n
    for axis in range(2):
        assert chi_square(np.histogram(offsets[:, axis], edges)[0], expected).p > sidak(6)
    coarse = np.linspace(-radius, radius, 13)
    share = np.diff(cumulative(coarse))
    table = np.histogram2d(offsets[:, 0], offsets[:, 1], bins=coarse)[0]
    assert chi_square(table, np.outer(share, share) * n).p > sidak(6)


@pytest.mark.parametrize("name", _core.filters())
def test_quantiles(name: str) -> None:
    """A rising function of u, which keeps strata, and the inverse of the cumulative distribution."""
    cumulative, radius = FILTERS[name]
    u = np.concatenate([np.arange(2**16) / 2**16, [1 - 2.0**-24]]).astype(np.float32)
    offsets = _core.filter_offsets(name, np.stack([u, u[::-1]], axis=1)).astype(float)
    assert (np.diff(offsets[:, 0]) > 0).all()
    np.testing.assert_array_equal(offsets[:, 0], offsets[::-1, 1])
    assert np.abs(cumulative(offsets[:, 0]) - u).max() < 1e-3
    assert offsets[0, 0] == pytest.approx(-radius, abs=1e-6)
    np.testing.assert_allclose(offsets[1:-1, 0], -offsets[1:-1, 0][::-1], atol=1e-4)


@pytest.mark.parametrize("name", _core.filters())
def test_the_density_is_that_of_the_offsets(name: str) -> None:
    """Also between the cells of the table that offsets are drawn from, which the window itself is not."""
    n, cells, steps = 4_000_000, 48, 64
    radius = FILTERS[name][1]
    offsets = _core.filter_offsets(name, np.random.default_rng(2).random((n, 2), dtype=np.float32))
    edges = np.linspace(-radius, radius, cells + 1)
    at = (np.arange(cells * steps) + 0.5) / (cells * steps) * 2 * radius - radius
    along_x = np.stack([at, np.zeros_like(at)], axis=1).astype(np.float32)
    density = _core.filter_density(name, along_x).reshape(cells, steps).mean(1)
    probability = density / density.sum()
    for axis in range(2):
        assert chi_square(np.histogram(offsets[:, axis], edges)[0], probability * n).p > sidak(4)
    # Of two dimensions it is the product, and its integral is 1.
    grid = np.stack(np.meshgrid(at[::8], at[::8]), axis=-1).reshape(-1, 2).astype(np.float32)
    area = (2 * radius / len(at[::8])) ** 2
    assert _core.filter_density(name, grid).sum() * area == pytest.approx(1, abs=2e-3)
    outside = np.array([[radius + 1e-3, 0], [0, -radius - 1e-3]], np.float32)
    assert (_core.filter_density(name, outside) == 0).all()
