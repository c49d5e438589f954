"""Panels of curves or colour maps, drawn by Matplotlib without a display."""

from __future__ import annotations

import io
import math
from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass
from html import escape
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from lwa.base.arrays import Array
from lwa.base.exact import InputError

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.axis import Axis
    from matplotlib.figure import Figure

SUFFIXES = (".pdf", ".png", ".svg")
_STYLES = ("o-", "s--", "^:", "D-.", "v-", "x--", "P:", "*-.")
_FEW = 40  # points of a curve; markers at more of them would cover the curve
_ACROSS = 3  # names in a row of a legend above the panel


@dataclass(frozen=True, eq=False)
class Curve:
    """Points joined by a line.

    label : name in the legend; empty for a curve that the legend leaves out.
    x, y : coordinates, both (N,).
    style : Matplotlib's format, such as "C0o--". By default each curve of a panel has its own
        colour, dashes and markers; curves of many points have no markers.
    error : half length of the error bar at each point, (N,).
    """

    label: str
    x: ArrayLike
    y: ArrayLike
    style: str = ""
    error: ArrayLike | None = None


@dataclass(frozen=True, eq=False)
class Map:
    """Values over two axes, shown as colours; cells without a value (NaN) are hatched.

    label : label of the colour bar.
    x, y, values : equidistant coordinates (X,) and (Y,), and values (Y, X).
    """

    label: str
    x: Array
    y: Array
    values: Array


@dataclass(frozen=True)
class Panel:
    """One pair of axes with curves or a map.

    x, y : labels of the axes.
    scale : logarithmic axes: "", "x", "y" or "xy".
    legend_above : True for a legend above the panel, where it covers no curve.
    """

    x: str
    y: str
    curves: tuple[Curve, ...] = ()
    scale: str = ""
    title: str = ""
    map: Map | None = None
    legend_above: bool = False


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
        if ax is None:
            from matplotlib import pyplot  # loaded as late as Matplotlib

            ax = pyplot.figure().add_subplot()
        draw(ax, first)
        return ax

    def _panels(self) -> Sequence[Panel]:
        if panels := self.pictured():
            return panels
        raise InputError("plot is asked for: this result has no picture")

    def _repr_html_(self) -> str:
        """The one-line description and the picture, for a notebook."""
        return f"<p>{escape(repr(self))}</p>{svg(self.pictured())}"


def svg(panels: Sequence[Panel]) -> str:
    """Return the figure of the panels as an SVG element named by its axes, or an empty text."""
    if not panels:
        return ""
    drawn = io.StringIO()
    figure(panels).savefig(drawn, format="svg")
    label = escape("; ".join(f"{panel.y} over {panel.x}" for panel in panels))
    picture = drawn.getvalue().partition("<svg")[2]
    return f'<svg role="img" aria-label="{label}"{picture}'


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
    scales = {f"{axis}scale": "log" for axis in panel.scale}
    plot.set(xlabel=panel.x, ylabel=panel.y, title=panel.title, **scales)
    if panel.map is not None:
        _draw_map(plot, panel.map)
    for i, curve in enumerate(panel.curves):
        x, y = np.asarray(curve.x, float), np.asarray(curve.y, float)
        error = None if curve.error is None else np.asarray(curve.error, float)
        default = _STYLES[i % len(_STYLES)]
        style = curve.style or f"C{i}{default if len(x) <= _FEW else default[1:]}"
        # hollow marks show the curves below
        plot.errorbar(
            x, y, error, fmt=style, ms=4, mfc="none", label=curve.label or None
        )
    for axis in panel.scale:
        _label_plainly(getattr(plot, f"{axis}axis"))
    if any(curve.label for curve in panel.curves):
        above = {
            "loc": "lower left",
            "bbox_to_anchor": (0, 1),
            "ncols": _ACROSS,
            "frameon": False,
        }
        plot.legend(
            fontsize="small", **(above if panel.legend_above else {"loc": "best"})
        )


def _label_plainly(axis: Axis) -> None:
    """Set plain tick labels on a logarithmic axis of few decades, where powers of ten overlap."""
    from matplotlib.ticker import (
        LogLocator,
        NullFormatter,
    )  # loaded as late as Matplotlib

    low, high = sorted(axis.get_view_interval())
    if low >= 1e-3 and high <= 1e5 and high < 1e3 * low:
        subs = (1, 1.5, 2, 3, 4, 6, 8) if high < 10 * low else (1, 2, 5)
        axis.set_major_locator(LogLocator(subs=subs))
        axis.set_major_formatter("{x:g}")
        axis.set_minor_formatter(NullFormatter())


def _draw_map(plot: Axes, colours: Map) -> None:
    """Draw a map into Matplotlib's axes."""
    # Pixels in a PDF, too: viewers are slow with one rectangle for each value.
    values = np.ma.masked_invalid(colours.values)
    image = plot.pcolormesh(
        colours.x, colours.y, values, shading="nearest", rasterized=True
    )
    plot.figure.colorbar(image, ax=plot, label=colours.label)
    plot.patch.set(
        facecolor="w", edgecolor="0.4", hatch="xxx"
    )  # unlike any colour of a map
