"""Films on the command line: --film, --resume, --samples, merge, signals and what killing leaves."""

from __future__ import annotations

import json
import os
import shlex
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import pytest

import etendue
from etendue import EtendueError, Film, cli
from etendue.cli.interrupts import Interrupts
from etendue.cli.progress import Goal, Status
from etendue.film import file as film_file

FILM = "a.film.exr"
# More samples than any test waits for.
ENDLESS = "100000000"


class Run(NamedTuple):
    code: int
    out: str
    err: str


Command = Callable[..., Run]
WriteScene = Callable[..., None]


@pytest.fixture(autouse=True)
def _scene(lit_scene: WriteScene) -> None:
    pass


@pytest.fixture
def run(capsys: pytest.CaptureFixture[str]) -> Command:
    def run(line: str) -> Run:
        capsys.readouterr()
        with pytest.raises(SystemExit) as ended:
            cli.main(shlex.split(line))
        captured = capsys.readouterr()
        code = ended.value.code
        return Run(code if isinstance(code, int) else 0, captured.out, captured.err)

    return run


def start(line: str) -> subprocess.Popen[str]:
    return subprocess.Popen(
        [sys.executable, "-m", "etendue", *shlex.split(line)],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )


def assert_equal(film: Film, other: Film) -> None:
    for name in ("image", "sum", "sum_squares", "half_sum", "sample_count"):
        np.testing.assert_array_equal(getattr(film, name), getattr(other, name), err_msg=name)


def test_a_render_goes_on_as_if_it_had_not_stopped(run: Command) -> None:
    said = run(f"render lit.json --film {FILM} --spp 3 --seed 2 --threads 1")
    assert said.code == 0, said.err
    assert said.err.endswith(f": lit.png, {FILM}\n")
    said = run(f"render --resume {FILM} --spp 8 -o b.exr --json")
    assert said.code == 0, said.err
    assert said.err.startswith("Pathtracer, 8 x 6, 8 spp, 3 of them there; ")
    assert json.loads(said.out)["spp"] == 8
    film = etendue.read_film(FILM)
    assert_equal(film, etendue.load("lit.json").render(spp=8, seed=2))
    assert film.origin is not None
    assert film.origin.config["framebuffer"]["sppx"] == 8
    # Again, and there is nothing left to do.
    said = run(f"render --resume {FILM} --json --spp 4 --quiet")
    assert (said.code, json.loads(said.out)["spp"]) == (0, 8)


def test_the_scene_file_may_be_named_again(run: Command, lit_scene: WriteScene) -> None:
    assert run(f"render lit.json --film {FILM}").code == 0
    lit_scene(framebuffer={"sppx": 6, "exposure": 2.0})
    assert run(f"render lit.json --resume {FILM}").code == 0
    assert etendue.read_film(FILM).spp == 6
    lit_scene(rr_threshold=0.5, scene={"materials": [{"name": "floor", "roughness": 0.3}]})
    said = run(f"render lit.json --resume {FILM} --seed 4 --size 9x6")
    assert (said.code, said.out) == (2, "")
    assert said.err.splitlines() == [
        f"{FILM}: the scene or its settings have changed:",
        "  rr_threshold: 0.5 here, 0.25 in the film",
        "  seed: 4 here, 0 in the film",
        "  framebuffer.res_w: 9 here, 8 in the film",
        "  scene.materials[floor].roughness: 0.3 here, not set in the film",
    ]
    assert run(f"render --resume {FILM} --set mis=balance").err.splitlines()[1:] == [
        '  mis: "balance" here, "power" in the film'
    ]


@pytest.mark.parametrize(
    ("name", "old", "new", "problem"),
    [
        ("lit.obj", "v 2 0 2", "v 2 0 2.01", "lit.obj (scene.mesh_files[0]): the content differs"),
        (
            "lit.mtl",
            "Ke 8 8 8",
            "Ke 8 8 9",
            "lit.obj (materials of scene.mesh_files[0]): the content differs",
        ),
    ],
)
def test_a_changed_file_is_named(run: Command, name: str, old: str, new: str, problem: str) -> None:
    assert run(f"render lit.json --film {FILM}").code == 0
    before = Path(FILM).read_bytes()
    text = Path(name).read_text()
    Path(name).write_text("# a comment changes nothing\n" + text)
    assert run(f"render --resume {FILM} --spp 5 --film b.exr").code == 0
    Path(name).write_text(text.replace(old, new))
    said = run(f"render --resume {FILM} --spp 5")
    assert said.code == 2
    assert said.err == f"{FILM}: the scene or its settings have changed:\n  {problem}\n"
    assert Path(FILM).read_bytes() == before


