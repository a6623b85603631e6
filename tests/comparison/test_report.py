"""The report: complete, self-contained, small, and with every name escaped."""

from __future__ import annotations

import base64
import dataclasses
import json
import re
import shlex
import time
import zlib
from html.parser import HTMLParser
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

import etendue
from etendue import cli
from etendue.comparison import Comparison, bias, crops, packing, report, results, techniques
from etendue.comparison.tally import Invalid

HOSTILE = "<script>alert(1)</script>\"'&lt;{{7*7}} $\\frac{ ünïcødé 雪 </script>"
FEW = dict(spp=2, repeats=2, reference_spp=16)


class Page(HTMLParser):
    """What a browser makes of a page."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.tags: list[tuple[str, dict[str, str | None]]] = []
        self.texts: list[str] = []
        self.scripts: list[str] = []
        self._inside: list[str] = []
        self.feed(text)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.append((tag, dict(attrs)))
        if tag in ("script", "style"):
            self._inside.append(tag)

    def handle_endtag(self, tag: str) -> None:
        if self._inside and self._inside[-1] == tag:
            self._inside.pop()

    def handle_data(self, data: str) -> None:
        (self.scripts if self._inside else self.texts).append(data)

    @property
    def text(self) -> str:
        return " ".join(" ".join(self.texts).split())


@pytest.fixture
def comparison(lit: Path) -> Comparison:
    return etendue.compare(lit, ["naive", "mis"], **FEW)


def unpacked(image: dict[str, Any], shape: tuple[int, int]) -> NDArray[np.float64]:
    """As the page's script does it."""
    data = np.frombuffer(zlib.decompress(base64.b64decode(image["data"])), np.uint8).astype(np.uint16)
    low, high = data.reshape(2, -1)
    bits = (low | high << 8).reshape(image["channels"], *shape)
    if image["channels"] == 3:
        bits[0] += bits[1]
        bits[2] += bits[1]
    return (
        np.moveaxis((bits << image["dropped"]).astype(np.uint16).view(np.float16).astype(float), 0, 2)
        * image["scale"]
    )


class TestPacking:
    @pytest.mark.parametrize("factor", [1e-6, 1, 1e6])
    def test_values_come_back(self, factor: float) -> None:
        image = np.random.default_rng(0).lognormal(0, 2, (20, 30, 3)) * factor
        back = unpacked(packing.packed(image), (20, 30))
        np.testing.assert_allclose(back, image, rtol=1 / 400)

    def test_fewer_bits(self) -> None:
        image = np.random.default_rng(0).lognormal(0, 2, (20, 30))
        few = packing.packed(image, bits=4)
        np.testing.assert_allclose(unpacked(few, (20, 30))[..., 0], image, rtol=0.033)
        assert len(few["data"]) < len(packing.packed(image)["data"])

    def test_extremes(self) -> None:
        image = np.zeros((2, 2, 3), np.float32)
        assert not unpacked(packing.packed(image), (2, 2)).any()
        image[0, 0] = 3e38, 1e30, 1e-30
        back = unpacked(packing.packed(image), (2, 2))
        assert back[0, 0] == pytest.approx([3e38, 1e30, 0], rel=1 / 400)
        counts = np.array([[7, 0], [255, 100]])
        np.testing.assert_array_equal(unpacked(packing.packed(counts), (2, 2))[..., 0], counts)


class TestCrops:
    def test_they_are_where_estimators_differ(self) -> None:
        reference = np.ones((64, 128, 3))
        noisy = reference.copy()
        noisy[40:48, 100:108] = 1.5
        found = crops.chosen([reference, noisy], reference)
        first = found[0]
        assert first.size == 16
        assert first.x <= 100
        assert first.x + first.size >= 108
        assert first.y <= 40
        assert first.y + first.size >= 48
        assert all(abs(other.x - first.x) >= 16 or abs(other.y - first.y) >= 16 for other in found[1:])

    def test_they_do_not_overlap(self) -> None:
        random = np.random.default_rng(0)
        found = crops.chosen([random.random((64, 64, 3))], np.ones((64, 64, 3)))
        assert len(found) == 4
        for index, a in enumerate(found):
            for b in found[:index]:
                assert abs(a.x - b.x) >= a.size or abs(a.y - b.y) >= a.size

    def test_images_smaller_than_a_crop(self) -> None:
        assert crops.chosen([np.zeros((3, 5, 3))], np.ones((3, 5, 3))) == [(0, 0, 3)]
        assert crops.chosen([np.ones((3, 5, 3))], np.ones((3, 5, 3))) == []


