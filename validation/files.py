"""Files that are written: checked before the work, and there only when complete."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

from lwa.exact import InputError


def output_file(name: str, path: str, suffixes: Sequence[str]) -> Path:
    """A path that can be written to; ``name`` is what messages call it.

    Raises `lwa.InputError` for a suffix not among ``suffixes`` or a folder that does not exist.
    """
    file = Path(path)
    if file.suffix.lower() not in suffixes:
        raise InputError(f"{name} is {path}: a file ending in {', '.join(suffixes)} is wanted")
    if not file.parent.is_dir():
        raise InputError(f"{name} is {path}: the folder {file.parent} does not exist")
    if file.is_dir() or not os.access(file.parent, os.W_OK):
        raise InputError(f"{name} is {path}: a file that can be written is wanted")
    return file


@contextmanager
def replacing(file: Path) -> Iterator[Path]:
    """A temporary file beside ``file``, which takes its place at the end, or vanishes on a failure.

    >>> with tempfile.TemporaryDirectory() as folder:
    ...     with replacing(Path(folder, "a.txt")) as new:
    ...         _ = new.write_text("whole")
    ...     Path(folder, "a.txt").read_text()
    'whole'
    """
    handle, name = tempfile.mkstemp(suffix=file.suffix.lower(), dir=file.parent)
    os.close(handle)
    try:
        yield Path(name)
        umask = os.umask(0)
        os.umask(umask)
        os.chmod(name, 0o666 & ~umask)
        os.replace(name, file)
    except BaseException:
        os.unlink(name)
        raise
