"""Commands as processes: how they begin, and how they end.

A process takes a second of the machine, so that few are started, and each answers many questions.
Everything else about a command is tested by a call of its ``main`` in the process of the tests.
"""

import os
import signal
import subprocess
import sys
import time
from contextlib import contextmanager
from importlib.metadata import version
from pathlib import Path

import pytest

from lwa import __version__
from lwa.base import INTERRUPTED
from tests.commands import terminal

LWA = (sys.executable, "-m", "lwa")
VERSION = (*LWA, "--version")  # takes a tenth of a second, as it does not load SymPy


def ended(*command, **options):
    """Exit status, standard output and standard error of a process."""
    options = {"capture_output": True, "text": True, "timeout": 240} | options
    done = subprocess.run(command, check=False, **options)
    return done.returncode, done.stdout, done.stderr


@contextmanager
def killed(process):
    """A process that ends with the test, whatever the test finds."""
    try:
        yield process
    finally:
        process.kill()
        process.wait()


def waited(written, seconds):
    """What a terminal shows next, after so many seconds at most."""
    end = time.monotonic() + seconds
    while not (shown := written()):
        assert time.monotonic() < end, f"silent for {seconds} s"
        time.sleep(0.1)
    return shown


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
    outputs = ("--plot", "p.svg", "--out", "o.json")
    command = (sys.executable, "-m", "validation", "run", "scene.toml", *outputs)
    with terminal() as written:
        pipes = dict(stdout=subprocess.PIPE, stderr=sys.stderr, cwd=tmp_path)
        with killed(subprocess.Popen(command, **pipes)) as running:
            shown = waited(written, 120)
            while "lattice run:" not in shown:
                shown += waited(written, 120)
            running.send_signal(signal.SIGINT)
            out, _ = running.communicate(timeout=120)
        shown += written()
    # Python ends itself by the signal, which is 130 in a shell as well, where the interrupt passed
    # through a text that is executed, as in the compiler.
    assert running.returncode in (INTERRUPTED, -signal.SIGINT)
    assert out == b""
    assert shown.splitlines()[-1].endswith("lwa-validate: interrupted")
    assert "Traceback" not in shown
    assert [file.name for file in tmp_path.iterdir()] == ["scene.toml"]


@pytest.mark.slow
def test_the_first_compilation_is_not_silent_for_long(tmp_path):
    """On a terminal, where ten seconds are the most."""
    command = (sys.executable, "-m", "validation", "paper")
    fresh = os.environ | {"NUMBA_CACHE_DIR": str(tmp_path)}
    with terminal() as written:
        streams = dict(stdout=sys.stderr, stderr=sys.stderr, env=fresh)
        with killed(subprocess.Popen(command, **streams)):
            for _ in range(4):
                # Twice the promised time: the machine may be busy.
                waited(written, 20)
                # Parts of a sign that come at once are one.
                time.sleep(1)
