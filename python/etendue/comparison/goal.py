"""How long each repeat goes on: to a number of samples, or for a number of seconds of its own."""

from __future__ import annotations

from dataclasses import dataclass

from ..errors import EtendueError

# The reference has so many times the samples, or the time, of a tested image ...
REFERENCE_FACTOR = 16
# ... and no fewer samples than these.
REFERENCE_LEAST = 1024


@dataclass(frozen=True)
class Goal:
    """One of `spp` and `seconds` is given."""

    spp: int | None = None
    seconds: float | None = None

    @classmethod
    def of(cls, spp: int | None, seconds: float | None, default_spp: int) -> Goal:
        """From options; EtendueError where they cannot be."""
        if spp is not None and seconds is not None:
            raise EtendueError("compare: equal samples (spp) and equal time (time) exclude each other")
        if seconds is not None:
            if not 0 < seconds < float("inf"):
                raise EtendueError(f"compare: a time above 0 seconds is needed, not {seconds:g}")
            return cls(seconds=float(seconds))
        return cls(spp=default_spp if spp is None else spp)

    @property
    def amount(self) -> float:
        """Samples or seconds."""
        return float(self.spp or self.seconds or 0)

    @property
    def label(self) -> str:
        """64spp or 10s, for names of files."""
        return f"{self.spp}spp" if self.spp is not None else f"{self.seconds:g}s"

    def of_reference(self, spp: int | None) -> Goal:
        """What the reference is to reach; `spp`: where the user says so."""
        if spp is not None:
            return Goal(spp=spp)
        if self.seconds is not None:
            return Goal(seconds=REFERENCE_FACTOR * self.seconds)
        return Goal(spp=max(REFERENCE_FACTOR * (self.spp or 1), REFERENCE_LEAST))
