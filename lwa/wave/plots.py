"""Axes of figures. Matplotlib is loaded when a new figure is drawn, not before."""

from __future__ import annotations

from typing import Any


def axes(ax: Any) -> Any:
    """Return the axes ``ax``, or the axes of a new figure if ``ax`` is None."""
    if ax is None:
        from matplotlib import pyplot  # start-up: only a figure needs it

        ax = pyplot.figure().add_subplot()
    return ax
