"""The pixel inspector: a pixel's value and variance, and the last paths through it."""

from __future__ import annotations

import numpy as np
from imgui_bundle import IM_COL32, imgui

from .viewer import Viewer

_EDGES = ((255, 255, 255), (6, 214, 160), (76, 201, 240), (247, 140, 107), (199, 125, 255))
_SEEN, _BLOCKED = (255, 225, 77), (255, 77, 77)


def draw(viewer: Viewer) -> None:
    """Draw the inspector's window."""
    imgui.set_next_window_size((430, 420), imgui.Cond_.first_use_ever)
    expanded, is_open = imgui.begin("Pixel inspector", True)
    viewer.inspecting = bool(is_open)
    if expanded:
        if viewer.pixel is None:
            imgui.text_wrapped("Click a pixel of the image.")
        else:
            _draw_value(viewer)
            replays, renderer = viewer.replays(), viewer.session.renderer
            if replays and renderer is not None and renderer.light_paths > 0:
                imgui.text_wrapped("Its paths, without light that is traced from the lights:")
            for replay in replays:
                radiance = ", ".join(f"{value:.3g}" for value in replay.radiance)
                edges = len(replay.vertices)
                if imgui.tree_node(f"sample {replay.sample}: {radiance}; {edges} edges###{replay.sample}"):
                    imgui.push_text_wrap_pos(0.0)
                    imgui.text_unformatted("\n".join(str(replay).splitlines()[2:]))
                    imgui.pop_text_wrap_pos()
                    imgui.tree_pop()
    imgui.end()


def _draw_value(viewer: Viewer) -> None:
    renderer, pixel = viewer.session.renderer, viewer.pixel
    if renderer is None or pixel is None:
        return
    x, y = pixel
    found = renderer.pixel(x, y)
    if found is None:
        imgui.text_wrapped(f"pixel {x}, {y}: outside of the image")
        return
    mean, variance, count, invalid = found
    rows = (
        ("pixel", f"{x}, {y}"),
        ("value", ", ".join(f"{value:.5g}" for value in mean)),
        ("variance of a sample", ", ".join(f"{value:.4g}" for value in variance)),
        ("samples", f"{count}" + (f", {invalid} of them invalid" if invalid else "")),
    )
    if imgui.begin_table("pixel", 2):
        for name, text in rows:
            imgui.table_next_row()
            imgui.table_next_column()
            imgui.text_disabled(name)
            imgui.table_next_column()
            imgui.text_unformatted(text)
        imgui.end_table()
    imgui.separator_text("last paths")


def draw_over(viewer: Viewer, corner: tuple[float, float], scale: float) -> None:
    """Draw the last paths over the picture, vertex by vertex as the camera sees them."""
    scene = viewer.session.scene
    if scene is None or viewer.pixel is None:
        return
    camera, lines = scene.camera(), imgui.get_window_draw_list()

    def place(point: list[float]) -> tuple[float, float] | None:
        film = camera.film_of(point)
        return None if film is None else (corner[0] + film[0] * scale, corner[1] + film[1] * scale)

    lines.push_clip_rect(corner, (corner[0] + camera.width * scale, corner[1] + camera.height * scale), True)
    for age, replay in enumerate(viewer.replays()):
        alpha = max(230 - 28 * age, 40)
        before = None
        for number, vertex in enumerate(replay.vertices):
            end = vertex.position if vertex.hit else np.add(vertex.origin, vertex.direction).tolist()
            here = place(list(end))
            if before and here:
                lines.add_line(before, here, IM_COL32(*_EDGES[number % len(_EDGES)], alpha), 1.6)
            for shadow in vertex.shadow_rays:
                light = place(np.add(shadow.origin, shadow.direction).tolist())
                if here and light:
                    colour = _SEEN if shadow.visible else _BLOCKED
                    lines.add_line(here, light, IM_COL32(*colour, alpha // 2), 1)
            if here:
                lines.add_circle_filled(here, 3, IM_COL32(20, 20, 20, alpha))
                lines.add_circle(here, 3, IM_COL32(255, 255, 255, alpha))
            before = here
    x, y = (corner[axis] + (viewer.pixel[axis] + 0.5) * scale for axis in (0, 1))
    for ring, width in ((IM_COL32(0, 0, 0, 200), 4.0), (IM_COL32(255, 255, 255, 255), 1.5)):
        lines.add_circle((x, y), 7, ring, 0, width)
    lines.pop_clip_rect()
