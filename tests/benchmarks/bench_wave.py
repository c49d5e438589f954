"""CPU time of closed-form waves of symbolic cells, and of the commands as whole processes.

    python -m pytest tests/benchmarks/bench_wave.py

wants pytest-benchmark. `BEFORE` are medians of what factored the wave's coefficients anew and
extended the expansion four times a level; ``--benchmark-json`` writes them beside the new ones.
SymPy forgets what it has cached before each round. No time is asserted.
"""

from __future__ import annotations

import os
import subprocess
import sys
import time

import pytest
import sympy as sp
from pytest_benchmark.fixture import BenchmarkFixture
from sympy.core.cache import clear_cache

from lwa import Cell, canonical_wave
from lwa.base.quantities import QUANTITIES

CANONICAL = {4: 4.5, 6: 23.7}
"""Particles of the cell, all masses symbols: seconds before, of an idle machine."""

COMMANDS = {
    "import lwa": ("import lwa", None),
    "lwa wave": ("from lwa.command.cli import main; main(['wave'])", 1.16),
    "lwa expansion --order 10": (
        "from lwa.command.cli import main; "
        "main(['expansion', '--k', '3/2', '--masses', '1', '--order', '10'])",
        1.06,
    ),
}
"""Code that Python runs, and seconds before."""


@pytest.mark.benchmark(timer=time.process_time)
@pytest.mark.parametrize("particles", CANONICAL)
def test_canonical_wave(benchmark: BenchmarkFixture, particles: int) -> None:
    cell = Cell(sp.symbols(f"m1:{particles + 1}", positive=True))

    def closed_forms() -> None:
        wave = canonical_wave(cell)
        assert all((wave.beta, wave.speed(), *map(wave.fwhm, QUANTITIES)))

    benchmark.group = f"canonical wave of {particles} particles"
    benchmark.extra_info["before"] = CANONICAL[particles]
    benchmark.pedantic(closed_forms, setup=clear_cache, rounds=5)


def children() -> float:
    """CPU time of the processes that have ended."""
    times = os.times()
    return times.children_user + times.children_system


@pytest.mark.benchmark(timer=children, group="commands")
@pytest.mark.parametrize("name", COMMANDS)
def test_command(benchmark: BenchmarkFixture, name: str) -> None:
    code, before = COMMANDS[name]
    benchmark.extra_info["before"] = before
    command = [sys.executable, "-c", code]
    benchmark.pedantic(
        subprocess.run, (command,), {"check": True, "stdout": subprocess.DEVNULL}, rounds=5
    )
