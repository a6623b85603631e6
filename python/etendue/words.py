"""Numbers as people read them."""

from __future__ import annotations


def si(value: float) -> str:
    """A count with three digits and k, M or G: 12.3 M."""
    for factor, unit in ((1e9, " G"), (1e6, " M"), (1e3, " k")):
        if value >= 0.9995 * factor:
            return f"{value / factor:.3g}{unit}" if value < 1000 * factor else f"{value / factor:.0f}{unit}"
    return f"{value:.3g}"


def clock(seconds: float) -> str:
    """Seconds as 12 ms, 9.3 s, 2:05 or 1:02:03."""
    if seconds < 0.0995:
        return f"{seconds * 1000:.2g} ms"
    if seconds < 9.95:
        return f"{seconds:.1f} s"
    whole = round(seconds)
    minutes, rest = divmod(whole, 60)
    hours, minutes = divmod(minutes, 60)
    if hours:
        return f"{hours}:{minutes:02}:{rest:02}"
    return f"{minutes}:{rest:02}" if minutes else f"{whole} s"


def counted(number: int, noun: str) -> str:
    """A number of things: 1 light, 1,234 lights."""
    return f"{number:,} {noun}{'' if number == 1 else 's'}"
