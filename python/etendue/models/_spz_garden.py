"""What stands and hangs in the court: lemon trees, painted vases, bowls on chains, and the well."""

from __future__ import annotations

import numpy as np

from etendue.models._spz_arcade import Parts
from etendue.models._spz_kit import block, moulding, planar, spun
from etendue.models._spz_plan import CENTRE_X, EAST, FAR, HALF_Z, NEAR, UPPER, WEST
from etendue.models.mesh import Floats, Mesh, cylinder, merged, sphere, surface

WELL = (CENTRE_X + 5.1, -0.35)


def garden(rng: np.random.Generator) -> Parts:
    """All of it."""
    pot, trees = _pot(), [_tree(rng) for _ in range(3)]
    places = [(x + CENTRE_X, -HALF_Z + 1.05) for x in FAR.columns()] + [
        (x + CENTRE_X, HALF_Z - 1.05) for x in list(NEAR.columns())[::2]
    ]
    for k, (x, z) in enumerate(places):
        angle = float(rng.random() * 360)
        x, z = x + float(rng.normal(0, 0.06)), z + float(rng.normal(0, 0.05))
        size = float(rng.uniform(0.88, 1.08))
        yield "vase.001", pot.turned("y", angle).moved(x, 0, z)
        for name, part in trees[k % 3]:
            yield name, part.scaled(size).turned("y", angle).moved(x, 0.66, z)
    yield from _vases(trees)
    yield from _hanging_bowls(rng)
    yield from _well()


def _pot() -> Mesh:
    """A clay pot with a rolled rim, bands and festoons, on a stone-like foot of clay; its soil included."""
    profile = [(0.0, 0.0), (0.30, 0.0), (0.31, 0.03), (0.29, 0.06), (0.30, 0.09), (0.33, 0.20),
               (0.37, 0.36), (0.395, 0.50), (0.40, 0.58), (0.415, 0.59), (0.415, 0.615), (0.40, 0.625),
               (0.405, 0.66), (0.44, 0.675), (0.455, 0.70), (0.45, 0.73), (0.43, 0.74), (0.40, 0.735),
               (0.385, 0.70), (0.375, 0.655), (0.0, 0.65)]  # fmt: skip
    body = spun(profile, 36, 0.8)
    swags = []
    for k in range(4):
        t = np.linspace(-1, 1, 11)
        phi, y = np.pi / 4 * t, 0.47 - 0.13 * (1 - t**2)
        r = 0.335 + 0.145 * (y - 0.2)
        path = np.stack([r * np.sin(phi), y, r * np.cos(phi)], 1)
        ring = [(0.022 * np.cos(a), 0.022 * np.sin(a)) for a in 2 * np.pi * np.arange(6) / 6]
        swags += [moulding(ring, path, 0.8, up=(0, 0.3, 1), crease_degrees=80).turned("y", 90 * k)]
        swags += [sphere(0.045, 10, 8).scaled(1, 1, 0.6).moved(0, 0.475, 0.385).turned("y", 90 * k + 45)]
    return merged([body, *swags])


def _tree(rng: np.random.Generator) -> list[tuple[str, Mesh]]:
    """A lemon tree standing on the origin: trunk and boughs, twigs that are cut out of cards, and fruit."""
    wood = [_bough(np.array([0, -0.05, 0]), np.array([0.03, 0.62, 0.02]), 0.042, rng)]
    for _ in range(9):
        phi, lift = rng.random() * 2 * np.pi, rng.uniform(0.3, 1.2)
        tip = np.array([0.03, 0.62, 0.02]) + 0.5 * np.array(
            [np.cos(phi) * np.cos(lift), np.sin(lift), np.sin(phi) * np.cos(lift)]
        )
        wood.append(_bough(np.array([0.03, rng.uniform(0.5, 0.64), 0.02]), tip, 0.018, rng))
    middle = np.array([0.0, 1.0, 0.0])
    d = _directions(190, rng)
    bulge = 1 + 0.14 * np.sin(d @ [3.0, 2.3, 4.0])
    at = middle + d * [0.60, 0.56, 0.60] * (rng.uniform(0.35, 1.0, 190) ** 0.5 * bulge)[:, None]
    cards = _cards(at, d + [0, 0.35, 0] + rng.normal(0, 0.45, (190, 3)), rng.uniform(0.26, 0.40, 190), rng)
    lemon = sphere(0.036, 9, 7).scaled(1, 1.25, 1)
    fruit = [
        lemon.turned("x", rng.normal(0, 25)).moved(*(middle + t * 0.57 - [0, 0.08, 0]))
        for t in _directions(12, rng)
    ]
    return [("branch.001", merged(wood)), ("leaf.001", cards), ("lemon.001", merged(fruit))]


def _directions(n: int, rng: np.random.Generator) -> Floats:
    d = rng.normal(0, 1, (n, 3))
    return np.asarray(d / np.linalg.norm(d, axis=1, keepdims=True))


