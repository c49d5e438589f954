"""Panels: curves or a colour map over two axes, and how they are drawn."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from lwa.base.arrays import Array


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
    x: Array
    y: Array
    style: str = ""
    error: Array | None = None

    @classmethod
    def of(
        cls, label: str, x: ArrayLike, y: ArrayLike, style: str = "", error: ArrayLike | None = None
    ) -> Curve:
        """Return a curve through any sequences of numbers."""
        bars = None if error is None else np.asarray(error, float)
        return cls(label, np.asarray(x, float), np.asarray(y, float), style, bars)


@dataclass(frozen=True, eq=False)
class Map:
    """Values over two axes, shown as colours; cells without a value (NaN) are hatched.

    label : label of the colour bar.
    x, y, values : coordinates (X,) and (Y,), and values (Y, X).
    low, high : ends of the colour scale, by default the range of the values. Values beyond an end
        have the colour of that end.
    scale : "log" for logarithmic colours.
    colours : Matplotlib's name of the colour map.
    """

    label: str
    x: Array
    y: Array
    values: Array
    low: float | None = None
    high: float | None = None
    scale: str = ""
    colours: str = "viridis"


@dataclass(frozen=True)
class Panel:
    """One pair of axes with curves or a map.

    x, y : labels of the axes.
    scale : logarithmic axes: "", "x", "y" or "xy".
    legend : lower left corner of the legend in fractions of the panel, above it from 1 on; by
        default where Matplotlib finds most room.
    """

    x: str
    y: str
    curves: tuple[Curve, ...] = ()
    scale: str = ""
    title: str = ""
    map: Map | None = None
    legend: tuple[float, float] | None = None

    def document(self) -> dict[str, Any]:
        """The labels and curves for JSON."""
        curves = [
            {"label": c.label, "x_value": _finite(c.x), "y_value": _finite(c.y)}
            for c in self.curves
        ]
        return {"x": self.x, "y": self.y, "scale": self.scale, "curves": curves}


def _finite(values: Array) -> list[float | None]:
    return [x if np.isfinite(x) else None for x in values.tolist()]
