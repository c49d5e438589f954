"""A result as a picture, drawn by Matplotlib without a display.

Matplotlib is imported when a picture is drawn. A file appears only when it is complete.
"""

from __future__ import annotations

from functools import singledispatch
from pathlib import Path
from typing import TYPE_CHECKING, Any

from validation.report.files import output_file, replacing

if TYPE_CHECKING:
    from matplotlib.figure import Figure

SUFFIXES = (".pdf", ".png", ".svg")


def plot_file(path: str) -> Path:
    """A path that a picture can be written to.

    Raises `lwa.InputError` for another suffix than `SUFFIXES` or a folder that does not exist.
    """
    return output_file("plot", path, SUFFIXES)


def save(result: Any, file: Path) -> None:
    """Draw a result into a file, which is replaced only by a complete picture."""
    with replacing(file) as new:
        figure(result).savefig(new, dpi=150)


@singledispatch
def figure(result: Any) -> Figure:
    """The picture of a result."""
    raise TypeError(f"nothing is known to draw of {type(result).__name__}")
