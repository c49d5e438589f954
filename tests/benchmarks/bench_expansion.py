"""CPU time of the expansion in k - 1: speed and three widths of a chain, and the command.

    python -m pytest tests/benchmarks/bench_expansion.py

wants pytest-benchmark. `BEFORE` are the same medians of the recursion that extended its fields
four times a level and took the widths from tables of powers; ``--benchmark-json`` writes them
beside the new ones. SymPy forgets what it has cached before each round. No time is asserted.
"""

from __future__ import annotations

import os
import subprocess
import sys
import time

import pytest
from pytest_benchmark.fixture import BenchmarkFixture
from sympy.core.cache import clear_cache

from lwa import Cell, expand
from lwa.quantities import QUANTITIES

CHAINS = {
    "equal beads to ε^40": (Cell([1]), 40),
    "symbolic dimer to ε^8": (Cell(["m1", "m2"]), 8),
    "numeric dimer to ε^16": (Cell([1, "1/4"]), 16),
}
BEFORE = {
    "equal beads to ε^40": 2.9,
    "symbolic dimer to ε^8": 2.0,
    "numeric dimer to ε^16": 0.9,
    "command beyond its import": 0.64,
}
"""Seconds, of an idle machine."""


def children() -> float:
    """CPU time of the processes that have ended."""
    times = os.times()
    return times.children_user + times.children_system


@pytest.mark.benchmark(timer=time.process_time)
@pytest.mark.parametrize("chain", CHAINS)
def test_expansion(benchmark: BenchmarkFixture, chain: str) -> None:
    cell, order = CHAINS[chain]

    def widths() -> None:
        wave = expand(cell, order)
        assert len(wave.c2.coefficients) == order + 1
        for quantity in QUANTITIES:
            assert len(wave.fwhm(quantity).coefficients) == order + 1

    benchmark.group = chain
    benchmark.extra_info["before"] = BEFORE[chain]
    benchmark.pedantic(widths, setup=clear_cache, rounds=5)


COMMAND = "from lwa.cli import main; main(['expansion', '--k', '3/2', '--masses', '1', *{}])"
CODE = {"import": "import lwa", "command": COMMAND.format(["--order", "10"])}


@pytest.mark.benchmark(timer=children, group="lwa expansion --order 10, and import lwa")
@pytest.mark.parametrize("code", CODE)
def test_command(benchmark: BenchmarkFixture, code: str) -> None:
    benchmark.extra_info["before"] = BEFORE["command beyond its import"]
    command = [sys.executable, "-c", CODE[code]]
    benchmark.pedantic(
        subprocess.run, (command,), {"check": True, "stdout": subprocess.DEVNULL}, rounds=5
    )