def test_a_changed_texture_and_sky_are_named(run: Command, lit_scene: WriteScene) -> None:
    def paint(name: str, value: int) -> None:
        image = np.full((2, 2, 3), value, np.uint8)
        image[0, 0] = 255
        Film(image.astype(np.float32), np.zeros((2, 2), np.uint64), *np.zeros((2, 2, 2, 3))).save(name)

    paint("wood.png", 0)
    paint("sky.exr", 1)
    Path("tri.mtl").write_text("newmtl floor\nmap_Kd wood.png\n")
    Path("tri.obj").write_text(
        "mtllib tri.mtl\nv -9 0 -9\nv 9 0 -9\nv 0 0 9\nvt 0 0\nvt 1 0\nvt 0 1\nusemtl floor\nf 1/1 3/3 2/2\n"
    )
    lit_scene("tri.json", scene={"mesh_files": ["tri.obj"], "sky": {"envmap": "sky.exr"}})
    assert run(f"render tri.json --film {FILM}").code == 0
    assert run(f"render --resume {FILM} --spp 5").code == 0
    paint("sky.exr", 3)
    image = np.zeros((2, 2, 3), np.float32)
    Film(image, np.zeros((2, 2), np.uint64), *np.zeros((2, 2, 2, 3))).save("wood.png")
    assert run(f"render --resume {FILM} --spp 6").err.splitlines()[1:] == [
        "  wood.png (texture 0): the content differs",
        "  sky.exr (scene.sky.envmap): the content differs",
    ]


def test_a_film_that_moved_finds_its_meshes(run: Command) -> None:
    Path("data").mkdir()
    Path("films").mkdir()
    for name in ("lit.obj", "lit.mtl"):
        Path(name).rename(Path("data") / name)
    assert run(f"render lit.json --data data --film {FILM}").code == 0
    Path(FILM).rename(Path("films") / FILM)
    os.chdir("films")
    assert run(f"render --resume {FILM} --spp 5").code == 0
    os.chdir("..")
    Path("data").rename("elsewhere")
    said = run(f"render --resume films/{FILM} --spp 6")
    assert said.code == 2
    assert "lit.json: scene.mesh_files[0]: no such file" in said.err
    assert run(f"render --resume films/{FILM} --spp 6 --data elsewhere").code == 0
    Path("elsewhere/lit.obj").rename("films/lit.obj")
    Path("elsewhere/lit.mtl").rename("films/lit.mtl")
    assert run(f"render --resume films/{FILM} --spp 7").code == 0


def test_ranges_and_merge(run: Command) -> None:
    for samples, name in (("5:9", "three"), ("0:2", "one"), ("2:5", "two")):
        said = run(f"render lit.json --samples {samples} --film {name}.film.exr -q")
        assert said.code == 0, said.err
    said = run(f"merge three.film.exr one.film.exr -o {FILM}")
    assert (said.code, said.err) == (0, "")
    assert said.out == (
        f"2 films, samples 0:2 and 5:9: {FILM}\nmissing: 2:5; etendue render --resume {FILM} renders them\n"
    )
    assert run(f"merge two.film.exr {FILM} -o whole.exr").out == "2 films, samples 0:9: whole.exr\n"
    whole = etendue.load("lit.json").render(spp=9)
    np.testing.assert_array_max_ulp(etendue.read_film("whole.exr").image, whole.image, maxulp=1)
    assert run(f"render --resume {FILM}").code == 0
    np.testing.assert_array_max_ulp(etendue.read_film(FILM).image, whole.image, maxulp=1)
    said = run("merge one.film.exr whole.exr -o d.film.exr")
    assert (said.code, said.err) == (2, "whole.exr: the samples 0:2 are in one.film.exr, too\n")
    assert not Path("d.film.exr").exists()


