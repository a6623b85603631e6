"""The window: flying and looking, keys, the split view, the inspector, questions for files."""

from __future__ import annotations

import ctypes
import os
import threading
from collections.abc import Callable
from pathlib import Path

import glfw
import numpy as np
import pytest
from imgui_bundle import imgui
from imgui_bundle.glfw_utils import glfw_window_hello_imgui

from etendue.cli import main
from etendue.display.views import VIEWS
from etendue.film import save_pixels
from etendue.loaders.image import load_image
from etendue.viewer.pictures import MODES
from etendue.viewer.status import State
from etendue.viewer.viewer import Viewer

from .drive import Hand, drive

Key = imgui.Key
pytestmark = [pytest.mark.usefixtures("screen", "lit_scene"), pytest.mark.xdist_group("viewer")]
BIG = ("framebuffer.res_w=64", "framebuffer.res_h=48", "framebuffer.sppx=1000000")


def camera_of(hand: Hand) -> tuple[np.ndarray, np.ndarray]:
    camera = hand.viewer.document.config.camera
    return np.array(camera.pos), np.array(camera.dir)


def test_flying_looking_and_taking_it_back() -> None:
    viewer = Viewer(["lit.json"], overrides=BIG)

    def steps(hand: Hand) -> None:
        document, context = viewer.document, hand.context
        hand.wait_for_picture()
        start = document.config
        ways = {Key.w: (0, -0.29, -0.96), Key.s: (0, 0.29, 0.96), Key.a: (-1, 0, 0), Key.d: (1, 0, 0)}
        for key, way in {**ways, Key.r: (0, 1, 0), Key.f: (0, -1, 0)}.items():
            before, direction = camera_of(hand)
            context.key_hold(int(key), 0.3)
            context.yield_(2)
            moved = camera_of(hand)[0] - before
            assert moved @ np.array(way) / np.linalg.norm(moved) > 0.99, key
            assert np.array_equal(camera_of(hand)[1], direction)
            hand.press(Key.mod_ctrl, Key.z)
            # All of one flight is one step.
            assert np.array_equal(camera_of(hand)[0], before)
        hand.press(Key.mod_ctrl, Key.y)
        assert not np.array_equal(camera_of(hand)[0], start.camera.pos)
        hand.press(Key.mod_ctrl, Key.z)
        assert document.config.data == start.data

        context.mouse_move("//Image/canvas")
        context.mouse_drag_with_delta((60, 0))
        context.yield_(2)
        turned = camera_of(hand)[1]
        assert turned[0] < 0  # what is under the mouse follows it to the right
        hand.press(Key.mod_ctrl, Key.z)
        assert document.config.data == start.data
        speed = viewer.speed
        context.mouse_wheel((0, 2))
        context.yield_(2)
        assert viewer.speed > speed

        context.mouse_move("//Image/canvas")
        context.mouse_click(1)
        context.yield_(2)
        assert viewer.material == "floor"
        assert not document.config.auto_focus
        assert 1 < document.config.camera.focal_depth < 10
        hand.wait_for_picture()

    drive(viewer, steps)


def test_keys_modes_and_views() -> None:
    viewer = Viewer(["lit.json"], overrides=BIG)

    def steps(hand: Hand) -> None:
        hand.wait_for_picture()
        hand.wait(lambda: viewer.session.status.spp > 4, "samples")
        for number, mode in enumerate(MODES, start=1):
            shown = viewer.session.picture
            hand.press(getattr(Key, f"_{number}"))
            assert viewer.look.mode == mode
            if number > 1:
                hand.wait(lambda shown=shown: viewer.session.picture is not shown, f"picture of {mode}")
        hand.press(Key._1)
        hand.open("Preview")
        for view in reversed(VIEWS):
            hand.choose(hand.place("Preview", "##tone mapping"), view)
            assert viewer.look.view == view
        hand.press(Key.equal)
        assert viewer.document.config.framebuffer.exposure == pytest.approx(2**0.5, rel=1e-4)
        hand.press(Key.space)
        hand.wait(lambda: viewer.session.status.state is State.PAUSED, "pause")
        clock = [-1.0]

        def stands_still() -> bool:
            before, clock[0] = clock[0], viewer.session.status.seconds
            return clock[0] == before

        hand.wait(stands_still, "end of the last samples")
        samples = viewer.session.status.spp
        hand.context.yield_(10)
        assert viewer.session.status.spp == samples
        hand.click(hand.place("Preview", "###pause"))
        hand.wait(lambda: viewer.session.status.spp > samples, "more samples")
        hand.click(hand.place("Preview", "Abort"))
        hand.wait(lambda: viewer.session.status.state is State.ABORTED, "end")
        hand.click(hand.place("Preview", "Restart"))
        hand.wait(lambda: viewer.session.status.state is State.RENDERING, "restart")
        hand.press(Key.tab)
        assert viewer.page is None
        hand.open("Help")

    drive(viewer, steps)


