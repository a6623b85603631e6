"""Denoising with Open Image Denoise: what it does to images, what it never sees, and the commands."""

from __future__ import annotations

import json
import shlex
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import OpenImageIO as oiio
import pytest

import etendue
from etendue import EtendueError, Scene, cli
from etendue.denoise import denoise, denoise_film, name

HEIGHT, WIDTH = 96, 128


class Run(NamedTuple):
    code: int
    out: str
    err: str


@pytest.fixture
def run(capsys: pytest.CaptureFixture[str]) -> Callable[[str], Run]:
    def run(line: str) -> Run:
        with pytest.raises(SystemExit) as ended:
            cli.main(shlex.split(line))
        captured = capsys.readouterr()
        return Run(int(ended.value.code or 0), captured.out, captured.err)

    return run


@pytest.fixture(autouse=True)
def scene(lit_scene: Callable[..., None]) -> Scene:
    lit_scene(framebuffer={"res_w": 48, "res_h": 32, "sppx": 2})
    return etendue.load("lit.json")


@pytest.fixture
def without_library(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "mitsuba_oidn", None)


def noisy(clean: np.ndarray, seed: int = 0) -> np.ndarray:
    """With the noise of a few samples: each pixel times a random number of mean 1."""
    random = np.random.default_rng(seed)
    return (clean * random.gamma(4, 1 / 4, (*clean.shape[:2], 1))).astype(np.float32)


def ramp() -> np.ndarray:
    """Radiance that rises from 0.1 to 3 across the image."""
    x = np.linspace(0.1, 3, WIDTH, dtype=np.float32)
    return np.broadcast_to(x[None, :, None] * np.float32([1, 0.8, 0.6]), (HEIGHT, WIDTH, 3)).copy()


def rel_mse(image: np.ndarray, clean: np.ndarray) -> float:
    return float(np.mean((image - clean) ** 2 / (clean**2 + 0.01)))


def refusal(action: Callable[[], Any]) -> str:
    with pytest.raises(EtendueError) as caught:
        action()
    return str(caught.value)


def test_noise_goes_and_brightness_stays() -> None:
    clean = ramp()
    image = noisy(clean)
    result = denoise(image)
    assert result.image.dtype == np.float32
    assert not result.unknown.any()
    assert rel_mse(image, clean) > 0.2
    assert rel_mse(result.image, clean) < 0.01
    assert result.image.mean() == pytest.approx(clean.mean(), rel=0.03)


def test_radiance_beyond_a_screen_is_kept() -> None:
    clean = 1000 * ramp()
    assert rel_mse(denoise(noisy(clean)).image, clean) < 0.01


