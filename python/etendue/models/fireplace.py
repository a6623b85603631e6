"""`fireplace`: a living room in grey and white, a fire behind glass, a mirror above, a bright day outside."""

from __future__ import annotations

import importlib
from collections.abc import Callable
from pathlib import Path

import numpy as np

from etendue.models import _fireplace_pictures as pictures
from etendue.models import _fireplace_plan as plan
from etendue.models import _fireplace_textures as textures
from etendue.models.mesh import Floats
from etendue.models.model import Model

PARTS = ("room", "fire", "hearth", "joinery", "seating", "cloth", "table", "lamps", "plants")


def build(folder: Path) -> None:
    """Writes fireplace/fireplace_room.obj with its MTL and textures below `folder`."""
    target = folder / "fireplace"
    _write_textures(target)
    model().write(target / "fireplace_room.obj")


def model() -> Model:
    """The furnished room."""
    room = Model()
    materials(room)
    for part in PARTS:
        importlib.import_module(f"etendue.models._fireplace_{part}").add(room)
    return room


def materials(m: Model) -> None:
    """Declares every material; the type of those that a scene file does not patch comes from the name."""

    def shiny(roughness: float) -> float:
        """The Phong exponent that stands for this roughness."""
        return 2 / roughness**2 - 2

    m.material(plan.FLOOR, kd=(0.30, 0.20, 0.13), ni=2.093, ns=shiny(0.084), map_kd="floor.png")
    m.material(plan.WALLS, kd=(0.47, 0.468, 0.46), ns=shiny(0.55))
    m.material(plan.PANELING, kd=(0.80, 0.795, 0.775), ns=shiny(0.35))
    m.material(plan.PAINT, kd=(0.82, 0.815, 0.80), ns=shiny(0.5))
    m.material(plan.SOFA, kd=(0.30, 0.305, 0.315), ns=shiny(0.8), map_kd="sofa.png")
    m.material(plan.WOOD, kd=(0.11, 0.06, 0.035), ns=shiny(0.28), map_kd="walnut.png")
    m.material(plan.MIRROR, kd=(0.93, 0.94, 0.94), ni=30, ns=1e5)
    m.material(plan.GLASS, kd=(0.97, 0.98, 0.975), ni=1.5, ns=1e5)
    m.material(plan.FIRE_GLASS, kd=(0.95, 0.95, 0.94), ni=1.5, ns=1e5)
    m.material(plan.STEEL, kd=(0.86, 0.86, 0.87), ni=2.42, ns=shiny(0.231))
    m.material(plan.SHEER, kd=(0.88, 0.87, 0.84), ni=1.52)
    m.material(plan.LEAVES, kd=(0.05, 0.11, 0.03), ns=shiny(0.32), map_kd="leaf.png")
    m.material(plan.BRANCHES, kd=(0.16, 0.115, 0.075), ns=shiny(0.7))
    m.material(plan.PAINTING, kd=(0.6, 0.6, 0.6), ns=shiny(0.6), map_kd="pictures.png")
    m.material(plan.SKY, kd=(0.65, 0.68, 0.7), ke=(30, 30, 30), map_kd="sky.png")
    m.material(plan.LAMPS, kd=(0.06, 0.045, 0.03), ke=(30, 30, 30), ns=shiny(0.7), map_kd="glow.png")
    m.material(plan.GARDEN, kd=(0.8, 0.8, 0.8), ke=(8, 8, 8), map_kd="garden.png")
    m.material(plan.FLAMES, kd=(1, 0.6, 0.2), ke=(9, 9, 9), map_kd="flame.png")
    m.material(plan.EMBERS, kd=(1, 0.4, 0.1), ke=(7, 7, 7), map_kd="embers.png")
    m.material(plan.RUG, kd=(0.6, 0.57, 0.5), map_kd="rug.png")
    m.material(plan.DRAPES, kd=(0.36, 0.375, 0.39))
    m.material(plan.CUSHIONS, kd=(0.5, 0.5, 0.5), map_kd="cushions.png")
    m.material(plan.THROW, kd=(0.60, 0.535, 0.44))
    m.material(plan.ARMCHAIR, kd=(0.5, 0.5, 0.5), map_kd="armchair.png")
    m.material(plan.BOOKS, kd=(0.5, 0.5, 0.5), map_kd="books.png")
    m.material(plan.PAPER, kd=(0.78, 0.755, 0.68))
    m.material(plan.SLATE, kd=(0.055, 0.057, 0.062), ns=shiny(0.25))
    m.material(plan.BRICK, kd=(0.1, 0.07, 0.06), map_kd="brick.png")
    m.material(plan.BARK, kd=(0.2, 0.15, 0.1), map_kd="bark.png")
    m.material(plan.IRON, kd=(0.022, 0.022, 0.024), ns=shiny(0.38))
    m.material(plan.CERAMIC, kd=(0.74, 0.725, 0.69), ns=shiny(0.22))
    m.material(plan.BRASS, kd=(0.9, 0.75, 0.45))
    m.material(plan.BASKET, kd=(0.42, 0.30, 0.18))
    m.material(plan.SOIL, kd=(0.05, 0.035, 0.025))
    m.material(plan.WAX, kd=(0.86, 0.83, 0.76))
    m.material(plan.FRUIT, kd=(0.44, 0.47, 0.12), ns=shiny(0.3))


Painter = Callable[[np.random.Generator], Floats]
TEXTURES: dict[str, Painter] = {
    "floor": textures.floor,
    "walnut": textures.table_wood,
    "sofa": lambda rng: textures.heather(rng, [0.57, 0.565, 0.562]),
    "armchair": lambda rng: textures.heather(rng, [0.80, 0.775, 0.73], depth=0.09),
    "cushions": textures.cushions,
    "rug": textures.rug,
    "books": textures.books,
    "leaf": textures.leaf,
    "bark": textures.bark,
    "brick": textures.brick,
    "glow": textures.glow,
    "flame": textures.flame,
    "embers": textures.embers,
    "garden": textures.garden,
    "sky": textures.sky,
    "pictures": pictures.sheet,
}


def _write_textures(target: Path) -> None:
    for k, (name, paint) in enumerate(TEXTURES.items()):
        textures.write(paint(np.random.default_rng(100 + k)), target / f"{name}.png")
