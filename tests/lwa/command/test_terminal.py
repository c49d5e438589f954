"""Between a command and its user: encodings, closed and full outputs, Ctrl-C, digits."""

import os
import signal
import subprocess
import sys
import textwrap
from importlib.metadata import version

import pytest

import lwa
from lwa.command.interrupt import INTERRUPTED, start
from tests.lwa.command.answers import run

COMMAND = [sys.executable, "-m", "lwa"]
WAVE = [*COMMAND, "wave", "--k", "3/2", "--masses", "1,1"]


@pytest.mark.parametrize("encoding", ["cp1252", "latin-1", "utf-8"])
def test_output_and_refusals_are_in_utf_8_whatever_the_locale(encoding):
    environment = os.environ | {"PYTHONIOENCODING": encoding}
    done = subprocess.run(WAVE, capture_output=True, env=environment, timeout=120)
    assert (done.returncode, done.stderr) == (0, b"")
    assert "width π/β = sqrt(10)*pi*D/2 ≈ 4.96729413289805 D" in done.stdout.decode("utf-8")
    refused = [*COMMAND, "derive", "--masses", "κ κ"]
    done = subprocess.run(refused, capture_output=True, env=environment, timeout=120)
    assert done.returncode == 2
    assert "'κ κ'" in done.stderr.decode("utf-8")


@pytest.mark.skipif(not os.path.exists("/dev/full"), reason="Linux's full device")
def test_a_full_disk_is_one_line():
    for arguments in (["derive", "--order", "8"], ["--version"], ["-h"]):
        with open("/dev/full", "w") as full:
            done = subprocess.run(
                [*COMMAND, *arguments], stdout=full, stderr=subprocess.PIPE, timeout=120
            )
        assert (done.returncode, done.stderr.count(b"\n")) == (2, 1)
        assert b"No space left" in done.stderr


@pytest.mark.skipif(os.name != "posix", reason="a shell closes the output")
def test_a_closed_output_is_one_line():
    for redirection, lines in ((">&-", 1), (">&- 2>&-", 0)):
        command = f'"{sys.executable}" -m lwa derive {redirection}'
        done = subprocess.run(command, shell=True, stderr=subprocess.PIPE, timeout=120)
        assert (done.returncode, done.stderr.count(b"\n")) == (2, lines)


def test_ctrl_c_while_the_command_is_loaded_is_one_line(tmp_path):
    (tmp_path / "slow.py").write_text(
        textwrap.dedent("""
            import os, signal
            try:
                os.kill(os.getpid(), signal.SIGINT)
            except BaseException:  # as a library's own `except` may
                pass
            main = print
        """)
    )
    code = f"import sys; sys.path.insert(0, {str(tmp_path)!r}); "
    code += "from lwa.command.interrupt import start; start('lwa', 'slow')"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=120)
    assert (done.returncode, done.stdout) == (INTERRUPTED, "")
    assert done.stderr == "lwa: interrupted\n"


def test_nothing_is_loaded_before_ctrl_c_is_heard():
    code = "import sys, lwa.__main__, lwa.command.interrupt; print('sympy' in sys.modules)"
    done = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, check=True, timeout=120
    )
    assert done.stdout.strip() == "False"


def test_once_loaded_the_command_hears_ctrl_c_itself(monkeypatch):
    heard = []
    monkeypatch.setattr(
        "lwa.command.cli.main", lambda: heard.append(signal.getsignal(signal.SIGINT))
    )
    start("lwa", "lwa.command.cli")
    assert heard == [signal.default_int_handler]


def test_the_version(capsys):
    assert lwa.__version__ == version("lwa")
    assert run(capsys, "--version")[1] == f"lwa {lwa.__version__}\n"


@pytest.mark.parametrize("arguments", [[], ["derive"], ["wave"], ["dispersion"], ["expansion"]])
def test_help_has_a_short_name(capsys, arguments):
    status, said, _ = run(capsys, *arguments, "-h")
    assert status == 0
    assert said.startswith("Usage: lwa")
    assert said == run(capsys, *arguments, "--help")[1]


@pytest.mark.parametrize(
    "arguments",
    [
        ["derive", "--order", "９"],
        ["derive", "--order", "1_0"],
        ["derive", "--order", "٤"],
        ["derive", "--order", "5/2"],
        ["derive", "--k", "１"],
        ["dispersion", "--order", "９"],
        ["expansion", "--order", "９"],
        ["wave", "--masses", "1,２"],
    ],
)
def test_digits_are_those_of_ascii_everywhere(capsys, arguments):
    status, out, err = run(capsys, *arguments)
    assert (status, out, err.count("\n")) == (2, "", 1)
    assert f"{arguments[1][2:]} is " in err


@pytest.mark.parametrize(
    ("words", "offered"),
    [
        ("lwa derive --closure ", "linear full"),
        ("lwa derive --law h", "hertz2"),
        ("lwa-validate run --method D", "DOP853"),
        ("lwa-validate hard --case u", "ulps under-load"),
    ],
)
def test_the_shell_completes_names(words, offered):
    """As bash asks click's programs: the line in COMP_WORDS, the place of the word to complete."""
    program = words.split()[0]
    module = {"lwa": "lwa.command.cli", "lwa-validate": "validation.cli"}[program]
    asked = {"COMP_WORDS": words, "COMP_CWORD": str(words.count(" "))}
    variable = f"_{program.upper().replace('-', '_')}_COMPLETE"
    code = f"from {module} import main; main()"
    done = subprocess.run(
        [sys.executable, "-c", code],
        capture_output=True,
        text=True,
        timeout=120,
        env={**os.environ, **asked, variable: "bash_complete"},
    )
    assert done.stdout.split() == [f"plain,{name}" for name in offered.split()]
