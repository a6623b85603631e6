"""A sample's path told and drawn: the words, the picture, and what is refused."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from pathlib import Path

import numpy as np
import pytest

import etendue
from etendue import _core, cli
from etendue.errors import EtendueError

from ..conftest import WriteScene

SVG = "{http://www.w3.org/2000/svg}"


def told(capsys: pytest.CaptureFixture[str], *arguments: str) -> tuple[int, str, str]:
    with pytest.raises(SystemExit) as exit_:
        cli.main(["replay", *arguments])
    out, err = capsys.readouterr()
    return int(exit_.value.code or 0), out, err


def test_the_command_tells_the_path(lit_scene: WriteScene, capsys: pytest.CaptureFixture[str]) -> None:
    lit_scene()
    code, out, err = told(capsys, "lit.json", "--pixel", "4,3", "--sample", "2")
    assert (code, err) == (0, "")
    first, *_ = out.splitlines()
    radiance = etendue.load("lit.json").render(samples=(2, 3)).image[3, 4]
    assert first.startswith("pixel 4,3, sample 2, Pathtracer: radiance (")
    shown = [float(number) for number in first[first.index("(") + 1 : -1].split(",")]
    np.testing.assert_allclose(shown, radiance, rtol=1e-3)
    for words in (
        'front of "floor" (layered_ggx)',
        "throughput (1, 1, 1)",
        "shadow ray to",
        "light sampled:",
        "pdf",
    ):
        assert words in out


def test_settings_are_those_of_the_render(lit_scene: WriteScene) -> None:
    lit_scene()
    scene = etendue.load("lit.json")
    settings = dict(algorithm="NaivePathtracer", seed=9, rr_threshold=1.0, rr_min_path_length=0)
    image = scene.render(samples=(7, 8), **settings).image
    path = scene.replay((3, 3), 7, **settings)
    assert list(path.radiance) == image[3, 3].tolist()
    assert any(vertex.roulette_q is not None for vertex in path.vertices)
    assert "Russian roulette, q " in str(path)


def test_the_drawing_has_every_vertex_before_the_camera(lit_scene: WriteScene) -> None:
    lit_scene()
    scene = etendue.load("lit.json")
    path = scene.replay((4, 3), 0)
    path.save("path.svg", scene)
    root = ET.parse("path.svg").getroot()
    assert root.attrib["viewBox"] == "0 0 8 6"
    marks = list(root.iter(f"{SVG}text"))
    camera = scene.camera()
    before = [v for v in path.vertices if not v.hit or camera.film_of(v.position)]
    assert [int(mark.text or 0) for mark in marks] == list(range(1, len(before) + 1))
    # The first vertex is in its pixel.
    circle = next(root.iter(f"{SVG}circle"))
    assert abs(float(circle.attrib["cx"]) - 4.5) < 2.5
    assert abs(float(circle.attrib["cy"]) - 3.5) < 2.5
    dashed = [line for line in root.iter(f"{SVG}line") if "stroke-dasharray" in line.attrib]
    assert dashed, "shadow rays are drawn"


@pytest.mark.parametrize("perspective", [True, False])
def test_film_of_is_the_inverse_of_the_camera(perspective: bool) -> None:
    camera = _core.Camera((1, 2, 3), (0.3, -0.2, -1), (0, 1, 0.1), 50, 0, 1, perspective, 40, 30)
    film = np.random.default_rng(1).uniform((0, 0), (40, 30), (50, 2)).astype(np.float32)
    origins, directions = camera.rays(film, np.zeros_like(film))
    for place, origin, direction in zip(film, origins, directions, strict=True):
        np.testing.assert_allclose(camera.film_of((origin + 7 * direction).tolist()), place, atol=1e-2)
    if perspective:
        assert camera.film_of((1 - 0.3, 2 + 0.2, 3 + 1)) is None


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["--pixel", "8,0"], "pixel 8,0: the image is 8x6, so x is 0 to 7 and y 0 to 5"),
        (["--pixel", "eight"], "'eight' is not X,Y in pixels"),
        (["--pixel", "1,1", "--sample", "-1"], "sample -1: an index from 0"),
        (["--pixel", "1,1", "-o", "path.png"], 'path.png: paths are drawn as .svg, not as ".png"'),
        (["--pixel", "1,1", "--algorithm", "Pathtracr"], 'did you mean "Pathtracer"?'),
    ],
)
def test_what_cannot_be_replayed_is_refused(
    lit_scene: WriteScene, capsys: pytest.CaptureFixture[str], arguments: list[str], message: str
) -> None:
    lit_scene()
    code, out, err = told(capsys, "lit.json", *arguments)
    assert (code, out) == (2, "")
    assert message in err


def test_names_are_escaped_in_the_drawing(lit_scene: WriteScene) -> None:
    lit_scene()
    name = "<b>&floor"
    for file in ("lit.obj", "lit.mtl"):
        Path(file).write_text(Path(file).read_text().replace(" floor", f" {name}"))
    scene = etendue.load("lit.json")
    path = scene.replay((4, 3), 0)
    path.save("path.svg", scene)
    titles = [title.text or "" for title in ET.parse("path.svg").getroot().iter(f"{SVG}title")]
    assert any(f'"{name}"' in title for title in titles)


def test_a_drawing_that_cannot_be_written_is_refused(lit_scene: WriteScene) -> None:
    lit_scene()
    scene = etendue.load("lit.json")
    with pytest.raises(EtendueError, match="nowhere"):
        scene.replay((0, 0), 0).save("nowhere/path.svg", scene)
