"""The render behind the window, without a window."""

from __future__ import annotations

import json
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
import pytest

import etendue
from etendue.errors import EtendueError, SceneError
from etendue.viewer.document import Document
from etendue.viewer.history import History
from etendue.viewer.pictures import Look
from etendue.viewer.scenes import Scenes
from etendue.viewer.session import Session
from etendue.viewer.status import State, Status
from etendue.viewer.viewer import Viewer

pytestmark = pytest.mark.usefixtures("lit_scene")
CONFIGS = Path(__file__).resolve().parents[2] / "configs"


@pytest.fixture
def session() -> Iterator[Session]:
    session = Session(Scenes(), 2)
    yield session
    session.close()
    assert not [thread for thread in threading.enumerate() if thread.name.startswith("etendue")]


def wait(condition: Callable[[], object]) -> None:
    deadline = time.monotonic() + 60
    while not condition():
        assert time.monotonic() < deadline
        time.sleep(0.001)


def stands_still(session: Session) -> bool:
    """Whether nothing renders: whatever does spends time."""
    before = session.status.seconds
    time.sleep(0.001)
    return session.status.seconds == before


def document(**framebuffer: int) -> Document:
    document = Document(etendue.read_config("lit.json"))
    document.set({("framebuffer", key): value for key, value in framebuffer.items()})
    return document


def test_a_finished_render_is_that_of_the_library(session: Session) -> None:
    shown = document(res_w=50, res_h=30, sppx=5)
    session.show(shown.config)
    wait(lambda: session.status.state is State.DONE)
    ours, theirs = session.film(), etendue.load(shown.config).render()
    assert ours is not None
    for array in ("sum", "sum_squares", "half_sum", "sample_count"):
        assert np.array_equal(getattr(ours, array), getattr(theirs, array)), array
    assert ours.complete
    assert session.status.percent == 100
    ours.write("ours.film.exr")
    etendue.load(shown.config).render(spp=8, resume=etendue.read_film("ours.film.exr"))


def test_more_samples_go_on_and_fewer_begin_again(session: Session) -> None:
    shown = document(sppx=4)
    session.show(shown.config)
    wait(lambda: session.status.state is State.DONE)
    first = session.renderer
    for spp, kept in ((9, True), (9, True), (3, False)):
        shown.set({("framebuffer", "sppx"): spp})
        session.show(shown.config)
        wait(lambda: session.status.state is State.DONE and session.status.goal == spp)  # noqa: B023
        assert (session.renderer is first) == kept
        film = session.film()
        assert film is not None
        assert np.array_equal(film.sum, etendue.load(shown.config).render().sum)


def test_what_is_shown_before_it_has_learned_gives_no_film(session: Session) -> None:
    """And more samples asked for meanwhile do not go on from there."""
    shown = Document(etendue.read_config(CONFIGS / "a04_mis.json"))
    shown.set({("framebuffer", "res_w"): 32, ("framebuffer", "res_h"): 24, ("framebuffer", "sppx"): 4})
    session.show(shown.config)
    wait(lambda: session.renderer is not None)
    for spp in (5, 6):
        shown.set({("framebuffer", "sppx"): spp})
        session.show(shown.config)
    wait(lambda: session.status.state is State.DONE and session.status.goal == 6)
    film = session.film()
    assert film is not None
    assert np.array_equal(film.sum, etendue.load(shown.config).render().sum)


def test_every_change_shows_something_however_fast_they_come(session: Session) -> None:
    shown = document(res_w=200, res_h=150, sppx=100_000)
    numbers: set[int] = set()
    deadline, step = time.monotonic() + 60, 0
    # Were first passes cut short, changes that never end would leave nothing to be seen.
    while step < 60 or len(numbers) <= 10:
        assert time.monotonic() < deadline
        step += 1
        shown.set({("camera", "fov"): 40.0 + step % 100 / 2})
        session.show(shown.config)
        if session.picture is not None and session.renderer is not None:
            numbers.add(session.picture.number)
            # A first pass is never cut short.
            assert session.renderer.sample_count()[::16, ::16].all()
        time.sleep(0.02)
    last = shown.config.camera.fov
    wait(lambda: session.scene is not None and session.scene.config.camera.fov == last)
    assert session.status.percent < 100


