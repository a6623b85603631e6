"""Teapots and rabbits on the checker floor of a terrace above the sea, at sunset.

A lamp above the picture throws the caustics of the glass rabbit; the low sun in the background colours the
floor.  The terrace is no larger than the picture needs: the power of a sky, by which lights are chosen, grows
with the scene.  The set is laid out in coordinates of the camera: `right` and `away` along the
floor from a point a little before the one that the camera looks at.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

from etendue.models._pots_bunny import bunny
from etendue.models._pots_floor import SQUARES, write_checker
from etendue.models._pots_sky import write_sunset
from etendue.models._pots_teapot import teapot
from etendue.models.mesh import Floats, Mesh, disc, lathe, rounded_prism
from etendue.models.model import Model

CENTRE = np.array([0.27, 0.0, -0.12])
RIGHT = np.array([-0.7534, 0.0, -0.6576])
AWAY = np.array([-0.6576, 0.0, 0.7534])

SLAB = 0.75  # edge of a square of the floor
TERRACE_AT, TERRACE = 2.0, 7.0  # how far away its middle is; radius

TEAPOT, BUNNY = 0.42, 1.25  # scales
# Material, right, away, and where the spout points: degrees from the right towards away.
TEAPOTS = (
    ("teapot_specular", 1.45, -1.75, 205.0),
    ("teapot_specular.001", 3.0, 0.45, 120.0),
    ("teapot_specular.002", -3.35, 0.35, 330.0),
    ("teapot_diffuse", 3.3, 3.2, 190.0),
    ("teapot_diffuse.001", -1.1, 1.9, 10.0),
)
GLASS_BUNNY = (-1.35, -1.25, 330.0)
WHITE_BUNNY = (0.85, 0.75, 215.0)

LAMP_AT, LAMP_AIM = (-0.6, 1.4, 4.5), (0.3, -0.2, 0.4)  # right, away, height
LAMP_RADIUS = 0.36

STONE = ((0.46, 0.42, 0.36), (0.50, 0.46, 0.39), (0.43, 0.40, 0.35))


def build(folder: Path) -> None:
    """Writes checkerpots/checkerpots.obj with its MTL and texture, and envmaps/sunset.hdr, below `folder`."""
    model().write(folder / "checkerpots" / "checkerpots.obj")
    write_checker(folder / "checkerpots" / "checker.png")
    write_sunset(folder / "envmaps" / "sunset.hdr")


def model() -> Model:
    """Floor, teapots, rabbits and lamp."""
    scene = Model()
    scene.material("Material.001", kd=(0.8, 0.8, 0.8), ni=1.3, ns=92, map_kd="checker.png")
    scene.add("Material.001", _floor())
    for i, kd in enumerate(STONE):
        scene.material(f"terrace_stone.{i + 1:03}", kd=kd, ni=1.4, ns=12)
        scene.add(f"terrace_stone.{i + 1:03}", *_kerb()[i :: len(STONE)])

    scene.material("teapot_specular", kd=(0.92, 0.77, 0.29), ni=0.75, ns=350)
    scene.material("teapot_specular.001", kd=(0.56, 0.56, 0.56), ni=0.15, ns=100)
    scene.material("teapot_specular.002", kd=(0.69, 0.28, 0.13), ni=1.12, ns=75)
    scene.material("teapot_diffuse", kd=(0.08, 0.20, 0.60))
    scene.material("teapot_diffuse.001", kd=(0.06, 0.42, 0.10), ni=1.3, ns=535)
    pot = teapot().scaled(TEAPOT)
    for name, right, away, facing in TEAPOTS:
        scene.add(name, _placed(pot, right, away, facing))

    scene.material("bunny_specular", kd=(1, 1, 1), ni=1.52)
    scene.material("bunny_specular.001", kd=(0.529, 0.529, 0.529), ni=1.52)
    scene.add("bunny_specular", _placed(bunny(head_turn=-24, seed=2).scaled(BUNNY), *GLASS_BUNNY))
    scene.add("bunny_specular.001", _placed(bunny(head_turn=20, ear_spread=0.05).scaled(BUNNY), *WHITE_BUNNY))

    scene.material("light", kd=(1, 1, 1), ke=(150, 150, 150))
    scene.material("lamp_hood", kd=(0.05, 0.05, 0.055), ni=1.5, ns=60)
    at, aim = place(*LAMP_AT), place(*LAMP_AIM)
    up = (at - aim) / np.linalg.norm(at - aim)
    side = np.cross(up, AWAY) / np.linalg.norm(np.cross(up, AWAY))
    frame = np.stack([side, up, np.cross(side, up)], 1)
    scene.add("light", disc(LAMP_RADIUS, 64).turned("x", 180).transformed(frame).moved(*at))
    scene.add("lamp_hood", _hood().transformed(frame).moved(*at))
    return scene


def place(right: float, away: float, height: float = 0.0) -> Floats:
    """A point of the set in the scene's coordinates."""
    return np.asarray(CENTRE + right * RIGHT + away * AWAY + [0.0, height, 0.0])


def _placed(mesh: Mesh, right: float, away: float, facing: float) -> Mesh:
    """The mesh standing at a place, its +x facing somewhere; a hair above the floor."""
    heading = np.cos(np.radians(facing)) * RIGHT + np.sin(np.radians(facing)) * AWAY
    turned = mesh.turned("y", float(np.degrees(np.arctan2(-heading[2], heading[0]))))
    return turned.moved(*place(right, away, 0.001 - float(turned.vertices[:, 1].min())))


def _floor() -> Mesh:
    """The round floor, its slabs turned a little from the view, so that no row runs straight at the eye."""
    round_ = disc(TERRACE, 128)
    uvs = round_.vertices[:, [0, 2]] * [1, -1] / (SQUARES * SLAB)
    return Mesh(round_.vertices, round_.faces, None, uvs).turned("y", 12).moved(*place(0, TERRACE_AT))


def _kerb() -> list[Mesh]:
    """The dressed stones around the floor, from below its edge to a step above it."""
    count, gap, depth = 46, 0.004, 0.5
    inner, outer = TERRACE - 0.1, TERRACE + 0.36
    half = np.pi / count
    stones = []
    for k in range(count):
        corners = [
            (r * np.sin(s * (half - gap / r)), r * np.cos(s * (half - gap / r)))
            for r, s in ((inner, -1), (inner, 1), (outer, 1), (outer, -1))
        ]
        stone = rounded_prism(corners, depth + 0.13, 0.012).moved(y=-depth)
        stones.append(stone.turned("y", 360 * k / count).moved(*place(0, TERRACE_AT)))
    return stones


def _hood() -> Mesh:
    """A spun shade around the lamp's disc, closed, with the rod that it hangs on."""
    r = LAMP_RADIUS
    inside = [(0, 0.012), (r + 0.006, 0.012), (r + 0.006, -0.03)]
    outside = [(r + 0.018, -0.03), (r + 0.02, 0.03), (0.55 * r, 0.17), (0.2 * r, 0.22), (0.015, 0.24)]
    return lathe([*inside, *outside, (0.015, 1.5), (0, 1.5)], 64)
