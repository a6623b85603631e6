"""Beauty renders: the error of a film, the schedule, and films whose pixels have unequal counts."""

from __future__ import annotations

import json
import shlex
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import OpenImageIO as oiio
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import etendue
from etendue import EtendueError, Film, Scene, cli

ARRAYS = ("image", "sum", "sum_squares", "half_sum", "sample_count", "half_count")
SIZE = (90, 60)
BOUND = 0.1
STAGES = (16, 24, 32, 48, 64, 96, 128, 192, 256, 384, 512)

WriteScene = Callable[..., None]


@pytest.fixture(scope="module")
def scene(tmp_path_factory: pytest.TempPathFactory) -> Scene:
    """A lamp over a floor: tiles with little noise, with much, and with none."""
    folder = tmp_path_factory.mktemp("beauty")
    (folder / "lamp.obj").write_text(
        "v -2 0 -2\nv 2 0 -2\nv 2 0 2\nv -2 0 2\nv -0.5 1.2 -0.5\nv 0.5 1.2 -0.5\nv 0 1.2 0.5\n"
        "usemtl floor\nf 4 3 2\nf 4 2 1\nusemtl light\nf 5 6 7\n"
    )
    return etendue.load(
        {
            "camera": {"pos": [0, 1, 3], "dir": [0, -0.3, -1]},
            "framebuffer": {"res_w": SIZE[0], "res_h": SIZE[1]},
            "error_eps": BOUND,
            "scene": {
                "mesh_files": [str(folder / "lamp.obj")],
                "materials": [{"name": "light", "emissive_strength": 9}],
            },
        }
    )


@pytest.fixture(scope="module")
def whole(scene: Scene) -> Film:
    return scene.render(beauty_render=True)


def assert_same(film: Film, other: Film) -> None:
    for name in ARRAYS:
        np.testing.assert_array_equal(getattr(film, name), getattr(other, name), err_msg=name)
    mine, its = ((f.ranges, f.partial, f.goal, f.bound, f.complete) for f in (film, other))
    assert mine == its


def test_the_error_is_that_of_the_page(scene: Scene) -> None:
    film = scene.render(spp=48)
    a = film.half_count[..., None].astype(float)
    b = 48 - a
    assert (a == 32).all()
    squared = (film.half_sum / a - (film.sum - film.half_sum) / b) ** 2 * a * b / 48**2
    found = film.error
    assert found.tiles.shape == (4, 6)
    spreads = np.zeros((4, 6))
    for row, column in np.ndindex(4, 6):
        part = np.s_[16 * row : 16 * row + 16, 16 * column : 16 * column + 16]
        darkest = 2.0 ** np.floor(np.log2(film.image.mean() / 100))
        total, radiance = squared[part].sum(), max(film.image[part].mean(), darkest)
        error = np.sqrt(squared[part].mean()) / radiance
        assert found.tiles[row, column] == pytest.approx(error, rel=1e-5)
        of_pixels = squared[part].sum(axis=2)
        # In each of three blocks of samples a pixel may have shared paths with 15 others.
        correlated = 1 + 15 / 3
        fourth = correlated * (of_pixels**2).sum()
        spreads[row, column] = error * np.sqrt(fourth) / (2 * total) if total > 0 else 0
    assert (found.tiles == 0).any()
    assert found.value == pytest.approx(np.sort(found.tiles.ravel())[22])
    assert found.low == pytest.approx(np.sort((found.tiles - 1.96 * spreads).clip(0).ravel())[22], rel=1e-5)
    assert found.high == pytest.approx(np.sort((found.tiles + 1.96 * spreads).ravel())[22], rel=1e-5)


@pytest.mark.parametrize(("sampler", "most"), [("independent", 1.08), ("sobol", 4)])
def test_estimates_are_true_or_too_large(scene: Scene, sampler: str, most: float) -> None:
    films = [scene.render(spp=32, seed=seed, sampler=sampler) for seed in range(40)]
    variance = np.var([film.image for film in films], axis=0, ddof=1, dtype=np.float64)
    image = np.mean([film.image for film in films], axis=0)
    for row, column in ((1, 1), (2, 2), (3, 4)):
        part = np.s_[16 * row : 16 * row + 16, 16 * column : 16 * column + 16]
        truth = np.sqrt(variance[part].mean()) / image[part].mean()
        estimate = np.sqrt(np.mean([film.error.tiles[row, column] ** 2 for film in films]))
        assert 0.93 < estimate / truth < most


def test_samples_of_one_half_are_taken_for_independent_and_one_tells_nothing(scene: Scene) -> None:
    film = scene.render(samples=(16, 24))
    assert (film.half_count == 8).all()
    of_mean = film.variance / 8
    part = np.s_[32:48, 32:48]
    assert film.error.tiles[2, 2] == pytest.approx(
        np.sqrt(of_mean[part].mean()) / film.image[part].mean(), rel=1e-5
    )
    assert scene.render(spp=1).error.value == np.inf