@pytest.mark.parametrize(
    ("line", "message"),
    [
        ("render lit.json --film a.png", 'a.png: a film file is an EXR image; its name must end with ".exr"'),
        ("render lit.json --film none/a.exr", "none/a.exr: cannot be written: there is no folder none"),
        ("render lit.json --film a.exr -o a.exr", "a.exr: the image and the film cannot be one file"),
        ("render lit.json --checkpoint 3", "--checkpoint: there is no film to write; --film names one"),
        (
            "render lit.json --film a.exr --checkpoint 0",
            "--checkpoint: a number of seconds above 0 is needed, not 0",
        ),
        (
            "render lit.json --samples 3",
            '--samples: a range FIRST:END is needed, as in 0:64, not "3"',
        ),
        (
            "render lit.json --samples 0:3 --spp 3",
            "--samples: excludes --spp; films of other samples are put together by merge",
        ),
        ("render --resume none.exr", "none.exr: cannot be read: No such file or directory"),
        ("merge none.exr -o a.exr", "none.exr: cannot be read: No such file or directory"),
        ("merge lit.json -o a.png", 'a.png: a film file is an EXR image; its name must end with ".exr"'),
    ],
)
def test_refusals(run: Command, line: str, message: str) -> None:
    assert run(line) == (2, "", message + "\n")


def test_a_film_does_not_take_the_place_of_another(run: Command) -> None:
    assert run(f"render lit.json --film {FILM}").code == 0
    before = Path(FILM).read_bytes()
    said = run(f"render lit.json --film {FILM}")
    assert said.code == 2
    assert said.err.startswith(f"{FILM}: there is a film with the samples 0:4 already; go on from it with ")
    assert said.err.endswith(f" render --resume {FILM}, or remove it first\n")
    assert Path(FILM).read_bytes() == before


