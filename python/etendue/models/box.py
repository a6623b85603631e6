"""The Cornell box, from the measurements that Cornell University's Program of Computer Graphics published.

The measured room is 556 wide, 548.8 high and 559.2 deep (mm of a model box, x from the green wall to the red
one, z away from the viewer); here each axis is brought to two metres, so that the box spans x -1..1, y 0..2,
z -1..1 with its open front towards +z.  The reflectances are the usual RGB reading of the measured spectra.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from etendue.models.mesh import Floats, Mesh, quad, rounded_prism
from etendue.models.model import Model

SIZE = np.array([556.0, 548.8, 559.2])
WHITE, RED, GREEN = (0.725, 0.71, 0.68), (0.63, 0.065, 0.05), (0.14, 0.45, 0.091)

# Corners as published: (x, y, z).  The room's walls are not quite square to each other.
FLOOR = [(552.8, 0, 0), (0, 0, 0), (0, 0, 559.2), (549.6, 0, 559.2)]
CEILING = [(556, 548.8, 0), (556, 548.8, 559.2), (0, 548.8, 559.2), (0, 548.8, 0)]
BACK_WALL = [(549.6, 0, 559.2), (0, 0, 559.2), (0, 548.8, 559.2), (556, 548.8, 559.2)]
RIGHT_WALL = [(0, 0, 559.2), (0, 0, 0), (0, 548.8, 0), (0, 548.8, 559.2)]
LEFT_WALL = [(552.8, 0, 0), (549.6, 0, 559.2), (556, 548.8, 559.2), (556, 548.8, 0)]
# Footprints (x, z) and heights.
SHORT_BLOCK, SHORT_HEIGHT = [(130, 65), (82, 225), (240, 272), (290, 114)], 165.0
TALL_BLOCK, TALL_HEIGHT = [(423, 247), (265, 296), (314, 456), (472, 406)], 330.0
LAMP_CENTRE, LAMP_SIZE = (278.0, 279.5), (130.0, 105.0)

# The measured lamp at radiance 78 would burn the picture out at exposure 1; edges of this share are right.
LAMP_SHARE = 0.75
LAMP_HEIGHT = 1.98


def build(folder: Path) -> None:
    """Writes CornellBox-Original.obj and its MTL below `folder`."""
    model().write(folder / "CornellBox-Original.obj")


def model() -> Model:
    """The box with its two blocks and its lamp."""
    scene = Model()
    for name in ("floor_diffuse", "ceiling", "backWall"):
        scene.material(name, kd=WHITE, ni=1.5, ns=1)
    scene.material("leftWall_diffuse", kd=RED, ni=1.5, ns=1)
    scene.material("rightWall_diffuse", kd=GREEN, ni=1.5, ns=1)
    scene.material("shortBox", kd=WHITE, ni=1.3, ns=10)
    scene.material("tallBox", kd=WHITE, ni=1.3, ns=10)
    scene.material("light", kd=(0.78, 0.78, 0.78), ke=(78, 78, 78), ns=1)

    scene.add("floor_diffuse", _wall(FLOOR))
    scene.add("ceiling", _wall(CEILING))
    scene.add("backWall", _wall(BACK_WALL))
    scene.add("leftWall_diffuse", _wall(LEFT_WALL))
    scene.add("rightWall_diffuse", _wall(RIGHT_WALL))
    scene.add("shortBox", _block(SHORT_BLOCK, SHORT_HEIGHT))
    scene.add("tallBox", _block(TALL_BLOCK, TALL_HEIGHT))

    x, z = _placed([[LAMP_CENTRE[0], 0, LAMP_CENTRE[1]]])[0, [0, 2]]
    w, d = LAMP_SHARE * np.array(LAMP_SIZE) / SIZE[[0, 2]]
    y = LAMP_HEIGHT
    scene.add("light", quad((x - w, y, z + d), (x - w, y, z - d), (x + w, y, z - d), (x + w, y, z + d)))
    rim = 0.012
    corners = [(-w - rim, -d - rim), (w + rim, -d - rim), (w + rim, d + rim), (-w - rim, d + rim)]
    # The fitting fills the gap to the ceiling and goes a little into it, so that no two faces coincide.
    fitting = rounded_prism(corners, 2.006 - (y + 0.001), 0.004)
    scene.add("ceiling", fitting.moved(x, y + 0.001, z).flat())
    return scene


def _placed(points: object) -> Floats:
    """Published coordinates to the scene's: turned about y to look along -z, and scaled."""
    p = np.asarray(points, float) * 2 / SIZE
    return np.stack([1 - p[:, 0], p[:, 1], 1 - p[:, 2]], 1)


def _wall(corners: Sequence[tuple[float, float, float]]) -> Mesh:
    return quad(*_placed(corners))


def _block(footprint: Sequence[tuple[float, float]], height: float) -> Mesh:
    """A block with edges rounded by a hair, which stands a hair deep in the floor."""
    sunk = 0.001
    base = _placed([(x, 0, z) for x, z in footprint])[:, [0, 2]]
    return rounded_prism(base, height * 2 / SIZE[1] + sunk, 0.004).moved(y=-sunk)
