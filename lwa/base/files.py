"""Readers of TOML and JSON files, of limited size; a fault is reported in one line."""

from __future__ import annotations

import json
import tomllib
from collections.abc import Callable
from pathlib import Path
from typing import Any, TypeVar

from lwa.base.errors import InputError

T = TypeVar("T")

MOST_BYTES = {".toml": 8_000_000, ".json": 64_000_000}
"""Size limits of a file; Python reads about 1 MB of TOML a second."""


def load(path: str | Path, what: str, reader: Callable[[Any], T]) -> T:
    """Parse a file and pass its content to ``reader``, whose result is returned.

    ``what`` names the expected kind of file in messages, such as "a scene".

    Raises `lwa.InputError`, in one line that names the file, if the file cannot be read or parsed,
    or if the reader refuses its content.
    """
    suffix = Path(path).suffix.lower()
    if suffix not in MOST_BYTES:
        raise InputError(f"{path}: {what} is a file ending in {' or '.join(MOST_BYTES)}")
    parse = tomllib.loads if suffix == ".toml" else _read_json
    try:
        return reader(parse(content(Path(path), MOST_BYTES[suffix]).decode("utf-8-sig")))
    except (InputError, OSError) as error:
        fault = reason(error)
    except UnicodeDecodeError:
        fault = "not a text in UTF-8"
    except RecursionError:
        fault = f"nested too deeply for {what}"
    except ValueError as error:  # raised by the parsers
        fault = f"not {suffix[1:].upper()}: {str(error).partition(';')[0]}"
    raise InputError(f"{path}: {fault}") from None


def _refuse_repeated(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    """The table of the pairs of a JSON object; JSON itself lets the last of equal keys win."""
    table: dict[str, Any] = {}
    for key, value in pairs:
        if key in table:
            raise InputError(f"{key[:60]!r} is there more than once")
        table[key] = value
    return table


def _read_json(text: str) -> Any:
    return json.loads(text, object_pairs_hook=_refuse_repeated)


def content(file: Path, most: int = 10**9) -> bytes:
    """Read a regular file of at most ``most`` bytes, by default a gigabyte.

    Raises `OSError` if it cannot be read, and `lwa.InputError` for a folder, a pipe or a device
    (nothing is read then) and for a larger file.
    """
    size = file.stat().st_size
    if not file.is_file():  # opening a pipe would wait for a writer
        raise InputError("only regular files are read")
    if size > most:
        raise InputError(f"more than {most} bytes, the most that is read")
    return file.read_bytes()


def reason(error: Exception) -> str:
    """Return the system's message for an error, without error number and file name."""
    return (isinstance(error, OSError) and error.strerror) or str(error)
