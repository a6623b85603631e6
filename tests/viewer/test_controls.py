"""Every key of the scene file has a control that changes it, and what is saved renders the same."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from etendue import _core, read_film
from etendue.config.located_json import Loc
from etendue.config.schema import Schema
from etendue.models import SCENES
from etendue.viewer.pages.algorithms import label_of
from etendue.viewer.pages.camera import FIELDS
from etendue.viewer.pages.settings import LABELS
from etendue.viewer.viewer import Viewer

from .drive import Hand, drive

ROOT = Path(__file__).resolve().parents[2]
SMALL = ("framebuffer.res_w=48", "framebuffer.res_h=32", "framebuffer.sppx=2")
# Their loading takes seconds.
HEAVY = ("spz", "sibenik")

pytestmark = [pytest.mark.usefixtures("screen"), pytest.mark.xdist_group("viewer")]


def scene_file(name: str) -> Path:
    return ROOT / "configs" / f"a04_{name}.json"


def another(node: Schema, value: Any, limits: Schema) -> Any:
    """Another value that is allowed, and renders something."""
    if "enum" in node:
        return next(choice for choice in reversed(node["enum"]) if choice != value)
    if node["type"] == "boolean":
        return not value
    if node["type"] == "array":
        highest = limits.get("maximum", np.inf)
        return [v + 0.125 if v + 0.125 <= highest else v - 0.125 for v in value]
    if node["type"] == "integer":
        return value + 1 if value < 40 else value - 3
    highest = min(node.get("maximum", np.inf), node.get("exclusiveMaximum", np.inf))
    return value + 0.25 if value + 0.25 < highest else value / 2


def move(hand: Hand, page: str, label: str, loc: Loc) -> None:
    """Gives a control another value by mouse and keyboard, and looks at what became of it."""
    document = hand.viewer.document
    node, limits, value = document.schema(loc), document.limits(loc), document.value(loc)
    new = another(node, value, limits)
    place = hand.place(page, f"##{label}")
    if "enum" in node:
        hand.choose(place, new)
    elif node["type"] == "boolean":
        hand.click(place)
    elif node["type"] == "array":
        for index, part in enumerate(new):
            hand.type(f"{place}/$${index}", part)
    else:
        hand.type(place, new)
    got = document.value(loc)
    same = got == new if isinstance(new, (bool, str)) else np.allclose(got, new, rtol=1e-5)
    assert same, f"{page}: {label}: {value} should have become {new}, and is {got}"


def move_all(hand: Hand) -> None:
    """Moves every control of the scene file once."""
    document = hand.viewer.document
    moved: set[Loc] = {("$schema",)}

    def once(page: str, label: str, loc: Loc) -> None:
        move(hand, page, label, loc)
        moved.add(loc)

    hand.open("Settings")
    for loc, label in LABELS.items():
        once("Settings", label, loc)
        if loc == ("beauty_render",):  # two samples are compared below
            hand.click(hand.place("Settings", f"##{label}"))
            assert not document.config.beauty_render
    for key in document.keys_of():
        if key in ("mis", "path_reuse", "sampling", "sampler", "filter", "seed", "max_light_path_length"):
            once("Settings", key, (key,))
    hand.open("Camera")
    once("Camera", "auto focal depth", ("auto_focus",))
    for key in document.keys_of(("camera",)):
        if key != "perspective" or not document.config.auto_focus:
            once("Camera", FIELDS[key], ("camera", key))
    hand.open("Preview")
    once("Preview", "exposure", ("framebuffer", "exposure"))
    move_materials(hand)
    hand.open("Algorithms")
    for info in _core.algorithms():
        hand.click(hand.place("Algorithms", info.name))
        assert document.config.algorithm == info.name
        for parameter in info.parameters:
            once("Algorithms", label_of(parameter.name), (parameter.name,))
    hand.click(hand.place("Algorithms", "Pathtracer"))
    moved.add(("algorithm",))
    known = [(key,) for key in document.keys_of() if key not in ("framebuffer", "camera", "scene")]
    known += [(section, key) for section in ("framebuffer", "camera") for key in document.keys_of((section,))]
    missing = [loc for loc in known if loc not in moved and loc != ("framebuffer", "hdr")]
    assert not missing, f"no control was moved for {missing}"


def move_some(hand: Hand) -> None:
    """Moves a control of each kind."""
    hand.open("Camera")
    move(hand, "Camera", "pos", ("camera", "pos"))
    move(hand, "Camera", "fov", ("camera", "fov"))
    hand.open("Settings")
    move(hand, "Settings", "sampler", ("sampler",))
    move(hand, "Settings", "RR threshold", ("rr_threshold",))
    hand.open("Algorithms")
    hand.click(hand.place("Algorithms", "NaivePathtracer"))


def move_materials(hand: Hand) -> None:
    """Moves every control of the sky, of one light and of one material."""
    viewer, document = hand.viewer, hand.viewer.document
    hand.open("Scene")
    hand.wait_for_picture()
    scene = viewer.session.scene
    assert scene is not None
    if document.config.scene.sky is None:
        hand.click(hand.place("Scene", "sky/Add sky").replace("\\", ""))
        hand.wait_for_picture()
    sky = hand.place("Scene", "")
    hand.type(f"{sky}sky/sky/##strength", 0.75)
    assert document.value(("scene", "sky", "intensity")) == 0.75
    hand.click(f"{sky}sky/sky/Remove sky")
    assert document.config.scene.sky is None
    hand.press(_ctrl(), _key("z"))
    assert document.value(("scene", "sky", "intensity")) == 0.75

    resolved = scene.surfaces.resolved(document.config.scene)
    lamps = [m.name for m in resolved.values() if m.emissive_strength > 0]
    if lamps:
        lamp = f"{sky}light {lamps[0]}/{lamps[0]}".replace("\\", "")
        patches = [p.emissive_strength for p in document.config.scene.materials if p.name == lamps[0]]
        for text, strength in (("Extinguish", 0.0), ("Light", patches[-1] if patches else None)):
            hand.click(f"{lamp}/###switch")
            assert patch(document, lamps[0]).emissive_strength == strength, text
        hand.type(f"{lamp}/##strength", 7.5)
        assert patch(document, lamps[0]).emissive_strength == 7.5
        hand.type(f"{lamp}/##colour/##Y", 0.625)
        assert patch(document, lamps[0]).albedo_col[1] == 0.625
    name = next(m.name for m in resolved.values() if m.name not in lamps)
    hand.context.item_open(f"{sky}###materials")
    material = f"{sky}material {name}/{name}"
    hand.context.item_open(material)
    for kind in _core.material_types():
        hand.choose(f"{material}/##type", kind.name)
        assert patch(document, name).type == kind.name
    hand.choose(f"{material}/##type", "plastic")
    for key, value in (("ior", 1.75), ("roughness", 0.5), ("absorb", 0.25), ("emissive_strength", 0.125)):
        hand.type(f"{material}/##{key}", value)
        assert getattr(patch(document, name), key) == value
        hand.click(f"{material}/x##{key}")
        assert getattr(patch(document, name), key) is None
        hand.press(_ctrl(), _key("z"))
        assert getattr(patch(document, name), key) == value
    hand.type(f"{material}/##albedo_col/##X", 0.25)
    assert patch(document, name).albedo_col[0] == 0.25
    hand.click(f"{material}/##coated")
    assert patch(document, name).coated is True


def patch(document: Any, name: str) -> Any:
    return next(p for p in reversed(document.config.scene.materials) if p.name == name)


def _ctrl() -> Any:
    from imgui_bundle import imgui

    return imgui.Key.mod_ctrl


def _key(name: str) -> Any:
    from imgui_bundle import imgui

    return getattr(imgui.Key, name)


def cases() -> list[Any]:
    others = [name for name in SCENES if name != "box"]
    some = [pytest.param(name, move_some, marks=[pytest.mark.slow] * (name in HEAVY)) for name in others]
    most = [pytest.param(name, move_all, marks=[pytest.mark.slow] * (name != "box")) for name in SCENES]
    return some + most


@pytest.mark.parametrize(("name", "moves"), cases())
def test_what_is_saved_renders_the_same_from_the_command_line(
    name: str, moves: Callable[[Hand], None], tmp_path: Path
) -> None:
    viewer = Viewer([scene_file(name)], overrides=SMALL)
    saved, film = tmp_path / "saved.json", tmp_path / "window.film.exr"

    def steps(hand: Hand) -> None:
        hand.wait_for_picture()
        moves(hand)
        hand.wait_for_picture()
        hand.wait_until_done()
        for button, path in (("Save config", saved), ("Save film", film)):
            hand.open("Input/Output")
            hand.click(hand.place("Input/Output", button))
            hand.type(f"//{button}/##file", str(path))
            if viewer.question is not None:
                hand.click(f"//{button}/###ok")
            hand.wait(path.is_file, "file")

    drive(viewer, steps)
    command = [
        sys.executable,
        "-m",
        "etendue",
        "render",
        str(saved),
        "-q",
        "--film",
        str(tmp_path / "line.film.exr"),
    ]
    subprocess.run([*command, "-o", str(tmp_path / "line.png")], check=True)
    ours, theirs = read_film(film), read_film(tmp_path / "line.film.exr")
    for array in ("sum", "sum_squares", "half_sum", "sample_count", "invalid_per_pixel"):
        assert np.array_equal(getattr(ours, array), getattr(theirs, array)), array
    assert ours.ranges == theirs.ranges == [(0, viewer.document.config.framebuffer.sppx)]
    assert ours.sum.any()
