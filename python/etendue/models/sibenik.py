"""A vaulted cathedral with a light dome and stained glass, seen from its south aisle.

Three-aisled, with a crossing under an octagonal dome, a triforium, rib vaults and a polygonal apse.  The
building is a design of its own.  Sunlight enters through the open windows of the drum; panels of dimmer light
stand outside the stained glass.
"""

from __future__ import annotations

from pathlib import Path

from etendue.models._sibenik_crossing import add_crossing
from etendue.models._sibenik_dome import add_dome, add_lamps
from etendue.models._sibenik_ends import add_ends
from etendue.models._sibenik_floor import add_floor
from etendue.models._sibenik_furniture import BRASS, WAX, WICK, WOOD, add_furniture
from etendue.models._sibenik_glass import BLUE, CLEAR, GREEN, LEAD, RED, YELLOW
from etendue.models._sibenik_nave import add_nave
from etendue.models._sibenik_plan import FLOOR
from etendue.models._sibenik_textures import write_textures
from etendue.models.model import Model

SKY, SUN = "window_light_sky", "window_light_sun"
PANELS = {"north": SKY, "south": SUN, "high": SKY, "east": SKY}


def base() -> Model:
    """The church without the lamps of its dome, its floor at y = `FLOOR`."""
    model = Model()
    stone = {"ni": 1.5, "ns": 5.87}
    model.material("kamen_zid", kd=(0.64, 0.605, 0.54), map_kd="zid.png", map_bump="zid_normal.png", **stone)
    model.material("kamen_zid_parapet", kd=(0.68, 0.645, 0.58), map_kd="parapet.png", **stone)
    model.material("kamen_svod", kd=(0.68, 0.65, 0.59), map_kd="svod.png", **stone)
    model.material("stup", kd=(0.59, 0.545, 0.49), map_kd="stup.png", ns=30)
    model.material("pod", kd=(0.4, 0.36, 0.3), map_kd="pod.png", ni=2.041, ns=798)
    model.material("fuga", kd=(0.22, 0.2, 0.17), ns=6)
    model.material("pod_tepih", kd=(0.36, 0.022, 0.025), map_kd="tepih.png", ns=2)
    model.material(LEAD, kd=(0.06, 0.06, 0.065), ns=20)
    for name, kd in (
        (CLEAR, (0.93, 0.95, 0.90)),
        (RED, (0.86, 0.07, 0.05)),
        (BLUE, (0.12, 0.24, 0.88)),
        (GREEN, (0.14, 0.66, 0.26)),
        (YELLOW, (0.96, 0.72, 0.18)),
    ):
        model.material(name, kd=kd, ni=1.52, ns=20000)
    # A lamp emits its Kd times the luminance of its Ke.
    model.material(SKY, kd=(0.82, 0.92, 1.0), ke=(1.4, 1.4, 1.4))
    model.material(SUN, kd=(1.0, 0.86, 0.66), ke=(5.0, 5.0, 5.0))
    model.material(WICK, kd=(0.03, 0.03, 0.03), ns=6)
    model.material(BRASS, kd=(0.72, 0.5, 0.22), ns=60)
    model.material(WAX, kd=(0.82, 0.77, 0.66), ns=30)
    model.material(WOOD, kd=(0.17, 0.085, 0.042), map_kd="drvo.png", ns=40)
    add_nave(model, PANELS)
    add_crossing(model, PANELS)
    add_dome(model)
    add_ends(model, PANELS)
    add_floor(model)
    add_furniture(model)
    return _lowered(model)


def light_dome() -> Model:
    """The lamps of the dome."""
    model = Model()
    model.material("light", kd=(1.0, 0.95, 0.87), ke=(750.0, 750.0, 750.0))
    add_lamps(model, "light")
    return _lowered(model)


def build(folder: Path) -> None:
    """Writes the church, its textures and the lamps of its dome below `folder`."""
    home = folder / "sibenik"
    home.mkdir(parents=True, exist_ok=True)
    write_textures(home)
    base().write(home / "sibenik_base.obj")
    light_dome().write(home / "sibenik_light_dome.obj")


def _lowered(model: Model) -> Model:
    model.parts = {name: [m.moved(y=FLOOR) for m in meshes] for name, meshes in model.parts.items()}
    return model
