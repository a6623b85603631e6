"""Every light's `sample_Li` has the density `pdf_Li` in every direction in which the light is seen."""

from __future__ import annotations

import itertools
import zlib
from pathlib import Path

import numpy as np
import pytest
from cells import Cells, chart
from light_scenes import REFERENCES, SCENES, registered_kinds, rows, seen
from numpy.typing import NDArray
from scipy.stats import norm
from stats import chi_square, sidak, welch

from etendue import _core

FAMILY = len(SCENES) * len(REFERENCES)


def facing(directions: NDArray[np.float32]) -> NDArray[np.float64]:
    """
    A rotation that brings the mean of the directions, if they have one, in front of the chart, far from its
    poles and seam.
    """
    mean = directions.astype(float).mean(axis=0)
    if np.linalg.norm(mean) < 0.3:
        return np.eye(3)
    z = mean / np.linalg.norm(mean)
    x = np.cross([0.3, 1, 0.2], z)
    x /= np.linalg.norm(x)
    return np.stack([x, np.cross(z, x), z])


def sky_cells(
    light: _core.Light, reference: NDArray[np.float32], columns: int, lines: int, with_mis: bool
) -> NDArray[np.float64]:
    """
    The integral of pdf_Li over cells of an equirectangular grid, which pixels of skies are whole numbers
    of, row by row.
    """
    a = (np.arange(4) + 0.5) / 4
    cosines = np.cos(np.pi * np.arange(lines + 1) / lines)
    total = np.zeros((lines, columns))
    for i in a:
        for j in a:
            y = cosines[:-1] + i * (cosines[1:] - cosines[:-1])
            phi = 2 * np.pi * (np.arange(columns) + j) / columns
            r = np.sqrt(1 - y**2)
            wi = np.stack(
                np.broadcast_arrays(r[:, None] * np.cos(phi), y[:, None], r[:, None] * np.sin(phi)), axis=-1
            )
            wi = wi.reshape(-1, 3).astype(np.float32)
            total += light.pdf_Li(rows(reference, len(wi)), wi, with_mis).reshape(lines, columns)
    return total / 16 * (cosines[:-1] - cosines[1:])[:, None] * (2 * np.pi / columns)