def test_guides_keep_detail() -> None:
    """A fine chequerboard of paint drowns in the noise, but not in its albedo, even if that is noisy, too."""
    y, x = np.indices((HEIGHT, WIDTH))
    albedo = np.where((x // 3 + y // 3) % 2, 0.5, 0.4)[..., None] * np.ones(3, np.float32)
    normal = np.broadcast_to(np.float32([0, 0, 1]), albedo.shape)
    image = noisy(albedo, 1)
    alone = rel_mse(denoise(image).image, albedo)
    random = np.random.default_rng(2)
    blurred = np.clip(albedo + random.normal(0, 0.02, albedo.shape), 0, 1).astype(np.float32)
    # That they are said to be clean, once they are, doubles what exact ones are worth.
    for guide, gain in ((albedo.astype(np.float32), 15), (blurred, 3)):
        assert rel_mse(denoise(image, guide, normal).image, albedo) < alone / gain


@pytest.mark.parametrize("value", [np.nan, np.inf, -np.inf, -1.0])
def test_what_is_no_radiance_is_never_shown_to_the_network(value: float) -> None:
    image = noisy(ramp())
    broken = image.copy()
    broken[10, 20, 1] = value
    filled = image.copy()
    around = np.delete(image[9:12, 19:22].reshape(9, 3), 4, axis=0)
    filled[10, 20] = around.astype(np.float64).mean(axis=0)
    result = denoise(broken)
    assert np.argwhere(result.unknown).tolist() == [[10, 20]]
    np.testing.assert_array_equal(result.image[10, 20], broken[10, 20])
    expected = denoise(filled).image
    np.testing.assert_array_equal(result.image[~result.unknown], expected[~result.unknown])


def test_pixels_without_samples_are_unknown() -> None:
    image = ramp()
    known = np.ones((HEIGHT, WIDTH), bool)
    known[40:60, 50:70] = False
    image[~known] = 0
    result = denoise(image, known=known)
    np.testing.assert_array_equal(result.unknown, ~known)
    assert (result.image[~known] == 0).all()
    assert rel_mse(result.image[known], ramp()[known]) < 0.01, "no dark rim around the hole"


def test_guides_without_numbers_are_harmless() -> None:
    image = noisy(ramp())
    guide = np.full_like(image, 0.5)
    guide[3, 4] = np.nan, np.inf, -np.inf
    assert np.isfinite(denoise(image, guide, guide).image).all()


def test_wrong_arguments() -> None:
    image = ramp()
    assert refusal(lambda: denoise(image, albedo=image[1:])) == (
        f"albedo: of the image's shape {image.shape} is needed, not {image[1:].shape}"
    )
    assert refusal(lambda: denoise(image[..., 0])) == (
        f"image: an array (height, width, 3) is needed, not {image.shape[:2]}"
    )
    assert refusal(lambda: denoise(image, normal=image)) == (
        "albedo and normal guide together: both are needed, or neither"
    )
    assert refusal(lambda: denoise(image * np.nan)) == "nothing to denoise: no pixel holds a finite radiance"


def test_progress_reaches_the_end_and_may_stop_it() -> None:
    image = ramp()
    seen: list[float] = []
    denoise(image, image / 3, image / 3, progress=seen.append)
    assert seen == sorted(seen)
    assert seen[-1] == pytest.approx(1)
    assert seen[0] < 0.3

    def stop(_: float) -> None:
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        denoise(image, progress=stop)


def test_a_denoised_film_says_so_and_cannot_be_gone_on_from(scene: Scene) -> None:
    film = scene.render(aovs=["depth"])
    image, attributes = film.image.copy(), dict(film.attributes)
    result = scene.denoise(film)
    assert (result.image != film.image).any()
    assert result.attributes["denoised"] == f"{name()}, guided by albedo and normal"
    assert result.attributes["biased"] == 1
    assert result.aovs == {}
    np.testing.assert_array_equal(film.image, image)
    assert film.attributes == attributes
    assert "no render gave" in refusal(lambda: result.write("a.film.exr"))
    assert "cannot be gone on from" in refusal(lambda: scene.render(resume=result))
    assert "does not come from a render" in refusal(lambda: etendue.merge([result]))
    assert "says nothing of its scene" in refusal(lambda: scene.denoise(result))


def test_invalid_pixels_of_a_film_are_told(scene: Scene) -> None:
    film = scene.render()
    film.invalid_per_pixel[2, 3] = film.sample_count[2, 3]
    film.image[2, 3] = 0
    warnings: list[str] = []
    result = scene.denoise(film, warnings=warnings)
    assert warnings == ["pixels without a finite radiance were not denoised: 1, the first at (3, 2)"]
    assert (result.image[2, 3] == 0).all()
    film.sample_count[:] = 0
    assert "nothing to denoise" in refusal(lambda: denoise_film(film))


def description(path: str) -> str:
    return oiio.ImageInput.open(path).spec().getattribute("ImageDescription") or ""


def test_the_command_writes_both(scene: Scene, run: Callable[[str], Run]) -> None:
    done = run("render lit.json -o a.png -o a.exr --film a.film.exr --aov albedo --denoise")
    assert done.code == 0
    assert f"{name()}, guided by albedo and normal (biased): a.denoised.png, a.denoised.exr\n" in done.err
    film = scene.render(aovs=["albedo"])
    film.save("b.exr")
    film.save("b.png")
    assert Path("a.png").read_bytes() == Path("b.png").read_bytes()
    assert description("a.png") == description("a.exr") == ""
    noisy_spec, clean_spec = (oiio.ImageInput.open(path).spec() for path in ("a.exr", "a.denoised.exr"))
    assert noisy_spec.channelnames == ("R", "G", "B", "albedo.R", "albedo.G", "albedo.B")
    assert clean_spec.channelnames == ("R", "G", "B")
    assert clean_spec.getattribute("etendue:biased") == 1
    for path in ("a.denoised.png", "a.denoised.exr"):
        assert description(path) == f"denoised by {name()}, guided by albedo and normal: biased"
    # The film is the noisy one, and gives the same denoised image.
    np.testing.assert_array_equal(etendue.read_film("a.film.exr").image, film.image)
    summary = json.loads(run("render lit.json -o d.png --denoise -q --json").out)
    assert summary["outputs"] == ["d.png", "d.denoised.png"]
    before = Path("a.film.exr").read_bytes()
    assert run("denoise a.film.exr -o c.png -q") == Run(0, "", "")
    assert Path("c.png").read_bytes() == Path("a.denoised.png").read_bytes()
    assert Path("a.film.exr").read_bytes() == before


def test_beauty_renders_are_denoised_where_there_is_a_denoiser(
    run: Callable[[str], Run], monkeypatch: pytest.MonkeyPatch
) -> None:
    beauty = "render lit.json --beauty --set error_eps=0.5 -q -o"
    assert run(f"{beauty} a.png").code == 0
    assert description("a.png") == ""
    assert "biased" in description("a.denoised.png")
    assert run(f"{beauty} b.png --no-denoise").code == 0
    monkeypatch.setattr("etendue.denoise.is_installed", lambda: False)
    assert run(f"{beauty} c.png") == Run(0, "", "")
    assert Path("c.png").exists()
    assert [path.name for path in Path().glob("*.denoised.*")] == ["a.denoised.png"]


def test_the_command_refuses(run: Callable[[str], Run]) -> None:
    assert run("render lit.json --film a.film.exr -o a.exr -q").code == 0
    before = {path: path.read_bytes() for path in Path().iterdir()}
    for line, message in {
        "denoise a.film.exr -o a.film.exr": "a.film.exr: the film is kept; the denoised image needs another name\n",
        "denoise a.exr -o b.png": "a.exr: an image, but no film; films are written with --film\n",
        "denoise none.film.exr -o b.png": "none.film.exr: cannot be read: No such file or directory\n",
        "denoise a.film.exr -o b.pgn": 'b.pgn: no image can be written as ".pgn" (did you mean ".png"? ',
        "render lit.json -o x.png -o x.denoised.png --denoise": "x.denoised.png: cannot be both ",
        "render lit.json -o x.exr --film x.denoised.exr --denoise": "x.denoised.exr: the image and the film ",
    }.items():
        done = run(line)
        assert (done.code, done.err[: len(message)]) == (2, message), line
    assert {path: path.read_bytes() for path in Path().iterdir()} == before


@pytest.mark.usefixtures("without_library")
def test_a_missing_library_is_named_before_anything_is_rendered(
    scene: Scene, run: Callable[[str], Run]
) -> None:
    film = scene.render()
    film.write("a.film.exr")
    before = sorted(Path().iterdir())
    for line in ("render lit.json --denoise", "denoise a.film.exr -o b.png"):
        done = run(line)
        assert done.code == 2
        assert done.err.count("\n") == 1
        assert done.err.startswith("denoising needs Open Image Denoise (")
        assert f'{sys.executable} -m pip install "etendue[denoise]"' in done.err
    assert "etendue[denoise]" in refusal(lambda: scene.denoise(film))
    assert sorted(Path().iterdir()) == before


def test_ctrl_c_keeps_the_noisy_image(run: Callable[[str], Run], monkeypatch: pytest.MonkeyPatch) -> None:
    def interrupted(*_: Any) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr(Scene, "denoise", interrupted)
    done = run("render lit.json --aov depth -o a.exr --denoise")
    assert done.code == 130
    assert "interrupted before the denoised image\n" in done.err
    assert not Path("a.denoised.exr").exists()
    assert oiio.ImageInput.open("a.exr").spec().channelnames == ("R", "G", "B", "depth.Z")


def test_a_failure_of_the_denoiser_loses_nothing(
    run: Callable[[str], Run], monkeypatch: pytest.MonkeyPatch
) -> None:
    def failing(*_: Any) -> None:
        raise EtendueError("Open Image Denoise failed: out of memory")

    monkeypatch.setattr(Scene, "denoise", failing)
    done = run("render lit.json --aov depth -o a.exr --film a.film.exr --denoise")
    assert done.code == 2
    assert done.err.endswith(
        "the denoised image could not be made: Open Image Denoise failed: out of memory\n"
    )
    assert oiio.ImageInput.open("a.exr").spec().channelnames == ("R", "G", "B", "depth.Z")
    assert etendue.read_film("a.film.exr").complete


def test_the_film_is_safe_before_anything_else_is_made(
    run: Callable[[str], Run], monkeypatch: pytest.MonkeyPatch
) -> None:
    def killed(*_: Any) -> None:
        raise SystemExit(9)

    monkeypatch.setattr(Scene, "with_aovs", killed)
    assert run("render lit.json --aov depth -o a.exr --film a.film.exr").code == 9
    assert etendue.read_film("a.film.exr").complete
