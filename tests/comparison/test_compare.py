"""`etendue compare` from end to end: what it renders, keeps, tells and refuses."""

from __future__ import annotations

import json
import math
from collections.abc import Iterator
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import pytest

import etendue
from etendue import EtendueError, cli
from etendue.comparison import estimators, extras, repeats
from etendue.comparison import reference as references
from etendue.comparison.goal import Goal
from etendue.comparison.work import Task, Work

FEW = dict(spp=4, repeats=3, reference_spp=64)
BOTH = {"nee": {"mis": "none"}, "naive": {"algorithm": "NaivePathtracer"}}


class Done(NamedTuple):
    """How a command ended."""

    exit_code: int
    stderr: str


def refusal(*arguments: Any, **keys: Any) -> str:
    with pytest.raises(EtendueError) as caught:
        etendue.compare(*arguments, **keys)
    return str(caught.value)


def numbers(value: Any) -> Iterator[Any]:
    if isinstance(value, dict):
        for each in value.values():
            yield from numbers(each)
    elif isinstance(value, list):
        for each in value:
            yield from numbers(each)
    else:
        yield value


class TestEstimators:
    def test_presets_and_algorithms(self) -> None:
        found = estimators.parse("naive, nee,DirectIllumination")
        assert [each.name for each in found] == ["naive", "nee", "DirectIllumination"]
        assert found[2].settings == {"algorithm": "DirectIllumination"}

    def test_a_file(self, tmp_path: Path) -> None:
        path = tmp_path / "e.json"
        path.write_text('{"a": {"mis": "none"}, "b": {"rr_threshold": 0, "scene.sky.intensity": 2}}')
        assert estimators.parse(str(path))[1] == estimators.Estimator(
            "b", {"rr_threshold": 0, "scene.sky.intensity": 2}
        )

    @pytest.mark.parametrize(
        ("text", "words"),
        [
            ("mes", ['there is no estimator "mes"', 'did you mean "mis"?', "allowed: naive"]),
            ("mis,mis", ['the name "mis" is there twice']),
            (",", ["at least one is needed"]),
            ("missing.json", ["missing.json: cannot be read"]),
        ],
    )
    def test_refusals(self, text: str, words: list[str]) -> None:
        with pytest.raises(EtendueError) as caught:
            estimators.parse(text)
        assert all(each in str(caught.value) for each in words)

    @pytest.mark.parametrize(
        ("content", "words"),
        [
            ("{", "not a JSON file"),
            ("[1]", "an object of estimators by name"),
            ('{"a": 1}', "estimator a: an object of keys"),
            ('{"": {}}', "a name of 1 to 100 characters"),
            ('{"a": {"seed": 1}}', "seed is the same for all that are compared"),
            ('{"a": {"framebuffer.sppx": 1}}', "framebuffer.sppx is the same for all"),
        ],
    )
    def test_files_that_are_refused(self, tmp_path: Path, content: str, words: str) -> None:
        path = tmp_path / "e.json"
        path.write_text(content)
        with pytest.raises(EtendueError) as caught:
            estimators.parse(str(path))
        assert str(caught.value).startswith(str(path))
        assert words in str(caught.value)


