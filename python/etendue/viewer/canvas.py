"""The picture in the window: its textures, the line of the split view, and what the mouse does there."""

from __future__ import annotations

from typing import Any

import numpy as np
from imgui_bundle import IM_COL32, imgui, immvision

from ..display import false_colour
from . import inspector
from .navigation import angles_of_drag, turned
from .pictures import Picture
from .session import Session
from .viewer import Viewer

_CLICK, _GRIP = 4.0, 8.0  # pixels
_WHEEL = 1.15
_SCALE_WIDTH, _SCALE_STEPS = 120.0, 30


class Texture:
    """A session's newest picture on the graphics card."""

    def __init__(self) -> None:
        self._texture: Any = None
        self._picture: Picture | None = None

    def update(self, session: Session) -> None:
        """Uploads the newest picture, if it is another one."""
        picture = session.picture
        if picture is not None and picture is not self._picture:
            if self._texture is None:
                self._texture = immvision.GlTexture()
            self._texture.update_from_image(picture.pixels)
            self._picture = picture

    def draw(
        self,
        corner: tuple[float, float],
        size: tuple[float, float],
        part: tuple[float, float],
        resolution: tuple[int, int],
    ) -> None:
        """Draws what is between two parts (0..1) of the width."""
        picture = self._picture
        if picture is None or part[0] >= part[1]:
            return
        height, width = picture.pixels.shape[:2]
        # The last pixels of a coarse picture reach beyond the image.
        u, v = resolution[0] / (width * picture.stride), resolution[1] / (height * picture.stride)
        left, right = (corner[0] + size[0] * place for place in part)
        imgui.get_window_draw_list().add_image(
            imgui.ImTextureRef(self._texture.texture_id),
            (left, corner[1]),
            (right, corner[1] + size[1]),
            (part[0] * min(u, 1), 0),
            (part[1] * min(u, 1), min(v, 1)),
        )

    @property
    def picture(self) -> Picture | None:
        """What is on it."""
        return self._picture


