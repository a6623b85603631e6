"""The report's drawings: SVG that takes the page's colours, and small pictures."""

from __future__ import annotations

import base64
import io
import warnings
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .bias import Bias
from .extras import needed
from .statistics import product_of_means
from .tally import Curve
from .techniques import NAMES, Row

# Apart for all kinds of colour vision, on light and dark (Okabe and Ito 2008).
COLOURS = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#8c6d31", "#999999")
# Stands for the colour of the page's text, whichever that is.
_INK = "#010203"


def curves(names: Sequence[str], all_curves: Sequence[Sequence[Curve]]) -> str:
    """The root of relMSE over samples and over seconds, log-log: means of the repeats with their intervals."""
    figure, axes = _figure(2, 10.4, 3.9, right=1.5)
    for axis, unit in zip(axes, ("spp", "seconds"), strict=True):
        for index, (name, repeats) in enumerate(zip(names, all_curves, strict=True)):
            _curve(axis, repeats, unit, name, COLOURS[index % len(COLOURS)])
        axis.set_xscale("log")
        axis.set_yscale("log")
        _guide(axis)
        axis.set_xlabel("samples per pixel" if unit == "spp" else "seconds of rendering")
    axes[0].set_ylabel("√relMSE")
    axes[1].legend(fontsize=9, loc="upper left", bbox_to_anchor=(1, 1), frameon=False, labelcolor=_INK)
    return _svg(figure, "Error over samples and over time")


def p_values(verdict: Bias) -> str:
    """Histogram of the tiles' p-values: flat where the estimator is right."""
    figure, axis = _figure(1, 3.4, 2.3)
    p = verdict.p_values.ravel()
    bins = 10
    axis.hist(p, bins=np.linspace(0, 1, bins + 1), color=COLOURS[0], alpha=0.8)
    axis.axhline(len(p) / bins, color=_INK, lw=0.8, ls="--")
    axis.set_xlabel("p-value of a tile")
    axis.set_ylabel("tiles")
    return _svg(figure, "Histogram of p-values")


def bias_map(verdict: Bias) -> str:
    """Relative difference of each tile, with those that fall outlined."""
    figure, axis = _figure(1, 3.4, 2.6)
    figure.subplots_adjust(0.02, 0.04, 0.96, 0.96)
    values = verdict.relative
    limit = max(float(np.percentile(np.abs(values), 98)), 1e-4)
    image = axis.imshow(values, cmap="RdBu_r", vmin=-limit, vmax=limit, interpolation="nearest")
    for y, x in np.argwhere(verdict.rejected):
        axis.add_patch(_rectangle(x, y))
    axis.set_xticks([])
    axis.set_yticks([])
    bar = figure.colorbar(
        image, ax=axis, shrink=0.9, format=lambda value, _: f"{value:+.2g}".replace("+0", "0")
    )
    bar.ax.tick_params(colors=_INK, labelsize=8)
    bar.outline.set_visible(False)
    return _svg(figure, "Relative difference of tiles from the reference")


def pyramid_bars(rows: Sequence[Row]) -> str:
    """Contribution and variance of each technique by path length, after MIS weights and before."""
    figure, axes = _figure(2, 10.4, 3.2, right=1.9)
    places = np.arange(len(rows))
    for axis, quantity in zip(axes, ("mean", "variance"), strict=True):
        table = np.array([getattr(row, quantity) for row in rows])
        for technique, name in enumerate(NAMES):
            colour = COLOURS[technique]
            at = places + 0.4 * technique - 0.3
            axis.bar(at, table[:, 1, technique], 0.2, color=colour, alpha=0.35, label=f"{name}, alone")
            axis.bar(at + 0.2, table[:, 0, technique], 0.2, color=colour, label=f"{name}, weighted")
        axis.set_xticks(places, [row.edges for row in rows])
        axis.set_xlabel("path length in rays")
        axis.set_ylabel("contribution" if quantity == "mean" else "variance of one sample")
        if table.max() > 0:
            axis.set_yscale("log")
            axis.set_ylim(max(table[table > 0].min() / 2, table.max() * 1e-6), 2 * table.max())
    axes[1].legend(fontsize=8, loc="upper left", bbox_to_anchor=(1, 1), frameon=False, labelcolor=_INK)
    return _svg(figure, "Contribution and variance by technique and path length")


