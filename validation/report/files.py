"""Output files: checked before the work, and replaced only by complete files."""

from __future__ import annotations

import tempfile
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

from lwa.base.exact import InputError
from lwa.base.files import reason


def output_file(name: str, path: str, suffixes: Sequence[str]) -> Path:
    """Return a path, ``name`` in messages, if its suffix is allowed and a file can be written."""
    file = Path(path)
    try:
        if file.suffix.lower() not in suffixes:
            fault = f"a file ending in {', '.join(suffixes)} is wanted"
        elif file.exists() and not file.is_file():
            fault = "a regular file is wanted"
        else:
            with tempfile.TemporaryFile(dir=file.resolve().parent):
                return file
    except (OSError, ValueError) as error:  # ValueError: a name with a null byte
        fault = f"it cannot be written, {reason(error)}"
    raise InputError(f"{name} is {path[:120]}: {fault}")


@contextmanager
def replacing(file: Path) -> Iterator[Path]:
    """Yield a temporary file that replaces ``file`` at the end, and is removed after a failure.

    A symbolic link keeps its target, and a file its mode. Raises `lwa.InputError`.
    """
    target = file.resolve()
    try:
        with tempfile.TemporaryDirectory(prefix=".", dir=target.parent) as folder:
            yield (new := Path(folder, "new"))
            if target.exists():
                new.chmod(target.stat().st_mode)
            new.replace(target)
    except OSError as error:
        raise InputError(f"{file} is not written: {reason(error)}") from None
