"""View transforms, false colours and `etendue tonemap`."""

from __future__ import annotations

import shlex
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import OpenImageIO as oiio
import pytest
from hypothesis import given
from hypothesis import strategies as st

import etendue
from etendue import EtendueError, cli
from etendue.display import false_colour, linear_to_srgb, srgb_to_linear, tonemap
from etendue.display.views import VIEWS, _agx_curve, _agx_inset

GREY = np.array([0.18, 0.18, 0.18], np.float32)


def shown(view: str, *colour: float) -> np.ndarray:
    values = colour * 3 if len(colour) == 1 else colour
    return np.asarray(VIEWS[view](np.array([[values]], np.float32))[0, 0], np.float64)


@pytest.mark.parametrize("view", VIEWS)
def test_every_view_is_monotonic_neutral_and_reaches_both_ends(view: str) -> None:
    grey = np.concatenate([[0], np.geomspace(1e-5, 1e5, 300)]).astype(np.float32)
    seen = VIEWS[view](np.repeat(grey[:, None], 3, axis=1))
    assert seen.dtype == np.float32
    # Half a step of 8 bits: an inverse of a matrix and the tables of OpenColorIO are not exact.
    assert np.ptp(seen, axis=1).max() < 0.002
    assert np.diff(seen[:, 1]).min() > -1e-4
    assert seen[0].max() < 0.01
    assert seen[-1].min() > 0.97


@pytest.mark.parametrize("view", VIEWS)
def test_every_view_keeps_shapes_and_survives_any_number(view: str) -> None:
    values = np.array([0, -1, 1e-40, 1, 3e38, np.inf, -np.inf, np.nan, 0.5], np.float32)
    image = np.stack(np.meshgrid(values, values, values, indexing="ij"), axis=-1).reshape(27, 27, 3)
    seen = tonemap(image, 3e38, view)
    assert (seen.dtype, seen.shape) == (np.uint8, (27, 27, 3))
    assert (tonemap(np.full((1, 1, 3), np.nan), 1, view) < 3).all()
    assert (tonemap(np.full((1, 1, 3), np.inf), 1, view) > 247).all()


def test_srgb_is_clipped() -> None:
    np.testing.assert_allclose(shown("srgb", 0.18), linear_to_srgb(GREY), rtol=1e-6)
    np.testing.assert_array_equal(tonemap(np.float32([[0.5, 1, 7]]), 2), [[255, 255, 255]])


@given(st.floats(0, 100), st.floats(0, 100), st.floats(0, 100))
def test_reinhard_keeps_the_colour(red: float, green: float, blue: float) -> None:
    luminance = 0.2126 * red + 0.7152 * green + 0.0722 * blue
    expected = linear_to_srgb(np.minimum(np.array([red, green, blue]) / (1 + luminance), 1))
    np.testing.assert_allclose(shown("reinhard", red, green, blue), expected, atol=1e-5)


def test_hable_is_white_at_its_white_point() -> None:
    assert shown("hable", 11.2 / 2) == pytest.approx(1, abs=1e-4)

    def curve(x: float) -> float:
        return (x * (0.15 * x + 0.05) + 0.004) / (x * (0.15 * x + 0.5) + 0.06) - 0.02 / 0.3

    assert shown("hable", 0.5) == pytest.approx(
        float(linear_to_srgb(np.array(curve(1) / curve(11.2)))), rel=1e-4
    )


def test_agx_has_the_curve_of_its_parameters() -> None:
    middle = 10 / 16.5
    step = 1e-6
    curve = _agx_curve(np.array([0, middle - step, middle, middle + step, 1]))
    np.testing.assert_allclose(curve[[0, 2, 4]], [0, 0.5, 1], atol=1e-9)
    np.testing.assert_allclose(np.diff(curve[1:4]) / step, 2, rtol=1e-3)
    # Middle grey becomes half of a screen of gamma 2.2.
    assert srgb_to_linear(shown("agx", 0.18)) == pytest.approx(0.5**2.2, rel=1e-3)
    np.testing.assert_allclose(_agx_inset() @ np.ones(3), 1, rtol=1e-6)
    # A bright pure colour loses it; clipped, it would not.
    assert shown("agx", 50, 0, 0).min() > 0.5
    assert shown("srgb", 50, 0, 0).min() == 0


def test_aces_is_that_of_opencolorio_whatever_the_environment_says(monkeypatch: pytest.MonkeyPatch) -> None:
    grey = shown("aces", 0.18)
    # ACES puts middle grey at a tenth of a screen's white.
    np.testing.assert_allclose(srgb_to_linear(grey), 0.1, atol=0.02)
    monkeypatch.setenv("OCIO", "nowhere.ocio")
    np.testing.assert_array_equal(shown("aces", 0.18), grey)


def test_an_unknown_view() -> None:
    with pytest.raises(EtendueError) as caught:
        tonemap(GREY, 1, "acse")
    assert str(caught.value) == (
        'there is no view "acse" (did you mean "aces"? allowed: srgb, reinhard, hable, aces, agx)'
    )


@pytest.fixture
def run(
    lit_scene: Callable[..., None], capsys: pytest.CaptureFixture[str]
) -> Callable[[str], tuple[int, str]]:
    etendue.load("lit.json").render(spp=8, size=(48, 36)).write("a.film.exr")

    def run(line: str) -> tuple[int, str]:
        capsys.readouterr()
        with pytest.raises(SystemExit) as ended:
            cli.main(shlex.split(line))
        return int(ended.value.code or 0), capsys.readouterr().err

    return run


