"""Files that are written: checked before the work, and there only when complete.

Every fault is one line, an `lwa.InputError`, whatever the operating system calls it.
"""

from __future__ import annotations

import os
import stat
import tempfile
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

from lwa.base.exact import InputError
from lwa.base.files import kind, reason


def output_file(name: str, path: str, suffixes: Sequence[str]) -> Path:
    """A path that can be written to; ``name`` is what messages call it.

    Raises `lwa.InputError` for a suffix not among ``suffixes``, a folder that does not exist or
    takes no file, a name that the system refuses, and what is there but no regular file.
    """
    file = Path(path)
    said = f"{name} is {_short(file)}"
    if file.suffix.lower() not in suffixes:
        raise InputError(f"{said}: a file ending in {', '.join(suffixes)} is wanted")
    try:
        place = _target(file).parent
        if (folder := _mode(place)) is None:
            raise InputError(f"{said}: the folder {_short(place)} does not exist")
        if not stat.S_ISDIR(folder):
            raise InputError(f"{said}: {_short(place)} is no folder")
        if (there := _mode(file)) is not None and not stat.S_ISREG(there):
            raise InputError(f"{said}: a file that can be written is wanted, not {kind(there)}")
        with tempfile.TemporaryFile(dir=place):
            pass
    except (OSError, ValueError) as error:  # ValueError: a name with a null byte
        if isinstance(error, InputError):
            raise
        raise InputError(f"{said}: it cannot be written, {reason(error)}") from None
    return file


def _target(file: Path) -> Path:
    """What a symbolic link names, which is written in its place."""
    return Path(os.path.realpath(file)) if file.is_symlink() else file


def _mode(file: Path) -> int | None:
    """What is there; None for nothing."""
    try:
        return file.stat().st_mode
    except FileNotFoundError:
        return None


@contextmanager
def replacing(file: Path) -> Iterator[Path]:
    """A temporary file beside ``file``, which takes its place at the end, or vanishes on a failure.

    A file that is there keeps its mode, and a symbolic link its target, which is replaced.
    An `OSError` on the way, such as of a disk that is full, becomes an `lwa.InputError`.

    >>> with tempfile.TemporaryDirectory() as folder:
    ...     with replacing(Path(folder, "a.txt")) as new:
    ...         _ = new.write_text("whole")
    ...     Path(folder, "a.txt").read_text()
    'whole'
    """
    target = _target(file)
    try:
        handle, name = tempfile.mkstemp(suffix=file.suffix.lower(), dir=target.parent)
        os.close(handle)
        try:
            yield Path(name)
            os.umask(umask := os.umask(0))
            there = _mode(target)
            os.chmod(name, 0o666 & ~umask if there is None else stat.S_IMODE(there))
            os.replace(name, target)
        except BaseException:
            os.unlink(name)
            raise
    except OSError as error:
        raise InputError(f"{_short(file)} is not written: {reason(error)}") from None


def _short(file: Path) -> str:
    name = str(file)
    return name if len(name) <= 120 else name[:117] + "..."