def _bough(a: Floats, b: Floats, radius: float, rng: np.random.Generator) -> Mesh:
    t = np.linspace(0, 1, 7)[:, None]
    path = a + (b - a) * t + np.sin(np.pi * t) * rng.normal(0, 0.03, 3)
    ring = [(radius * np.cos(k), radius * np.sin(k)) for k in 2 * np.pi * np.arange(7) / 7]
    return moulding(ring, path, 0.5, up=(0.9, 0.1, 0.4), crease_degrees=120)


def _cards(at: Floats, growth: Floats, size: Floats, rng: np.random.Generator) -> Mesh:
    """Bent cards (n, 3) that carry the picture of a twig each, every one with two faces a little apart."""
    n = len(at)
    y = growth / np.linalg.norm(growth, axis=1, keepdims=True)
    x = np.cross(y, rng.normal(0, 1, (n, 3)))
    x /= np.linalg.norm(x, axis=1, keepdims=True)
    z = np.cross(x, y)
    upwards = np.where(z[:, 1:2] < 0, -1.0, 1.0)  # leaves turn their faces to the light
    x, z = x * upwards, z * upwards
    fold, droop = rng.uniform(0.1, 0.3, (n, 1, 1)), rng.uniform(0.05, 0.3, (n, 1, 1))
    v, u = (g.reshape(1, -1, 1) for g in np.meshgrid(np.linspace(0, 1, 4), [0, 0.5, 1], indexing="ij"))
    a, s = u - 0.5, size[:, None, None]
    points = at[:, None] + s * (
        a * x[:, None] + v * y[:, None] + (fold * np.abs(a) - droop * v**2) * z[:, None]
    )
    normals = z[:, None] - fold * np.sign(a) * x[:, None] + 2 * droop * v * y[:, None]
    normals /= np.linalg.norm(normals, axis=2, keepdims=True)
    quads = np.array([[[k, k + 1, k + 4], [k, k + 4, k + 3]] for k in (0, 1, 3, 4, 6, 7)]).reshape(-1, 3)
    faces = (quads + 12 * np.arange(n)[:, None, None]).reshape(-1, 3)
    uvs = np.tile(np.concatenate([u[0], v[0]], 1), (n, 1))
    front = Mesh(points.reshape(-1, 3), faces, normals.reshape(-1, 3), uvs)
    assert front.normals is not None
    return merged([front, Mesh(front.vertices - 0.001 * front.normals, faces[:, ::-1], -front.normals, uvs)])


def _round_vase() -> Mesh:
    profile = np.array([(0.0, 0.0), (0.13, 0.0), (0.145, 0.02), (0.13, 0.045), (0.10, 0.06), (0.12, 0.09),
                        (0.20, 0.17), (0.265, 0.27), (0.29, 0.37), (0.285, 0.45), (0.25, 0.53),
                        (0.19, 0.585), (0.155, 0.61), (0.15, 0.65), (0.165, 0.69), (0.20, 0.72),
                        (0.205, 0.73), (0.19, 0.73), (0.14, 0.68), (0.13, 0.62), (0.0, 0.60)])  # fmt: skip
    vase = spun(profile, 36, 1.0)
    v = vase.vertices[:, 1] / 0.73
    assert vase.uvs is not None
    turns = max(vase.uvs[:, 0].max(), 1e-9)
    return Mesh(vase.vertices, vase.faces, vase.normals, np.c_[vase.uvs[:, 0] / turns, v])


def _vases(trees: list[list[tuple[str, Mesh]]]) -> Parts:
    """Painted vases: on plinths in the court's ends, and along the upper galleries."""
    vase = _round_vase()
    plinth = merged(
        [
            block(0.62, 0.10, 0.62, 0.015),
            block(0.5, 0.52, 0.5, 0.015).moved(y=0.09),
            block(0.6, 0.09, 0.6, 0.018).moved(y=0.60),
        ]
    )
    for side in (EAST, WEST):
        for x in (-4.0, *side.columns(), 4.0):
            yield "stone.001", side.place(plinth.moved(x, 0, 0.95))
            yield "vase_round.001", side.place(vase.scaled(1.25).moved(x, 0.688, 0.95))
    leafy = [(name, part.scaled(0.62)) for name, part in trees[1]]
    for k, x in enumerate(FAR.columns()):
        for side in (FAR, NEAR):
            yield "vase_round.001", side.place(vase.scaled(1.1).moved(x, UPPER.floor, -0.62))
        if k % 2:
            for name, part in leafy:
                yield name, FAR.place(part.moved(x, UPPER.floor + 0.68, -0.62))


def _chain(length: float, pitch: float = 0.075, wire: float = 0.008) -> Mesh:
    """A chain hanging from the origin down the y axis."""
    n = max(round(length / pitch), 1)

    def f(u: Floats, v: Floats) -> Floats:
        a, b = 2 * np.pi * u, -2 * np.pi * v
        r = 0.019 + wire * np.cos(b)
        long = np.where(np.cos(a) > 0, 1, -1) * (pitch / 2 - 0.012) * np.clip(np.abs(np.cos(a)) * 8, 0, 1)
        return np.stack([r * np.sin(a), r * np.cos(a) + long, wire * np.sin(b)], 1)

    link = surface(f, 12, 5)
    assert link.normals is not None
    if np.einsum("ij,ij->", link.normals, link.vertices) < 0:
        link = link.flipped()
    return merged(link.turned("y", 90 * (k % 2)).moved(y=-pitch * (k + 0.5)) for k in range(n))