def test_pause_abort_and_restart(session: Session) -> None:
    shown = document(res_w=64, res_h=64, sppx=1_000_000)
    session.show(shown.config)
    wait(lambda: session.status.spp > 2)
    session.pause()
    wait(lambda: session.status.state is State.PAUSED)
    wait(lambda: stands_still(session))
    paused = session.status.spp
    time.sleep(0.1)
    assert session.status.spp == paused
    session.pause(False)
    wait(lambda: session.status.spp > paused)
    session.abort()
    assert session.status.state is State.ABORTED
    wait(lambda: stands_still(session))
    aborted = session.status.spp
    time.sleep(0.1)
    assert session.status.spp == aborted
    renderer = session.renderer
    session.restart(threads=1)
    wait(lambda: session.renderer is not renderer and session.status.state is State.RENDERING)


def test_a_scene_that_cannot_be_loaded(session: Session) -> None:
    shown = document()
    session.show(shown.config)
    wait(lambda: session.status.state is State.DONE)
    shown.set({("scene", "mesh_files"): ["missing.obj"]})
    session.show(shown.config)
    wait(lambda: session.status.state is State.FAILED)
    assert "missing.obj" in (session.status.problem or "")
    shown.undo()
    session.show(shown.config)
    wait(lambda: session.status.state is State.DONE)
    assert session.status.problem is None


def test_pictures(session: Session) -> None:
    shown = document(res_w=40, res_h=30, sppx=8)
    session.show(shown.config)
    wait(lambda: session.status.state is State.DONE)
    wait(lambda: session.picture is not None and session.picture.stride == 1)
    film = session.film()
    assert film is not None
    for look in (Look(exposure=2, view="agx"), Look(exposure=0.5)):
        wanted = film.tonemapped(look.exposure, look.view)
        session.look(look)
        wait(lambda: session.picture and np.array_equal(session.picture.pixels, wanted))  # noqa: B023
    for mode in ("albedo", "normal", "depth", "samples", "convergence", "variance"):
        before = session.picture
        session.look(Look(mode=mode))
        wait(lambda: session.picture is not before)  # noqa: B023
        assert session.picture is not None
        assert session.picture.pixels.shape == (30, 40, 3)
        assert mode == "samples" or np.ptp(session.picture.pixels) > 20
    noisy = film.tonemapped()
    session.look(Look(denoised=True))
    wait(lambda: session.picture is not None and np.abs(session.picture.pixels - noisy.astype(int)).max() > 3)
    assert session.take_trouble() is None


@pytest.mark.parametrize(("fraction", "percent"), [(0, 0), (0.005, 0), (0.99999, 99), (1, 99)])
def test_progress_is_not_100_before_the_end(fraction: float, percent: int) -> None:
    assert Status(State.RENDERING, fraction=fraction).percent == percent
    assert Status(State.DONE, fraction=1).percent == 100


def test_a_beauty_render_is_that_of_the_library(session: Session) -> None:
    shown = document(res_w=48, res_h=32)
    shown.set({("beauty_render",): True, ("error_eps",): 0.05})
    session.show(shown.config)
    wait(lambda: session.status.state is State.DONE)
    assert session.status.goal is None
    assert 0 < (session.status.error or 0) <= 0.05
    assert session.errors
    ours, theirs = session.film(), etendue.load(shown.config).render()
    assert ours is not None
    assert ours.complete
    assert np.array_equal(ours.sample_count, theirs.sample_count)
    assert np.array_equal(ours.sum, theirs.sum)
    for changes in ({("error_eps",): 0.03}, {("beauty_render",): False}):
        shown.set(changes)
        session.show(shown.config)
        wait(lambda: session.status.state is State.DONE and session.scene.config.data == shown.config.data)  # type: ignore[union-attr]
        film = session.film()
        assert film is not None
        assert np.array_equal(film.sum, etendue.load(shown.config).render().sum)


