"""Time and number of terms of a derivation against the order of D, beside other systems.

    python -m pytest tests/benchmarks/bench_closure.py

Wants pytest-benchmark and symengine. All is derived for the dimer with k and the mass ratio as
symbols; order N of the ansatz reaches D^{k+N-1}. "kernel" is the derivation alone, in polynomials;
"converted" is `homogenize` with all coefficients of the wave equation in SymPy. The peers derive
the linear closure (see `peers`) and are held against lwa's outside the timed part. SymPy forgets
its cache before each round. No wall time is asserted.
"""

import pytest
import sympy as sp
from sympy.core.cache import clear_cache

from lwa import Dimer, homogenize
from lwa.algebra.model import Model
from lwa.cell import k
from lwa.closure.ansatz import linear
from lwa.closure.slaving import full
from lwa.law import Power
from tests.benchmarks import peers

DIMER = Dimer("m1", "m2")


def model(order):
    return Model(DIMER, Power(k), order=order)


every_order = pytest.mark.parametrize("order", [4, 6, 8, 10, 12])
both_closures = pytest.mark.parametrize("closure", [linear, full])


@pytest.fixture(autouse=True)
def _table(benchmark, order):
    benchmark.group = f"D^(k+{order - 1})"
    benchmark.extra_info["order"] = order


@both_closures
@every_order
def test_kernel(benchmark, closure, order):
    benchmark.extra_info["terms"] = len(closure(model(order)).acceleration[-1])
    benchmark(closure, model(order))


@both_closures
@every_order
def test_converted(benchmark, closure, order):
    def convert():
        theory = homogenize(DIMER, order, closure=closure.__name__, field="first")
        coefficients = [dict(terms) for terms in theory.pde.coefficients.values()]
        assert len(coefficients) == order - 2
        return len(theory.closure.solution.acceleration[-1])

    benchmark.extra_info["terms"] = benchmark.pedantic(
        convert, setup=clear_cache, rounds=5
    )


@pytest.mark.parametrize("order", [4, 6])
@pytest.mark.parametrize("system", ["sympy", "symengine"])
def test_peer(benchmark, system, order):
    module = pytest.importorskip(system)
    derived = benchmark.pedantic(
        peers.derive, (module, order), setup=clear_cache, rounds=5
    )
    benchmark.extra_info["terms"] = _checked(derived, order)


def _checked(derived, order):
    """The number of terms of a peer's highest E_n, after all of its E_n and b_n are lwa's."""
    closure = linear(model(order))
    strain = sp.symbols(f"k b r1:{order}")
    names = closure.algebra.context.names()
    generators = (
        *strain,
        *map(sp.Symbol, names[len(strain) :]),
    )  # jets of the velocity
    for own, found in zip((closure.acceleration, closure.ansatz), derived, strict=True):
        for polynomial, expression in zip(own, found, strict=True):
            expected = {
                tuple(map(int, e)): sp.Rational(str(c)) for e, c in polynomial.terms()
            }
            poly = sp.Poly(sp.sympify(expression), *generators)
            assert dict(poly.terms() if poly else ()) == expected
    return len(closure.acceleration[-1])
