"""Refusals of measured files: the columns that were found, and statements that read the file.

For a name without a column a column is proposed that has a unit of the quantity; else one that
behaves like it: times rise, but do not count their lines, signals vary. Where no column may be the
time, a step from sample to sample is proposed.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import partial

import numpy as np

from lwa.base.arrays import Array
from lwa.base.exact import InputError
from validation.scenes.cells import HEAD, Cells, longest
from validation.scenes.checks import SceneError
from validation.scenes.columns import Columns
from validation.scenes.units import BASES, found_unit, in_si

STEP = "1 us"
"""An example of a time: a usual step of recorders."""

_LISTED = 4  # columns in a message


def refusal(
    words: str, columns: Columns, missing: Sequence[str] = (), step: str = ""
) -> SceneError:
    """Return an error that lists the columns of a file and proposes statements.

    Parameters
    ----------
    words : str
        What is wrong.
    columns : Columns
        The columns of the file.
    missing : sequence of str
        Names for which columns are proposed, the time first.
    step : str
        Time from sample to sample that is proposed in place of a column.
    """
    cells = columns.cells
    headers = {n: header for n, header in columns.headers.items() if n not in missing}
    used = set()
    for column in replace(columns, headers=headers).named:
        if column.name not in missing:
            used.add(column.number)
    free = [number for number in cells.entries if number not in used]
    steps = _steps(cells) if missing else {}
    for name in missing:
        rank = partial(_rank, cells, steps, name)
        best = min(free, key=rank, default=None)
        if name == "time" and (step or best is None or rank(best) >= _UNLIKE):
            step = step or STEP
        elif best is not None:
            free.remove(best)
            headers[name] = str(best)
    proposed = replace(columns, headers=headers, step=step or columns.step)
    units = {}
    for column in proposed.named:
        # The unit of the times that a step states is its own.
        if column.number is not None:
            if column.size is None and proposed.si:
                units[column.key] = column.proposed
            elif column.stated:
                units[column.key] = column.stated
    change: dict[str, object] = {}
    for option, given, wanted in (
        ("columns", columns.headers, headers),
        ("step", columns.step, proposed.step),
        ("units", columns.units, units),
    ):
        if given or wanted:  # an empty one takes the user's away
            change[option] = wanted
    return SceneError(f"{words}: found {_listed(cells)}", **change)


_UNLIKE = 2  # least rank of a column that does not behave like a quantity


def _rank(cells: Cells, steps: dict[int, Array], name: str, number: int) -> int:
    """Return the rank of a column among those for a name, 0 for the best."""
    base = BASES[name.split()[-1]]
    unknown = in_si(found_unit(cells.above(number)), base) is None
    own = steps[number]
    if name == "time":
        # Numbers of lines rise by 1, as times in a unit may.
        lines = unknown and np.all(own == 1)
        alike = own.min(initial=0) >= 0 < own.max(initial=0) and not lines
    else:
        # Numbers of lines, and constants, are no signals.
        alike = len(np.unique(own)) > 1
    return unknown + _UNLIKE * (not alike)


def _steps(cells: Cells) -> dict[int, Array]:
    """Return the differences from line to line, at the beginning, of the columns of numbers."""
    numbers = [*cells.entries]
    try:
        table = cells.numbers([number - 1 for number in numbers], HEAD)
    except InputError:
        table = np.empty((0, len(numbers)))
    steps = {}
    for number, column in zip(numbers, table.T, strict=True):
        start, end = longest(np.isfinite(column))
        steps[number] = np.diff(column[start:end])
    return steps


def _listed(cells: Cells) -> str:
    """Return words on the first columns of numbers: number, header and an entry."""
    found = []
    for number, entry in cells.entries.items():
        header = " ".join(cells.above(number)[-2:])[-20:].strip()
        found.append(f"{number} {header!r} {entry[:12]}")
    return ", ".join(found[:_LISTED]) or "no numbers"
