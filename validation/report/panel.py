"""What a picture is made of: panels with curves, or a map."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from lwa.base.arrays import Array
from validation.report.table import plain


@dataclass(frozen=True, eq=False)
class Curve:
    """A row of points.

    label : none for what the legend does not name.
    error : of each y, drawn as bars.
    style : Matplotlib's, such as "C0o--"; by default one for each curve, with marks at few points.
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
        """From any sequences of numbers."""
        bars = None if error is None else np.asarray(error, float)
        return cls(label, np.asarray(x, float), np.asarray(y, float), style, bars)


@dataclass(frozen=True, eq=False)
class Map:
    """Values over two axes, shown as colours.

    label : of the colours.
    x, y, values : (X,), (Y,), (Y, X); hatched where there is no value.
    low, high : where the colours end; values beyond are shown in the last one. From the values
        where None.
    scale : "log" for logarithmic colours.
    colours : Matplotlib's name of them.
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
    """A picture with two axes: their labels ``x`` and ``y``, and which of them are logarithmic
    (``scale`` "", "x", "y" or "xy"). ``legend``: its lower left corner in shares of the panel,
    where Matplotlib finds no free place by itself."""

    x: str
    y: str
    curves: tuple[Curve, ...] = ()
    scale: str = ""
    title: str = ""
    map: Map | None = None
    legend: tuple[float, float] | None = None

    def document(self) -> dict[str, Any]:
        """For JSON: ``x``, ``y``, ``scale`` and ``curves`` of ``label``, ``x_value``,
        ``y_value``."""
        curves = [
            {"label": c.label, "x_value": plain(c.x), "y_value": plain(c.y)} for c in self.curves
        ]
        return {"x": self.x, "y": self.y, "scale": self.scale, "curves": curves}