def test_split_view() -> None:
    viewer = Viewer(["lit.json"], overrides=BIG)

    def steps(hand: Hand) -> None:
        hand.open("Algorithms")
        hand.click(hand.place("Algorithms", "Split view"))
        split = viewer.split
        assert split is not None
        hand.wait(lambda: len(viewer.session.errors) > 1 and len(split.session.errors) > 1, "errors")
        right = split.session.scene
        assert right is not None
        assert right.config.algorithm == "NaivePathtracer"
        assert viewer.session.scene is not None
        assert right.core is viewer.session.scene.core
        hand.choose(hand.place("Algorithms", "right/##right"), "Pathtracer")
        hand.choose(hand.place("Algorithms", "right/##mis"), "none")
        hand.wait(lambda: split.session.scene.config.mis == "none", "other estimator")  # type: ignore[union-attr]
        assert viewer.document.config.mis == "power"
        hand.context.mouse_move("//Image/canvas")
        hand.context.mouse_drag_with_delta((40, 0))
        hand.context.yield_(2)
        assert split.position > 0.55
        assert viewer.document.config.camera.dir == (0, -0.3, -1)
        hand.press(Key.x)
        assert viewer.split is None

    drive(viewer, steps)
    assert not [thread for thread in threading.enumerate() if thread.name.startswith("etendue")]


def test_pixel_inspector() -> None:
    viewer = Viewer(["lit.json"], overrides=BIG[:2] + ("framebuffer.sppx=4",))

    def steps(hand: Hand) -> None:
        hand.wait_until_done()
        hand.press(Key.i)
        hand.context.window_move("//Pixel inspector", (0, 300))
        hand.context.mouse_move("//Image/canvas")
        hand.context.mouse_click(0)
        hand.context.yield_(2)
        assert viewer.pixel is not None
        x, y = viewer.pixel
        assert 0 <= x < 64
        assert 0 <= y < 48
        renderer, scene = viewer.session.renderer, viewer.session.scene
        assert renderer is not None
        assert scene is not None
        paths = viewer.replays()
        assert [path.sample for path in paths] == [3, 2, 1, 0]
        mean = np.mean([path.radiance for path in paths], axis=0)
        assert np.allclose(mean, renderer.pixel(x, y)[0], rtol=1e-5)  # type: ignore[index]
        hand.context.item_open(f"//Pixel inspector/###{paths[0].sample}")
        hand.context.yield_(2)
        assert viewer.document.config.camera.dir == (0, -0.3, -1)

    drive(viewer, steps)


def test_files_are_asked_for() -> None:
    viewer = Viewer(["lit.json"], overrides=BIG[:2] + ("framebuffer.sppx=2",))

    def steps(hand: Hand) -> None:
        hand.wait_until_done()
        for button, name in (("Save PNG", "a.png"), ("Save EXR", "a.exr")):
            hand.open("Input/Output")
            hand.click(hand.place("Input/Output", button))
            hand.type("//Save rendering/##file", f"nowhere/{name}")
            assert viewer.question is not None
            assert "there is no folder nowhere" in viewer.question.problem
            hand.type("//Save rendering/##file", name)
            hand.wait(Path(name).is_file, name)
        film = viewer.session.film()
        assert film is not None
        assert np.array_equal(load_image(Path("a.exr"), "environment").pixels, film.image)
        hand.press(Key.mod_ctrl, Key.o)
        hand.type("//Load config/##file", "missing.json")
        assert viewer.question is not None
        assert "missing.json" in viewer.question.problem
        hand.click("//Load config/Cancel")
        hand.open("Scene")
        before = viewer.document.config
        hand.click(hand.place("Scene", "Clear"))
        assert viewer.document.config.scene.mesh_files == []
        hand.wait_for_picture()
        hand.click(hand.place("Scene", "Add mesh"))
        hand.type("//Add mesh/##file", "lit.obj")
        hand.wait_for_picture()
        assert viewer.session.scene is not None
        assert viewer.session.scene.core.triangle_count == 3
        hand.press(Key.mod_ctrl, Key.z)
        hand.press(Key.mod_ctrl, Key.z)
        assert viewer.document.config.data == before.data

    drive(viewer, steps)