def test_a_full_disk_ends_with_code_2_and_the_old_film(
    run: Command, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    assert run(f"render lit.json --film {FILM}").code == 0
    before = Path(FILM).read_bytes()

    def full(*_: Any) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("shutil.copyfileobj", full)
    # So short a time between them ends each pass with a checkpoint.
    said = run(f"render --resume {FILM} --spp 40 --checkpoint 1e-9")
    problem = f"{FILM}: cannot be written: No space left on device"
    assert said.code == 2
    assert f"warning: {problem}; rendering goes on, and writing is tried again\n" in said.err
    assert said.err.endswith(f"\n{problem}\n")
    assert Path(FILM).read_bytes() == before
    assert {path.name for path in tmp_path.iterdir()} == {"lit.json", "lit.obj", "lit.mtl", "lit.png", FILM}


def test_checkpoints_come_at_their_times() -> None:
    films: list[Film] = []
    spent = [time.process_time()]
    every = 0.25

    def checkpoint(film: Film) -> None:
        films.append(film)
        spent.append(time.process_time())
        if len(films) == 5:
            raise KeyboardInterrupt

    scene = etendue.load("lit.json")
    last = scene.render(spp=10**8, checkpoint=checkpoint, checkpoint_seconds=every, threads=1)
    # Never early by the clock; and not late by what they took of the processor, as a busy machine is by the clock.
    assert min(np.diff([0.0, *(film.seconds for film in films)])) >= 0.99 * every
    assert max(np.diff(spent)) < 1
    counts = [film.samples for film in films]
    assert counts == sorted(counts)
    assert last.interrupted
    assert_equal(scene.render(resume=films[1], spp=last.goal[0] + 1), _finished(scene, films[1]))


def test_time_ends_between_checkpoints() -> None:
    films: list[Film] = []
    last = etendue.load("lit.json").render(
        spp=10**8, time_limit=0.6, checkpoint=films.append, checkpoint_seconds=0.25
    )
    assert not last.complete
    assert not last.interrupted
    assert len(films) <= 2


def _finished(scene: etendue.Scene, film: Film) -> Film:
    """The single render with as many samples as the pixel of `film` with the most."""
    return scene.render(spp=int(film.sample_count.max()))


@pytest.mark.parametrize(("number", "code"), [(signal.SIGINT, 130), (signal.SIGTERM, 143)])
def test_a_signal_saves_and_says_how_to_go_on(number: int, code: int) -> None:
    process = start(
        f"render lit.json --film {FILM} --spp {ENDLESS} -o 'an image.png' --threads 2 --json --json-progress"
    )
    assert process.stderr is not None
    while (json.loads(process.stderr.readline()).get("spp") or 0) < 1:
        pass
    process.send_signal(number)
    out, err = process.communicate(timeout=60)
    assert process.returncode == code, err
    assert "Traceback" not in err
    film = etendue.read_film(FILM)
    assert json.loads(out)["spp"] == film.spp > 0
    assert film.interrupted
    assert Path("an image.png").exists()
    last = json.loads(err.splitlines()[-1])["text"]
    command = last.removeprefix("to go on: ")
    assert command.endswith(f" -m etendue render --resume {FILM} -o 'an image.png' --threads 2")
    ended = subprocess.run(f"{command} --spp 1", shell=True, capture_output=True, text=True, timeout=60)
    assert ended.returncode == 0, ended.stderr
    scene = etendue.load("lit.json")
    assert_equal(etendue.read_film(FILM), _finished(scene, film))


def strike(number: int) -> None:
    os.kill(os.getpid(), number)
    time.sleep(0.05)


@pytest.fixture
def default_ctrl_c() -> Iterator[None]:
    """Python's own handler, which a shell that runs the tests in the background has switched off."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


def test_the_first_signal_waits_for_the_file_the_second_does_not(default_ctrl_c: None) -> None:
    with Interrupts() as interrupts:
        with interrupts.shielded():
            strike(signal.SIGTERM)
        assert interrupts.by_signal
        with pytest.raises(KeyboardInterrupt), interrupts.shielded():
            strike(signal.SIGINT)
        assert interrupts.exit_code == 143
    with pytest.raises(KeyboardInterrupt):
        strike(signal.SIGINT)


def kill_again_and_again(kills: int, checkpoint: float) -> None:
    """Renders with `kill -9` at random moments; compares the end with the single render."""
    random = np.random.default_rng(kills)
    line = f"render lit.json --film {FILM} --spp {ENDLESS} --checkpoint {checkpoint} -q -o a.png"
    seconds = 0.0
    for _ in range(kills):
        process = start(line)
        began = time.monotonic()
        before = Path(FILM).stat().st_mtime_ns if Path(FILM).exists() else 0
        while not Path(FILM).exists() or Path(FILM).stat().st_mtime_ns == before:
            assert process.poll() is None, process.communicate()
            assert time.monotonic() - began < 60
            time.sleep(0.002)
        time.sleep(checkpoint * random.uniform(0, 2))
        process.kill()
        process.communicate()
        film = etendue.read_film(FILM)
        # At least the checkpoint that was waited for is there.
        assert film.seconds >= seconds + checkpoint * 0.99
        seconds = film.seconds
        line = f"render --resume {FILM} --checkpoint {checkpoint} -q -o a.png"
    ended = start(f"render --resume {FILM} --spp 1 -q -o a.png --checkpoint {checkpoint}")
    assert ended.wait(timeout=60) == 0
    last = etendue.read_film(FILM)
    assert_equal(last, _finished(etendue.load("lit.json"), film))
    assert not list(Path().glob(".*.part"))


def test_killing_loses_no_more_than_a_checkpoint() -> None:
    kill_again_and_again(2, 0.1)


@pytest.mark.slow
def test_killing_fifty_times() -> None:
    kill_again_and_again(50, 0.05)


def test_every_moment_of_a_write_leaves_a_whole_film(monkeypatch: pytest.MonkeyPatch) -> None:
    scene = etendue.load("lit.json")
    scene.render(spp=1).write(FILM)
    film = scene.render(spp=2)
    for name in ("fsync", "chmod", "replace"):

        def stop(*_: Any, **__: Any) -> None:
            raise KeyboardInterrupt

        with monkeypatch.context() as patch:
            patch.setattr(*((os, "fsync") if name == "fsync" else (Path, name)), stop)
            with pytest.raises(KeyboardInterrupt):
                film.write(FILM)
        assert etendue.read_film(FILM).spp == 1
        assert not list(Path().glob(".*.part"))
    film_file.write(film, Path(FILM))
    assert etendue.read_film(FILM).spp == 2


def test_python_refuses_what_the_command_refuses(lit_scene: WriteScene) -> None:
    scene = etendue.load("lit.json")
    film = scene.render(spp=2)
    with pytest.raises(EtendueError, match="seed: 1 here, 0 in the film"):
        scene.render(resume=film, seed=1)
    with pytest.raises(EtendueError, match="samples and resume exclude each other"):
        scene.render(resume=film, samples=(0, 4))
    with pytest.raises(EtendueError, match="checkpoint_seconds: above 0"):
        scene.render(checkpoint=print, checkpoint_seconds=0)
    assert_equal(scene.render(resume=film, spp=5), scene.render(spp=5))
    assert film.spp == 2


def test_the_progress_of_what_goes_on_counts_its_own_time() -> None:
    goal = Goal(100, 1000, spp_before=50)
    assert Status(goal, 0.75, 75, 5.0).words() == ("75%", "75/100 spp", "5 k samples/s", "", "5.0 s left")
    assert Status(goal, 0.5, 50, 0.0).words() == ("50%", "50/100 spp", "", "", "")
    assert Status(Goal(100, 1000, spp_before=100), 1, 100, 0.0).words()[0] == "100%"
