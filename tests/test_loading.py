"""Modules are loaded where they are used: a command starts quickly, and hears Ctrl-C at once."""

import subprocess
import sys

import pytest

NUMBERS = "numpy scipy matplotlib numba"
STEPS = {
    "import lwa, lwa.__main__, validation.__main__": f"sympy click tqdm {NUMBERS}",
    "from lwa.linear import dispersion": f"click tqdm {NUMBERS}",
    "from validation.cli import validate": NUMBERS,
    "call('--help'), call('nothing'), call('--nothing')": NUMBERS,
    "lwa.canonical_wave(lwa.Cell([1], spacing=1), '3/2').force([0], peak=1)": "scipy matplotlib",
    "call('run', '--example')": "numba matplotlib",
    "call('paper', '--beads', '12', '--sensors', '4,8')": "matplotlib",
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


@pytest.fixture(scope="module")
def loaded():
    done = subprocess.run(
        [sys.executable, "-c", PROGRAM, *STEPS],
        capture_output=True, text=True, check=True, timeout=240,
    )  # fmt: skip
    return dict(zip(STEPS, done.stdout.splitlines(), strict=True))


@pytest.mark.parametrize("statement", STEPS)
def test_a_package_is_loaded_where_it_is_used(loaded, statement):
    assert not {*STEPS[statement].split()} & {*loaded[statement].split()}


def test_the_engine_is_compiled_where_it_runs(loaded):
    """The last statement runs a chain: that the others load no compiler is no accident."""
    assert "numba" in loaded[list(STEPS)[-1]].split()
