"""Commands as processes: how they begin, and how they end.

A process takes a second of the machine, so that few are started, and each answers many questions.
Everything else about a command is tested by a call of its ``main`` in the process of the tests.
"""

import contextlib
import os
import pty
import select
import signal
import subprocess
import sys
import termios
import time
from importlib.metadata import version
from pathlib import Path

import pytest

from lwa import __version__
from lwa.base import INTERRUPTED

LWA = (sys.executable, "-m", "lwa")
VERSION = (*LWA, "--version")  # takes a tenth of a second, as it does not load SymPy


def ended(*command, **options):
    """Exit status, standard output and standard error of a process."""
    options = {"capture_output": True, "text": True, "timeout": 240} | options
    done = subprocess.run(command, check=False, **options)
    return done.returncode, done.stdout, done.stderr


NUMBERS = "numpy scipy matplotlib numba"
STEPS = {
    "import lwa, lwa.__main__, validation.__main__": f"sympy click tqdm {NUMBERS}",
    "from lwa.linear import dispersion": f"click tqdm {NUMBERS}",
    "from validation.cli import validate": NUMBERS,
    "call('--help'), call('nothing'), call('--nothing')": NUMBERS,
    "lwa.canonical_wave(lwa.Cell([1], [1], 1), '3/2').at_force(1).curve([0])": "scipy matplotlib",
    "call('exact')": "numba matplotlib",
}
"""Statements, one after another, and the packages that none of them has loaded so far."""

PROGRAM = """
import contextlib, io, sys

def call(*arguments):
    with contextlib.suppress(Exception), contextlib.redirect_stdout(io.StringIO()):
        validate.main(arguments, standalone_mode=False)

for statement in sys.argv[1:]:
    exec(statement)
    print(*sys.modules)
"""


def test_a_package_is_loaded_where_it_is_used():
    _, out, err = ended(sys.executable, "-c", PROGRAM, *STEPS)
    assert err == ""
    for (statement, none), modules in zip(STEPS.items(), out.splitlines(), strict=True):
        assert not {*none.split()} & {*modules.split()}, statement


@pytest.mark.parametrize(
    "program",
    [("lwa",), ("lwa-validate",), (sys.executable, "-m", "validation")],
    ids=["lwa", "lwa-validate", "-m validation"],
)
def test_a_program_says_its_name_and_version(program):
    if len(program) == 1:
        program = (str(Path(sys.executable).with_name(program[0])),)
    name = "lwa-validate" if "valid" in program[-1] else "lwa"
    assert ended(*program, "--version") == (0, f"{name} {version('lwa')}\n", "")
    assert __version__ == version("lwa")


def test_without_any_output_the_status_is_left():
    assert ended(f"{' '.join(VERSION)} >&- 2>&-", shell=True) == (2, "", "")


def test_ctrl_c_while_a_command_is_loaded_is_one_line(tmp_path):
    (tmp_path / "slow.py").write_text(
        "import os, signal; os.kill(os.getpid(), signal.SIGINT)"
    )
    code = "from lwa.__main__ import start; start('lwa', 'slow')"
    paths = os.pathsep.join((str(tmp_path), *filter(None, sys.path)))
    found = ended(sys.executable, "-c", code, env=os.environ | {"PYTHONPATH": paths})
    assert found == (INTERRUPTED, "", "lwa: interrupted\n")


CHAIN = """
duration = 10_000
samples = 601
chain = {cell = [1, 0.5], repeat = 20_000, k = 1.5, spacings = 2}
striker = {velocity = 1}
sensors = {beads = [9], contacts = [4, 12]}
"""


def test_a_long_run_shows_its_progress_on_a_terminal_and_stops_at_ctrl_c(
    engine, tmp_path
):
    (tmp_path / "scene.toml").write_text(CHAIN)
    command = (sys.executable, "-m", "validation", "run", "scene.toml")
    mine, theirs = pty.openpty()
    termios.tcsetwinsize(theirs, (24, 80))
    outputs = ("--plot", "p.svg", "--out", "o.json")
    pipes = dict(stdout=subprocess.PIPE, stderr=theirs, text=True, cwd=tmp_path)
    with (
        subprocess.Popen((*command, *outputs), **pipes) as running,
        contextlib.ExitStack() as end,
    ):
        end.callback(running.kill)
        os.close(theirs)
        shown = b""
        while b"lattice run:" not in shown:
            assert select.select([mine], [], [], 120)[0], "no progress"
            shown += os.read(mine, 1000)
        running.send_signal(signal.SIGINT)
        out, _ = running.communicate(timeout=120)
    rest = b""
    with contextlib.suppress(OSError):  # the other end is closed
        while some := os.read(mine, 1000):
            rest += some
    os.close(mine)
    # Python ends itself by the signal, which is 130 in a shell as well, where the interrupt passed
    # through a text that is executed, as in the compiler.
    assert running.returncode in (INTERRUPTED, -signal.SIGINT)
    assert out == ""
    assert rest.decode().splitlines()[-1].endswith("lwa-validate: interrupted")
    assert b"Traceback" not in rest
    assert [file.name for file in tmp_path.iterdir()] == ["scene.toml"]


@pytest.mark.slow
def test_the_first_compilation_is_not_silent_for_long(tmp_path):
    """On a terminal, where ten seconds are the most."""
    command = (sys.executable, "-m", "validation", "paper")
    fresh = os.environ | {"NUMBA_CACHE_DIR": str(tmp_path)}
    screen, terminal = pty.openpty()
    streams = dict(stdout=terminal, stderr=terminal, env=fresh)
    with subprocess.Popen(command, **streams) as running, contextlib.ExitStack() as end:
        end.callback(running.kill)
        os.close(terminal)
        for _ in range(4):
            # Twice the promised time: the machine may be busy.
            assert select.select([screen], [], [], 20)[0], "silent for 20 s"
            assert os.read(screen, 10_000)
            # Parts of a sign that come at once are one.
            time.sleep(1)
    os.close(screen)
