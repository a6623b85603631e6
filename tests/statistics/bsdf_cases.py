"""Every registered BSDF over roughness, parameters and angle, and what sampling it shows."""

from __future__ import annotations

import itertools
import zlib
from typing import NamedTuple

import numpy as np
from cells import Cells, chart
from numpy.typing import NDArray
from stats import ChiSquare, chi_square

from etendue import _core

ROUGHNESS = (0.0, 0.01, 0.05, 0.1, 0.3, 0.6, 1.0)  # the first is clamped to the least, 1e-3
ANGLES = (0.0, 30.0, 60.0, 80.0, 89.0, 89.9)
VARIANTS: dict[str, dict[str, object]] = {
    "": {},
    "back": {"front": False},
    "coated": {"coated": True},
    "dense": {"ior": 2.42},
    "metallic": {"ior": 0.2, "absorb": 3.0},
    "vacuum": {"ior": 1.0},
}


class Case(NamedTuple):
    """A BSDF with its parameters."""

    bsdf: str
    variant: str
    roughness: float

    def __str__(self) -> str:
        return "-".join(part for part in (self.bsdf, self.variant, f"{self.roughness:g}") if part)

    def make(self, albedo: tuple[float, float, float] = (1.0, 1.0, 1.0)) -> _core.Bsdf:
        """The BSDF; a variant may be the name of a material type, whose own values it then has."""
        if self.variant in VARIANTS:
            return _core.Bsdf(self.bsdf, albedo=albedo, roughness=self.roughness, **VARIANTS[self.variant])
        given = next(t for t in _core.material_types() if t.name == self.variant)
        values = {key: getattr(given, key) for key in ("albedo", "ior", "absorb", "roughness")}
        return _core.Bsdf(given.name, **{key: value for key, value in values.items() if value is not None})

    def rng(self, *stream: int) -> np.random.Generator:
        """Numbers of this case's own, the same in every run."""
        return np.random.default_rng([zlib.crc32(str(self).encode()), *stream])


def cases(variants: tuple[str, ...] = ("",), roughness: tuple[float, ...] = ROUGHNESS) -> list[Case]:
    """All BSDFs that have densities."""
    names = [name for name in _core.bsdfs() if not _core.Bsdf(name).is_delta]
    return [Case(*combination) for combination in itertools.product(names, variants, roughness)]


def typed_cases() -> list[Case]:
    """All material types with the values that they set."""
    return [Case(t.bsdf, t.name, t.roughness or 0.1) for t in _core.material_types()]


FAST = cases() + cases(tuple(VARIANTS)[1:], (0.1,))
SLOW = (
    cases()
    + cases(tuple(VARIANTS)[1:], (0.0, 0.1, 0.6))
    + [c for c in typed_cases() if not c.make().is_delta]
)


def direction(angle: float, azimuth: float = 0.0) -> NDArray[np.float32]:
    """
    A direction so many degrees from the normal. The components are rounded together: at a grazing angle a
    length off by 6e-8 would turn half vectors by more than the narrowest lobes are wide.
    """
    x = float(np.float32(np.sin(np.radians(angle))))
    z = np.sqrt(1 - x * x)
    return np.array([x * np.cos(azimuth), x * np.sin(azimuth), z], dtype=np.float32)


def rows(vector: NDArray[np.float32], n: int) -> NDArray[np.float32]:
    """The same vector n times."""
    return np.repeat(vector[None], n, axis=0)


def draw(bsdf: _core.Bsdf, wo: NDArray[np.float32], n: int, rng: np.random.Generator) -> dict[str, NDArray]:
    """n samples, with `ok` where sampling succeeded and `smooth` where of a lobe that has a density."""
    sample = bsdf.sample(rows(wo, n), rng.random((n, 3), dtype=np.float32))
    sample["ok"] = sample["type"] > 0
    sample["smooth"] = sample["ok"] & ((sample["type"] & _core.BRDF_SPECULAR) == 0)
    return sample


def cells_of(bsdf: _core.Bsdf, wo: NDArray[np.float32], rng: np.random.Generator, depth: int) -> Cells:
    """
    Cells that follow the BSDF's samples, with a share of uniform ones lest a place that is never sampled
    hide its density.
    """
    sample = draw(bsdf, wo, 100 << depth, rng)
    uniform = np.stack(
        [rng.uniform(-1, 1, 10 << depth), rng.uniform(-np.pi / 2, 1.5 * np.pi, 10 << depth)], axis=1
    )
    return Cells(np.concatenate([chart(sample["wi"][sample["smooth"]]), uniform]), depth)


class Sampling(NamedTuple):
    """What `measure` found at one angle."""

    agreement: ChiSquare
    integral: float  # of pdf
    kept: float  # share of samples that pdf should account for
    samples: int
    cells: Cells
    observed: NDArray[np.float64]
    expected: NDArray[np.float64]

    @property
    def lost_error(self) -> float:
        """
        How far the integral is from the share, in standard errors, the quadrature's 2e-5 of it allowed for.
        """
        variance = max(self.kept * (1 - self.kept), self.integral * abs(1 - self.integral), 1 / self.samples)
        return max(abs(self.integral - self.kept) - 2e-5 - 2e-4 * (self.samples < 1e5), 0) / float(
            np.sqrt(variance / self.samples)
        )


def measure(case: Case, angle: float, samples: int, depth: int) -> Sampling:
    """Samples of a case counted in cells, against the integral of its pdf over them."""
    bsdf, wo, rng = case.make(), direction(angle), case.rng(round(10 * angle))
    cells = cells_of(bsdf, wo, rng, depth)
    integrals = cells.integrate(lambda wi: bsdf.pdf(rows(wo, len(wi)), wi), 1e-6 if samples > 1e5 else 1e-5)
    sample = draw(bsdf, wo, samples, rng)
    smooth = sample["smooth"]
    observed = cells.count(chart(sample["wi"][smooth]))
    total = integrals.sum()
    expected = integrals / max(total, 1e-30) * smooth.sum()
    # Lobes without a density are chosen before, with what probability the delta tests see to.
    kept = 1 - (~sample["ok"]).mean() - (sample["ok"] & ~smooth).mean()
    return Sampling(
        chi_square(observed, expected), float(total), float(kept), samples, cells, observed, expected
    )