class TestResults:
    def test_numbers(self, lit: Path) -> None:
        found = etendue.compare(lit, BOTH, **FEW).results
        assert json.loads(json.dumps(found, allow_nan=False)) == found
        assert all(not isinstance(n, float) or math.isfinite(n) for n in numbers(found))
        nee, naive = found["estimators"]
        assert [nee["name"], naive["name"]] == ["nee", "naive"]
        assert nee["seeds"] == [0, 1, 2]
        table = naive["table"]
        for name, value in table.items():
            assert value["low"] <= value["value"] <= value["high"], name
        assert table["spp"]["value"] == 4
        assert table["relMSE"]["value"] > 2 * nee["table"]["relMSE"]["value"]
        ends = [curve[-1] for curve in naive["curves"]]
        mean = np.mean([end["errors"]["relMSE"] for end in ends])
        assert table["relMSE"]["value"] == pytest.approx(mean)
        seconds = np.mean([end["seconds"] for end in ends])
        assert table["efficiency"]["value"] == pytest.approx(1 / (mean * seconds))
        ratio = table["efficiency"]["value"] / nee["table"]["efficiency"]["value"]
        assert table["speed-up"]["value"] == pytest.approx(ratio)
        assert nee["table"]["speed-up"] == pytest.approx({"value": 1, "low": 1, "high": 1})
        assert [point["spp"] for point in naive["curves"][0]] == [1, 2, 4]
        # A naive path's rays are its edges; next event estimation adds those to lights.
        length = naive["table"]["mean path length"]
        assert 0.97 * length["low"] < table["rays/sample"]["value"] < 1.03 * length["high"]
        assert nee["table"]["rays/sample"]["value"] > 1.2 * nee["table"]["mean path length"]["value"]
        assert found["settings"] == {
            "algorithm": ["Pathtracer", "NaivePathtracer"],
            "light_choice": ["learned", None],
            "mis": ["none", None],
            "path_reuse": [True, None],
            "light_tracing": [True, None],
            "light_splitting": [True, None],
            "portals": [True, None],
        }

    def test_images_are_those_of_ordinary_renders(self, lit: Path) -> None:
        comparison = etendue.compare(lit, ["nee"], **FEW)
        film = etendue.load(lit).render(spp=4, mis="none")
        assert comparison.tallies[0].first is not None
        np.testing.assert_array_equal(comparison.tallies[0].first.film.image, film.image)
        mean = np.mean([etendue.load(lit).render(spp=4, mis="none", seed=s).image for s in range(3)], axis=0)
        luminance = mean @ np.array([0.2126, 0.7152, 0.0722])
        np.testing.assert_allclose(comparison.tallies[0].luminance, luminance, rtol=1e-5)

    def test_errors_shrink_like_one_over_n(self, lit: Path) -> None:
        """Naive path tracing of independent samples, 64 times as many: the error is 64 times smaller."""
        both = {"naive": {"algorithm": "NaivePathtracer", "sampler": "independent"}}
        found = etendue.compare(lit, both, spp=64, repeats=8, reference_spp=4096).results
        curves = found["estimators"][0]["curves"]
        first, last = (np.mean([curve[i]["errors"]["MSE"] for curve in curves]) for i in (0, -1))
        assert 40 < first / last < 100

    def test_a_biased_estimator_is_found_and_right_ones_are_not(self, lit: Path) -> None:
        several = {**BOTH, "mis": {}, "short": {"max_cam_path_length": 2}}
        Path("box.json").write_text(lit.read_text().replace('"lit.obj"', '"CornellBox-Original.obj"'))
        found = etendue.compare("box.json", several, spp=64, repeats=8, size=(32, 32), reference_spp=2048)
        biased = {each["name"]: each["bias"]["is_biased"] for each in found.results["estimators"]}
        assert biased == {"nee": False, "naive": False, "mis": False, "short": True}
        short = found.results["estimators"][3]["bias"]
        assert short["verdict"].startswith("biased: -")
        assert short["ratio"]["high"] < 1

    def test_equal_time_charges_each_its_own(self, lit: Path) -> None:
        found = etendue.compare(
            lit, BOTH, time=0.2, repeats=2, reference_spp=64, size=(64, 64), threads=1
        ).results
        for each in found["estimators"]:
            assert each["table"]["seconds"]["value"] > 0.19
            # On a busy machine it is late by the clock, and no more than that.
            assert each["table"]["CPU seconds"]["value"] < 0.4
            assert each["curves"][0][-1]["spp"] > each["curves"][0][0]["spp"] == 1
        assert found["goal"] == {"spp": None, "seconds": 0.2}

    def test_one_repeat_has_no_verdict(self, lit: Path) -> None:
        found = etendue.compare(lit, ["nee"], spp=1, repeats=1, reference_spp=16).results
        assert found["estimators"][0]["bias"] is None
        assert found["estimators"][0]["table"]["MSE"]["low"] is None

    def test_a_scene_of_its_own_for_an_estimator(self, lit: Path) -> None:
        brighter = {"dim": {}, "bright": {"scene.materials[light].emissive_strength": 20}}
        found = etendue.compare(lit, brighter, **FEW).results
        assert (
            found["estimators"][1]["table"]["MSE"]["value"]
            > 3 * found["estimators"][0]["table"]["MSE"]["value"]
        )


