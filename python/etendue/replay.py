"""One sample's path, vertex by vertex: in words, and drawn over the picture."""

from __future__ import annotations

import base64
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from html import escape
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from . import outputs

if TYPE_CHECKING:
    from . import _core
    from .scene import Scene

_TECHNIQUES = {"bsdf_sampling": "BSDF sampling", "light_sampling": "light sampling"}
_BACKDROP_SPP = 4


@dataclass(frozen=True)
class Replay:
    """The path of sample number `sample` of `pixel`, (x, y), as `algorithm` took it; made by `Scene.replay`."""

    pixel: tuple[int, int]
    sample: int
    algorithm: str
    path: _core.PathRecord

    @property
    def radiance(self) -> tuple[float, float, float]:
        """The sample's linear radiance: what the film adds up; in the viewer without what is traced from the lights."""
        r, g, b = self.path.radiance
        return r, g, b

    @property
    def vertices(self) -> list[_core.PathVertex]:
        """The ends of the path's edges, from the camera on."""
        return self.path.vertices

    def __str__(self) -> str:
        return "\n".join(self._lines())

    def _lines(self) -> Iterator[str]:
        x, y = self.pixel
        yield f"pixel {x},{y}, sample {self.sample}, {self.algorithm}: radiance {_triple(self.radiance)}"
        for number, vertex in enumerate(self.vertices, start=1):
            yield ""
            yield from _vertex_lines(number, vertex)
        if self.path.borrowed:
            yield ""
            yield f"found by the paths of other pixels, and shared: {_triple(_total(self.path.borrowed))}"
        if self.path.by_portals:
            yield ""
            yield f"found beside the path, through glass and over mirrors: {_triple(_total(self.path.by_portals))}"
        if self.path.from_lights:
            yield ""
            yield f"found by paths from lights: {_triple(_total(self.path.from_lights))}"

    def save(self, path: str | Path, scene: Scene) -> None:
        """Draw the path over a picture of `scene`, from its camera, as an SVG file.

        Raises EtendueError where it cannot be written.
        """
        text = drawing(self, scene)
        outputs.write(Path(path), lambda place: place.write_text(text, encoding="utf-8"))


def _vertex_lines(number: int, vertex: _core.PathVertex) -> Iterator[str]:
    if vertex.hit:
        side = "front" if vertex.front else "back"
        yield f'{number}  {side} of "{vertex.material}" ({vertex.bsdf}), {vertex.distance:.4g} away'
        yield f"   position {_triple(vertex.position)}, normal {_triple(vertex.normal)}"
    else:
        yield f"{number}  out of the scene, towards {_triple(vertex.direction)}"
    yield f"   throughput {_triple(vertex.throughput)}"
    for found in vertex.contributions:
        if found.technique == "bsdf_sampling" and any(found.unweighted):
            yield f"   light found by chance: {_contribution(found)}"
    for shadow in vertex.shadow_rays:
        end = np.add(shadow.origin, shadow.direction)
        yield f"   shadow ray to {_triple(end)}: {'the light is seen' if shadow.visible else 'blocked'}"
    for found in vertex.contributions:
        if found.technique == "light_sampling":
            yield f"   light sampled: {_contribution(found)}"
    if vertex.bounce_weight is not None:
        yield (
            f"   goes on by {vertex.bounce_lobe}: pdf {vertex.bounce_pdf:.4g}, "
            f"f cos / pdf {_triple(vertex.bounce_weight)}"
        )
    if vertex.roulette_q is not None:
        outcome = (
            f"survives, x {1 / (1 - vertex.roulette_q):.4g}" if vertex.roulette_survived else "ends here"
        )
        yield f"   Russian roulette, q {vertex.roulette_q:.4g}: {outcome}"


def _total(contributions: Sequence[_core.Contribution]) -> np.ndarray:
    return np.sum([np.multiply(found.unweighted, found.weight) for found in contributions], axis=0)