def check(name: str, which: int, samples: int, depth: int, folder: Path) -> None:
    scene, reference = SCENES[name](), REFERENCES[which]
    # Only skies are sampled in another way with MIS.
    for (index, light), with_mis in itertools.product(enumerate(scene.lights), (False, True)):
        if with_mis and light.material is not None:
            continue
        rng = np.random.default_rng([zlib.crc32(name.encode()), which, index])
        u = rng.random((samples, 2), dtype=np.float32)
        sample = light.sample_Li(rows(reference, samples), u, with_mis)
        visible = seen(scene, light, reference, sample)
        wi = sample["wi"][visible]
        if light.material is None:
            # A sky's pdf jumps from pixel to pixel: cells are parts of pixels, but for those that the
            # square hides.
            lines, columns = 48, 96
            v = np.arccos(np.clip(wi[:, 1].astype(float), -1, 1)) / np.pi
            u = np.arctan2(wi[:, 2].astype(float), wi[:, 0]) / (2 * np.pi) % 1
            cell = np.minimum((v * lines).astype(int), lines - 1) * columns + np.minimum(
                (u * columns).astype(int), columns - 1
            )
            observed = np.bincount(cell, minlength=lines * columns).reshape(lines, columns)
            integrals = sky_cells(light, reference, columns, lines, with_mis)
            partly = np.zeros_like(integrals, dtype=bool)
            hidden = sample["pdf"] > 0
            hidden &= ~visible
            w = sample["wi"][hidden]
            for shift in np.linspace(-0.5, 0.5, 3):
                v = np.arccos(np.clip(w[:, 1].astype(float), -1, 1)) / np.pi * lines + shift
                u = np.arctan2(w[:, 2].astype(float), w[:, 0]) / (2 * np.pi) % 1 * columns
                for turn in np.linspace(-0.5, 0.5, 3):
                    partly[np.clip(v.astype(int), 0, lines - 1), (u + turn).astype(int) % columns] = True
            observed, integrals = np.where(partly, 0, observed), np.where(partly, 0, integrals)
            expected = samples * integrals
            expected, observed = (
                np.append(expected, samples - expected.sum()),
                np.append(observed, samples - observed.sum()),
            )
            assert chi_square(observed, expected).p > sidak(FAMILY), f"light {index}"
            continue
        turn = facing(wi) if len(wi) else np.eye(3)
        points = chart((wi @ turn.T).astype(np.float32))
        pilots = light.sample_Li(
            rows(reference, 300 << depth), rng.random((300 << depth, 2), dtype=np.float32)
        )
        pilots = pilots["wi"][seen(scene, light, reference, pilots)]
        uniform = np.stack(
            [rng.uniform(-1, 1, 10 << depth), rng.uniform(-np.pi / 2, 1.5 * np.pi, 10 << depth)], axis=1
        )
        pilots = chart((pilots @ turn.T).astype(np.float32))
        cells = Cells(np.concatenate([pilots, uniform]), depth)

        def density(
            w: NDArray[np.float32], light: _core.Light = light, turn: NDArray[np.float64] = turn
        ) -> NDArray[np.float32]:
            return light.pdf_Li(rows(reference, len(w)), (w @ turn).astype(np.float32))

        integrals = cells.integrate(
            density, 0.2 / np.sqrt(samples) / len(cells), 6 if samples < 1e5 else 9, 3, pilots
        )
        observed = cells.count(points)
        total, share = integrals.sum(), len(wi) / samples
        if total == 0:
            assert share == 0
            continue
        found = chi_square(observed, integrals / total * len(wi))
        lost = abs(total - share) / np.sqrt(
            max(share * (1 - share), 1 / samples) / samples + (1e-3 * share) ** 2
        )
        picture = (
            ""
            if found.p > sidak(FAMILY)
            else cells.picture(observed, samples * integrals, folder / f"{name}-{which}.png")
        )
        assert found.p > sidak(FAMILY), (
            f"light {index}: {found}; expected, observed and difference: {picture}"
        )
        # What is lost is what other things and the light itself hide, cut-outs, and faces that are turned
        # away.
        assert lost < norm.isf(sidak(FAMILY) / 2), (
            f"light {index}: pdf_Li integrates to {total:.5f}, {share:.5f} of samples are seen"
        )


@pytest.mark.parametrize("which", range(len(REFERENCES)))
@pytest.mark.parametrize("name", SCENES)
def test_samples_have_the_density(name: str, which: int, tmp_path: Path) -> None:
    check(name, which, 20_000, 6, tmp_path)


@pytest.mark.slow
@pytest.mark.parametrize("which", range(len(REFERENCES)))
@pytest.mark.parametrize("name", SCENES)
def test_a_million_samples_have_the_density(name: str, which: int, tmp_path: Path) -> None:
    check(name, which, 1_000_000, 7, tmp_path)


def test_every_kind_is_covered() -> None:
    assert {light.kind for scene in SCENES.values() for light in scene().lights} == registered_kinds()


@pytest.mark.parametrize("name", SCENES)
def test_samples_agree_with_rays(name: str) -> None:
    """A sample that is seen has the radiance and the density that a ray in its direction finds."""
    scene = SCENES[name]()
    for which, reference in enumerate(REFERENCES):
        for light in scene.lights:
            rng = np.random.default_rng([which, zlib.crc32(name.encode())])
            sample = light.sample_Li(rows(reference, 5000), rng.random((5000, 2), dtype=np.float32))
            assert all(np.isfinite(values).all() for values in sample.values())
            assert (sample["pdf"] >= 0).all()
            assert (sample["radiance"] >= 0).all()
            visible = seen(scene, light, reference, sample)
            wi, pdf, radiance = (sample[key][visible] for key in ("wi", "pdf", "radiance"))
            np.testing.assert_allclose(np.linalg.norm(wi.astype(float), axis=1), 1, atol=1e-6)
            # A ray that rounding sends past the edge of a triangle, a hole or a pixel finds something else.
            same = np.isclose(light.pdf_Li(rows(reference, len(wi)), wi), pdf, rtol=2e-3)
            bright = np.isclose(light.Le(rows(reference, len(wi)), wi), radiance, rtol=1e-2, atol=1e-2).all(
                axis=1
            )
            assert (~same).sum() <= 3 + 0.001 * len(same)
            assert (~bright).sum() <= 3 + 0.001 * len(bright)


