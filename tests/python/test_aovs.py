"""AOVs of scenes: arrays, layers of EXR files, what films keep, and `etendue render --aov`."""

from __future__ import annotations

import json
import shlex
from collections.abc import Callable
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import OpenImageIO as oiio
import pytest

import etendue
from etendue import EtendueError, Film, Scene, cli
from etendue.cli import memory
from etendue.film.aovs import AOVS

CONTRIBUTIONS = ("direct", "indirect", "bsdf_sampling", "light_sampling")


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
    return etendue.load("lit.json")


def layers(path: str) -> tuple[Any, dict[str, np.ndarray]]:
    source = oiio.ImageInput.open(path)
    spec = source.spec()
    pixels = source.read_image(0, 0, 0, spec.nchannels, oiio.FLOAT)
    return spec, {name: pixels[..., i] for i, name in enumerate(spec.channelnames)}


def refusal(action: Callable[[], Any]) -> str:
    with pytest.raises(EtendueError) as caught:
        action()
    return str(caught.value)


def test_all_of_them_and_the_same_picture(scene: Scene) -> None:
    film = scene.render(aovs=list(AOVS))
    assert list(film.aovs) == list(AOVS)
    np.testing.assert_array_equal(film.image, scene.render().image)
    for name, array in film.aovs.items():
        channels = len(AOVS[name].channels)
        assert array.shape == ((6, 8) if channels == 1 else (6, 8, 3)), name
        assert array.dtype == (np.int32 if name.endswith("_id") else np.float32), name
    for parts in (("direct", "indirect"), ("bsdf_sampling", "light_sampling")):
        total = film.aovs[parts[0]] + film.aovs[parts[1]]
        np.testing.assert_allclose(total, film.image, rtol=2e-6, atol=1e-7)
    assert film.aovs["light_sampling"].max() > 0
    assert film.aovs["indirect"].max() == 0, "there is but a floor"
    assert (film.aovs["sample_count"] == 4).all()
    np.testing.assert_allclose(film.aovs["variance"], film.variance / 4, rtol=1e-6)


def test_what_the_scene_is_like(scene: Scene) -> None:
    film = scene.render(aovs=["albedo", "normal", "position", "object_id", "material_id"])
    floor = film.aovs["object_id"] == 0
    assert floor.any()
    assert not floor.all()
    inside = floor & (film.aovs["normal"][..., 1] > 0.999)
    np.testing.assert_allclose(
        film.aovs["albedo"][inside],
        np.broadcast_to(np.float32([0.5, 0.25, 0.1]), (inside.sum(), 3)),
        rtol=1e-5,
    )
    np.testing.assert_allclose(film.aovs["position"][inside][:, 1], 0, atol=1e-6)
    names = json.loads(film.attributes["materials"])
    assert names == ["floor", "light"]
    assert film.attributes["objects"] == film.attributes["materials"], "an OBJ file has a mesh a material"
    assert film.attributes["aov_samples"] == 4


def test_materials_of_one_name_are_one(lit_scene: Callable[..., None]) -> None:
    wall = "mtllib lit.mtl\nv -9 -9 -3\nv 9 -9 -3\nv 0 9 -3\nusemtl floor\nf 1 2 3\n"
    Path("wall.obj").write_text(wall)
    lit_scene(scene={"mesh_files": ["lit.obj", "wall.obj"]})
    film = etendue.load("lit.json").render(aovs=["object_id", "material_id"])
    assert json.loads(film.attributes["objects"]) == ["floor", "light", "floor"]
    assert json.loads(film.attributes["materials"]) == ["floor", "light"]
    ids = film.aovs["object_id"]
    assert set(ids.flat) >= {0, 2}
    np.testing.assert_array_equal(film.aovs["material_id"], np.array([0, 1, 0, -1])[ids])


def test_of_long_renders_the_first_samples_do(scene: Scene) -> None:
    short = scene.render(samples=(7, 7 + 64), aovs=["depth", "normal"])
    long = scene.render(samples=(7, 7 + 80), aovs=["depth", "normal"])
    assert long.attributes["aov_samples"] == 64
    np.testing.assert_array_equal(short.aovs["depth"], long.aovs["depth"])
    assert (short.aovs["normal"] != scene.render(spp=64, aovs=["normal"]).aovs["normal"]).any()


def test_of_a_film_that_was_read(scene: Scene) -> None:
    film = scene.render(size=(10, 4), seed=3, algorithm="NaivePathtracer", aovs=["depth", "direct"])
    film.write("a.film.exr")
    again = scene.with_aovs(etendue.read_film("a.film.exr"), ["direct", "depth"])
    assert list(again.aovs) == ["direct", "depth"]
    for name, array in film.aovs.items():
        np.testing.assert_array_equal(array, again.aovs[name])
    other = etendue.load({**json.loads(Path("lit.json").read_text()), "camera": {"fov": 20}})
    assert refusal(lambda: other.with_aovs(film, ["depth"])).startswith(
        "the film is of another scene:\n  camera."
    )


def test_contributions_survive_resume_and_merge(scene: Scene) -> None:
    whole = scene.render(spp=8, aovs=CONTRIBUTIONS)
    start = scene.render(spp=3, aovs=["direct"])
    start.write("start.film.exr")
    film = scene.render(resume=etendue.read_film("start.film.exr"), spp=8, aovs=CONTRIBUTIONS)
    parts = [scene.render(samples=(first, first + 4), aovs=["indirect"]) for first in (4, 0)]
    merged = scene.with_aovs(etendue.merge(parts), CONTRIBUTIONS)
    for name in CONTRIBUTIONS:
        np.testing.assert_allclose(film.aovs[name], whole.aovs[name], rtol=1e-6)
        np.testing.assert_allclose(merged.aovs[name], whole.aovs[name], rtol=1e-6)
    # Once begun, they are kept, whether they are asked for or not.
    assert scene.render(resume=start, spp=4).contributions is not None


