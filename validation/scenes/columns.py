"""Columns of numbers in CSV files."""

from __future__ import annotations

import csv
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from lwa.base import files
from lwa.base.arrays import Array
from lwa.base.exact import shorten
from validation.scenes.checks import SceneError

_MOST_BYTES = 10**9


def columns(path: str | Path, *wanted: str, optional: Sequence[str] = ()) -> dict[str, Array]:
    """Read columns of a CSV file with a header; return each, (N,), by its name without unit.

    A header such as "force (N)" names the column "force". Raises `SceneError`, in one line, for a
    file without a wanted column, and for entries that are no finite numbers.
    """
    try:
        text = files.content(Path(path), _MOST_BYTES).decode("utf-8-sig")
        header, *rows = csv.reader(text.splitlines()) if text.strip() else [[]]
    except (OSError, UnicodeDecodeError, csv.Error, SceneError) as error:
        raise SceneError(f"{path}: {files.reason(error)}") from None
    names = [name.partition("(")[0].strip() for name in header]
    found = {}
    for name in (*wanted, *optional):
        if names.count(name) != 1 and (name in wanted or name in names):
            there = shorten(names)
            raise SceneError(f"{path}: one column {name} is wanted, the header has {there}")
        if name in names:
            place = names.index(name)
            cells = [row[place] if place < len(row) else "" for row in rows if row]
            try:
                found[name] = np.array(cells, float)
            except ValueError as error:
                raise SceneError(f"{path}: column {name}: {error}") from None
            if not np.isfinite(found[name]).all():
                raise SceneError(f"{path}: column {name}: finite numbers are wanted")
    return found
