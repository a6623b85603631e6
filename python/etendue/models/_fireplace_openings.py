"""Windows and the door of the fireplace room."""

from __future__ import annotations

from etendue.models._fireplace_plan import GARDEN, HEAD, PAINT, SILL, SKY, SOUTH, STEEL
from etendue.models._fireplace_shapes import block, block_between, faceted, panel_moulding
from etendue.models._fireplace_things import Place
from etendue.models.mesh import Mesh, lathe, merged, quad
from etendue.models.model import Model

# How far a window's reveal runs behind the wall's face, the height of its transom, and that of the hedge
# before the sky in the east windows.
REVEAL = 0.25
TRANSOM = 1.62
HORIZON = 0.74


def window(model: Model, width: float, place: Place, sky: bool) -> None:
    """A casement window with a transom; it faces +z into the room, the sill's middle at the origin.

    Its panes are the lamps, sky over garden or garden alone: each as large as it is seen, so that few shadow
    rays end on a frame.
    """
    h, w = HEAD - SILL, width / 2
    transom = TRANSOM - SILL
    over, back = 0.02, -REVEAL
    parts = [
        quad((-w, 0, 0), (w, 0, 0), (w, 0, back - over), (-w, 0, back - over)),
        quad((-w, h, back - over), (w, h, back - over), (w, h, 0), (-w, h, 0)),
        quad((-w, 0, back - over), (-w, h, back - over), (-w, h, 0), (-w, 0, 0)).flipped(),
        quad((w, 0, 0), (w, h, 0), (w, h, back - over), (w, 0, back - over)).flipped(),
    ]
    model.add(PAINT, place(faceted(merged(parts))))

    def pane(left: float, right: float, low: float, high: float) -> Mesh:
        z = -0.152
        mesh = quad((left, low, z), (right, low, z), (right, high, z), (left, high, z))
        return place(faceted(Mesh(mesh.vertices, mesh.faces, None, (mesh.vertices[:, :2] + [w, 0]) / 1.8)))

    # Frame, casements, glazing bars: stiles run through, rails stand between them.
    z0, z1, y0, y1, f = -0.215, -0.135, -0.203, -0.121, 0.042
    wood = [
        block_between((-w - 0.01, -0.01, z0), (-w + 0.05, h + 0.01, z1)),
        block_between((w - 0.05, -0.01, z0), (w + 0.01, h + 0.01, z1)),
        block_between((-0.032, 0.055, z0 + 0.001), (0.032, transom - 0.03, z1 - 0.001)),
    ]
    for low, high in ((-0.01, 0.055), (transom - 0.03, transom + 0.03), (h - 0.05, h + 0.01)):
        wood.append(block_between((-w + 0.05, low, z0 + 0.002), (w - 0.05, high, z1 - 0.002)))
    horizon = HORIZON - SILL if sky else h
    for low, high, bar in ((0.055, transom - 0.03, 0.032), (transom + 0.03, h - 0.05, 0.0)):
        for a, b in ((-w + 0.05, -bar), (bar, w - 0.05)):
            wood += [
                block_between((a, low, y0), (a + f, high, y1)),
                block_between((b - f, low, y0), (b, high, y1)),
                block_between((a + f, low, y0 + 0.001), (b - f, low + f, y1 - 0.001)),
                block_between((a + f, high - f, y0 + 0.001), (b - f, high, y1 - 0.001)),
            ]
            left, right, bottom, top = a + f - 0.008, b - f + 0.008, low + f - 0.008, high - f + 0.008
            if bottom < horizon:
                model.add(GARDEN, pane(left, right, bottom, min(top, horizon)))
            if top > horizon:
                model.add(SKY, pane(left, right, max(bottom, horizon), top))
    model.add(PAINT, *(place(p) for p in wood))
    board = block_between((-w - 0.06, -0.028, -0.13), (w + 0.06, 0.004, 0.045), bevel=0.006)
    model.add(PAINT, place(board))
    architrave = [(-w - 0.085, -w + 0.004), (w - 0.004, w + 0.085)]
    for a, b in architrave:
        model.add(PAINT, place(block_between((a, -0.03, -0.004), (b, h + 0.085, 0.022), bevel=0.005)))
    model.add(
        PAINT,
        place(block_between((-w + 0.004, h - 0.004, -0.004), (w - 0.004, h + 0.085, 0.020), bevel=0.005)),
    )
    model.add(PAINT, place(block_between((-w - 0.06, -0.09, -0.004), (w + 0.06, -0.028, 0.016), bevel=0.005)))
    for x in (-0.02, 0.02):
        plate = block(0.016, 0.10, 0.006, 0.002).moved(x, transom * 0.52, z1 + 0.017)
        lever = block(0.012, 0.014, 0.030, 0.003).moved(x, transom * 0.52, z1 + 0.033)
        grip = block(0.014, 0.11, 0.012, 0.004).moved(x, transom * 0.52 - 0.045, z1 + 0.052)
        model.add(STEEL, *(place(m) for m in (plate, lever, grip)))


def door(model: Model) -> None:
    """A panelled door in the south wall, behind the camera."""
    w, h = 0.86, 2.06
    x, z = 1.75, SOUTH
    leaf = block_between((x - w / 2, 0.006, z - 0.01), (x + w / 2, h, z + 0.016))
    fields = [
        panel_moulding(w / 2 - 0.16, hi - lo, 0.03).moved(x + s * (w / 4 - 0.02), (lo + hi) / 2, z + 0.0162)
        for s in (-1, 1)
        for lo, hi in ((0.2, 0.9), (1.05, 1.92))
    ]
    model.add(PAINT, leaf, *fields)
    for a, b in ((x - w / 2 - 0.09, x - w / 2 - 0.002), (x + w / 2 + 0.002, x + w / 2 + 0.09)):
        model.add(PAINT, block_between((a, 0.0, z - 0.01), (b, h + 0.09, z + 0.028), 0.006))
    model.add(
        PAINT,
        block_between(
            (x - w / 2 - 0.002, h + 0.002, z - 0.01), (x + w / 2 + 0.002, h + 0.09, z + 0.026), 0.006
        ),
    )
    rose = lathe(
        [(0, 0), (0.026, 0), (0.026, 0.006), (0.022, 0.009), (0.010, 0.010), (0.010, 0.045), (0, 0.045)], 24
    )
    model.add(
        STEEL,
        rose.turned("x", 90).moved(x + w / 2 - 0.06, 1.02, z + 0.0162),
        block(0.13, 0.018, 0.018, 0.006).moved(x + w / 2 - 0.11, 1.02, z + 0.066),
    )