def test_history() -> None:
    history = History(0)
    for state, gesture in ((1, None), (2, "drag"), (3, "drag"), (4, "fly"), (5, None)):
        history.push(state, gesture)
    assert [history.undo() for _ in range(5)] == [4, 3, 1, 0, 0]
    assert not history.can_undo
    assert [history.redo() for _ in range(5)] == [1, 3, 4, 5, 5]
    history.undo()
    history.push(9)
    assert not history.can_redo
    history.push(10, "drag")
    history.end_gesture()
    history.push(11, "drag")
    assert history.undo() == 10


def test_what_is_not_allowed_changes_nothing() -> None:
    shown = document()
    before = shown.config
    with pytest.raises(SceneError, match="fov"):
        shown.set({("camera", "fov"): 200.0})
    with pytest.raises(SceneError, match="dir"):
        shown.set({("camera", "dir"): [0, 0, 0]})
    assert shown.config is before
    assert not shown.is_changed or shown.can_undo


def test_saving_elsewhere_keeps_the_files(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    shown = document(sppx=2)
    folder = tmp_path / "elsewhere"
    folder.mkdir()
    shown.set_material("floor", {"roughness": 0.25})
    shown.set_material("floor", {"roughness": None, "type": "metal"})
    before = etendue.load(shown.config).render()
    assert shown.is_changed
    shown.save(folder / "saved.json")
    assert not shown.is_changed
    monkeypatch.chdir("/")  # what is found from where one stands proves nothing
    saved = json.loads((folder / "saved.json").read_text())
    assert saved["scene"]["materials"] == [{"name": "floor", "type": "metal"}]
    assert np.array_equal(etendue.load(folder / "saved.json").render().sum, before.sum)
    assert np.array_equal(etendue.load(shown.config).render().sum, before.sum)
    bundled = Document(etendue.Config.from_data({"scene": {"mesh_files": ["mis.obj"]}}))
    bundled.save(folder / "bundled.json")
    assert json.loads((folder / "bundled.json").read_text())["scene"]["mesh_files"] == ["mis.obj"]


def test_the_camera_goes_to_the_clipboard_and_back() -> None:
    viewer = Viewer(["lit.json"])
    try:
        text = viewer.copied_camera()
        start = viewer.document.config.camera
        viewer.document.set({("camera", "fov"): 33.0, ("camera", "pos"): [1, 2, 3]})
        viewer.paste_camera(text)
        assert viewer.document.config.camera == start
        viewer.paste_camera(json.dumps({"pos": [4, 5, 6]}))
        assert viewer.document.config.camera.pos == (4, 5, 6)
        for wrong in ("", "[1]", "pos"):
            with pytest.raises(EtendueError, match="no camera"):
                viewer.paste_camera(wrong)
        with pytest.raises(EtendueError, match="fov"):
            viewer.paste_camera(json.dumps({"fov": -3}))
    finally:
        viewer.close()


def test_nothing_but_the_window_needs_the_extra() -> None:
    code = "import sys, etendue.cli.commands, etendue.viewer.viewer; sys.exit('imgui_bundle' in sys.modules)"
    subprocess.run([sys.executable, "-c", code], check=True)


def test_a_light_is_lit_again_as_it_was() -> None:
    viewer = Viewer(["lit.json"])
    try:
        for strength in (None, 5.0):
            viewer.document.set_material("light", {"emissive_strength": strength})
            viewer.switch_light("light", False)
            assert viewer.document.config.scene.materials[-1].emissive_strength == 0
            viewer.switch_light("light", True)
            assert viewer.document.config.scene.materials[-1].emissive_strength == strength
    finally:
        viewer.close()
