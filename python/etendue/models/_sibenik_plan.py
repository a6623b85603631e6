"""The plan of the cathedral: where things stand, in metres, with the floor at height 0.

The nave runs along x, the apse lies east (+x), north is -z.  `FLOOR` moves the whole building to the height
that the scene's camera expects.
"""

from __future__ import annotations

FLOOR = -0.5

BAY = 4.3
NAVE_COLUMNS = (-15.75, -11.45, -7.15, -2.85)
WEST_PIER, EAST_PIER = 1.45, 8.45
CHOIR_END = EAST_PIER + BAY
CROSSING = (WEST_PIER + EAST_PIER) / 2
WEST_WALL = NAVE_COLUMNS[0] - BAY
EAST_WALL = CHOIR_END + 0.45

# Centres of the bays with an arcade: four west of the crossing, one east of it.
NAVE_BAYS = tuple(x + BAY / 2 for x in (WEST_WALL, *NAVE_COLUMNS))
CHOIR_BAY = EAST_PIER + BAY / 2

ARCADE = 3.4  # |z| of the column line
WALL = 0.9  # thickness of the arcade walls
NAVE_HALF = ARCADE - WALL / 2
AISLE_IN = ARCADE + WALL / 2
AISLE_OUT = 7.5

SPRING = 3.68  # of arcade and aisle vaults
GALLERY = 6.35  # floor of the triforium
CLERESTORY = 8.2  # springing of the nave vault
NAVE_TOP = 12.2  # walls end here, above every vault
CROSSING_SPRING = CLERESTORY
CROSSING_HALF = 2.95  # the square under the dome
RING = CROSSING_SPRING + CROSSING_HALF  # where the pendentives end
DRUM_BASE, DRUM_TOP = RING + 0.35, RING + 3.1
WEST_WINDOW_HEIGHT = 8.3