def _hanging_bowls(rng: np.random.Generator) -> Parts:
    """Bowls on three chains under the upper arches' crowns, with trailing leaves."""
    bowl = spun([(0.0, 0.0), (0.03, -0.03), (0.05, 0.0), (0.14, 0.03), (0.22, 0.09), (0.265, 0.17),
                 (0.28, 0.20), (0.28, 0.215), (0.26, 0.215), (0.24, 0.18), (0.0, 0.17)], 32, 0.5)  # fmt: skip
    phi, r = rng.uniform(0, 2 * np.pi, 54), rng.uniform(0.05, 0.27, (54, 1))
    out = np.stack([np.cos(phi), 0 * phi, np.sin(phi)], 1)
    growth = out * rng.uniform(0.3, 1.0, (54, 1)) + np.array([0, 1, 0]) * rng.uniform(-0.9, 0.9, (54, 1))
    leaves = _cards(out * r + [0, 0.2, 0], growth, rng.uniform(0.16, 0.30, 54), rng)
    stem, spread = _chain(0.55), []
    lean = np.degrees(np.arctan2(0.27, 0.62))
    for k in range(3):
        spread.append(_chain(0.67, 0.067, 0.005).turned("x", -lean).turned("y", 120 * k))
    chains = merged(
        [stem.moved(y=1.37), *(s.moved(y=0.83) for s in spread), sphere(0.03, 10, 8).moved(y=0.83)]
    )
    y = UPPER.spring + UPPER.radius - 1.37 + 0.01
    for side in (FAR, EAST):
        for x in side.centres():
            angle = float(rng.random() * 360)
            yield "chain.001", side.place(chains.turned("y", angle).moved(x, y))
            yield "vase.001", side.place(bowl.turned("y", angle).moved(x, y))
            yield "leaf.001", side.place(leaves.turned("y", angle).moved(x, y))


def _well() -> Parts:
    """An eight-sided well head on two steps, with a yoke, a pulley, a chain and a bucket."""
    x, z = WELL

    def eight(profile: list[tuple[float, float]]) -> Mesh:
        return planar(spun(profile, 8, 1.0, 10).turned("y", 22.5), 2.0)

    steps = [
        (0.0, 0.0),
        (1.45, 0.0),
        (1.45, 0.13),
        (1.43, 0.15),
        (1.12, 0.15),
        (1.12, 0.28),
        (1.10, 0.30),
        (0.0, 0.30),
    ]
    drum = [(0.86, 0.30), (0.86, 0.42), (0.83, 0.45), (0.76, 0.47), (0.74, 0.50), (0.72, 0.54),
            (0.72, 0.98), (0.74, 1.0), (0.78, 1.03), (0.82, 1.10), (0.86, 1.12), (0.86, 1.22),
            (0.84, 1.24), (0.62, 1.24), (0.60, 1.22), (0.60, 0.4), (0.0, 0.4)]  # fmt: skip
    parts = [eight(steps), eight(drum)]
    for k in range(8):
        disc = spun(
            [(0.15, 0), (0.15, 0.02), (0.13, 0.035), (0.11, 0.02), (0.05, 0.02), (0.045, 0.045), (0, 0.055)],
            24,
        ).turned("x", 90)
        parts.append(disc.moved(0, 0.76, 0.72 * np.cos(np.pi / 8) - 0.004).turned("y", 45 * k))
    post = spun(
        [
            (0.085, 0),
            (0.085, 0.06),
            (0.06, 0.09),
            (0.055, 0.12),
            (0.05, 1.25),
            (0.065, 1.28),
            (0.065, 1.31),
            (0.09, 1.38),
            (0.09, 1.42),
        ],
        20,
    )
    for s in (-1, 1):
        parts.append(post.moved(s * 0.70, 1.23))
    beam = merged([block(1.75, 0.16, 0.2, 0.015).moved(y=2.64), block(1.9, 0.07, 0.28, 0.015).moved(y=2.80)])
    yield "stone.001", merged([*parts, beam]).moved(x, 0, z)
    wheel = spun(
        [(0.0, -0.03), (0.13, -0.03), (0.13, -0.02), (0.10, 0), (0.13, 0.02), (0.13, 0.03), (0.0, 0.03)], 24
    ).turned("x", 90)
    bucket = spun(
        [
            (0.0, 0.0),
            (0.11, 0.0),
            (0.115, 0.01),
            (0.145, 0.26),
            (0.152, 0.265),
            (0.152, 0.285),
            (0.138, 0.285),
            (0.10, 0.02),
            (0.0, 0.02),
        ],
        24,
    )
    hook = cylinder(0.012, 0.16, 10).moved(y=2.50)
    chain = _chain(0.68)
    yield "chain.001", merged([wheel.moved(y=2.43), hook, chain.moved(0.115, 2.43)]).moved(x, 0, z)
    yield "vase.001", bucket.moved(x + 0.115, 1.45, z)