def pixels(name: str) -> Any:
    return oiio.ImageBuf(name).get_pixels(oiio.UINT8)


@pytest.mark.parametrize("view", VIEWS)
def test_tonemap_shows_the_film(run: Callable[[str], tuple[int, str]], view: str) -> None:
    film = etendue.read_film("a.film.exr")
    assert run(f"tonemap a.film.exr -o a.png --exposure 3 --view {view}") == (0, "")
    np.testing.assert_array_equal(pixels("a.png"), film.tonemapped(3, view))


def test_tonemap_takes_the_film_s_exposure_and_other_images(
    run: Callable[[str], tuple[int, str]], lit_scene: Callable[..., None]
) -> None:
    lit_scene(framebuffer={"exposure": 5.0})
    film = etendue.load("lit.json").render(spp=2)
    film.write("b.film.exr")
    film.save("b.exr")
    assert run("tonemap b.film.exr -o film.png") == (0, "")
    assert run("tonemap b.exr -o image.png --exposure 5") == (0, "")
    np.testing.assert_array_equal(pixels("film.png"), film.tonemapped())
    np.testing.assert_array_equal(pixels("image.png"), film.tonemapped())
    assert film.exposure == 5


@pytest.mark.parametrize(
    ("line", "message"),
    [
        ("a.film.exr -o a.exr", "a.exr: .exr files stay linear; allowed here: .png, .jpg, .jpeg"),
        ("none.exr -o a.png", "none.exr: cannot be read: No such file or directory"),
        ("a.film.exr -o a.png --exposure 0", "--exposure: a factor above 0 is needed, not 0"),
        ("a.film.exr -o a.png --scale 1:2", "--scale: without effect but on --false-colour"),
        ("a.film.exr -o a.png --false-colour samples --view agx", "--view: without effect on --false-colour"),
        (
            "a.film.exr -o a.png --false-colour bias",
            'there is no quantity "bias" to show (allowed: variance, relative-error, tile-error, samples)',
        ),
        (
            "a.film.exr -o a.png --false-colour samples --scale 2:1",
            '--scale: two numbers above 0, the smaller first, are needed, as in 0.01:1, not "2:1"',
        ),
    ],
)
def test_refusals(run: Callable[[str], tuple[int, str]], line: str, message: str) -> None:
    assert run(f"tonemap {line}") == (2, message + "\n")
    assert not Path("a.png").exists()


@pytest.mark.parametrize("name", false_colour.QUANTITIES)
def test_false_colours_have_a_scale(run: Callable[[str], tuple[int, str]], name: str) -> None:
    assert run(f"tonemap a.film.exr -o a.png --false-colour {name} --scale 0.01:10") == (0, "")
    image = pixels("a.png")
    assert image.shape[0] == 36
    assert image.shape[1] > 48 + 20
    # The scale runs from the lightest colour down to the darkest.
    bar = image[9:-9, 48 + 8].astype(int).sum(axis=1)
    assert bar[0] > 450 > 200 > bar[-1]


def test_quantities_are_those_of_the_noise(lit_scene: Callable[..., None]) -> None:
    scene = etendue.load("lit.json")
    film = scene.render(spp=200)
    again = np.stack([scene.render(spp=200, seed=seed).image for seed in range(1, 40)])
    measured = again.var(axis=0, ddof=1, dtype=np.float64).mean(axis=2)
    variance = false_colour.quantity(film, "variance")
    np.testing.assert_allclose(variance, film.variance.mean(axis=2) / 200, rtol=1e-5)
    # Points of low discrepancy have less variance than independent ones, on which the estimate rests.
    lit = (again.min(axis=(0, 3)) > 0) & (film.image.min(axis=2) > 0)
    assert (measured[lit] < 2 * variance[lit]).mean() > 0.9
    independent = scene.render(spp=200, sampler="independent")
    others = np.stack([scene.render(spp=200, seed=s, sampler="independent").image for s in range(1, 40)])
    measured = others.var(axis=0, ddof=1, dtype=np.float64).mean(axis=2)
    ratio = measured[lit].mean() / false_colour.quantity(independent, "variance")[lit].mean()
    assert 0.6 < ratio < 1.5
    relative = false_colour.quantity(independent, "relative-error")
    luminance = np.array([0.2126, 0.7152, 0.0722])
    spread = (others[:, lit] @ luminance).std(axis=0, ddof=1) / (others[:, lit] @ luminance).mean(axis=0)
    assert np.median(relative[lit] / spread) == pytest.approx(1, abs=0.2)
    assert np.isnan(relative[independent.image.max(axis=2) == 0]).all()
    assert (false_colour.quantity(film, "samples") == 200).all()
    assert np.isnan(false_colour.quantity(scene.render(spp=1), "variance")).all()


def test_pictures_of_nothing_and_of_one_number() -> None:
    for values in (
        np.full((50, 20), np.nan),
        np.zeros((50, 20)),
        np.full((50, 20), 7.0),
        np.full((1, 1), 7.0),
    ):
        picture = false_colour.picture(values, "samples")
        assert picture.dtype == np.uint8
        assert picture.shape[0] == values.shape[0]
    assert len(np.unique(false_colour.picture(np.full((50, 20), np.nan), "")[:, :20])) == 1
