"""Between a command and its user: encodings, closed and full outputs, completion, digits."""

from contextlib import redirect_stdout

import pytest
from click.testing import CliRunner

from lwa.command import cli
from lwa.command.cli import CLOSED
from tests.commands import closed_pipe, encoded, full_disk, unwritable
from tests.lwa.command.answers import run
from validation.cli import validate

WAVE = ("wave", "--k", "3/2", "--masses", "1,1")


@pytest.mark.parametrize("encoding", ["cp1252", "latin-1", "utf-8"])
def test_output_and_refusals_are_in_utf_8_whatever_the_locale(encoding):
    status, out, err = encoded(cli.main, *WAVE, encoding=encoding)
    assert (status, err) == (0, b"")
    assert "width π/β = sqrt(10)*pi*D/2 ≈ 4.96729413289805 D" in out.decode("utf-8")
    status, _, err = encoded(cli.main, "derive", "--masses", "κ κ", encoding=encoding)
    assert status == 2
    assert "'κ κ'" in err.decode("utf-8")


def test_a_file_name_that_is_not_utf_8_is_one_line():
    status, out, err = encoded(cli.main, "wave", "--spheres", "\udcff.json", encoding="utf-8")
    assert (status, out, err) == (2, b"", b"lwa: \\udcff.json: No such file or directory\n")


def test_an_output_that_takes_nothing_is_no_result(capsys):
    for arguments in (WAVE, ["--version"], ["-h"]):
        status, err = unwritable(capsys, cli.main, *arguments, output=full_disk())
        assert (status, err) == (2, "lwa: the output: No space left on device\n")
        assert unwritable(capsys, cli.main, *arguments, output=closed_pipe()) == (CLOSED, "")
    with redirect_stdout(None):
        status, _, err = run(capsys, *WAVE)
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