def test_the_pyramid_adds_up_to_the_image(comparison: Comparison) -> None:
    scene = comparison.plan.scenes[1]
    rows = techniques.measured(scene, lambda _: None)
    assert [row.edges for row in rows] == ["1", "2", "3", "4", "5", "6", "7 to 10"]
    image = scene.render(spp=64).image @ np.array([0.2126, 0.7152, 0.0722])
    assert sum(row.mean[0].sum() for row in rows) == pytest.approx(image.mean(), rel=1e-4)
    # The lamp itself is found by chance alone; its light on the floor by both.
    assert rows[0].mean[0, 1] == 0
    assert rows[1].mean[1, 1] == pytest.approx(rows[1].mean[0].sum(), rel=0.1)
    assert rows[1].gain <= rows[6].gain


class TestPage:
    def test_it_has_every_section(self, comparison: Comparison) -> None:
        page = Page(comparison.html)
        ids = [attributes.get("id") for tag, attributes in page.tags if tag == "section"]
        assert ids == [
            *("run", "table", "images", "curves", "bias", "crops", "techniques", "reference", "invalid")
        ]
        for words in (
            "mean (I − R)² / (R² + 0.01)",
            "independent samples",
            "etendue.compare(...)",
            "image mean over the reference's",
            "light sampling, weighted",
            "None: every sample of every repeat was a finite radiance.",
        ):
            assert words in page.text
        assert "nan" not in page.text.lower().split()

    def test_it_loads_nothing(self, comparison: Comparison) -> None:
        page = Page(comparison.html)
        for tag, attributes in page.tags:
            for name in ("src", "href"):
                target = attributes.get(name)
                assert target is None or target.startswith(("#", "data:")), (tag, target)
        policy = next(
            attributes["content"]
            for tag, attributes in page.tags
            if tag == "meta" and "http-equiv" in attributes
        )
        assert policy is not None
        assert policy.startswith("default-src 'none'")

    def test_names_are_escaped(self, lit: Path) -> None:
        hostile = lit.parent / "<img src=x onerror=alert(1)>\"'&.json"
        hostile.write_text(lit.read_text())
        clean = etendue.compare(lit, {"a": {"rr_threshold": 0}, "b": {}}, **FEW)
        found = etendue.compare(hostile, {HOSTILE: {"rr_threshold": 0}, "b": {}}, **FEW, command=HOSTILE)
        page, plain = Page(found.html), Page(clean.html)
        # How many ticks a curve over time has depends on the time.
        drawing = {"circle", "clippath", "defs", "g", "line", "path", "rect", "text", "tspan", "use"}
        outlines = [[tag for tag, _ in each.tags if tag not in drawing] for each in (page, plain)]
        assert outlines[0] == outlines[1]
        assert " ".join(HOSTILE.split()) in page.text
        assert hostile.name in page.text
        assert len(page.scripts) == len(plain.scripts)
        data = next(s for s in page.scripts if s.startswith("{"))
        assert "<" not in data
        assert json.loads(data)["estimators"][0]["name"] == HOSTILE

    def test_numbers_of_the_page_are_those_of_the_results(self, comparison: Comparison) -> None:
        text = Page(comparison.html).text
        for estimator in comparison.results["estimators"]:
            for name in ("relMSE", "FLIP", "efficiency"):
                assert report.shortly(estimator["table"][name]["value"]) in text

    def test_the_viewer_gets_the_images(self, comparison: Comparison) -> None:
        data = json.loads(next(s for s in Page(comparison.html).scripts if s.startswith("{")))
        assert (data["width"], data["height"]) == (16, 12)
        for given, tally in zip(data["estimators"], comparison.tallies, strict=True):
            np.testing.assert_allclose(unpacked(given["image"], (12, 16)), tally.film.image, rtol=1 / 400)
            assert (unpacked(given["samples"], (12, 16)) == 2).all()

    def test_jupyter_shows_it_in_a_frame(self, comparison: Comparison) -> None:
        (tag, attributes), *others = Page(comparison._repr_html_()).tags
        assert tag == "iframe"
        assert attributes["srcdoc"] == comparison.html
        assert not others

    def test_it_is_written_with_the_results(self, lit: Path) -> None:
        comparison = etendue.compare(lit, ["mis"], output="out", **FEW)
        assert Path("out/index.html").read_text() == comparison.html
        comparison.write("elsewhere")
        assert json.loads(Path("elsewhere/results.json").read_text()) == comparison.results

    def test_one_estimator_and_one_repeat(self, lit: Path) -> None:
        page = Page(etendue.compare(lit, ["mis"], spp=1, repeats=1, reference_spp=4).html)
        assert "The estimators do not differ in any setting." in page.text
        assert "A verdict needs two repeats." in page.text

    def test_a_given_reference_is_told(self, lit: Path) -> None:
        etendue.load(lit).render(spp=16).save("r.exr")
        found = etendue.compare(lit, ["mis"], spp=1, repeats=2, reference="r.exr")
        assert "its own error is not known" in Page(found.html).text

    def test_black_scenes(self, lit: Path) -> None:
        dark = {"scene.materials[light].emissive_strength": 1e-30}
        found = etendue.compare(lit, {"dark": dark}, **FEW)
        assert "dark" in Page(found.html).text


