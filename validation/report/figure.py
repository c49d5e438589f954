"""Panels as a picture, drawn by Matplotlib without a display."""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import compress
from typing import TYPE_CHECKING

import numpy as np

from lwa.base.arrays import Array
from validation.report.panel import Map, Panel

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.axis import Axis
    from matplotlib.figure import Figure

SUFFIXES = (".pdf", ".png", ".svg")

_STYLES = ("o-", "s--", "^:", "D-.", "v-", "x--", "P:", "*-.")
_FEW = 40
"""Points of a curve, beyond which marks would cover it."""
_MOST = 10
"""Names in a panel's legend; more stand once below all panels."""


def figure(panels: Sequence[Panel]) -> Figure:
    """All panels in one picture, two in a row."""
    from matplotlib.figure import Figure  # start-up

    columns = min(2, len(panels))
    rows = math.ceil(len(panels) / columns)
    crowded = [len(panel.curves) > _MOST for panel in panels]
    size = (6.5 if columns == 1 else 6 * columns, 4.2 * rows + any(crowded))
    picture = Figure(figsize=size, layout="constrained")
    plots = picture.subplots(rows, columns, squeeze=False).ravel()
    for plot, panel in zip(plots, panels, strict=False):
        draw(plot, panel)
    for empty in plots[len(panels) :]:
        empty.set_visible(False)
    names = {label: handle for plot in compress(plots, crowded)
             for handle, label in zip(*plot.get_legend_handles_labels(), strict=True)}  # fmt: skip
    if names:
        picture.legend(names.values(), names.keys(), fontsize="small", ncols=2 * columns + 1,
                       loc="outside lower center")  # fmt: skip
    return picture


def draw(plot: Axes, panel: Panel) -> None:
    """Draw one panel."""
    plot.set(xlabel=panel.x, ylabel=panel.y, title=panel.title)
    for axis in ("x", "y"):
        if axis in panel.scale:
            plot.set(**{f"{axis}scale": "log"})
        else:  # 1, 2, … times a power of ten
            getattr(plot, f"{axis}axis").get_major_formatter().set_powerlimits((-3, 5))
    if panel.map is not None:
        _draw_map(plot, panel.map, panel.scale)
    for i, curve in enumerate(panel.curves):
        style = curve.style or _STYLES[i % len(_STYLES)]
        if not curve.style and len(curve.x) > _FEW:
            style = style[1:]
        colour = None if any(part in style for part in "Ckr") else f"C{i}"
        plot.errorbar(
            curve.x, curve.y, curve.error, fmt=style, color=colour, ms=4, label=curve.label or None
        )
    for axis in panel.scale:
        _plain(getattr(plot, f"{axis}axis"))
    if 0 < sum(bool(curve.label) for curve in panel.curves) <= _MOST:
        plot.legend(fontsize="small", loc=panel.legend or "best")


def _plain(axis: Axis) -> None:
    """Plain numbers on a logarithmic axis of few decades, not products with a power of ten."""
    from matplotlib.ticker import LogLocator, NullFormatter  # start-up

    low, high = sorted(axis.get_view_interval())
    if low >= 1e-3 and high <= 1e5 and high < 1e3 * low:
        subs = (1, 1.5, 2, 3, 4, 6, 8) if high < 10 * low else (1, 2, 5)
        axis.set_major_locator(LogLocator(subs=subs))
        axis.set_major_formatter("{x:g}")
        axis.set_minor_formatter(NullFormatter())


def _draw_map(plot: Axes, found: Map, scale: str) -> None:
    from matplotlib.colors import LogNorm, Normalize  # start-up

    values = np.ma.masked_invalid(found.values)
    norm = (LogNorm if found.scale else Normalize)(found.low, found.high)
    below = found.low is not None and bool(np.any(values < found.low))
    above = found.high is not None and bool(np.any(values > found.high))
    extend = ("neither", "min", "max", "both")[below + 2 * above]
    x, y = _borders(found.x, "x" in scale), _borders(found.y, "y" in scale)
    # as dots in a PDF, too: of a colour for each place it would be slow to show
    image = plot.pcolormesh(x, y, values, norm=norm, cmap=found.colours, rasterized=True)
    plot.figure.colorbar(image, ax=plot, label=found.label, extend=extend)
    plot.patch.set(facecolor="w", edgecolor="0.4", hatch="xxx")  # no colour of a map


def _borders(places: Array, log: bool) -> Array:
    """Half way between places, on their scale, and as far beyond the outer ones."""
    centres = np.log(places) if log else places
    half = np.diff(centres) / 2
    ends = [centres[0] - half[0]], centres[:-1] + half, [centres[-1] + half[-1]]
    borders = np.concatenate(ends)
    return np.exp(borders) if log else borders
