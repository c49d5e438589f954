"""Readers of TOML and JSON files, of limited size, and of their entries.

A fault is reported in one line, with the full key of the entry. The reader of an entry takes a
value and its name in messages, and returns the checked value or raises `lwa.InputError`. Numbers
of a file are floats.
"""

from __future__ import annotations

import json
import math
import sys
import tomllib
from collections.abc import Callable, Collection, Mapping, Sequence, Set
from contextlib import suppress
from pathlib import Path
from typing import Any, TypeVar

from lwa.base.exact import InputError, integer as integer, shorten
from lwa.base.words import one_of, suggestion

T = TypeVar("T")
Reader = Callable[[Any, str], Any]

LEAST = sys.float_info.min
"""The least positive number with all digits of a float."""

MOST_BYTES = {".toml": 8_000_000, ".json": 64_000_000}
"""Size limits of a file; Python reads about 1 MB of TOML a second."""

_WRITTEN = "try: lwa-validate run --example > scene.toml"
"""The line that writes a file where there is none."""


def load(path: str | Path, what: str, reader: Callable[[Any], T]) -> T:
    """Parse a TOML or JSON file and read its content.

    Parameters
    ----------
    path : str or Path
        The file, whose ending tells the format, or "-", standard input in either format.
    what : str
        The expected kind of file in messages, such as "a scene".
    reader : callable
        Function of the parsed content.

    Returns
    -------
    object
        The result of the reader.

    Raises
    ------
    InputError
        In one line that names the file, if it cannot be read or parsed, or if the reader refuses
        its content.
    """
    if not isinstance(path, str | Path):
        raise InputError(f"{what} is read from a file: {shorten(path)} is no file name")
    suffix = Path(path).suffix.lower()
    if suffix not in MOST_BYTES and str(path) != "-":
        raise InputError(
            f"{path}: {what} is a file ending in {' or '.join(MOST_BYTES)}; {_WRITTEN}"
        )
    try:
        # Standard input may be of either format, and has the smaller limit.
        text = content(Path(path), MOST_BYTES.get(suffix, MOST_BYTES[".toml"]))
        if str(path) == "-":
            # A JSON object begins with a brace, which no TOML file does.
            suffix = ".json" if text.lstrip().startswith(b"{") else ".toml"
        parse = tomllib.loads if suffix == ".toml" else json.loads
        # Editors on Windows put a mark of three bytes in front of UTF-8.
        return reader(parse(text.decode("utf-8-sig")))
    except (InputError, OSError) as error:
        fault = reason(error)
        if isinstance(error, FileNotFoundError):
            raise InputError(f"{path}: {fault}; {_WRITTEN}") from None
    except UnicodeDecodeError:
        fault = "not a text in UTF-8"
    except RecursionError:
        fault = f"nested too deeply for {what}"
    except ValueError as error:  # raised by the parsers
        # Python's advice on integers of too many digits stands behind a semicolon.
        fault = f"not {suffix[1:].upper()}: {str(error).partition(';')[0]}"
    # A reader of the file may know a better line.
    if "; try: " not in fault:
        fault += "; try: lwa-validate run --keys"
    raise InputError(f"{path}: {fault}") from None


def content(file: Path, most: int = 10**9) -> bytes:
    """Read a regular file of at most ``most`` bytes; of "-", standard input, the first ``most``.

    Raises
    ------
    OSError
        If the file cannot be read.
    InputError
        For a folder, a pipe or a device (nothing is read then), and for a larger file.
    """
    if str(file) == "-":
        return sys.stdin.buffer.read(most)
    size = file.stat().st_size
    if not file.is_file():  # opening a pipe would wait for a writer
        raise InputError("only regular files are read")
    if size > most:
        raise InputError(f"more than {most} bytes, the most that is read")
    return file.read_bytes()


def reason(error: Exception) -> str:
    """Return the system's message for an error, without error number and file name."""
    if isinstance(error, OSError) and error.strerror:
        return error.strerror
    return str(error)


def finite(value: Any, name: str) -> float:
    """Read one finite number."""
    number = None
    if value is None:
        raise InputError(f"{name} is missing")
    # A masked array's float is NaN, or the number behind the mask.
    if not isinstance(value, str | bytes | bool) and not hasattr(value, "mask"):
        with suppress(TypeError, ValueError, OverflowError):
            number = float(value)
    if number is None:
        raise InputError(f"{name} is {shorten(value)}: a number is wanted")
    if not math.isfinite(number):
        raise InputError(f"{name} is {number}: a finite number is wanted")
    return number


