"""Parsed files, checked entry by entry: what is unknown, missing or wrong is told by its full key.

A reader takes a value and what messages call it, and returns the value checked or raises
`SceneError`; `validation.checked` has those of numbers, and here are those of the rest.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping, Sequence
from difflib import get_close_matches
from typing import Any

from lwa.exact import shorten
from validation.checked import SceneError, integer, row

Reader = Callable[[Any, str], Any]


class Table:
    """A table whose keys are known.

    >>> Table({"masss": 1}, "bead", ("mass", "radius"))
    Traceback (most recent call last):
        ...
    validation.checked.SceneError: bead.masss is unknown: did you mean mass?
    """

    def __init__(self, value: Any, name: str, known: Sequence[str]) -> None:
        self.name, self.entries = name, entries(value, name or "the file")
        for key in self.entries:
            if key not in known:
                raise SceneError(f"{self.path(key)} is unknown: {_suggestion(key, known)}")

    def __contains__(self, key: str) -> bool:
        return key in self.entries

    def path(self, key: str) -> str:
        """The full name of a key."""
        return f"{self.name}.{_plain(key)}" if self.name else _plain(key)

    def read(self, key: str, reader: Reader, default: Any = None) -> Any:
        """An entry, checked; one without a default must be there."""
        if key in self:
            return reader(self.entries[key], self.path(key))
        if default is None:
            raise SceneError(f"{self.path(key)} is missing")
        return default

    def one(self, *keys: str) -> str:
        """The one of the keys that is there."""
        found = [key for key in keys if key in self]
        if len(found) != 1:
            there = f"both {' and '.join(found)}" if found else f"neither {' nor '.join(keys)}"
            raise SceneError(f"{self.name} has {there}: one is wanted")
        return found[0]


def table(known: Sequence[str]) -> Reader:
    """Reader of a `Table`."""
    return lambda value, name: Table(value, name, known)


def entries(value: Any, name: str) -> dict[str, Any]:
    """Read a table without looking at its keys."""
    if not isinstance(value, dict):
        raise SceneError(f"{name} is {shorten(value)}: a table of keys is wanted")
    return value


def named(reader: Reader) -> Reader:
    """Reader of a table of any names, whose entries are read alike."""
    return lambda value, name: {
        key: reader(entry, f"{name}.{_plain(key)}") for key, entry in entries(value, name).items()
    }


def array(value: Any, name: str) -> list[Any]:
    """Read a list."""
    if not isinstance(value, list):
        raise SceneError(f"{name} is {shorten(value)}: a list is wanted")
    return value


def each(reader: Reader) -> Reader:
    """Reader of a list whose items are read alike."""
    return lambda value, name: row(array(value, name), reader, lambda i: f"{name} number {i + 1}")


def among(values: Mapping[str, Any]) -> Reader:
    """Reader of a name, for which the value of that name is returned."""

    def read(value: Any, name: str) -> Any:
        if not isinstance(value, str) or value not in values:
            raise SceneError(f"{name} is {shorten(value)}: {_suggestion(value, values)}")
        return values[value]

    return read


def place(count: int) -> Reader:
    """Reader of a number from 1 to ``count``; returns the index, from 0."""

    def read(value: Any, name: str) -> int:
        if not count:
            raise SceneError(f"{name} is {shorten(value)}: the chain has none")
        return integer(value, name, 1, count) - 1

    return read


def places(count: int) -> Reader:
    """Reader of a list of different numbers from 1 to ``count``; returns the indices."""

    def read(value: Any, name: str) -> list[int]:
        found: list[int] = each(place(count))(value, name)
        if len(set(found)) < len(found):
            raise SceneError(f"{name} is {shorten(value)}: each may be named once")
        return found

    return read


def flag(value: Any, name: str) -> bool:
    """Read true or false."""
    if not isinstance(value, bool):
        raise SceneError(f"{name} is {shorten(value)}: true or false is wanted")
    return value


def _plain(key: str) -> str:
    return key if key.isidentifier() and len(key) < 60 else shorten(key)


def _suggestion(value: Any, known: Collection[str]) -> str:
    if close := get_close_matches(str(value)[:60], known, 1):
        return f"did you mean {close[0]}?"
    return f"one of {', '.join(list(known)[:12])} is wanted" if known else "none is defined"
