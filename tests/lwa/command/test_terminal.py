"""Between a command and its user: encodings, closed and full outputs, completion, digits."""

import os
import time
from contextlib import redirect_stdout
from itertools import pairwise

import pytest
from click.testing import CliRunner

from lwa.base import progress
from lwa.command import cli
from lwa.command.cli import CLOSED
from tests.commands import encoded, ended
from tests.lwa.command.answers import said
from validation.cli import main, validate

MAINS = {"lwa": cli.main, "lwa-validate": main}


@pytest.mark.parametrize("encoding", ["cp1252", "latin-1", "utf-8"])
def test_output_and_refusals_are_in_utf_8_whatever_the_locale(encoding):
    status, out, err = encoded(
        cli.main, "wave", "--k", "3/2", "--masses", "1,1", encoding=encoding
    )
    assert (status, err) == (0, b"")
    assert "width π/β = sqrt(10)*pi*D/2 ≈ 4.96729413289805 D" in out.decode("utf-8")
    status, _, err = encoded(cli.main, "derive", "--masses", "κ κ", encoding=encoding)
    assert status == 2
    assert "'κ κ'" in err.decode("utf-8")


def test_a_file_name_that_is_not_utf_8_is_one_line():
    name = "\udcff.json"
    status, out, err = encoded(cli.main, "wave", "--spheres", name, encoding="utf-8")
    assert (status, out, err.count(b"\n")) == (2, b"", 1)
    assert err.startswith(b"lwa: \\udcff.json: No such file or directory")


@pytest.mark.parametrize(
    ("name", "line"),
    [
        ("lwa", "wave --k 3/2 --masses 1,1"),
        ("lwa", "--version"),
        ("lwa", "-h"),
        ("lwa-validate", "run --example"),
        ("lwa-validate", "--help"),
    ],
)
def test_an_output_that_takes_nothing_is_no_result(capsys, name, line):
    """A disk that is full, a pipe whose reader is gone, and no output at all."""
    reader, writer = os.pipe()
    os.close(reader)
    full = 2, "", f"{name}: the output: No space left on device\n"
    for output, expected in (("/dev/full", full), (writer, (CLOSED, "", ""))):
        with open(output, "w") as stream, redirect_stdout(stream):
            assert ended(capsys, MAINS[name], *line.split()) == expected
    with redirect_stdout(None):
        status, _, err = ended(capsys, MAINS[name], *line.split())
    assert (status, err.count("\n")) == (2, 1)


@pytest.mark.parametrize(
    ("words", "offered"),
    [
        ("lwa-validate pa", "paper"),
        ("lwa-validate run --method RK", "RKN86 RK45 RK23"),
        ("lwa wave --spheres s", "file,s"),
        ("lwa-validate run s", "file,s"),
        ("lwa-validate run s.toml --out s", "file,s"),
    ],
)
def test_a_shell_completes_names_and_files(words, offered):
    """As bash asks click's programs: the line in COMP_WORDS, the place of the word to complete."""
    program = words.split()[0]
    asked = {
        "COMP_WORDS": words,
        "COMP_CWORD": str(words.count(" ")),
        f"_{program.upper().replace('-', '_')}_COMPLETE": "bash_complete",
    }
    command = {"lwa": cli.lwa, "lwa-validate": validate}[program]
    shown = CliRunner(env=asked).invoke(command, prog_name=program)
    expected = [name if "," in name else f"plain,{name}" for name in offered.split()]
    assert shown.output.split() == expected


@pytest.mark.slow
@pytest.mark.parametrize(
    "line",
    [
        "derive --closure full --order 10 --format latex",
        "derive --closure full --masses a,b,c,d --order 5 --format json",
        "expansion --masses m1,m2 --order 8",
        "expansion --masses a,b --stiffnesses c,d --format latex",
        "dispersion --masses a,b,c --stiffnesses c,d,e --order 8",
        "envelope --masses m1,m2 --law general --background p0",
        "wave --masses a,b,c --stiffnesses x,y,z --format c",
    ],
)
def test_no_step_of_a_long_command_is_silent(capsys, monkeypatch, line):
    """Derivation and printing let a sign be drawn, so that two are at most 10 s apart."""
    most = 10 - progress.QUIET
    times = [time.monotonic()]

    def shown(*_, **settings):
        times.append(time.monotonic())

    monkeypatch.setattr(progress, "EVERY", 0.2)
    monkeypatch.setattr(progress, "print", shown, raising=False)
    said(capsys, *line.split())
    shown()
    # A step that holds Python's lock delays a sign by its own length.
    assert max(b - a for a, b in pairwise(times)) < most
