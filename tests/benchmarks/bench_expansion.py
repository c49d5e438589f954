"""CPU time of the expansion in k - 1: speed and three widths of a chain.

    python -m pytest tests/benchmarks/bench_expansion.py

wants pytest-benchmark. `BEFORE` are the same medians of the recursion that extended its fields
four times a level and took the widths from tables of powers; ``--benchmark-json`` writes them
beside the new ones. SymPy forgets what it has cached before each round. No time is asserted.
"""

from __future__ import annotations

import time

import pytest
from pytest_benchmark.fixture import BenchmarkFixture
from sympy.core.cache import clear_cache

from lwa import Cell, expand
from lwa.base.quantities import QUANTITIES

CHAINS = {
    "equal beads to ε^40": (Cell([1]), 40),
    "symbolic dimer to ε^8": (Cell(["m1", "m2"]), 8),
    "numeric dimer to ε^16": (Cell([1, "1/4"]), 16),
}
BEFORE = {
    "equal beads to ε^40": 2.9,
    "symbolic dimer to ε^8": 2.0,
    "numeric dimer to ε^16": 0.9,
}
"""Seconds, of an idle machine."""


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
