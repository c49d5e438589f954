"""Panels of curves or colour maps, drawn by Matplotlib without a display.

A label that ends in an SI unit, such as "time (s)", is printed with the prefix that suits the
axis; the data stay in SI.
"""

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
from lwa.spheres.units import labelled

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.axis import Axis
    from matplotlib.figure import Figure

SUFFIXES = (".pdf", ".png", ".svg")
"""Endings of a picture's file."""

# Marker and dashes of the curves of a panel, in turn.
_STYLES = ("o-", "s--", "^:", "D-.", "v-", "x--", "P:", "*-.")
_FEW = 40  # points of a curve; markers at more of them would cover the curve
_ACROSS = 3  # names in a row of a legend above the panel
# Inches of a panel, with text that a page at full width keeps readable.
_SIZE = (6.2, 4.2)
# Six digits of a tick's label do not tell two ticks apart on an axis that is shorter, relative to
# its largest value. Matplotlib then prints an offset, which needs the data's own unit.
_SHORTEST = 1e-3


@dataclass(frozen=True, eq=False)
class Curve:
    """Points joined by a line.

    Parameters
    ----------
    label : str
        Name in the legend; empty for a curve that the legend leaves out.
    x, y : array_like, shape (N,)
        Coordinates.
    style : str
        Matplotlib's format, such as "C0o--". By default each curve of a panel has a colour, dashes
        and markers of its own; curves of many points have no markers.
    error : array_like, shape (N,), optional
        Half length of the error bar at each point.
    """

    label: str
    x: ArrayLike
    y: ArrayLike
    style: str = ""
    error: ArrayLike | None = None


@dataclass(frozen=True, eq=False)
class Map:
    """Values over two axes, shown as colours; cells without a value (NaN) are hatched.

    Parameters
    ----------
    label : str
        Label of the colour bar.
    x, y : ndarray, shapes (X,) and (Y,)
        Equidistant coordinates.
    values : ndarray, shape (Y, X)
        Values.
    """

    label: str
    x: Array
    y: Array
    values: Array


@dataclass(frozen=True)
class Panel:
    """One pair of axes with curves or a map.

    Parameters
    ----------
    x, y : str
        Labels of the axes.
    curves : sequence of Curve
        Curves.
    scale : {"", "x", "y", "xy"}
        Logarithmic axes.
    title : str
        Title above the axes.
    map : Map, optional
        A map in place of curves.
    legend_above : bool
        True for a legend above the panel, where the legend covers no curve.
    """

    x: str
    y: str
    curves: Sequence[Curve] = ()
    scale: str = ""
    title: str = ""
    map: Map | None = None
    legend_above: bool = False


class Pictured(ABC):
    """A result that draws itself: into Matplotlib's axes, a figure, or a notebook."""

    @abstractmethod
    def pictured(self) -> Sequence[Panel]:
        """Panels of the picture; none for a result without a picture."""

    def figure(self) -> Figure:
        """Draw all panels in one Matplotlib figure.

        Raises
        ------
        InputError
            For a result without panels.
        """
        return figure(self._panels())

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the first panel into Matplotlib's axes, by default new ones.

        Parameters
        ----------
        ax : matplotlib.axes.Axes, optional
            The axes.

        Returns
        -------
        matplotlib.axes.Axes
            The axes with the panel.

        Raises
        ------
        InputError
            For a result without panels.
        """
        first = self._panels()[0]
        if ax is None:
            from matplotlib import pyplot  # loaded as late as Matplotlib

            ax = pyplot.figure().add_subplot()
        draw(ax, first)
        return ax

    def _panels(self) -> Sequence[Panel]:
        """Panels of the picture, at least one."""
        panels = self.pictured()
        if not panels:
            raise InputError("plot is asked for: this result has no picture")
        return panels

    def _repr_html_(self) -> str:
        """The description and the picture, for a notebook."""
        return f"<pre>{escape(repr(self))}</pre>{svg(self.pictured())}"


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
    # Pyplot would need the user's display. Loading Matplotlib takes half a second.
    from matplotlib.figure import Figure

    columns = min(2, len(panels))
    rows = math.ceil(len(panels) / columns)
    width, height = _SIZE
    picture = Figure(figsize=(width * columns, height * rows), layout="constrained")
    plots = picture.subplots(rows, columns, squeeze=False).ravel()
    for plot, panel in zip(plots, panels, strict=False):
        draw(plot, panel)
    for empty in plots[len(panels) :]:
        empty.set_visible(False)
    return picture


def draw(plot: Axes, panel: Panel) -> None:
    """Draw one panel into Matplotlib's axes."""
    plot.set(xlabel=panel.x, ylabel=panel.y, title=panel.title)
    if "x" in panel.scale:
        plot.set_xscale("log")
    if "y" in panel.scale:
        plot.set_yscale("log")
    if panel.map is not None:
        _draw_map(plot, panel.map)
    for i, curve in enumerate(panel.curves):
        _draw_curve(plot, curve, i)
    _label(plot.xaxis)
    _label(plot.yaxis)
    if not any(curve.label for curve in panel.curves):
        return
    if panel.legend_above:
        # The legend's lower left corner lies upon the panel's upper left one.
        plot.legend(
            fontsize="small",
            frameon=False,
            loc="lower left",
            bbox_to_anchor=(0, 1),
            ncols=_ACROSS,
        )
    else:
        plot.legend(fontsize="small", loc="best")