def test_a_scene_that_cannot_be_loaded_is_told(lit_scene: Callable[..., None]) -> None:
    viewer = Viewer(["lit.json"], overrides=BIG)

    def steps(hand: Hand) -> None:
        hand.wait_for_picture()
        Path("broken.obj").write_text("f 1 2 3\n")
        viewer.attempt(lambda: viewer.open(["broken.obj"]))
        hand.wait(lambda: viewer.session.status.state is State.FAILED, "message")
        assert "broken.obj" in (viewer.session.status.problem or "")
        assert viewer.session.picture is not None
        hand.press(Key.mod_ctrl, Key.z)
        hand.wait(lambda: viewer.session.status.state is State.RENDERING, "picture after undo")
        assert viewer.session.status.problem is None
        viewer.attempt(lambda: viewer.open(["lit.mtl"]))
        assert viewer.message is not None
        assert "neither a scene file nor a mesh" in viewer.message[0]

    drive(viewer, steps)


def test_dropped_files() -> None:
    viewer = Viewer(overrides=BIG)
    sky = np.ones((2, 4, 3), np.float32)
    save_pixels(Path("sky.hdr"), sky, {})

    def steps(hand: Hand) -> None:
        hand.wait_for_picture()
        # The callback that the window has given to GLFW, as the desktop would call it.
        window = glfw_window_hello_imgui()
        received = glfw.set_drop_callback(window, None)

        def drop(*names: str) -> None:
            paths = (ctypes.c_char_p * len(names))(*(name.encode() for name in names))
            received(window, len(names), paths)

        drop("lit.json")
        assert viewer.document.config.path == Path("lit.json")
        drop("sky.hdr", "lit.obj")
        scene = viewer.document.config.scene
        assert scene.sky is not None
        assert Path(scene.sky.envmap or "").name == "sky.hdr"
        assert [Path(name).name for name in scene.mesh_files] == ["lit.obj", "lit.obj"]
        hand.wait_for_picture()
        drop("missing.obj")
        assert viewer.message is not None
        assert "no such file" in viewer.message[0]

    drive(viewer, steps)


def run(*arguments: str) -> int:
    with pytest.raises(SystemExit) as ended:
        main(["view", *arguments])
    return int(ended.value.code or 0)


def test_screenshots() -> None:
    assert run("lit.json", "--screenshot", "shot.png", "--after", "0.5") == 0
    pixels = load_image(Path("shot.png"), "colour").pixels
    assert pixels.shape[:2] == (800, 1280)
    assert np.ptp(pixels[100:600, 500:1000]) > 50
    assert run("--screenshot", "empty.png", "--after", "0") == 0
    assert Path("empty.png").is_file()


def test_without_a_display(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    for name in ("DISPLAY", "WAYLAND_DISPLAY"):
        monkeypatch.delenv(name, raising=False)
    assert run("lit.json") == 2
    assert "no display" in (told := capsys.readouterr().err)
    assert "etendue render" in told
    monkeypatch.setenv("DISPLAY", ":7654")
    assert run("lit.json") == 2
    assert "no display" in capsys.readouterr().err
    assert os.environ["DISPLAY"] == ":7654"


def test_without_the_extra(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    monkeypatch.setattr("importlib.util.find_spec", lambda name: None)
    assert run("lit.json") == 2
    assert 'pip install "etendue[viewer]"' in capsys.readouterr().err


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        (["missing.json"], "missing.json"),
        (["lit.mtl"], "neither a scene file nor a mesh"),
        (["lit.json", "--after", "3"], "--screenshot"),
        (["lit.json", "--screenshot", "shot.gif"], "shot.gif"),
        (["lit.json", "--threads", "-1"], "--threads"),
        (["missing.hdr"], "no such file"),
    ],
)
def test_refusals(arguments: list[str], told: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert run(*arguments) == 2
    assert told in capsys.readouterr().err
