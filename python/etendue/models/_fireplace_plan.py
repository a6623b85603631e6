"""The fireplace room's plan: where its walls and its joinery stand, in metres, and its materials' names.

The camera of the exercise's scene file stands in the south-east corner and looks to the north-west: west is
-x, north is +z.
"""

from __future__ import annotations

WEST, EAST, SOUTH, NORTH = -0.5, 5.1, -3.9, 3.5
HEIGHT = 2.7

# The chimney breast stands before the west wall and leaves an alcove on either side.
BREAST = -0.12
BREAST_SOUTH, BREAST_NORTH = -1.25, 0.65
AXIS = (BREAST_SOUTH + BREAST_NORTH) / 2

# Openings of the windows: (from, to) along their wall, then (sill, head).
NORTH_WINDOW = (1.25, 2.75)
EAST_WINDOWS = ((1.25, 2.95), (-1.75, -0.05))
SILL, HEAD = 0.55, 2.32

PREFIX = "grey_and_white_room:"

FLOOR = PREFIX + "Floor"
MIRROR = PREFIX + "Mirror"
GLASS = PREFIX + "Glass"
FIRE_GLASS = PREFIX + "FireplaceGlass"
STEEL = PREFIX + "BrushedStainlessSteel"
SHEER = PREFIX + "Transluscent"
PAINT = PREFIX + "MattePaint"
PANELING = PREFIX + "Paneling"
SOFA = PREFIX + "Sofa"
WALLS = PREFIX + "Walls"
WOOD = PREFIX + "TableWood"
LEAVES = PREFIX + "Leaves"
BRANCHES = PREFIX + "Branches"
PAINTING = PREFIX + "Painting"
SKY = PREFIX + "lambert2SG_light"
LAMPS = PREFIX + "lambert3SG"

# Materials that scene files do not patch: the type comes from the name.
GARDEN = PREFIX + "Garden_light"
FLAMES = PREFIX + "Flames_light"
EMBERS = PREFIX + "Embers_light"
RUG = PREFIX + "Rug_fabric"
DRAPES = PREFIX + "Drapes_fabric"
CUSHIONS = PREFIX + "Cushion_fabric"
ARMCHAIR = PREFIX + "Armchair_fabric"
BOOKS = PREFIX + "Books_diffuse"
PAPER = PREFIX + "Paper_diffuse"
SLATE = PREFIX + "Slate"
BRICK = PREFIX + "Brick_diffuse"
BARK = PREFIX + "Bark_diffuse"
IRON = PREFIX + "Iron"
CERAMIC = PREFIX + "Ceramic"
BRASS = PREFIX + "Brass_gold"
BASKET = PREFIX + "Basket_diffuse"
SOIL = PREFIX + "Soil_diffuse"
WAX = PREFIX + "Wax_diffuse"
FRUIT = PREFIX + "Fruit"
THROW = PREFIX + "Throw_fabric"
