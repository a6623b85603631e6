"""
Random numbers: uniform, independent where they must be, stratified where they claim it, and a function of
their indices.
"""

from __future__ import annotations

import itertools

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy import stats
from scipy.stats import qmc
from stats import chi_square, holm, sidak, uniformity

from etendue import _core

KINDS = _core.samplers()
PLACES = [(pixel, vertex) for pixel in (0, 1, 77, 123_456) for vertex in (0, 1, 2, 11)]
PAIRS = 3  # two-dimensional draws at a vertex that are looked at


def in_strata(points: NDArray[np.float64], columns: int, lines: int) -> bool:
    """
    Whether every cell of the grid holds exactly one of its columns x lines points. A coordinate that
    rounding to a float put onto the line between two cells may belong to either.
    """
    x, y = points[:, 0] * columns, points[:, 1] * lines
    unsure = (x == np.floor(x)) | (y == np.floor(y))
    cell = np.floor(x).astype(int) * lines + np.floor(y).astype(int)
    return int(np.bincount(cell[~unsure], minlength=columns * lines).max()) <= 1 and unsure.mean() < 0.05


@pytest.mark.parametrize(("pixel", "vertex"), PLACES)
def test_sobol_is_a_net_in_every_block(pixel: int, vertex: int) -> None:
    """
    The (0, 2) property, for every pair at every vertex: any aligned block of 2^k samples has one point in
    each elementary interval of area 2^-k, whatever its shape.
    """
    sobol = _core.Sampler("sobol", 7)
    for k in (1, 2, 3, 4, 6, 8, 10):
        for block in (0, 1, 5, 1000):
            points = sobol.points(pixel, block << k, 1 << k, vertex, PAIRS).astype(float)
            for pair in range(PAIRS):
                for split in range(k + 1):
                    assert in_strata(points[:, 2 * pair : 2 * pair + 2], 1 << split, 1 << (k - split)), (
                        f"{k=} {block=} {pair=} {split=}"
                    )