class TestReference:
    def test_it_is_cached_and_improved(self, lit: Path) -> None:
        first = etendue.compare(lit, ["nee"], **FEW).results["reference"]
        again = etendue.compare(lit, ["nee"], **FEW).results["reference"]
        assert again == first
        better = etendue.compare(lit, ["nee"], **{**FEW, "reference_spp": 128}).results["reference"]
        assert better["spp"] == 128
        assert better["film"] == first["film"]
        whole = references.scene_of(etendue.load(lit)).render(spp=128)
        np.testing.assert_array_equal(etendue.read_film(better["film"]).image, whole.image)

    def test_its_random_numbers_are_no_repeats(self, lit: Path) -> None:
        config = references.scene_of(etendue.load(lit)).config
        assert config.seed > 1000
        assert config.sampler == "independent"

    def test_its_own_error_is_known(self, lit: Path) -> None:
        """From halves, against a reference of 64 times the samples."""
        size = ["framebuffer.res_w=96", "framebuffer.res_h=72"]
        scene = etendue.load(etendue.read_config(lit, size))
        true = references.made(scene, Goal(spp=4096), 0, lambda _: None)
        films = [references.scene_of(scene).render(spp=64, seed=seed) for seed in range(12)]
        made = [references.of_film(film, "test") for film in films]
        error = np.mean([np.square(film.image.astype(float) - true.image) for film in films])
        assert np.mean([each.own_errors["MSE"] for each in made]) == pytest.approx(error, rel=0.15)
        assert np.mean([each.variance for each in made]) == pytest.approx(error, rel=0.15)

    def test_a_warning_where_it_is_too_noisy(self, lit: Path) -> None:
        found = etendue.compare(lit, BOTH, spp=64, repeats=2, reference_spp=16).results["reference"]
        assert "nee" in found["too_near"]

    def test_the_rule(self) -> None:
        assert Goal(spp=10).of_reference(None) == Goal(spp=1024)
        assert Goal(spp=100).of_reference(None) == Goal(spp=1600)
        assert Goal(seconds=2.5).of_reference(None) == Goal(seconds=40)
        assert Goal(seconds=2.5).of_reference(99) == Goal(spp=99)

    def test_given_images(self, lit: Path) -> None:
        etendue.load(lit).render(spp=64).save("r.exr")
        found = etendue.compare(lit, ["nee"], spp=4, repeats=2, reference="r.exr").results["reference"]
        assert (found["name"], found["spp"], found["errors"]) == ("r.exr", None, {})
        etendue.load(lit).render(spp=64, sampler="independent").write("r.film.exr")
        found = etendue.compare(lit, ["nee"], spp=4, repeats=2, reference="r.film.exr").results["reference"]
        assert found["spp"] == 64
        assert found["errors"]["MSE"] > 0
        assert not (lit.parent / "cache" / "references").exists()

    def test_refusals(self, lit: Path) -> None:
        etendue.load(lit).render(spp=1, size=(8, 8)).save("small.exr")
        assert "the reference has 8 x 8 pixels, the comparison 16 x 12" in refusal(lit, reference="small.exr")
        assert "missing.exr: cannot be read" in refusal(lit, reference="missing.exr")
        assert "exclude each other" in refusal(lit, reference="small.exr", reference_spp=4)


class TestFolder:
    def test_finished_repeats_are_kept(self, lit: Path, monkeypatch: pytest.MonkeyPatch) -> None:
        first = etendue.compare(lit, BOTH, output="out", **FEW).results
        assert len(list(Path("out/parts").glob("*.film.exr"))) == 6
        assert json.loads(Path("out/results.json").read_text()) == first
        monkeypatch.setattr(repeats, "render", lambda *_: pytest.fail("rendered again"))
        again = etendue.compare(lit, BOTH, output="out", **FEW).results
        assert again["estimators"] == first["estimators"]

    def test_ctrl_c_keeps_them(self, lit: Path, monkeypatch: pytest.MonkeyPatch) -> None:
        rendered = []
        real = repeats.render

        def render(*arguments: Any) -> Any:
            if len(rendered) == 3:
                raise KeyboardInterrupt
            rendered.append(1)
            return real(*arguments)

        monkeypatch.setattr(repeats, "render", render)
        with pytest.raises(KeyboardInterrupt) as caught:
            etendue.compare(lit, BOTH, output="out", **FEW)
        assert isinstance(caught.value, repeats.Interrupted)
        assert (caught.value.done, caught.value.whole) == (3, 6)
        assert not Path("out/results.json").exists()
        rendered.clear()
        found = etendue.compare(lit, BOTH, output="out", **FEW).results
        assert len(rendered) == 3
        assert found["estimators"][1]["seeds"] == [0, 1, 2]

    @pytest.mark.parametrize("change", [{"spp": 2}, {"size": (8, 8)}, {"reference_spp": 128}])
    def test_other_settings_are_rendered_anew(self, lit: Path, change: dict[str, Any]) -> None:
        etendue.compare(lit, ["nee"], output="out", **FEW)
        found = etendue.compare(lit, ["nee"], output="out", **{**FEW, **change})
        fresh = etendue.compare(lit, ["nee"], **{**FEW, **change})
        mine, its = (each.results["estimators"][0] for each in (found, fresh))
        assert mine["table"]["MSE"] == its["table"]["MSE"]

    def test_a_broken_part_is_rendered_again(self, lit: Path) -> None:
        first = etendue.compare(lit, ["nee"], output="out", **FEW).results
        for path in Path("out/parts").glob("nee*"):
            path.write_bytes(b"{")
        again = etendue.compare(lit, ["nee"], output="out", **FEW).results
        assert again["estimators"][0]["table"]["MSE"] == first["estimators"][0]["table"]["MSE"]

    def test_folders_of_others_are_left_alone(self, lit: Path) -> None:
        Path("mine").mkdir()
        Path("mine/index.html").write_text("mine")
        assert "mine: the folder holds something else (index.html)" in refusal(lit, output="mine")
        assert Path("mine/index.html").read_text() == "mine"
        assert [p.name for p in Path("mine").iterdir()] == ["index.html"]
        assert "this is a file" in refusal(lit, output="lit.obj")


