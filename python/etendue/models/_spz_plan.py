"""The atrium's plan: a court of 8 by 3 bays, two arcaded storeys and an attic; metres, y = 0 on its floor."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from etendue.models.mesh import Mesh

BAY = 3.4
CENTRE_X = -1.25
HALF_X, HALF_Z = 4 * BAY, 1.5 * BAY  # lines of columns around the court, about CENTRE_X
CORRIDOR = 3.1  # from the line of columns to the wall behind
THICK = 0.56  # of the arcade's wall
PIER = 0.72


@dataclass(frozen=True)
class Storey:
    """Heights of one arcaded storey."""

    floor: float
    foot: float  # under the columns
    column: float  # height of a column with base and capital
    spring: float
    top: float  # where the arcade's wall ends
    radius: float = 1.37  # of an arch's opening
    vault_rise: float = 1.6


GROUND = Storey(floor=0.15, foot=0.15, column=2.65, spring=2.95, top=5.1)
UPPER = Storey(floor=5.1, foot=6.02, column=2.2, spring=8.36, top=10.5)
STOREYS = (GROUND, UPPER)
RAIL_TOP = 6.02
ATTIC_TOP = 12.95


@dataclass(frozen=True)
class Side:
    """One side of the court: its own frame has x along the columns, z into the court, z = 0 on their line."""

    bays: int
    degrees: float
    x: float
    z: float

    def place(self, mesh: Mesh) -> Mesh:
        """The mesh brought from the side's frame to the world."""
        return mesh.turned("y", self.degrees).moved(self.x, 0, self.z)

    def columns(self) -> Iterator[float]:
        """Where columns stand along the side; its corners are piers."""
        return (BAY * (k - self.bays / 2) for k in range(1, self.bays))

    def centres(self) -> Iterator[float]:
        """The middles of the bays."""
        return (BAY * (k + 0.5 - self.bays / 2) for k in range(self.bays))


FAR = Side(8, 0, CENTRE_X, -HALF_Z)
NEAR = Side(8, 180, CENTRE_X, HALF_Z)
EAST = Side(3, -90, CENTRE_X + HALF_X, 0)  # the end that the camera looks at
WEST = Side(3, 90, CENTRE_X - HALF_X, 0)
SIDES = (FAR, NEAR, EAST, WEST)