def _contribution(found: _core.Contribution) -> str:
    value = _triple(np.multiply(found.unweighted, found.weight))
    if found.pdf == 0:
        return f"{value}, over {found.edges} edges"
    other = _TECHNIQUES["light_sampling" if found.technique == "bsdf_sampling" else "bsdf_sampling"]
    return (
        f"{value}, over {found.edges} edges: {_triple(found.unweighted)} x weight {found.weight:.4g} "
        f"(pdf {found.pdf:.4g}, of {other} {found.other_pdf:.4g})"
    )


def _triple(values: Sequence[float] | np.ndarray) -> str:
    return "(" + ", ".join(f"{value + 0.0:.4g}" for value in values) + ")"


_EDGE_COLOURS = ("#ffffff", "#06d6a0", "#4cc9f0", "#f78c6b", "#c77dff")
_SEEN, _BLOCKED = "#ffe14d", "#ff4d4d"
_SMALLEST_SIDE = 640  # of the drawing: a small image is enlarged


def drawing(replay: Replay, scene: Scene) -> str:
    """An SVG image: the path over the scene as its camera sees it.

    Vertices are numbered and tell about themselves under the mouse; shadow rays are dashed, red where blocked.
    What is hidden behind surfaces is drawn all the same. What is behind the camera is not.
    """
    camera = scene.camera()
    places = [camera.film_of(_end(vertex)) for vertex in replay.vertices]
    lines, marks = [], []
    for number, (vertex, place) in enumerate(zip(replay.vertices, places, strict=True), start=1):
        before = places[number - 2] if number > 1 else None
        if before and place:
            lines.append(_line(before, place, _EDGE_COLOURS[number % len(_EDGE_COLOURS)]))
        for shadow in vertex.shadow_rays:
            light = camera.film_of(np.add(shadow.origin, shadow.direction).tolist())
            if place and light:
                lines.append(_line(place, light, _SEEN if shadow.visible else _BLOCKED, dashed=True))
        if place:
            marks.append((place, number, "\n".join(_vertex_lines(number, vertex))))
    width, height = camera.width, camera.height
    scale = max(1.0, _SMALLEST_SIDE / min(width, height))
    return "\n".join(
        [
            f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" '
            f'width="{width * scale:.0f}" height="{height * scale:.0f}">',
            f"<title>{escape(next(replay._lines()))}</title>",
            f'<image width="{width}" height="{height}" style="image-rendering: pixelated" '
            f'href="data:image/png;base64,{base64.b64encode(_backdrop(scene)).decode()}"/>',
            f'<g stroke-width="{2 / scale:.3g}" font-size="{14 / scale:.3g}" font-family="sans-serif" '
            'text-anchor="middle" stroke-linecap="round">',
            *lines,
            *(_mark(*mark, scale) for mark in marks),
            "</g>",
            "</svg>",
            "",
        ]
    )


def _end(vertex: _core.PathVertex) -> list[float]:
    """The vertex; of an edge that leaves the scene a point on it, near enough to be drawn."""
    if vertex.hit:
        return list(vertex.position)
    return np.add(vertex.origin, vertex.direction).tolist()


def _line(start: Sequence[float], end: Sequence[float], colour: str, dashed: bool = False) -> str:
    ends = f'x1="{start[0]:.2f}" y1="{start[1]:.2f}" x2="{end[0]:.2f}" y2="{end[1]:.2f}"'
    dashes = ' stroke-dasharray="1% 1%" stroke-opacity="0.8"' if dashed else ""
    return f'<line {ends} stroke="{colour}"{dashes}/>'


def _mark(place: Sequence[float], number: int, text: str, scale: float) -> str:
    x, y = place
    return (
        f'<g><title>{escape(text)}</title><circle cx="{x:.2f}" cy="{y:.2f}" r="{9 / scale:.3g}" '
        f'fill="#222" stroke="#fff"/><text x="{x:.2f}" y="{y + 5 / scale:.2f}" fill="#fff">{number}</text></g>'
    )


def _backdrop(scene: Scene) -> bytes:
    """The scene as a PNG file, without light transport, so that it is clear and quick."""
    from .display import tonemap
    from .film import encoded

    film = scene.render(spp=_BACKDROP_SPP, algorithm="SimpleRenderer")
    return encoded(Path("backdrop.png"), tonemap(film.image), {})