def test_contributions_cannot_be_had_afterwards(scene: Scene) -> None:
    film = scene.render(spp=3)
    expected = (
        "the film was rendered without keeping contributions apart (direct, indirect, bsdf_sampling, "
        "light_sampling); to have them, ask for them from its first sample on"
    )
    assert refusal(lambda: scene.render(resume=film, spp=4, aovs=["direct"])) == expected
    assert refusal(lambda: scene.with_aovs(film, ["indirect"])) == expected
    mixed = etendue.merge([film, scene.render(samples=(3, 5), aovs=["direct"])])
    assert mixed.contributions is None
    assert mixed.aovs == {}
    assert refusal(lambda: scene.render(algorithm="SimpleRenderer", aovs=["direct"])) == (
        "SimpleRenderer: follows no light, so there are no contributions to keep apart"
    )


def test_unknown_names(scene: Scene) -> None:
    message = refusal(lambda: scene.render(aovs=["albdo", "depth", "nothing"]))
    first, second = message.split("\n")
    assert first.startswith('there is no AOV "albdo" (did you mean "albedo"? allowed: albedo, normal, ')
    assert second.startswith('there is no AOV "nothing" (allowed: albedo, ')


def test_layers_as_other_programs_read_them(scene: Scene) -> None:
    film = scene.render(aovs=list(AOVS))
    film.save("a.exr")
    spec, values = layers("a.exr")
    assert spec.channelnames[:3] == ("R", "G", "B")
    for i, colour in enumerate("RGB"):
        np.testing.assert_array_equal(values[colour], film.image[..., i])
    for name, aov in AOVS.items():
        array = np.atleast_3d(film.aovs[name])
        for i, channel in enumerate(aov.channels):
            np.testing.assert_array_equal(values[f"{name}.{channel}"], array[..., i], err_msg=name)
    assert len(values) == 3 + sum(len(aov.channels) for aov in AOVS.values())
    assert spec.getattribute("etendue:aov_samples") == 4
    film.save("a.png")
    assert oiio.ImageInput.open("a.png").spec().nchannels == 3


def test_ctrl_c_leaves_out_what_needs_a_pass(scene: Scene) -> None:
    def interrupt(_: float, spp: float) -> None:
        if spp >= 1:
            raise KeyboardInterrupt

    film = scene.render(spp=10**6, progress=interrupt, aovs=["albedo", "direct", "sample_count"])
    assert film.interrupted
    assert list(film.aovs) == ["direct", "sample_count"]


def test_the_command_writes_layers(scene: Scene, run: Callable[[str], Run]) -> None:
    done = run("render lit.json --aov albedo,normal --aov depth -q")
    assert (done.code, done.err) == (0, "")
    film = scene.render(aovs=["albedo", "normal", "depth"])
    _, values = layers("lit.exr")
    assert not Path("lit.png").exists()
    for name, array in film.aovs.items():
        for i, channel in enumerate(AOVS[name].channels):
            np.testing.assert_array_equal(values[f"{name}.{channel}"], np.atleast_3d(array)[..., i])


def test_the_command_adds_layers_to_a_finished_film(run: Callable[[str], Run]) -> None:
    assert run("render lit.json --film a.film.exr -q").code == 0
    assert run("render --resume a.film.exr --aov position -o b.exr -q").code == 0
    assert "position.X" in layers("b.exr")[1]
    refused = run("render --resume a.film.exr --aov direct -o c.exr -q")
    assert refused.code == 2
    assert "without keeping contributions apart" in refused.err
    assert not Path("c.exr").exists()


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ("--aov norml -o a.exr", 'there is no AOV "norml" (did you mean "normal"? allowed: '),
        ("--aov normal -o a.png", "--aov: only EXR images have layers; -o NAME.exr names one\n"),
        ("--aov direct --algorithm SimpleRenderer", "SimpleRenderer: follows no light, "),
    ],
)
def test_the_command_refuses(run: Callable[[str], Run], options: str, message: str) -> None:
    before = sorted(Path().iterdir())
    done = run(f"render lit.json -q {options}")
    assert done.code == 2
    assert done.err.startswith(message)
    assert sorted(Path().iterdir()) == before


def test_memory_for_layers_is_asked_for_before_rendering(
    run: Callable[[str], Run], monkeypatch: pytest.MonkeyPatch
) -> None:
    pixels = 8 * 6
    enough = memory.of_image(etendue.read_config("lit.json").framebuffer)
    monkeypatch.setattr(memory, "of_machine", lambda: enough + 100 * pixels)
    assert run("render lit.json -o a.exr --aov sample_count -q").code == 0
    for aov in ("depth", "direct"):
        done = run(f"render lit.json -o b.exr --aov {aov} -q")
        assert done.code == 2
        assert "needs" in done.err
    assert not Path("b.exr").exists()


def test_an_interrupted_command_tells_what_is_missing(
    run: Callable[[str], Run], monkeypatch: pytest.MonkeyPatch
) -> None:
    def interrupted(*_: Any) -> Film:
        raise KeyboardInterrupt

    monkeypatch.setattr(Scene, "with_aovs", interrupted)
    done = run("render lit.json --aov albedo,normal -o a.exr")
    assert done.code == 130
    assert "interrupted before the layers albedo, normal\n" in done.err
    assert layers("a.exr")[0].nchannels == 3
