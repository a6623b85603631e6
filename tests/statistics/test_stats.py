"""The yardstick itself: it passes what is right as often as it says, and fails what is wrong by little."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from cells import WHOLE, Cells, chart, directions
from stats import chi_square, holm, mean_is, sidak, uniformity, welch


@pytest.fixture
def rng() -> np.random.Generator:
    """Anew for every test, so that none depends on which ran before it."""
    return np.random.default_rng(2)


def test_chi_square_of_the_right_table(rng: np.random.Generator) -> None:
    """Uniform p-values, with small cells that need pooling."""
    share = np.concatenate([np.geomspace(1e-7, 1, 60), np.zeros(5)])
    share /= share.sum()
    p_values = [
        chi_square(np.bincount(rng.choice(65, 20_000, p=share), minlength=65), 20_000 * share).p
        for _ in range(300)
    ]
    assert uniformity(p_values) > 0.01


def test_chi_square_of_wrong_tables(rng: np.random.Generator) -> None:
    share = np.full(100, 0.01)
    counts = np.bincount(rng.choice(100, 1_000_000, p=share), minlength=100)
    off = share.copy()
    off[:50] *= 1.02
    assert chi_square(counts, 1e6 * off / off.sum()).p < 1e-4
    # A few counts where there can be none are not drowned in the rest.
    assert chi_square([1000, 1000, 5], [1002, 1003, 0]).p == 0
    assert chi_square([1000, 1000, np.nan], [1000, 1000, np.nan]).p == 0


def test_corrections() -> None:
    assert 1 - (1 - sidak(1000)) ** 1000 == pytest.approx(0.01)
    np.testing.assert_array_equal(holm([1e-6, 0.5, 0.0049, 0.02]), [True, False, False, False])
    np.testing.assert_array_equal(holm([1e-6, 0.5, 0.0032, 0.004]), [True, False, True, True])


def test_means(rng: np.random.Generator) -> None:
    a, b = rng.normal(1, 1, 40_000), rng.normal(1, 3, 40_000)
    assert welch(a, b) > 0.01
    assert welch(a * 1.1, b) < 1e-3
    assert mean_is(a, 1) > 0.01
    assert mean_is(a * 1.03, 1) < 1e-3
    assert mean_is(np.ones(5), 1.0) > 0.99


def test_chart(rng: np.random.Generator) -> None:
    v = rng.normal(size=(1000, 3))
    v = (v / np.linalg.norm(v, axis=1, keepdims=True)).astype(np.float32)
    np.testing.assert_allclose(directions(chart(v)), v, atol=1e-6)
    upper = chart(v)[:, 1] < np.pi / 2
    np.testing.assert_array_equal(upper, v[:, 2] > 0)


def test_cells_integrate_lobes_of_any_width(rng: np.random.Generator, tmp_path: Path) -> None:
    """
    A lobe with heavy tails, 1 to 1e-5 wide, whose integral is known: s^2 / (pi (s^2 + d^2)^2) of the
    distance d in the plane z = 1.
    """
    for width in (1.0, 0.1, 1e-3, 1e-5):
        u = rng.random((30_000, 2))
        tangent = width * np.sqrt(u[:, 0] / (1 - u[:, 0]))
        x, y = tangent * np.cos(2 * np.pi * u[:, 1]), tangent * np.sin(2 * np.pi * u[:, 1])
        v = np.stack([x, y, np.ones(len(x))], axis=1)
        v = (v / np.linalg.norm(v, axis=1, keepdims=True)).astype(np.float32)

        def density(w: np.ndarray, width: float = width) -> np.ndarray:
            x, y, z = np.where(w[:, 2:] > 0, w, [0, 0, 1]).astype(float).T
            d2 = (x**2 + y**2) / z**2
            return np.where(w[:, 2] > 0, width**2 / (np.pi * (width**2 + d2) ** 2) / z**3, 0)

        cells = Cells(chart(v[:20_000]), 6)
        assert np.prod(cells.bounds[:, :, 1] - cells.bounds[:, :, 0], axis=1).sum() == pytest.approx(
            np.prod(WHOLE[:, 1] - WHOLE[:, 0])
        )
        integrals = cells.integrate(density)
        assert integrals.sum() == pytest.approx(1, abs=1e-4)
        observed = cells.count(chart(v[20_000:]))
        assert chi_square(observed, 10_000 * integrals).p > 1e-3
        # A fifth wider is found out.
        wide = cells.integrate(lambda w, width=width: density(w, 1.2 * width))
        assert chi_square(observed, 10_000 * wide).p < 0.01
        assert cells.picture(observed, 10_000 * integrals, tmp_path / "tables.png").stat().st_size > 1000