def positive(value: Any, name: str) -> float:
    """Read one positive number, not below the range where floats have all their digits."""
    number = finite(value, name)
    if not number > 0:
        raise InputError(f"{name} is {number:g}: it must be positive")
    if number < LEAST:
        raise InputError(
            f"{name} is {number}: floats below {LEAST:.1g} lose their digits"
        )
    return number


class Table:
    """A table of a file, refused if it holds unknown keys.

    Parameters
    ----------
    value : dict
        The parsed table.
    name : str
        The full key of the table; "" for the file itself.
    known : collection of str
        Keys that the table may hold.

    Examples
    --------
    >>> Table({"masss": 1}, "bead", ("mass", "radius"))
    Traceback (most recent call last):
        ...
    lwa.base.InputError: bead.masss is unknown: did you mean mass?
    """

    def __init__(self, value: Any, name: str, known: Collection[str]) -> None:
        self.name = name
        self.entries = entries(value, name or "the file")
        for key in self.entries:
            if key not in known:
                raise InputError(
                    f"{self.path(key)} is unknown: {suggestion(key, known)}"
                )

    def __contains__(self, key: str) -> bool:
        return key in self.entries

    def path(self, key: str) -> str:
        """The full name of a key, such as ``bead.mass``."""
        return f"{self.name}.{_plain(key)}" if self.name else _plain(key)

    def read(self, key: str, reader: Reader, default: Any = None) -> Any:
        """Read an entry by ``reader``; an entry without a default must be present."""
        if key in self:
            return reader(self.entries[key], self.path(key))
        # No reader returns None, which therefore stands for "no default".
        if default is None:
            raise InputError(f"{self.path(key)} is missing")
        return default

    def one(self, *keys: str) -> str:
        """Return the key that is present; exactly one of the keys must be."""
        # Of two keys that exclude each other none is chosen: both are refused.
        present = [key for key in keys if key in self]
        if len(present) == 1:
            return present[0]
        fault = f"neither {' nor '.join(keys)}"
        if present:
            fault = f"both {' and '.join(present)}"
        raise InputError(f"{self.name} has {fault}: one is wanted")


def table(known: Sequence[str]) -> Reader:
    """Reader of a `Table` with these keys."""
    return lambda value, name: Table(value, name, known)


def entries(value: Any, name: str) -> dict[str, Any]:
    """Read a table with any keys."""
    # Keys are checked by `Table`, or by the reader of the entries.
    if not isinstance(value, dict):
        raise InputError(f"{name} is {shorten(value)}: a table of keys is wanted")
    return value


def named(reader: Reader) -> Reader:
    """Reader of a table with any names, each entry read by ``reader``."""
    return lambda value, name: {
        key: reader(entry, f"{name}.{_plain(key)}")
        for key, entry in entries(value, name).items()
    }


def items(values: Any, name: str) -> tuple[Any, ...]:
    """Read a sequence of any kind but a text; its items are not checked."""
    if not isinstance(values, str | bytes | Mapping | Set):
        # A single value has no items; nor has an array without an axis.
        with suppress(TypeError):
            return tuple(values)
    raise InputError(f"{name} is {shorten(values)}: a sequence is wanted")


def array(value: Any, name: str) -> list[Any]:
    """Read a list."""
    # A tuple comes from no file: JSON and TOML have lists.
    if not isinstance(value, list):
        raise InputError(f"{name} is {shorten(value)}: a list is wanted")
    return value


def each(reader: Reader) -> Reader:
    """Reader of a list, each item read by ``reader``."""
    return lambda value, name: [
        reader(item, f"{name} number {i}")
        for i, item in enumerate(array(value, name), start=1)
    ]


def among(values: Mapping[str, Any]) -> Reader:
    """Reader of one of the names in ``values``; returns the value of that name."""

    def read(value: Any, name: str) -> Any:
        return values[one_of(value, values, name)]

    return read


def place(count: int) -> Reader:
    """Reader of a number from 1 to ``count``; returns the index, from 0."""

    def read(value: Any, name: str) -> int:
        if not count:
            raise InputError(f"{name} is {shorten(value)}: the chain has none")
        return integer(value, name, 1, count) - 1

    return read


def _plain(key: str) -> str:
    """A key as it is written, or in quotes and shortened if it is no plain name."""
    if key.isidentifier() and len(key) < 60:
        return key
    return shorten(key)
