"""Commands run in an empty folder, and files of numbers there."""

import json

import numpy as np
import pytest

from tests.commands import ended
from validation import cli


@pytest.fixture
def document(capsys, folder):
    """Run a line of `lwa-validate`; return its JSON document."""

    def run(line):
        status, out, err = ended(capsys, cli.main, *line.split(), "--format", "json")
        assert (status, err) == (0, "")
        return json.loads(out)

    return run


@pytest.fixture
def saved(folder):
    """Write columns, or rows, with a header to a file of the folder; return its name."""

    def save(columns, header):
        np.savetxt(
            "table.csv",
            np.column_stack(columns),
            delimiter=",",
            header=header,
            comments="",
        )
        return "table.csv"

    return save
