"""Numbers as people read them."""

from __future__ import annotations

import pytest

from etendue.words import clock, counted, si


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (0.5, "0.5"),
        (999.4, "999"),
        (999.6, "1 k"),
        (1234, "1.23 k"),
        (12.3e6, "12.3 M"),
        (999.9e6, "1 G"),
        (4e9, "4 G"),
    ],
)
def test_si(value: float, text: str) -> None:
    assert si(value) == text


@pytest.mark.parametrize(
    ("seconds", "text"),
    [
        (0.0004, "0.4 ms"),
        (0.04, "40 ms"),
        (0.0994, "99 ms"),
        (0.1, "0.1 s"),
        (9.94, "9.9 s"),
        (9.96, "10 s"),
        (59.6, "1:00"),
        (125, "2:05"),
        (3723, "1:02:03"),
    ],
)
def test_clock(seconds: float, text: str) -> None:
    assert clock(seconds) == text


def test_counted() -> None:
    assert [counted(number, "light") for number in (0, 1, 1234)] == ["0 lights", "1 light", "1,234 lights"]
