"""Errors against numbers worked out by hand."""

from __future__ import annotations

import numpy as np
import pytest

from etendue.comparison import metrics


def test_errors_of_known_images() -> None:
    reference = np.full((20, 10, 3), 2.0, np.float32)
    image = reference + np.float32([0.3, 0, 0])
    assert metrics.quick(image, reference) == pytest.approx(
        {"MSE": 0.03, "relMSE": 0.03 / 4.01, "trimmed relMSE": 0.03 / 4.01}
    )


def test_black_references_do_not_divide_by_zero() -> None:
    black = np.zeros((2, 2, 3), np.float32)
    assert metrics.quick(black + 1, black)["relMSE"] == pytest.approx(1 / metrics.EPSILON)


def test_trimmed_error_leaves_the_worst_thousandth_out() -> None:
    reference = np.ones((100, 100, 3), np.float32)
    image = reference.copy()
    image[:1, :10] = 1e4
    found = metrics.quick(image, reference)
    assert found["relMSE"] > 1e4
    assert found["trimmed relMSE"] == 0
    image[1, 0] = 2
    assert metrics.quick(image, reference)["trimmed relMSE"] > 0
    assert metrics.trimmed_mean(np.array([[5.0]])) == 5


def test_flip_sees_what_is_displayed() -> None:
    random = np.random.default_rng(0)
    reference = random.random((32, 32, 3), np.float32)
    assert metrics.flip_map(reference, reference, 1).max() == 0
    assert metrics.flip_map(1 - reference, reference, 1).mean() > 0.2
    # Brighter than white is white on a display, and what is too dark to be seen is not seen.
    assert metrics.flip_map(reference + 5, reference + 1, 1).max() == 0
    assert metrics.flip_map(1 - reference, reference, 1e-6).max() == 0


def test_flip_takes_the_reference_first() -> None:
    """FLIP is not symmetric; the published numbers have the reference first."""
    flip = pytest.importorskip("flip_evaluator")
    random = np.random.default_rng(3)
    reference, image = random.random((2, 32, 32, 3), np.float32)
    shown = [np.rint(255 * metrics.tonemap(x).astype(np.float32) / 255) / 255 for x in (reference, image)]
    expected = flip.evaluate(shown[0], shown[1], "LDR", True, False)[1]
    assert metrics.flip_map(image, reference, 1).mean() == pytest.approx(expected, abs=1e-6)
