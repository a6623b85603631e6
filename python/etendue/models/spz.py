"""A colonnaded court of an Italian palace with cloth, vases and lemon trees, in the noon sun."""

from __future__ import annotations

from itertools import chain
from pathlib import Path

import numpy as np

from etendue.models import _spz_arcade, _spz_fabrics, _spz_masonry, _spz_shell
from etendue.models._spz_cloth import cloth
from etendue.models._spz_garden import garden
from etendue.models._spz_light import light
from etendue.models._spz_shield import shield
from etendue.models.model import Model

FOLDER = "sponza"
# Roughness is sqrt(2 / (Ns + 2)).
DULL, SATIN, POLISHED = 9.8, 40.0, 303.0


def build(folder: Path) -> None:
    """Writes the atrium, its lamps and their textures below `folder`."""
    target = folder / FOLDER
    textures = target / "textures"
    _spz_masonry.paint(textures)
    _spz_fabrics.paint(textures)
    light(target).write(target / "sponza_light.obj")
    atrium().write(target / "sponza_base.obj")


def atrium() -> Model:
    """The court without its lamps."""
    model = Model()
    _materials(model)
    rng = np.random.default_rng(2010)
    parts = chain(
        _spz_arcade.columns(), _spz_arcade.arches(rng), _spz_arcade.vaults(), _spz_arcade.balustrade(),
        _spz_arcade.cornices(), _spz_arcade.gallery_floor(), _spz_shell.floors(), _spz_shell.walls(rng),
        _spz_shell.attic(rng), _spz_shell.roof(), shield(), cloth(rng), garden(rng), )  # fmt: skip
    for name, mesh in parts:
        model.add(name, mesh)
    return model


def _materials(model: Model) -> None:
    def textured(
        name: str, picture: str, bump: str | None = None, ns: float = DULL, ni: float = 1.3, **more: str
    ) -> None:
        extra = {key: f"textures/{value}.png" for key, value in more.items()}
        if bump:
            extra["map_bump"] = f"textures/{bump}.png"
        model.material(name, map_kd=f"textures/{picture}.png", ns=ns, ni=ni, **extra)

    textured("floor.001", "floor", ns=POLISHED, ni=1.381)
    textured("bricks.001", "bricks", "bricks_normal")
    textured("plaster.001", "plaster", "plaster_normal")
    textured("ceiling.001", "ceiling", "plaster_normal")
    textured("stone.001", "stone", "stone_normal")
    textured("arch.001", "arch")
    textured("details.001", "details")
    textured("column_a.001", "column_a", ns=SATIN)
    textured("column_b.001", "column_b", ns=SATIN)
    textured("column_c.001", "stone", "stone_normal")
    textured("tiles.001", "tiles", "tiles_normal", ns=SATIN)
    textured("roof.001", "roof")
    textured("wood.001", "wood", ns=SATIN)
    textured("vase.001", "roof")
    textured("vase_round.001", "majolica", ns=POLISHED)
    textured("leaf.001", "leaves", ns=60, map_d="leaves_mask")
    for letter in "abcdefg":
        textured(f"fabric_{letter}.001", f"fabric_{letter}")
    model.material("shutter.001", kd=(0.075, 0.15, 0.105), ns=SATIN)
    model.material("window_pane.001", kd=(0.03, 0.035, 0.04), ns=5000, ni=1.5)
    model.material("flagpole.001", kd=(0.30, 0.20, 0.085), ns=SATIN)
    model.material("chain.001", kd=(0.075, 0.07, 0.065), ns=SATIN)
    model.material("branch.001", kd=(0.11, 0.085, 0.055), ns=DULL)
    model.material("lemon.001", kd=(0.72, 0.50, 0.04), ns=SATIN)
