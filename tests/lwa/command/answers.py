"""What the command `lwa` answers."""

import json

from lwa.command.cli import main
from tests.commands import ended


def run(capsys, *arguments):
    """Exit status, standard output and standard error of one call."""
    return ended(capsys, main, *arguments)


def result(capsys, *arguments):
    """The JSON of a call that succeeds."""
    status, out, err = run(capsys, *arguments, "--format", "json")
    assert (status, err) == (0, "")
    return json.loads(out)
