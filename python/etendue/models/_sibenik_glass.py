"""Stained glass: outlines cut into panes, every pane a closed thin solid held by a lead came."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from etendue.models._sibenik_shapes import Arch, bare, between, block, circle
from etendue.models.mesh import Floats, Mesh, extruded, merged

CLEAR, RED, BLUE, GREEN, YELLOW = (
    "staklo_glass",
    "staklo_glass_crveno",
    "staklo_glass_plavo",
    "staklo_glass_zeleno",
    "staklo_glass_zuto",
)
LEAD = "sprljci"
LEAD_HALF_WIDTH, LEAD_DEPTH = 0.008, 0.0035
GLASS_DEPTH = 0.005

Piece = tuple[Floats, str]


def lancet(arch: Arch, jamb: float, colours: Sequence[str], offset: float = 0.0) -> dict[str, Mesh]:
    """The glazing of a lancet window: a border, a stack of medallions, diamonds in the head.

    In the xy plane with the springing on y = 0; `colours` are those of centre, ring, corners and border.
    """
    border = 0.11 * min(1.0, arch.half / 0.4)
    jamb_steps = max(4, round(jamb / 0.3))
    outer = arch.outline(jamb, offset, 6, jamb_steps, 3)
    inner = arch.outline(jamb, -border, 6, jamb_steps, 3)
    pieces = _border(outer, inner, (colours[3], colours[2]))
    half = arch.half - border
    count = max(1, round(jamb / (2 * half)))
    edges = np.linspace(-jamb + border, 0, count + 1)
    for i, (y0, y1) in enumerate(zip(edges[:-1], edges[1:], strict=True)):
        if i % 2 == 0:
            pieces += _medallion(half, y0, y1, colours)
        else:
            pieces += _diamonds(_rectangle(-half, half, y0, y1), half / 1.5, (CLEAR, colours[0], CLEAR))
    head = arch.curve(-border, 6)
    pieces += _diamonds(head, half / 1.5, (colours[1], CLEAR, colours[0]))
    parts = _lead_up(pieces)
    bars = [block(-arch.half, arch.half, y - 0.011, y + 0.011, 0.008, 0.024, 0.003) for y in edges]
    parts[LEAD] = merged([parts[LEAD], *map(bare, bars)])
    return parts


def rose(radius: float, petals: int, colours: Sequence[str]) -> dict[str, Mesh]:
    """The glazing of a round window: rings of petals about a medallion."""
    pieces: list[Piece] = [(circle(radius * 0.2, 16), colours[0])]
    rings = (
        (0.2, 0.42, 1, colours[1:2]),
        (0.42, 0.78, 1, (colours[2], colours[0])),
        (0.78, 1.0, 2, (colours[3], CLEAR)),
    )
    for r0, r1, split, tints in rings:
        n = petals * split
        for k in range(n):
            angle = 2 * np.pi * (k + np.linspace(0, 1, 4)) / n
            ring = np.stack([np.cos(angle), np.sin(angle)], 1)
            pieces.append((radius * np.concatenate([r1 * ring, r0 * ring[::-1]]), tints[k % len(tints)]))
    return _lead_up(pieces)


def quarries(outline: Floats, size: float, colours: Sequence[str]) -> dict[str, Mesh]:
    """Plain diamond glazing of a convex outline."""
    return _lead_up(_diamonds(outline, size, colours))


def _border(outer: Floats, inner: Floats, tints: Sequence[str]) -> list[Piece]:
    nxt = np.roll(np.arange(len(outer)), -1)
    quads = [np.array([outer[i], outer[j], inner[j], inner[i]]) for i, j in enumerate(nxt)]
    return [(q, tints[i % len(tints)]) for i, q in enumerate(quads)]


def _medallion(half: float, y0: float, y1: float, colours: Sequence[str]) -> list[Piece]:
    """A disc in a ring in a rectangle."""
    middle, r = (y0 + y1) / 2, min(half, (y1 - y0) / 2)
    centre = np.array([0, middle])
    pieces: list[Piece] = [(centre + circle(0.42 * r, 12), colours[0])]
    for k in range(8):
        angle = 2 * np.pi * (k + np.linspace(0, 1, 4)) / 8
        ring = np.stack([np.cos(angle), np.sin(angle)], 1)
        tint = colours[1] if k % 2 else (colours[1] if colours[1] != colours[0] else CLEAR)
        pieces.append((centre + r * np.concatenate([0.9 * ring, 0.42 * ring[::-1]]), tint))
    for sx, sy in ((1, 1), (-1, 1), (-1, -1), (1, -1)):
        angle = np.linspace(0, np.pi / 2, 7)
        arc = 0.9 * r * np.stack([np.cos(angle), np.sin(angle)], 1)
        top = (y1 - y0) / 2
        corner = np.concatenate([[[half, 0], [half, top], [0, top]], arc[::-1]]) * [sx, sy]
        pieces.append((centre + (corner if sx * sy > 0 else corner[::-1]), colours[2]))
    return pieces


def _diamonds(outline: Floats, size: float, tints: Sequence[str]) -> list[Piece]:
    """A lattice of diamonds, one and a half times as tall as wide, within a convex outline."""
    low, high = outline.min(0), outline.max(0)
    half, tall = size / 2, 0.75 * size
    pieces = []
    columns = int(np.ceil((high[0] - low[0]) / size)) + 1
    rows = int(np.ceil((high[1] - low[1]) / tall)) + 1
    for j in range(-1, rows + 1):
        for i in range(-columns, columns + 1):
            centre = np.array([(i + (j % 2) / 2) * size, low[1] + j * tall])
            diamond = centre + np.array([[half, 0], [0, tall], [-half, 0], [0, -tall]])
            piece = _clipped(diamond, outline)
            if len(piece) >= 3 and _area(piece) > 2e-4:
                pieces.append((piece, tints[(i + 2 * j) % len(tints)]))
    return pieces


def _rectangle(x0: float, x1: float, y0: float, y1: float) -> Floats:
    return np.array([[x0, y0], [x1, y0], [x1, y1], [x0, y1]])


def _area(p: Floats) -> float:
    q = np.roll(p, -1, 0)
    return float((p[:, 0] * q[:, 1] - p[:, 1] * q[:, 0]).sum() / 2)


def _clipped(p: Floats, by: Floats) -> Floats:
    """The convex polygon `p` within the convex polygon `by`, both counter-clockwise."""
    out = list(p)
    for a, b in zip(by, np.roll(by, -1, 0), strict=True):
        edge = b - a
        if edge @ edge < 1e-16:
            continue
        side = [edge[0] * (q[1] - a[1]) - edge[1] * (q[0] - a[0]) for q in out]
        kept = []
        for k in range(len(out)):
            q, r, s, t = out[k - 1], out[k], side[k - 1], side[k]
            if (s < -1e-12 and t > 1e-12) or (s > 1e-12 and t < -1e-12):
                kept.append(q + (r - q) * (s / (s - t)))
            if t >= -1e-12:
                kept.append(r)
        out = kept
        if not out:
            break
    points = np.array(out).reshape(-1, 2)
    if len(points):
        points = points[np.linalg.norm(points - np.roll(points, 1, 0), axis=1) > 2e-3]
    return points


def _inset(p: Floats, by: float) -> Floats | None:
    """The polygon with every edge moved inwards, or None where nothing would be left of it.

    Edges may vanish from a convex polygon; others keep all of theirs.
    """
    edge = np.roll(p, -1, 0) - p
    edge = edge / np.linalg.norm(edge, axis=1, keepdims=True)
    inward = np.stack([-edge[:, 1], edge[:, 0]], 1)
    before, after = np.roll(inward, 1, 0), inward
    moved = p + by * (before + after) / (1 + (before * after).sum(1, keepdims=True)).clip(0.2)
    along = ((np.roll(moved, -1, 0) - moved) * edge).sum(1)
    if (along <= 1e-3).any():
        moved = p
        for start, direction, normal in zip(p, edge, inward, strict=True):
            line = start + by * normal
            far = 10 * direction
            deep = 10 * normal
            moved = _clipped(moved, np.array([line - far, line + far, line + far + deep, line - far + deep]))
            if len(moved) < 3:
                return None
    return moved if _area(moved) > 3e-4 else None


def _lead_up(pieces: Sequence[Piece]) -> dict[str, Mesh]:
    """Panes and cames of pieces that lie side by side; a piece too small for glass becomes lead."""
    parts: dict[str, list[Mesh]] = {LEAD: []}
    for outline, tint in pieces:
        hole, pane = _inset(outline, LEAD_HALF_WIDTH), _inset(outline, LEAD_HALF_WIDTH - 0.003)
        if hole is None or pane is None:
            parts[LEAD].append(extruded(outline, LEAD_DEPTH))
            continue
        parts[LEAD].append(_came(outline, hole))
        parts.setdefault(tint, []).append(extruded(pane, GLASS_DEPTH).moved(z=-GLASS_DEPTH / 2))
    return {name: merged(bare(m) for m in meshes) for name, meshes in parts.items()}


def _came(outer: Floats, inner: Floats) -> Mesh:
    """A flat frame between two outlines, close before the glass: nobody sees its back or its sides."""
    n = len(inner)
    if len(outer) != n:
        front = between(inner, outer, inner.mean(0), closed=True)
        return Mesh(front.vertices, front.faces).moved(z=LEAD_DEPTH)
    i = np.arange(n)
    j = np.roll(i, -1)
    face = np.concatenate([np.stack([n + i, n + j, j], 1), np.stack([n + i, j, i], 1)])
    return Mesh(np.c_[np.concatenate([inner, outer]), np.full(2 * n, LEAD_DEPTH)], face)
