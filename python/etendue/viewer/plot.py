"""The live plot of the split view: each estimator's error over time."""

from __future__ import annotations

import numpy as np
from imgui_bundle import imgui, implot

from .viewer import Viewer

# Within a decade, too, as an error rarely falls by more.
_TICKS = [digit * 10.0**power for power in range(-5, 6) for digit in (1, 1.5, 2, 3, 5, 7)]


def draw(viewer: Viewer) -> None:
    """Draw the plot's window."""
    imgui.set_next_window_size((460, 280), imgui.Cond_.first_use_ever)
    expanded = imgui.begin("Error over time")[0]
    if expanded and not any(session.errors for session in viewer.sessions):
        imgui.text_wrapped("There is an estimate once each pixel has a few samples.")
    elif expanded:
        flags = implot.AxisFlags_.auto_fit
        if implot.begin_plot("##errors", (-1, -1)):
            implot.setup_axes("seconds of rendering", "relative error", flags, flags)
            implot.setup_axis_scale(implot.ImAxis_.x1, implot.Scale_.log10)
            implot.setup_axis_scale(implot.ImAxis_.y1, implot.Scale_.log10)
            implot.setup_axis_ticks(implot.ImAxis_.x1, _TICKS, [f"{tick:g}" for tick in _TICKS])
            implot.setup_axis_ticks(implot.ImAxis_.y1, _TICKS, [f"{100 * tick:g}%" for tick in _TICKS])
            implot.setup_legend(
                implot.Location_.north, implot.LegendFlags_.outside | implot.LegendFlags_.horizontal
            )
            for side, session in zip(("left", "right"), viewer.sessions, strict=False):
                points, scene = session.errors, session.scene
                if points and scene is not None:
                    seconds, errors = np.array(points, np.float64).T.copy()
                    implot.plot_line(f"{scene.config.algorithm} ({side})", seconds, errors)
            implot.end_plot()
    imgui.end()
