"""The command: exit codes, what goes to which stream, and the files that it leaves."""

from __future__ import annotations

import json
import signal
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import pytest

from etendue import _core, cli, models
from etendue.cli import memory, progress
from etendue.errors import EtendueError
from etendue.film import Film

CAMERA = {"pos": [0, 1, 3], "dir": [0, -0.3, -1]}
LIT = """mtllib lit.mtl
v -2 0 -2
v 2 0 -2
v 2 0 2
v -2 0 2
v -0.5 2 -0.5
v 0.5 2 -0.5
v 0 2 0.5
usemtl floor
f 4 3 2
f 4 2 1
usemtl light
f 5 6 7
"""
MTL = "newmtl floor\nKd 0.5 0.5 0.5\nnewmtl light\nKd 1 1 1\nKe 8 8 8\n"


class Run(NamedTuple):
    code: int
    out: str
    err: str


Command = Callable[..., Run]


@pytest.fixture(autouse=True)
def _scene(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.delenv("ETENDUE_DATA", raising=False)
    Path("lit.obj").write_text(LIT)
    Path("lit.mtl").write_text(MTL)
    write("lit.json")


def write(name: str, **keys: Any) -> None:
    scene = {"mesh_files": ["lit.obj"], **keys.pop("scene", {})}
    framebuffer = {"res_w": 16, "res_h": 12, "sppx": 4}
    Path(name).write_text(json.dumps({"camera": CAMERA, "framebuffer": framebuffer, "scene": scene, **keys}))


@pytest.fixture
def etendue(capsys: pytest.CaptureFixture[str]) -> Command:
    def run(*arguments: str) -> Run:
        capsys.readouterr()
        with pytest.raises(SystemExit) as ended:
            cli.main(list(arguments))
        captured = capsys.readouterr()
        code = ended.value.code
        return Run(code if isinstance(code, int) else 0, captured.out, captured.err)

    return run


def read(path: str) -> Any:
    import OpenImageIO as oiio

    image = oiio.ImageBuf(path)
    assert not image.has_error
    return image.get_pixels(oiio.FLOAT)


def test_render_writes_the_scene_s_name_as_png_here(etendue: Command, tmp_path: Path) -> None:
    Path("elsewhere").mkdir()
    Path("lit.json").rename("elsewhere/lit.json")
    Path("lit.obj").rename("elsewhere/lit.obj")
    Path("lit.mtl").rename("elsewhere/lit.mtl")
    run = etendue("render", "elsewhere/lit.json")
    assert run.code == 0, run.err
    assert run.out == ""
    assert run.err.startswith("Pathtracer, 16 x 12, 4 spp; 3 triangles, 1 light, loaded in ")
    assert run.err.splitlines()[-1].startswith("4 spp in ")
    assert run.err.endswith(": lit.png\n")
    assert read("lit.png").shape == (12, 16, 3)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["elsewhere", "lit.png"]


def test_options_and_outputs_of_every_kind(etendue: Command) -> None:
    outputs = ["a.exr", "a.hdr", "a.png", "a.jpg", "a.jpeg"]
    options = [
        "--spp",
        "3",
        "--size",
        "20x10",
        "--algorithm",
        "NaivePathtracer",
        "--seed",
        "5",
        "--threads",
        "1",
    ]
    run = etendue("render", "lit.json", *options, *(f"-o{name}" for name in outputs), "--json", "--quiet")
    assert (run.code, run.err) == (0, "")
    (line,) = run.out.splitlines()
    said = json.loads(line)
    assert list(said) == [
        "algorithm",
        "spp",
        "width",
        "height",
        "seconds",
        "load_seconds",
        "rays",
        "samples_per_second",
        "mean",
        "error",
        "error_interval",
        "error_eps",
        "complete",
        "invalid_samples",
        "outputs",
    ]
    assert (said["algorithm"], said["spp"], said["width"], said["height"]) == ("NaivePathtracer", 3, 20, 10)
    assert (said["invalid_samples"], said["outputs"]) == (0, outputs)
    assert said["samples_per_second"] == pytest.approx(600 / said["seconds"])
    assert said["rays"] >= 600
    assert (said["error_eps"], said["complete"]) == (None, True)
    assert 0 < said["error_interval"][0] < said["error"] < said["error_interval"][1]
    linear = read("a.exr")
    assert linear.shape == (10, 20, 3)
    np.testing.assert_allclose(said["mean"], linear.mean(axis=(0, 1)), rtol=1e-5)
    for name in outputs:
        assert read(name).shape == (10, 20, 3)


def test_data_folders_and_settings(etendue: Command) -> None:
    Path("more").mkdir()
    for name in ("lit.obj", "lit.mtl"):
        Path(name).rename(Path("more") / name)
    assert etendue("render", "lit.json").code == 2
    means = []
    for strength in ("1", "2"):
        setting = f"scene.materials[light].emissive_strength={strength}"
        run = etendue("render", "lit.json", "--data", "more", "--set", setting, "--set", "seed=3", "--json")
        assert run.code == 0, run.err
        means.append(json.loads(run.out)["mean"][0])
    assert means[1] == pytest.approx(2 * means[0], rel=1e-5)


def test_the_same_seed_gives_the_same_file(etendue: Command) -> None:
    for name, seed, threads in (("a", "1", "1"), ("b", "1", "2"), ("c", "2", "2")):
        assert (
            etendue("render", "lit.json", "-o", f"{name}.png", "--seed", seed, "--threads", threads).code == 0
        )
    assert Path("a.png").read_bytes() == Path("b.png").read_bytes()
    assert Path("a.png").read_bytes() != Path("c.png").read_bytes()


def test_warnings_are_said_once_and_first(etendue: Command) -> None:
    write("lit.json", scene={"materials": [{"name": "flor"}]})
    run = etendue("render", "lit.json")
    assert run.code == 0
    warning = "warning: lit.json:1: scene.materials[0].name: "
    assert run.err.startswith(warning)
    assert run.err.count("warning: ") == 1
    assert 'did you mean "floor"?' in run.err


def test_no_light_is_a_warning_and_a_black_image(etendue: Command) -> None:
    Path("lit.mtl").write_text(MTL.replace("light", "lamp").replace("Ke 8 8 8", ""))
    Path("lit.obj").write_text(LIT.replace("light", "lamp"))
    run = etendue("render", "lit.json", "--json")
    assert run.code == 0
    assert "warning: lit.json:1: scene: no light: the image will be black" in run.err
    assert json.loads(run.out)["mean"] == [0, 0, 0]


def test_every_problem_of_file_and_options_at_once(etendue: Command) -> None:
    write("bad.json", sed=1, scene={"mesh_files": ["lit.obj", "lot.obj"]})
    run = etendue(
        "render", "bad.json", "--spp", "0", "--size", "0x5", "--algorithm", "Pathtrace", "--seed", "-1"
    )
    assert (run.code, run.out) == (2, "")
    algorithms = ", ".join(info.name for info in _core.algorithms())
    lines = run.err.splitlines()
    assert lines[:4] == [
        '--algorithm: algorithm: unknown algorithm (got "Pathtrace"; did you mean "Pathtracer"? '
        f"allowed: {algorithms})",
        "--seed: seed: out of range (got -1; allowed: a whole number from 0 to 4294967295)",
        "--size: framebuffer.res_w: out of range (got 0; allowed: a whole number from 1 to 65536)",
        "--spp: framebuffer.sppx: out of range (got 0; allowed: a whole number from 1 to 2147483647)",
    ]
    assert lines[4].startswith('bad.json:1: sed: unknown key (did you mean "seed"? allowed: ')
    assert lines[5] == (
        "bad.json:1: scene.mesh_files[1]: no such file; looked as given, beside the scene file (.), "
        "under $ETENDUE_DATA (which is not set), among the bundled scenes "
        '(got "lot.obj"; did you mean "lit.obj"?)'
    )
    assert len(lines) == 6
    assert not Path("bad.png").exists()


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["render", "none.json"], "none.json: cannot be read: No such file or directory\n"),
        (["check", "none.json"], "none.json: cannot be read: No such file or directory\n"),
        (["render", "lit.json", "--data", "none"], "--data: there is no folder none\n"),
        (["check", "lit.json", "--data", "none"], "--data: there is no folder none\n"),
        (["render", "lit.json", "--time", "0"], "--time: a number of seconds above 0 is needed, not 0\n"),
        (["render", "lit.json", "--time", "nan"], "--time: a number of seconds above 0 is needed, not nan\n"),
        (
            ["render", "lit.json", "--threads", "-1"],
            "--threads: a number of threads, or 0 for one on each core, is needed, not -1\n",
        ),
        (
            ["render", "lit.json", "-o", "a.tif", "-o", "none/a.png"],
            'a.tif: no image can be written as ".tif" (allowed: .exr, .hdr, .png, .jpg, .jpeg)\n'
            "none/a.png: cannot be written: there is no folder none\n",
        ),
        (
            ["render", "lit.json", "--set", "rr_treshold"],
            "--set rr_treshold: a key, an equals sign and a value are needed, as in rr_threshold=0.5\n",
        ),
        (
            ["scenes", "bax"],
            'there is no bundled scene "bax" '
            '(did you mean "box"? allowed: box, pots, sibenik, spz, fireplace, mis)\n',
        ),
    ],
)
def test_refusals(etendue: Command, arguments: list[str], message: str) -> None:
    assert etendue(*arguments) == (2, "", message)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["render"], "Missing argument 'CONFIG'"),
        (["render", "lit.json", "--size", "640"], "'640' is not WIDTHxHEIGHT in pixels, as in 640x480"),
        (["render", "lit.json", "--spp", "many"], "'--spp'"),
        (["render", "lit.json", "--bogus"], "No such option"),
        (["rendr"], "No such command 'rendr'"),
    ],
)
def test_mistyped_commands(etendue: Command, arguments: list[str], message: str) -> None:
    run = etendue(*arguments)
    assert (run.code, run.out) == (2, "")
    assert message in run.err


