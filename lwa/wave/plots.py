"""Figures of waves. Matplotlib is loaded when a new figure is drawn, not before."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from lwa.base.arrays import Array


def axes(ax: Any) -> Any:
    """The given axes, or those of a new figure."""
    if ax is None:
        from matplotlib import pyplot  # start-up: only a figure needs it

        ax = pyplot.figure().add_subplot()
    return ax


def draw(
    ax: Any, x: Array, curves: Mapping[str, Array], xlabel: str, ylabel: str, title: str = ""
) -> Any:
    """Draw curves over x with a legend on ``ax`` or a new figure, and return the axes."""
    ax = axes(ax)
    for label, values in curves.items():
        ax.plot(x, values, label=label)
    ax.set(xlabel=xlabel, ylabel=ylabel, title=title)
    ax.legend()
    return ax