@pytest.mark.parametrize("parts", [2, 4, 8])
def test_parts_of_samples_are_a_net_together(parts: int) -> None:
    """And no part of a sample has the sample's own numbers, nor those that other samples have."""
    sobol = _core.Sampler("sobol", 7)
    for first in (0, 64, 1 << 32, (1 << 32) - 64):
        points = np.concatenate([sobol.points(3, first, 64, 1, 1, part=(k, parts)) for k in range(parts)])
        for columns in (1, parts, 8 * parts, 64 * parts):
            assert in_strata(points.astype(float), columns, 64 * parts // columns)
    far = [sobol.points(3, first, 64, 1, 1, part=(1, parts)) for first in (0, (1 << 32) - 64, 1 << 32)]
    assert not any(np.isin(far[i], far[j]).any() for i, j in ((0, 1), (0, 2), (1, 2)))
    for kind in KINDS:
        sampler = _core.Sampler(kind, 7)
        each = [sampler.points(3, 0, 64), *(sampler.points(3, 0, 64, part=(k, parts)) for k in range(parts))]
        assert len(np.unique(np.concatenate(each)[:, 0])) > 64 * (parts + 1) - 3


@pytest.mark.parametrize(("pixel", "vertex"), PLACES)
def test_sobol_numbers_are_stratified(pixel: int, vertex: int) -> None:
    """The same for one-dimensional draws."""
    sobol = _core.Sampler("sobol", 7)
    for k, block in itertools.product((1, 4, 8, 12), (0, 3)):
        numbers = sobol.numbers(pixel, block << k, 1 << k, vertex, 4).astype(float) * (1 << k)
        for column in numbers.T:
            sure = column != np.floor(column)
            assert np.bincount(column[sure].astype(int)).max() == 1
            assert sure.mean() > 0.95


@pytest.mark.parametrize("kind", KINDS)
def test_marginals_and_pairs_are_uniform(kind: str) -> None:
    """
    Over pixels, as a sequence is better than random within one: one sample of each of 40,000 pixels,
    chi-square in one and in two dimensions, of every pair with itself, with the other pairs, and across
    vertices.
    """
    sampler, p_values = _core.Sampler(kind, 3), []
    for index in (0, 5):
        draws = [
            np.concatenate([sampler.points(pixel, index, 1, vertex, PAIRS) for pixel in range(20_000)])
            for vertex in (0, 1)
        ]
        u = np.concatenate(draws, axis=1)
        for column in u.T:
            p_values.append(
                chi_square(np.bincount((column * 64).astype(int), minlength=64), np.full(64, len(u) / 64)).p
            )
        for a, b in itertools.combinations(range(u.shape[1]), 2):
            cell = (u[:, a] * 16).astype(int) * 16 + (u[:, b] * 16).astype(int)
            p_values.append(chi_square(np.bincount(cell, minlength=256), np.full(256, len(u) / 256)).p)
    assert not holm(p_values).any()
    assert uniformity(p_values) > 1e-3


@pytest.mark.parametrize("kind", KINDS)
def test_dimensions_are_independent(kind: str) -> None:
    """
    Within one pixel's sequence of 256 samples: different draws, vertices, pixels and seeds, over 40 seeds.

    Correlations average 0. The chi-square statistic of a 16 x 16 table of two draws averages what it must:
    255 of independent numbers; 240 of two sequences that Owen's way shuffled apart, as of the 225 contrasts
    64 have twice the variance (those of the first bits, where neighbours pair up), 16 four times, 4 eight
    times, 1 sixteen times, and the others none.
    """
    n, tables, correlations = 256, [], []
    for seed in range(40):
        columns = {}
        for s, pixel, vertex in [
            (seed, 0, 0),
            (seed, 0, 1),
            (seed, 0, 2),
            (seed, 1, 0),
            (seed + 100, 0, 0),
            (seed, 1 << 16, 0),
        ]:
            points = _core.Sampler(kind, s).points(pixel, 0, n, vertex, 2)
            for i in range(4):
                columns[s, pixel, vertex, i] = points[:, i]
        numbers = _core.Sampler(kind, seed).numbers(0, 0, n, 3, 2)
        columns[seed, 0, 3, 0], columns[seed, 0, 3, 2] = numbers.T
        rows = np.array(list(columns.values()), dtype=float)
        # The two numbers of a pair are too even together, by design.
        pairs = [
            (i, j)
            for (i, a), (j, b) in itertools.combinations(enumerate(columns), 2)
            if a[:3] != b[:3] or a[3] // 2 != b[3] // 2
        ]
        a, b = np.array(pairs).T
        correlations.append(np.corrcoef(rows)[a, b])
        cells = (
            (rows[a] * 16).astype(int) * 16 + (rows[b] * 16).astype(int) + 256 * np.arange(len(a))[:, None]
        )
        counts = np.bincount(cells.ravel(), minlength=256 * len(a)).reshape(len(a), 256)
        tables.append(((counts - n / 256) ** 2 / (n / 256)).sum(axis=1))
    p_values = stats.ttest_1samp(correlations, 0, axis=0).pvalue
    assert not holm(p_values).any()
    assert uniformity(p_values) > 1e-4
    assert np.sqrt(n) * np.std(correlations) < 1.6
    statistics = np.array(tables)
    # The pairs of one seed share columns: its mean is one observation.
    assert stats.ttest_1samp(statistics.mean(axis=1), 240 if kind == "sobol" else 255).pvalue > 1e-3
    assert not holm(stats.ttest_1samp(statistics, 240 if kind == "sobol" else 255, axis=0).pvalue).any()


def test_sobol_is_more_even_than_independent() -> None:
    """
    Star-like (L2) discrepancy of 256 points, over 200 pixels, and convergence of an integral: n^-3 against
    n^-1 in variance.
    """
    found = {}
    for kind in KINDS:
        sampler = _core.Sampler(kind, 5)
        found[kind] = np.array(
            [
                qmc.discrepancy(sampler.points(pixel, 0, 256).astype(float), method="L2-star")
                for pixel in range(200)
            ]
        )
    # Of independent points the mean square is (2^-2 - 3^-2) / n exactly.
    independent = np.sqrt((found["independent"] ** 2).mean())
    assert independent == pytest.approx(np.sqrt((1 / 4 - 1 / 9) / 256), rel=0.15)
    assert found["sobol"].max() < found["independent"].min()

    def variance(kind: str, n: int) -> float:
        sampler = _core.Sampler(kind, 5)
        points = [sampler.points(pixel, 0, n).astype(float) for pixel in range(300)]
        return float(np.var([np.exp(p[:, 0] * p[:, 1]).mean() for p in points]))

    assert variance("sobol", 1024) / variance("sobol", 64) < 16**-2.5
    assert 1 / 16 / 1.6 < variance("independent", 1024) / variance("independent", 64) < 1.6 / 16


def test_independent_is_not_serially_correlated() -> None:
    sampler = _core.Sampler("independent", 9)
    u = sampler.points(3, 0, 1 << 17, 0, 4)
    p_values = [stats.pearsonr(a[:-lag], a[lag:]).pvalue for a in (u.ravel(), *u.T) for lag in (1, 2, 7, 64)]
    bits = (u.ravel() * 2**24).astype(np.int64)
    for bit in range(24):
        ones = int(((bits >> bit) & 1).sum())
        # The last bits of a number below a half have been there, too: it is a float.
        p_values.append(stats.binomtest(ones, len(bits)).pvalue if bit > 3 else 1.0)
    p_values.append(
        chi_square(
            np.bincount((u.ravel() * 1024).astype(int), minlength=1024), np.full(1024, u.size / 1024)
        ).p
    )
    assert not holm(p_values).any()


@pytest.mark.parametrize("kind", KINDS)
def test_a_number_is_a_function_of_its_indices(kind: str) -> None:
    """Not of the order of asking; and every index matters."""
    a, b = _core.Sampler(kind, 11), _core.Sampler(kind, 11)
    whole = a.points(5, 100, 64, 2, 3)
    one_by_one = np.concatenate([b.points(5, index, 1, 2, 3) for index in reversed(range(100, 164))])[::-1]
    np.testing.assert_array_equal(whole, one_by_one)
    np.testing.assert_array_equal(whole[:, :2], a.points(5, 100, 64, 2, 1))
    others = [
        _core.Sampler(kind, 12).points(5, 100, 64, 2, 3),
        a.points(6, 100, 64, 2, 3),
        a.points(5, 164, 64, 2, 3),
        a.points(5, 100, 64, 3, 3),
    ]
    for other in others:
        assert (other != whole).mean() > 0.999
    with pytest.raises(ValueError, match="sampler"):
        _core.Sampler("no such sampler")


@pytest.mark.parametrize("kind", KINDS)
def test_indices_of_64_bits(kind: str) -> None:
    """Beyond 2^32 samples the sequence goes on: just as even, and unlike its beginning."""
    sampler = _core.Sampler(kind, 13)
    for first in (1 << 32, 5 << 32, (1 << 63) + (1 << 40)):
        there, start = sampler.points(1, first, 1024).astype(float), sampler.points(1, 0, 1024).astype(float)
        assert (there != start).mean() > 0.999
        assert stats.pearsonr(there[:, 0], start[:, 0]).pvalue > sidak(12)
        assert stats.kstest(there[:, 0], "uniform").pvalue > sidak(12)
        if kind == "sobol":
            assert all(in_strata(there, 1 << split, 1 << (10 - split)) for split in range(11))
    across = sampler.points(1, (1 << 32) - 2, 4)
    np.testing.assert_array_equal(across[2:], sampler.points(1, 1 << 32, 2))


@pytest.mark.parametrize("kind", KINDS)
def test_range(kind: str) -> None:
    """In [0, 1): never 1, and the smallest are there."""
    u = np.concatenate([_core.Sampler(kind, seed).points(0, 0, 1 << 17, 0, 2).ravel() for seed in range(4)])
    assert u.min() >= 0
    assert u.max() < 1
    assert u.min() < 1e-4
    assert u.max() > 1 - 1e-4