def test_an_image_larger_than_the_memory(etendue: Command, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(memory, "of_machine", lambda: 16_000_000_000)
    run = etendue("render", "lit.json", "--size", "65536x65536")
    assert (run.code, run.out) == (2, "")
    assert run.err == "an image of 65536 x 65536 pixels needs 1048 GB of memory; this machine has 16 GB\n"


def test_outputs_are_tried_before_anything_else(etendue: Command) -> None:
    Path("lit.json").write_text("no scene at all")
    assert etendue("render", "lit.json", "-o", "none/a.png").err == (
        "none/a.png: cannot be written: there is no folder none\n"
    )


def test_a_failure_leaves_existing_images(etendue: Command) -> None:
    Path("lit.png").write_text("old")
    write("lit.json", camera={"fov": 0})
    assert etendue("render", "lit.json").code == 2
    assert Path("lit.png").read_text() == "old"


def test_one_image_that_fails_keeps_no_other_from_being_written(
    etendue: Command, monkeypatch: pytest.MonkeyPatch
) -> None:
    save = Film.save

    def failing(film: Film, path: Path, *arguments: Any) -> None:
        if path.suffix == ".exr":
            raise EtendueError(f"{path}: cannot be written: No space left on device")
        save(film, path, *arguments)

    monkeypatch.setattr(Film, "save", failing)
    run = etendue("render", "lit.json", "-o", "a.exr", "-o", "a.png")
    assert run.code == 2
    assert run.err.endswith("\na.exr: cannot be written: No space left on device\n")
    assert not Path("a.exr").exists()
    assert read("a.png").shape == (12, 16, 3)


def test_a_cache_that_cannot_be_written(
    etendue: Command, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    Path("file").touch()
    monkeypatch.setenv("ETENDUE_CACHE", str(tmp_path / "file"))
    write("box.json", scene={"mesh_files": ["CornellBox-Original.obj"]})
    run = etendue("render", "box.json")
    assert (run.code, run.out) == (2, "")
    message = run.err.splitlines()[-1]
    assert "the bundled scene cannot be built here: Not a directory" in message


def test_a_bundled_scene_is_announced_when_it_is_built(
    etendue: Command, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setenv("ETENDUE_CACHE", str(tmp_path / "cache"))
    write("box.json", scene={"mesh_files": ["CornellBox-Original.obj"]})
    announcement = "building the bundled scene box, this once\n"
    assert etendue("render", "box.json").err.startswith(announcement)
    assert announcement not in etendue("check", "box.json").err


def test_the_time_limit_saves_what_is_done(etendue: Command) -> None:
    run = etendue("render", "lit.json", "--spp", "100000000", "--time", "0.2", "--json")
    assert run.code == 0
    said = json.loads(run.out)
    assert 0 < said["spp"] < 100_000_000
    assert "\nthe time is over: " in run.err
    assert " of 100000000 spp are done\n" in run.err
    assert Path("lit.png").exists()


def test_ctrl_c_saves_what_is_done() -> None:
    arguments = ["render", "lit.json", "--spp", "100000000", "--json", "--json-progress"]
    process = subprocess.Popen(
        [sys.executable, "-m", "etendue", *arguments, "-o", "a.exr", "-o", "a.png"],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )
    assert process.stderr is not None
    while (json.loads(process.stderr.readline()).get("spp") or 0) < 1:
        pass
    process.send_signal(signal.SIGINT)
    out, err = process.communicate(timeout=60)
    assert process.returncode == 130, err
    assert json.loads(out)["spp"] > 0
    texts = [json.loads(line).get("text", "") for line in err.splitlines()]
    assert any(text.startswith("interrupted: ") for text in texts)
    assert read("a.exr").max() > 0
    assert read("a.png").max() > 0


def test_ctrl_c_before_the_first_sample_writes_nothing(
    etendue: Command, monkeypatch: pytest.MonkeyPatch
) -> None:
    def interrupted(*arguments: Any, **options: Any) -> Any:
        raise KeyboardInterrupt

    Path("lit.png").write_text("old")
    monkeypatch.setattr("etendue.scene.Scene.render", interrupted)
    run = etendue("render", "lit.json")
    assert run.code == 130
    assert run.err.endswith("\ninterrupted before the first samples; nothing was written\n")
    assert Path("lit.png").read_text() == "old"


def test_ctrl_c_while_loading(etendue: Command, monkeypatch: pytest.MonkeyPatch) -> None:
    def interrupted(*arguments: Any, **options: Any) -> Any:
        raise KeyboardInterrupt

    monkeypatch.setattr("etendue.scene.load", interrupted)
    assert etendue("render", "lit.json") == (130, "", "interrupted\n")


def test_progress_is_never_complete_before_the_end(etendue: Command, monkeypatch: pytest.MonkeyPatch) -> None:
    seen = []
    show = progress._Lines.__call__

    def watched(lines: progress._Lines, status: progress.Status) -> None:
        seen.append((status.fraction, status.words()[0]))
        show(lines, status)

    monkeypatch.setattr(progress._Lines, "__call__", watched)
    run = etendue("render", "lit.json", "--spp", "2000")
    assert run.code == 0
    assert all(percent != "100%" for fraction, percent in seen if fraction < 1)
    assert seen[-1] == (1, "100%")
    assert [line for line in run.err.splitlines() if line.startswith("100%")]


def test_check(etendue: Command) -> None:
    write("lit.json", scene={"materials": [{"name": "flor"}]})
    run = etendue("check", "lit.json")
    assert (run.code, run.err) == (0, "")
    rows = [line.split(None, 1) for line in run.out.splitlines()]
    assert [row[0] for row in rows] == [
        *("scene", "algorithm", "image", "triangles", "lights", "AreaLight"),
        *("memory", "loading", "time", "warning:"),
    ]
    said = {row[0]: row[1] for row in rows}
    assert said["scene"] == "lit.json: no problems, 1 warning"
    assert said["image"] == "16 x 12, 4 samples per pixel"
    assert (said["triangles"], said["lights"]) == ("3", "1")
    # Luminance 8 over half a square unit, times pi.
    assert said["AreaLight"] == '"light": power 12.57, 100%'
    assert said["time"].startswith("about ")
    assert said["warning:"].startswith("lit.json:1: scene.materials[0].name: ")


def test_check_tells_all_problems(etendue: Command) -> None:
    write("bad.json", seed=-1, scene={"mesh_files": ["a.obj", "b.obj"]})
    run = etendue("check", "bad.json", "--set", "camera.fov=0")
    assert (run.code, run.out) == (2, "")
    assert [line.split(": ")[1] for line in run.err.splitlines()] == [
        "camera.fov",
        "seed",
        "scene.mesh_files[0]",
        "scene.mesh_files[1]",
    ]


def test_broken_meshes_are_all_told(etendue: Command) -> None:
    Path("a.obj").write_text("v 0 0 0\nv 1 0 0\nv nan 0 0\nf 1 2 3\n")
    Path("b.obj").write_text("v 0 0 0\nf 1 2 3\n")
    write("bad.json", scene={"mesh_files": ["a.obj", "b.obj"]})
    run = etendue("render", "bad.json")
    assert (run.code, run.out) == (2, "")
    assert "a.obj" in run.err
    assert "b.obj" in run.err
    assert "Traceback" not in run.err


def test_an_empty_scene(etendue: Command) -> None:
    write("bad.json", scene={"mesh_files": []})
    run = etendue("render", "bad.json")
    assert (run.code, run.err) == (
        2,
        "bad.json:1: scene: an empty scene: it names no mesh file and has no sky\n",
    )


def test_schema(etendue: Command) -> None:
    run = etendue("schema")
    assert (run.code, run.err) == (0, "")
    assert json.loads(run.out)["title"] == "Étendue scene"


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="needs a file that is always full")
def test_output_that_cannot_be_printed() -> None:
    with Path("/dev/full").open("w") as full:
        run = subprocess.run(
            [sys.executable, "-m", "etendue", "schema"],
            stdout=full,
            stderr=subprocess.PIPE,
            text=True,
            check=False,
        )
    assert run.returncode == 2
    assert run.stderr.startswith("output: No space left on device\n")
    assert "Traceback" not in run.stderr


def test_a_reader_that_leaves_early() -> None:
    process = subprocess.Popen(
        [sys.executable, "-m", "etendue", "schema"], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    )
    assert process.stdout is not None
    process.stdout.close()
    assert process.stderr is not None
    assert process.stderr.read() == ""
    assert process.wait(timeout=60) == 1


def test_algorithms(etendue: Command) -> None:
    run = etendue("algorithms")
    assert (run.code, run.err) == (0, "")
    assert '    "mis": power, balance, none (default power). ' in run.out
    assert "NaivePathtracer\n" in run.out


def test_doctor(etendue: Command, monkeypatch: pytest.MonkeyPatch) -> None:
    run = etendue("doctor")
    assert (run.code, run.err) == (0, "")
    for name in (
        "etendue",
        "python",
        "core",
        "Embree",
        "oneTBB",
        "instruction set",
        "threads",
        "MB in",
        "numpy",
        "OpenImageIO",
    ):
        assert name in run.out, name
    monkeypatch.setenv("ETENDUE_FILE_CACHE", "much")
    assert 'a number of megabytes is needed (0: no cache), not "much"' in etendue("doctor").out
    monkeypatch.setenv("ETENDUE_FILE_CACHE", "0")
    assert "off (ETENDUE_FILE_CACHE)" in etendue("doctor").out


def test_scenes_are_listed_and_exported(
    etendue: Command, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setenv("ETENDUE_CACHE", str(tmp_path / "cache"))
    before = etendue("scenes", "box")
    assert before.code == 0
    assert "not built yet" in before.out
    run = etendue("scenes", "--export", "out/folder", "box")
    assert (run.code, run.err) == (0, "")
    assert [Path(line).name for line in run.out.splitlines()] == [
        "CornellBox-Original.mtl",
        "CornellBox-Original.obj",
    ]
    assert Path("out/folder/CornellBox-Original.obj").is_file()
    assert "not built yet" not in etendue("scenes", "box").out
    all_names = [line.split()[0] for line in etendue("scenes").out.splitlines()[1:-2]]
    assert all_names == list(models.SCENES)


def test_exporting_to_where_nobody_can_write(
    etendue: Command, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setenv("ETENDUE_CACHE", str(tmp_path / "cache"))
    Path("file").touch()
    run = etendue("scenes", "--export", "file/folder", "box")
    assert (run.code, run.out) == (2, "")
    assert run.err == "file/folder: cannot be written: Not a directory\n"


def test_help_says_everything_in_words(etendue: Command) -> None:
    run = etendue("render", "--help")
    assert (run.code, run.err) == (0, "")
    for option in (
        *("--output", "--spp", "--time", "--size", "--algorithm", "--threads", "--seed"),
        *("--data", "--set", "--json", "--quiet"),
    ):
        assert option in run.out
    assert "scene.materials[floor].roughness=0.2" in run.out
    assert etendue("--version").out.startswith("etendue ")


def test_help_is_quick() -> None:
    heavy = ("numpy", "pydantic", "OpenImageIO", "rich")
    code = f"import sys, etendue.cli.commands; print([name for name in {heavy} if name in sys.modules])"
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert run.stdout == "[]\n"