class TestCommand:
    @pytest.fixture(autouse=True)
    def _capture(self, capsys: pytest.CaptureFixture[str]) -> None:
        self.capsys = capsys

    def run(self, *arguments: str) -> Done:
        few = ["--spp", "4", "--repeats", "2", "--reference-spp", "64"]
        with pytest.raises(SystemExit) as ended:
            cli.main(["compare", "lit.json", *few, *arguments])
        written = self.capsys.readouterr()
        assert written.out == ""
        return Done(int(ended.value.code or 0), written.err)

    def test_it_tells_what_it_found(self, lit: Path) -> None:
        done = self.run("--estimators", "naive,nee")
        assert done.exit_code == 0, done.stderr
        assert "speed-up" in done.stderr
        assert Path("lit-compared/results.json").exists()
        assert "left" in done.stderr
        assert self.run("--estimators", "naive,nee", "-q", "-o", "q") == (0, "")

    @pytest.mark.parametrize(
        ("limit", "code"), [("relMSE=1e9", 0), ("relmse=0.0001", 1), ("FLIP=0", 1), ("MSE=1e9", 0)]
    )
    def test_limits(self, lit: Path, limit: str, code: int) -> None:
        done = self.run("--estimators", "nee", "--fail-above", limit, "-q")
        assert done.exit_code == code
        assert ("nee: " in done.stderr and "above" in done.stderr) == (code == 1)

    def test_bias_fails(self, lit: Path) -> None:
        Path("e.json").write_text('{"short": {"max_cam_path_length": 1}}')
        done = self.run("--estimators", "e.json", "--fail-if-biased", "-q", "--size", "256x192")
        assert done.exit_code == 1
        assert "short: biased: -" in done.stderr

    @pytest.mark.parametrize(
        ("arguments", "words"),
        [
            (["--fail-above", "relMES=1"], 'did you mean "relMSE"?'),
            (["--fail-above", "relMSE"], "METRIC=VALUE is needed"),
            (["--fail-above", "relMSE=-1"], "0 or more"),
            (["--fail-above", "relMSE=nan"], "0 or more"),
            (["--estimators", "niave"], 'did you mean "naive"?'),
            (["--repeats", "0"], "1 to 1000 repeats"),
            (["--time", "1"], "exclude each other"),
            (["--threads", "-1"], "--threads"),
            (["--size", "65000x65000"], "of memory"),
            (["--set", "rr_treshold=1"], 'did you mean "rr_threshold"?'),
        ],
    )
    def test_refusals(self, lit: Path, arguments: list[str], words: str) -> None:
        done = self.run(*arguments)
        assert done.exit_code == 2
        assert words in done.stderr
        assert not Path("lit-compared").exists()

    def test_an_unknown_key_names_its_estimator(self, lit: Path) -> None:
        Path("e.json").write_text('{"odd": {"mis": "sometimes"}}')
        done = self.run("--estimators", "e.json")
        assert done.exit_code == 2
        assert "estimator odd" in done.stderr
        assert "power" in done.stderr

    def test_what_is_missing_is_named(self, lit: Path, monkeypatch: pytest.MonkeyPatch) -> None:
        monkeypatch.setattr(extras.importlib.util, "find_spec", lambda name: None)
        done = self.run()
        assert done.exit_code == 2
        assert "flip-evaluator" in done.stderr
        assert 'pip install "etendue[compare]"' in done.stderr

    def test_ctrl_c(self, lit: Path, monkeypatch: pytest.MonkeyPatch) -> None:
        def interrupted(*_: Any) -> Any:
            raise KeyboardInterrupt

        monkeypatch.setattr(repeats, "render", interrupted)
        done = self.run()
        assert done.exit_code == 130
        assert "0 of 6 renders are done" in done.stderr
        assert "the same command goes on" in done.stderr


def test_the_time_left_is_of_all_work() -> None:
    told: list[tuple[float, float | None]] = []
    tasks = [Task("a", 1, "a1"), Task("b", 2, "b1"), Task("a", 1, "a2")]
    work = Work(tasks, lambda part, left, _: told.append((part, left)))
    work.skip(tasks[2])
    work.begin(tasks[0])
    assert told[-1] == (0, None)
    work.advance(0.5)
    part, left = told[-1]
    assert left is not None
    # Half of "a" and all of "b", twice as large, are left: five sixths of all.
    assert part == pytest.approx(1 / 6, rel=1e-3)
    work.finish()
    work.begin(tasks[1])
    work.advance(1)
    assert told[-1] == pytest.approx((1, 0))
