"""A result as a table for people, as a document for JSON, and as a file.

`text` and `document` take any result of this package. In a document floats stand under names that
end in ``_value`` and exact numbers as strings that SymPy reads.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import singledispatch
from typing import Any


def table(header: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    """Columns of text, the first aligned left, the others right.

    >>> print(table(("bead", "force"), (("first", "1.5"), ("second", "12.25"))))
    bead    force
    first     1.5
    second  12.25
    """
    lines = [header, *rows]
    widths = [max(map(len, column)) for column in zip(*lines, strict=True)]
    return "\n".join(
        "  ".join(
            cell.rjust(width) if i else cell.ljust(width)
            for i, (cell, width) in enumerate(zip(line, widths, strict=True))
        ).rstrip()
        for line in lines
    )


@singledispatch
def text(result: Any) -> str:
    """The result as a table, with what it takes to read it."""
    raise TypeError(f"nothing is known to print of {type(result).__name__}")


@singledispatch
def document(result: Any) -> dict[str, Any]:
    """The result for JSON."""
    raise TypeError(f"nothing is known to print of {type(result).__name__}")


def percent(error: float) -> str:
    return f"{100 * error:+.3g} %"
