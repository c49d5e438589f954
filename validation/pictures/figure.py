"""Figures made of panels, drawn by Matplotlib without a display."""

from __future__ import annotations

import io
import math
from abc import ABC, abstractmethod
from collections.abc import Sequence
from html import escape
from typing import TYPE_CHECKING

import numpy as np

from lwa.base.arrays import Array
from lwa.base.exact import InputError
from lwa.wave.plots import axes
from validation.pictures.panel import Map, Panel

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.axis import Axis
    from matplotlib.figure import Figure

SUFFIXES = (".pdf", ".png", ".svg")
_STYLES = ("o-", "s--", "^:", "D-.", "v-", "x--", "P:", "*-.")
_FEW = 40  # points of a curve; markers at more of them would cover the curve
_ACROSS = 5  # names in a row of a legend above the panel


class Pictured(ABC):
    """A result that draws itself: into Matplotlib's axes, a figure, or a notebook."""

    @abstractmethod
    def pictured(self) -> Sequence[Panel]:
        """The panels of the picture, none for a result without a picture."""

    def figure(self) -> Figure:
        """Return all panels in one Matplotlib figure; `lwa.InputError` without panels."""
        return figure(self._panels())

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the first panel into Matplotlib's axes ``ax``, by default new ones.

        Returns the axes. Raises `lwa.InputError` without panels.
        """
        first = self._panels()[0]
        drawn: Axes = axes(ax)
        draw(drawn, first)
        return drawn

    def _panels(self) -> Sequence[Panel]:
        if found := self.pictured():
            return found
        raise InputError("plot is asked for: this result has no picture")

    def _repr_html_(self) -> str:
        """The one-line description and the picture, for a notebook."""
        return f"<p>{escape(repr(self))}</p>{svg(self.pictured())}"


def svg(panels: Sequence[Panel]) -> str:
    """Return the figure of the panels as an SVG element; empty without panels."""
    if not panels:
        return ""
    drawn = io.StringIO()
    figure(panels).savefig(drawn, format="svg")
    return drawn.getvalue()[drawn.getvalue().index("<svg") :]


def figure(panels: Sequence[Panel]) -> Figure:
    """Return a figure of all panels, two in a row."""
    from matplotlib.figure import Figure  # here: loading Matplotlib takes half a second

    columns = min(2, len(panels))
    rows = math.ceil(len(panels) / columns)
    size = 6.5 if columns == 1 else 6 * columns, 4.2 * rows
    picture = Figure(figsize=size, layout="constrained")
    plots = picture.subplots(rows, columns, squeeze=False).ravel()
    for plot, panel in zip(plots, panels, strict=False):
        draw(plot, panel)
    for empty in plots[len(panels) :]:
        empty.set_visible(False)
    return picture


def draw(plot: Axes, panel: Panel) -> None:
    """Draw one panel into Matplotlib's axes."""
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
            curve.x,
            curve.y,
            curve.error,
            fmt=style,
            color=colour,
            ms=4,
            mfc="none",  # hollow marks show the curves below
            label=curve.label or None,
        )
    for axis in panel.scale:
        _plain(getattr(plot, f"{axis}axis"))
    if any(curve.label for curve in panel.curves):
        above = panel.legend is not None and panel.legend[1] >= 1
        place = {"loc": "lower left", "bbox_to_anchor": panel.legend, "ncols": _ACROSS}
        other = {"loc": panel.legend or "best"}
        plot.legend(fontsize="small", frameon=not above, **(place if above else other))


def _plain(axis: Axis) -> None:
    """Set plain tick labels, not powers of ten, on a logarithmic axis of few decades."""
    from matplotlib.ticker import LogLocator, NullFormatter  # loaded as late as Matplotlib

    low, high = sorted(axis.get_view_interval())
    if low >= 1e-3 and high <= 1e5 and high < 1e3 * low:
        subs = (1, 1.5, 2, 3, 4, 6, 8) if high < 10 * low else (1, 2, 5)
        axis.set_major_locator(LogLocator(subs=subs))
        axis.set_major_formatter("{x:g}")
        axis.set_minor_formatter(NullFormatter())


def _draw_map(plot: Axes, found: Map, scale: str) -> None:
    from matplotlib.colors import LogNorm, Normalize  # loaded as late as Matplotlib

    values = np.ma.masked_invalid(found.values)
    norm = (LogNorm if found.scale else Normalize)(found.low, found.high)
    below = found.low is not None and bool(np.any(values < found.low))
    above = found.high is not None and bool(np.any(values > found.high))
    extend = ("neither", "min", "max", "both")[below + 2 * above]
    x, y = _borders(found.x, "x" in scale), _borders(found.y, "y" in scale)
    # Pixels in a PDF, too: viewers are slow with one rectangle for each value.
    image = plot.pcolormesh(x, y, values, norm=norm, cmap=found.colours, rasterized=True)
    plot.figure.colorbar(image, ax=plot, label=found.label, extend=extend)
    plot.patch.set(facecolor="w", edgecolor="0.4", hatch="xxx")  # unlike any colour of a map


def _borders(places: Array, log: bool) -> Array:
    """Return the borders of a map's cells, halfway between neighbouring places on the axis."""
    centres = np.log(places) if log else places
    half = np.diff(centres) / 2
    ends = [centres[0] - half[0]], centres[:-1] + half, [centres[-1] + half[-1]]
    borders = np.concatenate(ends)
    return np.exp(borders) if log else borders