def test_invalid_samples_come_with_a_command_that_works(
    comparison: Comparison, capsys: pytest.CaptureFixture[str]
) -> None:
    comparison.tallies[0].invalid = [Invalid(3, 4, 1, 1)]
    comparison.tallies[0].invalid_count = 5
    page = Page(comparison.html)
    assert "naive: 5" in page.text
    command = next(text for text in page.texts if " replay " in text)
    assert re.search(r"replay \S*lit.json --pixel 3,4 --sample 1 --seed 1 --set 'algorithm=", command)
    with pytest.raises(SystemExit) as ended:
        cli.main(shlex.split(command)[1:] if "-m etendue" not in command else shlex.split(command)[3:])
    assert not ended.value.code
    assert "pixel 3,4, sample 1, NaivePathtracer" in capsys.readouterr().out


def test_replayed_samples_are_those_of_the_command_line(lit: Path) -> None:
    """Options that change the picture are in the command."""
    changed = etendue.read_config(lit, ["max_cam_path_length=3"])
    found = etendue.compare(changed, ["mis"], size=(8, 8), **FEW)
    command = report.replay(found.plan, found.tallies[0], Invalid(0, 0, 0, 0))
    assert "framebuffer.res_w=8" in command


@pytest.mark.slow
def test_a_large_report_is_small_and_quick(lit: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Three estimators at 1024 x 1024, all noise: below 30 MB, within 10 seconds of one processor."""
    size = 1024
    found = etendue.compare(
        lit, ["naive", "nee", "mis"], spp=1, repeats=2, reference_spp=2, size=(size, size)
    )
    random = np.random.default_rng(0)
    colour = random.lognormal(-1, 1, (16, 16, 3)).repeat(size // 16, 0).repeat(size // 16, 1)

    def noisy() -> NDArray[np.float32]:
        grain = random.gamma(1, 1, (size, size, 1)) * random.gamma(30, 1 / 30, (size, size, 3))
        return np.asarray(colour * grain, np.float32)

    for tally in found.tallies:
        assert tally.first is not None
        tally.film.image[:] = noisy()
        tally.sum_squares[:] += noisy() ** 2
        tally.first = tally.first._replace(flip=random.random((size, size), np.float32))
    monkeypatch.setattr(found, "reference", dataclasses.replace(found.reference, image=noisy()))
    start = time.process_time()
    verdicts = [bias.judge(tally, found.reference) for tally in found.tallies]
    results.of(found.plan, found.reference, found.tallies, verdicts, "")
    page = found.html
    assert time.process_time() - start < 10
    assert 15e6 < len(page.encode()) < 30e6


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (0.0123456, "0.0123"),
        (123.4, "123"),
        (1234.5, "1234"),
        (12345.0, "12.3 k"),
        (1.5e6, "1.5 M"),
        (2e9, "2 G"),
        (None, "–"),
        (float("nan"), "–"),
        (0.0, "0"),
    ],
)
def test_numbers_for_people(value: float | None, text: str) -> None:
    assert report.shortly(value) == text
