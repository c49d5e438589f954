"""Readers of TOML and JSON files: regular files of limited size, faults in one line."""

from __future__ import annotations

import json
import os
import re
import stat
import tomllib
from collections import Counter
from collections.abc import Callable
from pathlib import Path
from typing import Any, TypeVar

from lwa.base.exact import InputError, shorten

T = TypeVar("T")

MOST_BYTES = {".toml": 8_000_000, ".json": 64_000_000}
"""Size limits of a file; Python reads about 1 MB of TOML a second."""

# Without O_NONBLOCK, opening a pipe waits for a writer.
_AT_ONCE = getattr(os, "O_NONBLOCK", 0)


def load(path: str | Path, what: str, reader: Callable[[Any], T]) -> T:
    """Parse a file and pass its content to ``reader``, whose result is returned.

    ``what`` names the expected kind of file in messages, such as "a scene".

    Raises `lwa.InputError`, in one line that names the file, if the file cannot be read or parsed,
    or if the reader refuses its content.
    """
    file = Path(path)
    suffix = file.suffix.lower()
    if suffix not in MOST_BYTES:
        raise InputError(f"{path}: {what} is a file ending in {' or '.join(MOST_BYTES)}")
    parse = _toml if suffix == ".toml" else _json
    try:
        return reader(parse(content(file, MOST_BYTES[suffix]).decode("utf-8-sig")))
    except InputError as error:
        raise InputError(f"{path}: {error}") from None
    except OSError as error:
        raise InputError(f"{path}: {reason(error)}") from None
    except UnicodeDecodeError:
        raise InputError(f"{path}: not a text in UTF-8") from None
    except RecursionError:
        raise InputError(f"{path}: nested too deeply for {what}") from None
    except ValueError as error:  # raised by the parsers
        fault = str(error).partition(";")[0]
        raise InputError(f"{path}: not {suffix[1:].upper()}: {fault}") from None


def content(file: Path, most: int) -> bytes:
    """Read a regular file of at most ``most`` bytes.

    Raises `OSError` if it cannot be read, and `lwa.InputError` for a folder, a pipe or a device
    (nothing is read then) and for a larger file.
    """
    with open(file, "rb", opener=_regular) as stream:
        found = stream.read(most + 1)
    if len(found) > most:
        raise InputError(f"more than {most} bytes, the most that is read")
    return found


def _regular(path: str, flags: int) -> int:
    handle = os.open(path, flags | _AT_ONCE)
    mode = os.fstat(handle).st_mode
    if not stat.S_ISREG(mode):
        os.close(handle)
        raise InputError(f"{kind(mode)}, and only regular files are read")
    return handle


def kind(mode: int) -> str:
    """Name the kind of a file other than a regular file, such as "a folder"."""
    named = {stat.S_IFDIR: "a folder", stat.S_IFIFO: "a pipe", stat.S_IFSOCK: "a socket"}
    return named.get(stat.S_IFMT(mode), "a device")


def reason(error: Exception) -> str:
    """Return the system's message for an error, without error number and file name."""
    return (isinstance(error, OSError) and error.strerror) or str(error)


_DEEP = re.compile(r"""(?:\.[ \t]*+(?=["'\w-]*[A-Za-z_"'-])["'\w-]++[ \t]*+){20}""")
"""Deeply nested keys, for which tomllib takes time in proportion to the square of the depth."""


def _toml(text: str) -> Any:
    if _DEEP.search(text):
        raise RecursionError
    return tomllib.loads(text)


def _json(text: str) -> Any:
    return json.loads(text, object_pairs_hook=_once)


def _once(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    found = dict(pairs)
    if len(found) < len(pairs):
        ((key, times),) = Counter(key for key, _ in pairs).most_common(1)
        raise InputError(f"{shorten(key)} is there {times} times")
    return found
