"""Calls of a command in the tests' own process, terminals and small disks."""

import fcntl
import io
import os
import pty
import re
import resource
import select
import struct
import termios
from contextlib import contextmanager, redirect_stderr, redirect_stdout

import pytest


def ended(capsys, main, *arguments):
    """Exit status, standard output and standard error of one call."""
    with pytest.raises(SystemExit) as end:
        main(arguments)
    captured = capsys.readouterr()
    # On a busy machine a command may say that it still computes.
    said = re.sub(r".* still computing, .*\n", "", captured.err)
    return end.value.code, captured.out, said


def encoded(main, *arguments, encoding):
    """Exit status and bytes of both outputs of one call, where the terminal has this encoding."""
    outputs = [io.TextIOWrapper(io.BytesIO(), encoding=encoding) for _ in range(2)]
    with (
        redirect_stdout(outputs[0]),
        redirect_stderr(outputs[1]),
        pytest.raises(SystemExit) as end,
    ):
        main(arguments)
    for output in outputs:
        output.flush()
    return end.value.code, *(output.buffer.getvalue() for output in outputs)


@contextmanager
def small_disk(size):
    """Let no file of this process grow beyond so many bytes."""
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (size, before[1]))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)


@contextmanager
def terminal(lines=24, columns=80):
    """Make standard error a terminal; a function returns what was written to it so far."""
    screen, keyboard = pty.openpty()
    size = struct.pack("HHHH", lines, columns, 0, 0)
    fcntl.ioctl(keyboard, termios.TIOCSWINSZ, size)

    def written():
        found = b""
        while select.select([screen], [], [], 0)[0]:
            found += os.read(screen, 4096)
        return found.decode()

    try:
        with open(keyboard, "w") as output, redirect_stderr(output):
            yield written
    finally:
        os.close(screen)