@pytest.mark.parametrize("name", SCENES)
def test_irradiance_by_light_and_by_direction(name: str) -> None:
    """
    The light that arrives on a plane facing up, or a sky's on the whole sphere, is the same by light
    sampling and by rays in uniform directions, which know nothing of the light: Welch's test at each point,
    of each channel.
    """
    scene = SCENES[name]()
    for which, reference in enumerate(REFERENCES[:4]):
        rng = np.random.default_rng([9, which, zlib.crc32(name.encode())])
        for light in scene.lights:
            sample = light.sample_Li(rows(reference, 60_000), rng.random((60_000, 2), dtype=np.float32))
            visible = seen(scene, light, reference, sample)
            if not visible.any():
                continue
            cosine = np.maximum(sample["wi"][:, 1], 0)
            by_light = (
                np.where(visible, cosine / np.where(visible, sample["pdf"], 1), 0)[:, None]
                * sample["radiance"]
            )
            # Uniform in the box of the chart around what is seen, as small lights would hardly be met by
            # chance otherwise.
            turn = facing(sample["wi"][visible])
            points = chart((sample["wi"][visible] @ turn.T).astype(np.float32))
            low, high = points.min(axis=0), points.max(axis=0)
            low, high = (
                np.maximum(low - 0.05 * (high - low), [-1, -np.pi / 2]),
                np.minimum(high + 0.05 * (high - low), [1, 1.5 * np.pi]),
            )
            s, g = rng.uniform(low, high, (60_000, 2)).T
            r = np.sqrt(1 - s * s)
            wi = (np.stack([r * np.sin(g), s, r * np.cos(g)], axis=1) @ turn).astype(np.float32)
            by_chance = (
                light.Le(rows(reference, len(wi)), wi) * np.maximum(wi[:, 1:2], 0) * np.prod(high - low)
            )
            for channel in range(3):
                assert welch(by_light[:, channel], by_chance[:, channel]) > sidak(12 * len(SCENES)), (
                    f"point {which}"
                )


@pytest.mark.parametrize("name", ["triangle", "quad", "textured", "unequal_triangles", "small_and_far"])
def test_backs_are_dark(name: str) -> None:
    scene = SCENES[name]()
    light, behind = scene.lights[0], np.array([0.3, 60, 0.1], dtype=np.float32)
    u = np.random.default_rng(1).random((5000, 2), dtype=np.float32)
    assert not light.sample_Li(rows(behind, len(u)), u)["pdf"].any()
    # The same points, drawn from the front, looked at from behind.
    points = light.sample_Li(rows(REFERENCES[0], len(u)), u)["position"]
    wi = points - behind
    wi = (wi / np.linalg.norm(wi, axis=1, keepdims=True)).astype(np.float32)
    assert np.isfinite(scene.intersect(rows(behind, len(u)), wi)["distance"]).all()
    assert not light.pdf_Li(rows(behind, len(u)), wi).any()
    assert not light.Le(rows(behind, len(u)), wi).any()


@pytest.mark.parametrize("name", SCENES)
def test_edges(name: str) -> None:
    """Numbers at the ends of their range, and points on the light itself."""
    scene = SCENES[name]()
    last = np.float32(1) - np.float32(2) ** -24
    ends = np.array([0, 1e-30, 2.0**-32, 0.5, last], dtype=np.float32)
    u = np.stack([grid.ravel() for grid in np.meshgrid(ends, ends)], axis=1)
    for light in scene.lights:
        on_it = light.sample_Li(rows(REFERENCES[0], 1), u[12:13])["position"][0]
        for reference in (*REFERENCES, on_it):
            sample = light.sample_Li(rows(reference, len(u)), u)
            assert all(np.isfinite(values).all() for values in sample.values())
            assert (sample["pdf"] >= 0).all()
            assert (sample["radiance"] >= 0).all()