def png(pixels: NDArray[np.uint8]) -> str:
    """A data URL of pixels (height, width, 3)."""
    return _image(pixels, "png", {})


def jpeg(pixels: NDArray[np.uint8]) -> str:
    """The same, smaller and almost the same."""
    return _image(pixels, "jpeg", {"quality": 88})


def _image(pixels: NDArray[np.uint8], kind: str, options: dict[str, Any]) -> str:
    with io.BytesIO() as buffer:
        needed("matplotlib.image").imsave(
            buffer, np.ascontiguousarray(pixels), format=kind, pil_kwargs=options
        )
        return f"data:image/{kind};base64,{base64.b64encode(buffer.getvalue()).decode()}"


def _figure(columns: int, width: float, height: float, right: float = 0.0) -> tuple[Any, Any]:
    """Axes side by side, with inches of room at the right. Without pyplot, whose state would outlive the report.

    The margins are fixed: to have them computed would take longer than all the rest.
    """
    figure = needed("matplotlib.figure").Figure(figsize=(width, height))
    axes = figure.subplots(1, columns)
    figure.subplots_adjust(0.7 / width, 0.55 / height, 1 - (0.15 + right) / width, 1 - 0.15 / height, 0.25)
    for axis in np.atleast_1d(axes):
        axis.patch.set_alpha(0)
        axis.spines[["top", "right"]].set_visible(False)
        axis.spines[["left", "bottom"]].set_color(_INK)
        axis.tick_params(colors=_INK, which="both", labelsize=9)
        axis.xaxis.label.set_color(_INK)
        axis.yaxis.label.set_color(_INK)
    return figure, axes


def _curve(axis: Any, repeats: Sequence[Curve], unit: str, name: str, colour: str) -> None:
    """Points that all repeats have; those of the end differ where the time was the limit."""
    points = list(zip(*(repeat[: min(map(len, repeats))] for repeat in repeats), strict=True))
    x = [float(np.mean([getattr(each, unit) for each in point])) for point in points]
    estimates = [product_of_means([([each.errors["relMSE"] for each in point], 0.5)]) for point in points]
    values = np.array([(e.value, e.low, e.high) for e in estimates])
    axis.plot(x, values[:, 0], color=colour, label=_plain(name), marker="o", ms=3, lw=1.5)
    if np.isfinite(values).all():
        axis.fill_between(x, values[:, 1], values[:, 2], color=colour, alpha=0.2, lw=0)


def _guide(axis: Any) -> None:
    """The slope that independent samples have: twice the effort, the root of two less error."""
    (left, right), (low, high) = axis.get_xlim(), axis.get_ylim()
    x = np.geomspace(left, right, 2)
    for top in np.geomspace(low, high * (right / left) ** 0.5, 8)[1:-1]:
        axis.plot(x, top * (x / left) ** -0.5, color=_INK, lw=0.5, ls=":", alpha=0.6, zorder=0)
    axis.set_xlim(left, right)
    axis.set_ylim(low, high)


def _plain(name: str) -> str:
    """For a legend: no mathematics, and labels that begin with _ are shown, too."""
    return "\u200b" + name.replace("$", r"\$")


def _rectangle(x: int, y: int) -> Any:
    return needed("matplotlib.patches").Rectangle((x - 0.5, y - 0.5), 1, 1, fill=False, ec=_INK, lw=1)


def _svg(figure: Any, label: str) -> str:
    """The figure as an SVG element with texts that stay texts, in the page's colour."""
    matplotlib = needed("matplotlib")
    with (
        io.StringIO() as buffer,
        matplotlib.rc_context({"svg.fonttype": "none", "font.family": "sans-serif"}),
    ):
        # A name may hold letters that the font measuring it has not; the browser has them.
        warnings.simplefilter("ignore")
        figure.savefig(buffer, format="svg", transparent=True, metadata={"Date": None, "Creator": None})
        text = buffer.getvalue()
    text = text[text.index("<svg") :].replace(_INK, "currentColor")
    return text.replace("<svg", f'<svg role="img" aria-label="{label}"', 1)
