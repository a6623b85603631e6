"""Many random changes in a row: nothing crashes, no memory is lost, no thread is left behind."""

from __future__ import annotations

import ctypes
import dataclasses
import gc
import random
import threading
from pathlib import Path

import pytest
from imgui_bundle import imgui

from etendue import _core
from etendue.display.views import VIEWS
from etendue.viewer.navigation import flown, turned
from etendue.viewer.pages import PAGES
from etendue.viewer.pictures import MODES
from etendue.viewer.viewer import Viewer

from .drive import Hand, drive
from .test_controls import scene_file

pytestmark = [pytest.mark.usefixtures("screen"), pytest.mark.xdist_group("viewer")]
PATIENT = ("framebuffer.res_w=160", "framebuffer.res_h=120", "framebuffer.sppx=1000")


def memory() -> int:
    """Bytes of this process that are in memory, without what is free and kept for later."""
    gc.collect()
    ctypes.CDLL(None).malloc_trim(0)
    return int(Path("/proc/self/statm").read_text().split()[1]) * 4096


def change(viewer: Viewer, hand: Hand, dice: random.Random) -> None:
    """One change of any kind, allowed or not, as quickly as a hand can make it."""
    document = viewer.document
    camera = document.config.camera
    names = [surface.material.name for surface in viewer.session.scene.surfaces.of_meshes]  # type: ignore[union-attr]
    kind = dice.choice(_core.material_types()).name
    info = dice.choice(_core.algorithms())
    changes = [
        lambda: document.set(flown(camera, *(dice.uniform(-0.1, 0.1) for _ in range(3))), "fly"),
        lambda: document.set(turned(camera, dice.uniform(-0.2, 0.2), dice.uniform(-0.2, 0.2)), "look"),
        lambda: document.set({("camera", "fov"): dice.uniform(-20, 200)}),
        lambda: document.set({("camera", "lens_radius"): dice.choice([0.0, 0.05])}),
        lambda: document.set({("algorithm",): info.name}),
        lambda: document.set({("mis",): dice.choice(["power", "none"]), ("seed",): dice.randrange(9)}),
        lambda: document.set({("max_cam_path_length",): dice.randrange(0, 12)}),
        lambda: document.set_material(dice.choice(names), {"type": kind, "roughness": dice.random()}),
        lambda: document.set_material(
            dice.choice(names), {"emissive_strength": dice.choice([0.0, 5.0, None])}
        ),
        lambda: document.set({("scene", "sky"): dice.choice([None, {"intensity": dice.random()}])}),
        lambda: document.set({("framebuffer", "res_w"): dice.choice([160, 160, 96])}),
        document.undo,
        document.undo,
        document.redo,
        viewer.restart,
        viewer.pause,
        viewer.abort,
        viewer.toggle_split,
        lambda: viewer.focus(dice.uniform(0, 160), dice.uniform(0, 120)),
        lambda: setattr(viewer, "look", dataclasses.replace(viewer.look, mode=dice.choice(list(MODES)))),
        lambda: setattr(viewer, "look", dataclasses.replace(viewer.look, view=dice.choice(list(VIEWS)))),
        lambda: setattr(viewer, "page", dice.choice(list(PAGES))),
        lambda: setattr(viewer, "pixel", (dice.randrange(96), dice.randrange(120))),
        lambda: hand.press(imgui.Key.i),
    ]
    viewer.attempt(dice.choice(changes))
    hand.context.yield_(dice.choice([1, 1, 2, 5]))


@pytest.mark.parametrize("number", [40, pytest.param(500, marks=pytest.mark.slow)])
def test_changes_in_a_row(number: int) -> None:
    viewer = Viewer([scene_file("box")], overrides=PATIENT)
    used: list[int] = []

    def steps(hand: Hand) -> None:
        hand.wait_for_picture()
        dice = random.Random(1)
        for _ in range(2):
            for _ in range(number):
                change(viewer, hand, dice)
            settle(hand)
            used.append(memory())

    def settle(hand: Hand) -> None:
        if viewer.split is not None:
            viewer.toggle_split()
        viewer.inspecting, viewer.pixel = False, None
        viewer.look = dataclasses.replace(viewer.look, mode="image")
        viewer.document.set(
            {("framebuffer", "res_w"): 160, ("max_cam_path_length",): 5, ("algorithm",): "Pathtracer"}
        )
        viewer.restart()
        hand.wait_for_picture()
        hand.wait(lambda: viewer.session.status.spp >= 8, "samples")
        assert viewer.session.status.problem is None

    drive(viewer, steps)
    # Fewer have not yet done once all that there is.
    if number >= 500:
        assert used[1] < used[0] * 1.05, f"memory grew from {used[0]} to {used[1]} bytes"
    assert not [thread for thread in threading.enumerate() if thread.name.startswith("etendue")]