def expected_counts(scene: Scene, bound: float) -> tuple[np.ndarray, int]:
    """Tiles' samples by the definition: the first stage within the bound, or that which is enough for 95%."""
    film, need = None, np.full((4, 6), 10**9)
    for stage in STAGES:
        film = scene.render(spp=stage, resume=film)
        need = np.where((film.error.tiles <= bound) & (need == 10**9), stage, need)
        if (need <= stage).sum() >= 0.95 * need.size:
            return np.minimum(need, stage), stage
    raise AssertionError


@pytest.mark.parametrize("bound", [BOUND, 0.15, 10.0])
def test_every_tile_has_what_it_needs_and_none_more_than_uniform_sampling(scene: Scene, bound: float) -> None:
    film = scene.render(beauty_render=True, error_eps=bound)
    counts, uniform = expected_counts(scene, bound)
    assert film.complete
    assert film.error.value <= film.bound == bound
    per_pixel = counts.repeat(16, axis=0).repeat(16, axis=1)[: SIZE[1], : SIZE[0]]
    np.testing.assert_array_equal(film.sample_count, per_pixel)
    assert (film.sample_count.min(), film.sample_count.max()) == (16, uniform)
    for stage in np.unique(counts):
        where = film.sample_count == stage
        np.testing.assert_array_equal(film.sum[where], scene.render(spp=int(stage)).sum[where])
    assert film.ranges == [(0, 16)] == [film.goal]
    assert film.partial == ((16, uniform) if uniform > 16 else None)


def test_threads_do_not_matter(scene: Scene, whole: Film) -> None:
    assert whole.spp < whole.sample_count.max() / 1.5
    for threads in (1, 3):
        assert_same(scene.render(beauty_render=True, threads=threads), whole)


@settings(max_examples=12)
@given(st.lists(st.floats(0.02, 0.98), min_size=1, max_size=4), st.booleans())
def test_interruptions_anywhere_change_nothing(
    scene: Scene, whole: Film, moments: list[float], with_time: bool
) -> None:
    film = None
    for moment in sorted(moments):

        def stop(_: float, spp: float, moment: float = moment) -> None:
            if spp >= moment * whole.spp:
                raise KeyboardInterrupt

        limit = moment * whole.seconds / 2 if with_time else None
        try:
            film = scene.render(beauty_render=True, resume=film, progress=stop, time_limit=limit)
        except KeyboardInterrupt:
            continue
    films: list[Film] = []
    film = scene.render(
        beauty_render=True, resume=film, checkpoint=films.append, checkpoint_seconds=0.05, threads=2
    )
    assert_same(film, whole)
    assert not any(film.complete for film in films)


def test_the_worst_come_first(scene: Scene) -> None:
    size = (2 * SIZE[0], 2 * SIZE[1])
    # Looks follow each other in parts of what the first samples take of the processor: there are as many on a quick
    # machine, and more on a busy one.
    before = time.process_time()
    rough = scene.render(spp=16, size=size, threads=1)
    seconds = (time.process_time() - before) / 20
    errors = rough.error.tiles
    seen = 0

    def look(film: Film) -> None:
        nonlocal seen
        counts = film.sample_count[::16, ::16]
        if counts.min() == 16 < counts.max():
            seen += 1
            assert errors[counts == 16].max() <= np.sqrt(2) * errors[counts > 16].min()

    scene.render(
        beauty_render=True,
        error_eps=BOUND / 3,
        resume=rough,
        checkpoint=look,
        checkpoint_seconds=seconds,
        threads=1,
        size=size,
    )
    assert seen > 10


def test_a_film_goes_on_to_another_bound_and_to_equal_counts(
    scene: Scene, whole: Film, tmp_path: Path
) -> None:
    rough = scene.render(beauty_render=True, error_eps=0.2)
    assert rough.samples < whole.samples
    rough.write(tmp_path / "a.exr")
    back = etendue.read_film(tmp_path / "a.exr")
    assert_same(back, rough)
    assert back.origin is not None
    assert back.origin.config["beauty_render"] is True
    assert_same(scene.render(resume=back, beauty_render=True), whole)
    assert_same(scene.render(resume=scene.render(spp=16), beauty_render=True), whole)
    # Nobody wants the most of all for every pixel.
    even = scene.render(resume=whole, spp=40)
    np.testing.assert_array_equal(even.sample_count, np.maximum(whole.sample_count, 40))
    assert (even.ranges, even.partial, even.complete) == (
        [(0, 40)],
        (40, int(whole.sample_count.max())),
        True,
    )
    assert even.origin is not None
    assert not even.origin.config.get("beauty_render")
    assert even.bound is None
    many = scene.render(resume=whole, spp=600)
    np.testing.assert_array_equal(many.sum, scene.render(spp=600).sum)