class Canvas:
    """The area of the window that shows the picture."""

    def __init__(self) -> None:
        self._textures = [Texture(), Texture()]
        self._looking = False
        self._moving_line = False

    @property
    def picture(self) -> Picture | None:
        """What is shown, left of the line where there are two."""
        return self._textures[0].picture

    def draw(self, viewer: Viewer) -> None:
        """Draws the picture into the rest of the window, and follows the mouse."""
        for texture, session in zip(self._textures, viewer.sessions, strict=False):
            texture.update(session)
        room, start = imgui.get_content_region_avail(), imgui.get_cursor_screen_pos()
        framebuffer = viewer.document.config.framebuffer
        scene = viewer.session.scene
        if scene is not None:
            framebuffer = scene.config.framebuffer
        resolution = framebuffer.res_w, framebuffer.res_h
        scale = min(room.x / resolution[0], room.y / resolution[1])
        size = resolution[0] * scale, resolution[1] * scale
        corner = start.x + (room.x - size[0]) / 2, start.y + (room.y - size[1]) / 2
        imgui.set_cursor_screen_pos(corner)
        flags = imgui.ButtonFlags_.mouse_button_left | imgui.ButtonFlags_.mouse_button_right
        imgui.invisible_button("canvas", (max(size[0], 1), max(size[1], 1)), flags)
        split = viewer.split
        part = 1.0 if split is None else split.position
        self._textures[0].draw(corner, size, (0, part), resolution)
        if split is not None:
            self._textures[1].draw(corner, size, (part, 1), resolution)
            self._draw_line(viewer, corner, size)
        picture = self._textures[0].picture
        if picture is not None and picture.scale is not None:
            _draw_scale(picture.scale, (corner[0] + size[0], corner[1] + size[1]))
        if viewer.inspecting:
            inspector.draw_over(viewer, corner, scale)
        self._follow(viewer, corner, size, scale)

    def _draw_line(self, viewer: Viewer, corner: tuple[float, float], size: tuple[float, float]) -> None:
        split = viewer.split
        assert split is not None
        x = corner[0] + size[0] * split.position
        lines = imgui.get_window_draw_list()
        white, shade = IM_COL32(255, 255, 255, 230), IM_COL32(0, 0, 0, 170)
        lines.add_line((x, corner[1]), (x, corner[1] + size[1]), shade, 4)
        lines.add_line((x, corner[1]), (x, corner[1] + size[1]), white, 1.5)
        names = [session.scene.config.algorithm if session.scene else "" for session in viewer.sessions]
        for name, right in zip(names, (True, False), strict=False):
            width = imgui.calc_text_size(name).x
            at = (x - width - 16 if right else x + 10, corner[1] + 10)
            lines.add_rect_filled(
                (at[0] - 5, at[1] - 3), (at[0] + width + 5, at[1] + imgui.get_font_size() + 3), shade, 4
            )
            lines.add_text(at, white, name)

    def _follow(
        self, viewer: Viewer, corner: tuple[float, float], size: tuple[float, float], scale: float
    ) -> None:
        io, hovered = imgui.get_io(), imgui.is_item_hovered()
        at = io.mouse_pos
        if hovered and io.mouse_wheel:
            viewer.speed = min(max(viewer.speed * _WHEEL**io.mouse_wheel, 1e-4), 1e6)
            viewer.say(f"speed {viewer.speed:.3g}")
        if hovered and imgui.is_mouse_clicked(imgui.MouseButton_.right):
            viewer.attempt(lambda: viewer.focus((at.x - corner[0]) / scale, (at.y - corner[1]) / scale))
        if imgui.is_item_activated():
            split = viewer.split
            line = None if split is None else corner[0] + size[0] * split.position
            self._moving_line = line is not None and abs(at.x - line) < _GRIP
        if imgui.is_item_active() and imgui.is_mouse_down(imgui.MouseButton_.left):
            self._drag(viewer, corner, size)
        if imgui.is_item_deactivated():
            moved = imgui.get_mouse_drag_delta(imgui.MouseButton_.left, 0)
            if viewer.inspecting and not self._looking and abs(moved.x) + abs(moved.y) <= _CLICK:
                viewer.pixel = int((at.x - corner[0]) / scale), int((at.y - corner[1]) / scale)
            self._looking = self._moving_line = False

    def _drag(self, viewer: Viewer, corner: tuple[float, float], size: tuple[float, float]) -> None:
        io = imgui.get_io()
        if self._moving_line and viewer.split is not None:
            viewer.split.position = min(max((io.mouse_pos.x - corner[0]) / size[0], 0.0), 1.0)
            return
        total = imgui.get_mouse_drag_delta(imgui.MouseButton_.left, 0)
        self._looking = self._looking or abs(total.x) + abs(total.y) > _CLICK
        if self._looking and (io.mouse_delta.x or io.mouse_delta.y):
            camera = viewer.document.config.camera
            turn = angles_of_drag(camera, (io.mouse_delta.x, io.mouse_delta.y), size[1])
            viewer.attempt(lambda: viewer.document.set(turned(camera, *turn), gesture="look"))


def _draw_scale(scale: tuple[float, float], corner: tuple[float, float]) -> None:
    """The false colours between their lowest and highest value, left of and above a corner."""
    lines, line = imgui.get_window_draw_list(), imgui.get_font_size()
    low, high = scale
    texts = f"{low:.3g}", f"{high:.3g}"
    widths = [imgui.calc_text_size(text).x for text in texts]
    right, bottom = corner[0] - 14, corner[1] - 12
    left = right - widths[0] - widths[1] - _SCALE_WIDTH - 16
    lines.add_rect_filled((left - 8, bottom - line - 6), (right + 8, bottom + 6), IM_COL32(0, 0, 0, 190), 4)
    lines.add_text((left, bottom - line), IM_COL32(255, 255, 255, 230), texts[0])
    lines.add_text((right - widths[1], bottom - line), IM_COL32(255, 255, 255, 230), texts[1])
    colours = false_colour.coloured(np.linspace(1, 2, _SCALE_STEPS), (1, 2))
    start, step = left + widths[0] + 8, _SCALE_WIDTH / _SCALE_STEPS
    for index, (red, green, blue) in enumerate(colours.tolist()):
        x = start + index * step
        lines.add_rect_filled((x, bottom - line + 2), (x + step, bottom - 2), IM_COL32(red, green, blue, 255))
