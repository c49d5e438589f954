"""CPU time of closed-form waves, of the expansion in k - 1, and of commands as whole processes.

    python -m pytest tests/benchmarks/bench_wave.py

wants pytest-benchmark. SymPy forgets what it has cached before each round. No time is asserted.
"""

import os
import subprocess
import sys
import time

import pytest
import sympy as sp
from sympy.core.cache import clear_cache

from lwa import Cell, canonical_wave, expand
from lwa.base.frozen import QUANTITIES

CHAINS = {
    "equal beads to ε^40": (Cell([1]), 40),
    "symbolic dimer to ε^8": (Cell(["m1", "m2"]), 8),
    "numeric dimer to ε^16": (Cell([1, "1/4"]), 16),
}
COMMANDS = {
    "import lwa": "import lwa",
    "lwa wave": "from lwa.command.cli import main; main(['wave'])",
    "lwa expansion --order 10": "from lwa.command.cli import main; "
    "main(['expansion', '--k', '3/2', '--masses', '1', '--order', '10'])",
}
"""Code that Python runs."""


@pytest.mark.benchmark(timer=time.process_time)
@pytest.mark.parametrize("particles", [4, 6])
def test_canonical_wave(benchmark, particles):
    cell = Cell(sp.symbols(f"m1:{particles + 1}", positive=True))

    def closed_forms():
        wave = canonical_wave(cell)
        assert all((wave.beta, wave.speed(), *map(wave.fwhm, QUANTITIES)))

    benchmark.pedantic(closed_forms, setup=clear_cache, rounds=5)


@pytest.mark.benchmark(timer=time.process_time)
@pytest.mark.parametrize("chain", CHAINS)
def test_expansion(benchmark, chain):
    cell, order = CHAINS[chain]

    def widths():
        wave = expand(cell, order)
        assert len(wave.c2.coefficients) == order + 1
        for quantity in QUANTITIES:
            assert len(wave.fwhm(quantity).coefficients) == order + 1

    benchmark.pedantic(widths, setup=clear_cache, rounds=5)


def children():
    """CPU time of the processes that have ended."""
    times = os.times()
    return times.children_user + times.children_system


@pytest.mark.benchmark(timer=children)
@pytest.mark.parametrize("name", COMMANDS)
def test_command(benchmark, name):
    command = [sys.executable, "-c", COMMANDS[name]]
    options = {"check": True, "stdout": subprocess.DEVNULL}
    benchmark.pedantic(subprocess.run, (command,), options, rounds=5)
