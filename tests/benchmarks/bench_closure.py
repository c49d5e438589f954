"""Time and number of terms of a derivation against the order of D, beside other systems.

    python -m pytest tests/benchmarks/bench_closure.py

wants pytest-benchmark and symengine. All is derived for the dimer with k and the mass ratio as
symbols; order N of the ansatz reaches D^{k+N-1}, and the table of each has the ratios to its
fastest entry in parentheses. "kernel" is the derivation alone, in
polynomials; "converted" is `homogenize` with all coefficients of the wave equation in SymPy. The
peers derive the linear closure (see `peers`) and are held against lwa's outside the timed part.
SymPy forgets what it has cached before each round: nobody derives the same thing twice. No wall
time is asserted. ``--benchmark-json`` writes the number of terms at the highest order too.
"""

from __future__ import annotations

import importlib
from collections.abc import Callable

import pytest
import sympy as sp
from pytest_benchmark.fixture import BenchmarkFixture
from sympy.core.cache import clear_cache

from lwa import Dimer, homogenize
from lwa.algebra.model import Model
from lwa.cell import k
from lwa.closure.ansatz import linear
from lwa.closure.slaving import Solution, full
from lwa.law import Power
from tests.benchmarks import peers

DIMER = Dimer("m1", "m2")
MODEL = Model(DIMER, Power(k))

every_order = pytest.mark.parametrize("order", [4, 6, 8, 10, 12])
peers_orders = pytest.mark.parametrize("order", [4, 6])
both_closures = pytest.mark.parametrize("closure", [linear, full], ids=["linear", "full"])


@pytest.fixture(autouse=True)
def _table(benchmark: BenchmarkFixture, order: int) -> None:
    benchmark.group = f"D^(k+{order - 1})"
    benchmark.extra_info["order"] = order


@both_closures
@every_order
def test_kernel(
    benchmark: BenchmarkFixture, closure: Callable[[Model, int], Solution], order: int
) -> None:
    benchmark.extra_info["terms"] = len(closure(MODEL, order).acceleration[-1])
    benchmark(closure, MODEL, order)


@both_closures
@every_order
def test_converted(
    benchmark: BenchmarkFixture, closure: Callable[[Model, int], Solution], order: int
) -> None:
    def convert() -> int:
        theory = homogenize(DIMER, order, closure=closure.__name__)
        coefficients = [dict(terms) for terms in theory.pde.coefficients.values()]
        assert len(coefficients) == order - 2
        return len(theory.closure.acceleration[-1])

    benchmark.extra_info["terms"] = benchmark.pedantic(convert, setup=clear_cache, rounds=5)


@peers_orders
def test_sympy(benchmark: BenchmarkFixture, order: int) -> None:
    derived = benchmark.pedantic(peers.derive, (sp, order), setup=clear_cache, rounds=5)
    benchmark.extra_info["terms"] = _checked(derived, order)


@peers_orders
def test_symengine(benchmark: BenchmarkFixture, order: int) -> None:
    pytest.importorskip("symengine", reason="SymEngine is not installed")
    derived = benchmark(peers.derive, importlib.import_module("symengine"), order)
    benchmark.extra_info["terms"] = _checked(derived, order)


def _checked(derived: peers.Derived, order: int) -> int:
    """The number of terms of a peer's highest E_n, after all of its E_n and b_n are lwa's."""
    closure = linear(MODEL, order)
    generators = sp.symbols(f"k b r1:{order}")
    assert len(closure.algebra.context.names()) == len(generators)
    for own, found in zip((closure.acceleration, closure.ansatz), derived, strict=True):
        for polynomial, expression in zip(own, found, strict=True):
            expected = {tuple(map(int, e)): sp.Rational(str(c)) for e, c in polynomial.terms()}
            poly = sp.Poly(sp.sympify(expression), *generators)
            assert dict(poly.terms() if poly else ()) == expected
    return len(closure.acceleration[-1])