def test_unequal_films_merge_with_others(scene: Scene, whole: Film) -> None:
    most = int(whole.sample_count.max())
    more = scene.render(samples=(most, most + 16))
    merged = etendue.merge([more, whole])
    np.testing.assert_array_equal(merged.sample_count, whole.sample_count + np.uint64(16))
    np.testing.assert_allclose(merged.sum, whole.sum + more.sum, rtol=1e-12)
    assert (merged.ranges, merged.partial) == ([(0, 16), (most, most + 16)], (16, most))
    assert (merged.bound, merged.complete) == (None, False)
    filled = scene.render(resume=merged)
    np.testing.assert_array_max_ulp(filled.image, scene.render(spp=most + 16).image, maxulp=1)
    # A beauty render of films with gaps closes them first.
    parts = etendue.merge([scene.render(samples=(0, 8)), scene.render(samples=(16, 24))])
    film = scene.render(resume=parts, beauty_render=True)
    assert (film.ranges, film.complete) == ([(0, 24)], True)
    with pytest.raises(EtendueError, match="the samples 0:16 are in film 1, too"):
        etendue.merge([whole, scene.render(spp=20)])


def test_what_is_black_needs_nothing_more() -> None:
    night = {"framebuffer": {"res_w": 20, "res_h": 20}, "scene": {"sky": {"intensity": 0}}}
    film = etendue.load(night).render(beauty_render=True)
    assert (film.sample_count == 16).all()
    assert film.complete
    assert film.error.value == 0


def test_what_is_asked_for_counts_before_the_scene_file(scene: Scene) -> None:
    data = {"beauty_render": True, "framebuffer": {"res_w": 8, "res_h": 8}, "scene": {"sky": {}}}
    beautiful = etendue.load(data)
    assert beautiful.render().bound == 0.05
    assert beautiful.render(spp=3).spp == 3
    assert beautiful.render(samples=(4, 6)).ranges == [(4, 6)]
    assert beautiful.render(beauty_render=False).spp == 10
    for other in ({"spp": 4}, {"samples": (0, 4)}):
        with pytest.raises(EtendueError, match=r"beauty_render and (spp|samples) exclude each other"):
            scene.render(beauty_render=True, **other)  # type: ignore[arg-type]


def test_progress_and_error_are_told(scene: Scene, whole: Film) -> None:
    parts: list[tuple[float, float]] = []
    errors: list[float] = []

    def stop(fraction: float, spp: float) -> None:
        parts.append((fraction, spp))
        if fraction > 0 and errors and errors[0] > errors[-1]:
            raise KeyboardInterrupt

    # It ends by what it tells alone: no machine is quick enough to come to the bound before.
    film = scene.render(beauty_render=True, error_eps=1e-5, progress=stop, error=errors.append, threads=1)
    assert film.interrupted
    assert all(0 <= fraction < 1 for fraction, _ in parts)
    parts.clear()
    film = scene.render(
        beauty_render=True, progress=lambda *part: parts.append(part), error=errors.append, threads=1
    )
    assert parts[-1] == (1, film.spp)
    assert all(fraction < 1 for fraction, _ in parts[:-1])
    assert errors[-1] == whole.error.value
    errors.clear()
    film = scene.render(spp=64, error=errors.append)
    assert errors[-1] == film.error.value


class Run(NamedTuple):
    code: int
    out: str
    err: str


@pytest.fixture
def run(
    capsys: pytest.CaptureFixture[str], lit_scene: WriteScene, monkeypatch: pytest.MonkeyPatch
) -> Callable[[str], Run]:
    lit_scene(framebuffer={"res_w": 48, "res_h": 32})
    monkeypatch.setattr("etendue.denoise.is_installed", lambda: False)

    def run(line: str) -> Run:
        capsys.readouterr()
        with pytest.raises(SystemExit) as ended:
            cli.main(shlex.split(line))
        captured = capsys.readouterr()
        code = ended.value.code
        return Run(code if isinstance(code, int) else 0, captured.out, captured.err)

    return run


