"""Exposure and the sRGB transfer function."""

from __future__ import annotations

import numpy as np
import pytest

from etendue.display import linear_to_srgb, srgb_to_linear, tonemap


def test_known_values() -> None:
    linear = np.array([0, 0.0031308, 0.18, 0.5, 1], np.float32)
    assert linear_to_srgb(linear) == pytest.approx([0, 0.04045, 0.46136, 0.735357, 1], abs=1e-5)
    assert linear_to_srgb(np.array([-1.0])) == [0]


def test_every_8_bit_value_comes_back() -> None:
    encoded = np.arange(256, dtype=np.uint8)
    assert (tonemap(srgb_to_linear(encoded / np.float32(255))) == encoded).all()


def test_exposure_and_clipping() -> None:
    image = np.array([[[0.0, 0.25, 4.0], [np.nan, np.inf, -1.0]]], np.float32)
    assert tonemap(image, 2.0).tolist() == [[[0, 188, 255], [0, 255, 0]]]
    assert tonemap(image).dtype == np.uint8
    assert tonemap(image, 0.5).tolist()[0][0] == [0, 99, 255]


def test_values_are_rounded() -> None:
    # 127.5 / 255 lies between two levels; one ulp aside decides.
    level = srgb_to_linear(np.array([127.4 / 255, 127.6 / 255], np.float32))
    assert tonemap(level).tolist() == [127, 128]