def _draw_curve(plot: Axes, curve: Curve, number: int) -> None:
    """Draw a curve; its number in the panel, from 0, chooses its style."""
    # Floats: Matplotlib does not draw SymPy's numbers.
    x = np.asarray(curve.x, float)
    y = np.asarray(curve.y, float)
    style = curve.style
    if not style:
        style = _STYLES[number % len(_STYLES)]
        if len(x) > _FEW:
            style = style[1:]  # without the marker
        style = f"C{number}{style}"
    name = curve.label or None
    # Hollow marks show the curves below.
    plot.errorbar(x, y, curve.error, fmt=style, ms=4, mfc="none", label=name)


def _draw_map(plot: Axes, colours: Map) -> None:
    """Draw a map into Matplotlib's axes."""
    values = np.ma.masked_invalid(colours.values)
    # Pixels in a PDF, too: viewers are slow with one rectangle for each value.
    image = plot.pcolormesh(
        colours.x, colours.y, values, shading="nearest", rasterized=True
    )
    bar = plot.figure.colorbar(image, ax=plot, label=colours.label)
    _label(bar.ax.yaxis)
    # A hatch is unlike any colour of a map.
    plot.patch.set(facecolor="w", edgecolor="0.4", hatch="xxx")


def _label(axis: Axis) -> None:
    """Give the unit in an axis's label a prefix, if the ticks are plain numbers."""
    logarithmic = axis.get_scale() == "log"
    low, high = sorted(axis.get_view_interval())
    largest = max(abs(low), abs(high))
    unit = labelled(axis.get_label_text(), largest)
    if logarithmic:
        # Plain numbers fit an axis of few decades, where powers of ten would overlap.
        # Three decades at most, in labels of at most six characters: 0.0015 to 100000.
        short = 1e-3 * unit.size <= low and high <= 1e5 * unit.size and high < 1e3 * low
        if not short:
            return  # Matplotlib's powers of ten, in the data's own unit
        _set_plain_ticks(axis, low, high)
    elif high - low < _SHORTEST * largest:
        return
    if logarithmic or unit.size != 1:
        axis.set_label_text(unit.name)
        axis.set_major_formatter(
            lambda value, _: f"{value / unit.size:g}".replace("-", "\N{MINUS SIGN}")
        )


def _set_plain_ticks(axis: Axis, low: float, high: float) -> None:
    """Put ticks on a logarithmic axis of few decades where plain numbers do not overlap."""
    from matplotlib.ticker import LogLocator, NullFormatter

    # Factors of the powers of ten at which ticks stand: more of them within one decade.
    subs = (1, 1.5, 2, 3, 4, 6, 8) if high < 10 * low else (1, 2, 5)
    axis.set_major_locator(LogLocator(subs=subs))
    axis.set_minor_formatter(NullFormatter())