def test_the_command(run: Callable[[str], Run]) -> None:
    said = run(
        "render lit.json --beauty --set error_eps=0.3 --film a.exr --sample-map map.png --json -o b.png"
    )
    assert said.code == 0, said.err
    first, *_, report, last = said.err.splitlines()
    assert first.startswith("Pathtracer, 48 x 32, beauty render to an error of 0.3; 3 triangles, ")
    found = json.loads(said.out)
    assert found["error_interval"][0] < found["error"] <= found["error_eps"] == 0.3
    assert found["complete"] is True
    film = etendue.read_film("a.exr")
    assert found["spp"] == film.spp
    assert film.complete
    assert report.startswith(f"error {film.error.value:.3g} (95% interval {film.error.low:.3g} to ")
    assert report.endswith(f" of the tiles within 0.3; 16 to {film.sample_count.max()} samples per pixel")
    assert last.endswith(": b.png, map.png, a.exr")
    assert run("tonemap a.exr -o again.png --false-colour samples").code == 0
    assert (pixels("again.png") == pixels("map.png")).all()

    before = film.samples
    said = run("render --resume a.exr --set error_eps=0.2 -q --json -o b.png")
    assert (said.code, said.err) == (0, "")
    film = etendue.read_film("a.exr")
    assert film.samples > before
    assert film.error.value <= film.bound == 0.2
    # Again, and there is nothing left to do.
    assert run("render --resume a.exr -q -o b.png").code == 0
    assert etendue.read_film("a.exr").samples == film.samples
    said = run("render --resume a.exr --spp 40 -o b.png")
    assert ", 40 spp, " in said.err
    assert (etendue.read_film("a.exr").sample_count == np.maximum(film.sample_count, 40)).all()


def pixels(name: str) -> Any:
    return np.asarray(oiio.ImageBuf(name).get_pixels(oiio.UINT8))


def test_time_ends_it(run: Callable[[str], Run]) -> None:
    before = time.process_time()
    said = run("render lit.json --beauty --set error_eps=1e-5 --time 1 --film a.exr -o b.png --threads 1")
    # A busy machine may let it end late by the clock.
    assert time.process_time() - before < 3
    assert said.code == 0
    lines = said.err.splitlines()
    assert lines[-4] == "the time is over"
    assert lines[-3].startswith("error ")
    assert lines[-1].endswith(" render --resume a.exr -o b.png --threads 1")
    assert "100%" not in "".join(line for line in lines if "samples/s" in line and "left" in line)
    film = etendue.read_film("a.exr")
    assert (film.complete, film.bound) == (False, 1e-5)
    assert film.sample_count.min() >= 16


@pytest.mark.parametrize(
    ("line", "message"),
    [
        ("--beauty --spp 4", "--beauty: excludes --spp; the error decides how many samples there will be"),
        (
            "--beauty --samples 0:4",
            "--beauty: excludes --samples; the error decides how many samples there will be",
        ),
        ("--sample-map a.exr", "a.exr: .exr files stay linear; allowed here: .png, .jpg, .jpeg"),
        ("--sample-map no/a.png", "no/a.png: cannot be written: there is no folder no"),
    ],
)
def test_refusals(run: Callable[[str], Run], line: str, message: str) -> None:
    assert run(f"render lit.json {line}") == (2, "", message + "\n")


def test_all_lines_for_scripts_are_objects(run: Callable[[str], Run]) -> None:
    said = run("render lit.json --beauty --set error_eps=0.2 --json-progress")
    assert (said.code, said.out) == (0, "")
    lines = [json.loads(line) for line in said.err.splitlines()]
    assert {line["event"] for line in lines} == {"message", "progress"}
    last = [line for line in lines if line["event"] == "progress"][-1]
    assert (last["fraction"], last["error_goal"], last["spp_goal"], last["seconds_left"]) == (
        1,
        0.2,
        None,
        None,
    )
    assert last["error"] <= 0.2
    said = run("render lit.json --set scene.sky.intensity=-1 --json-progress")
    assert said.code == 2
    (line,) = map(json.loads, said.err.splitlines())
    assert (line["event"], "scene.sky.intensity" in line["text"]) == ("error", True)


def test_ctrl_c_keeps_what_is_done_and_the_bound(lit_scene: WriteScene) -> None:
    lit_scene(framebuffer={"res_w": 48, "res_h": 32})
    line = "render lit.json --beauty --set error_eps=1e-4 --film a.exr --sample-map m.png -o b.png --json-progress"
    process = subprocess.Popen(
        [sys.executable, "-m", "etendue", *line.split()], stderr=subprocess.PIPE, text=True
    )
    assert process.stderr is not None
    while (json.loads(process.stderr.readline()).get("spp") or 0) < 1:
        pass
    process.send_signal(signal.SIGINT)
    _, err = process.communicate(timeout=60)
    assert process.returncode == 130, err
    command = json.loads(err.splitlines()[-1])["text"].removeprefix("to go on: ")
    assert command.endswith(" render --resume a.exr -o b.png --sample-map m.png")
    film = etendue.read_film("a.exr")
    assert (film.interrupted, film.complete, film.bound) == (True, False, 1e-4)
    assert Path("m.png").exists()
    ended = subprocess.run(f"{command} --time 0.1 -q", shell=True, capture_output=True, text=True, timeout=60)
    assert ended.returncode == 0, ended.stderr
    assert etendue.read_film("a.exr").samples > film.samples
