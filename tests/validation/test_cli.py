"""The command `lwa-validate`: exit status, standard error, JSON, pictures."""

import dataclasses
import json
import subprocess
import sys
from pathlib import Path

import pytest
from click.testing import CliRunner

from validation import cli
from validation.limits import Limits
from validation.report import document, text

COMMAND = Path(sys.executable).with_name("lwa-validate")


def run(capsys, *arguments):
    """Exit status, standard output and standard error of one call."""
    with pytest.raises(SystemExit) as ended:
        cli.main(arguments)
    captured = capsys.readouterr()
    return ended.value.code, captured.out, captured.err


def test_paper_text(capsys):
    status, out, err = run(capsys, "paper")
    assert (status, err) == (0, "")
    assert out.startswith("38 beads, steel (the striker, 1.37 m/s)")
    assert "no gravity; sensors in beads 15 and 34" in out


def test_paper_options(capsys, tmp_path):
    picture = tmp_path / "p.svg"
    status, out, err = run(
        capsys, "paper", "--velocity", "1/2", "--beads", "24", "--sensors", "9,20", "--gravity",
        "--format", "json", "--plot", str(picture),
    )  # fmt: skip
    assert (status, err) == (0, "")
    found = json.loads(out)
    assert (found["velocity_value"], found["beads"]) == (0.5, 24)
    assert (found["sensors"], found["gravity_value"]) == ([9, 20], 9.81)
    assert picture.read_text().startswith("<?xml")


def test_limits(capsys, monkeypatch, limits_result):
    monkeypatch.setattr(cli, "run_limits", lambda progress: limits_result)
    status, out, err = run(capsys, "limits")
    assert (status, out, err) == (0, text(limits_result) + "\n", "")
    status, out, err = run(capsys, "limits", "--format", "json")
    assert (status, json.loads(out), err) == (0, document(limits_result), "")


def test_limits_that_fail_are_printed_and_end_with_1(capsys, monkeypatch, limits_result):
    first, *others = limits_result.rows
    broken = Limits((dataclasses.replace(first, bound=1e-6), *others))
    monkeypatch.setattr(cli, "run_limits", lambda progress: broken)
    status, out, err = run(capsys, "limits")
    assert (status, err) == (1, "")
    assert "FAILS" in out


BAD = [
    ("paper", "--velocity", "fast"),
    ("paper", "--velocity", "-1"),
    ("paper", "--velocity", "1e400"),
    ("paper", "--velocity", "__import__('os')"),
    ("paper", "--beads", "3"),
    ("paper", "--beads", "x"),
    ("paper", "--sensors", "34,15"),
    ("paper", "--sensors", "a,b"),
    ("paper", "--sensors", "1.5,8"),
    ("paper", "--sensors", "36,37"),
    ("paper", "--sensors", ""),
    ("paper", "--format", "xml"),
    ("paper", "--plot", "picture.txt"),
    ("paper", "--plot", "no/such/folder/picture.png"),
    ("limits", "--plot", "picture"),
    ("limits", "extra"),
    ("nothing",),
    ("--nothing",),
]


@pytest.mark.parametrize("arguments", BAD, ids=" ".join)
def test_bad_input_is_one_line_and_status_2(capsys, monkeypatch, arguments):
    monkeypatch.setattr(cli, "run_limits", lambda progress: pytest.fail("computed first"))
    status, out, err = run(capsys, *arguments)
    assert (status, out) == (2, "")
    assert err.startswith("lwa-validate: ")
    assert err.count("\n") == 1
    assert len(err) < 200


def test_no_arguments_show_the_help(capsys):
    status, out, err = run(capsys)
    assert (status, out) == (2, "")
    assert "Commands:" in err


@pytest.mark.parametrize("arguments", [["--help"], ["paper", "--help"], ["limits", "--help"]])
def test_help(arguments):
    shown = CliRunner().invoke(cli.validate, arguments)
    assert shown.exit_code == 0
    assert "--help" in shown.output


def test_the_installed_command():
    ended = subprocess.run(
        [COMMAND, "paper", "--beads", "20", "--sensors", "8,15", "--format", "json"],
        capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert (ended.returncode, ended.stderr) == (0, "")
    assert len(json.loads(ended.stdout)["rows"]) == 11
    ended = subprocess.run(
        [COMMAND, "paper", "--beads", "two"], capture_output=True, text=True, check=False
    )
    assert (ended.returncode, ended.stdout) == (2, "")
    assert ended.stderr.count("\n") == 1


def test_matplotlib_is_loaded_only_for_a_picture():
    code = (
        "import sys; from validation import cli; cli.validate.main(['paper', '--beads', '12', "
        "'--sensors', '4,8'], standalone_mode=False); assert 'matplotlib' not in sys.modules"
    )
    ended = subprocess.run([sys.executable, "-c", code], capture_output=True, check=False)
    assert ended.returncode == 0, ended.stderr
