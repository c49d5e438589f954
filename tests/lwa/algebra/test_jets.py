"""The jet algebra against calculus on a concrete function."""

import pytest
import sympy as sp
from hypothesis import given
from hypothesis import strategies as st

from lwa.algebra.jets import JetAlgebra

x = sp.Symbol("x")
BASE = sp.exp(x) + sp.Rational(1, 3) * sp.exp(3 * x)  # any smooth positive base p


def at_zero(algebra, f):
    """A polynomial in the jets, with r_n = ∂^n p/p of `BASE` at x = 0."""
    values = [BASE.diff(x, n).subs(x, 0) / BASE.subs(x, 0) for n in range(algebra.weight + 1)]
    return sum(
        sp.Rational(int(c.p), int(c.q)) * sp.prod(values[n] ** e for n, e in jet.x)
        for jet, terms in algebra.terms(f).items()
        for _, c in terms
    )


@pytest.mark.parametrize("exponent", [0, 1, 3])
def test_dx_is_the_derivative(exponent):
    algebra = JetAlgebra((), weight=4)
    r = algebra.r
    f = r[1] ** 2 * r[2] - 3 * r[3] + 2
    as_function = (
        (BASE.diff(x) / BASE) ** 2 * BASE.diff(x, 2) / BASE - 3 * BASE.diff(x, 3) / BASE + 2
    )
    expected = (BASE**exponent * as_function).diff(x) / BASE**exponent
    assert at_zero(algebra, algebra.dx(f, exponent)) == sp.simplify(expected.subs(x, 0))


def test_dx_beyond_the_weight_of_the_algebra_is_an_error():
    algebra = JetAlgebra((), weight=2)
    with pytest.raises(ValueError, match="more weight"):
        algebra.dx(algebra.r[2], 0)


@given(st.integers(2, 5), st.data())
def test_antiderivative_undoes_dx(weight, data):
    algebra = JetAlgebra(("k",), weight + 1)
    k = algebra.context.gens()[0]
    jets = [sp.utilities.iterables.partitions(weight)]
    f = algebra.zero
    for partition in jets[0]:
        term = algebra.one * data.draw(st.integers(-5, 5))
        for n, e in partition.items():
            term = term * algebra.r[n] ** e
        f = f + term * (k + 1)
    assert algebra.antiderivative(algebra.dx(f, k), k) == f


def test_other_expressions_have_no_antiderivative():
    algebra = JetAlgebra(("k",), weight=4)
    k, r = algebra.context.gens()[0], algebra.r
    assert algebra.antiderivative(r[2] ** 2, k) is None
    assert algebra.antiderivative(r[1] ** 3, k) is None
    assert algebra.antiderivative(r[1] * r[2], k) is None  # exact only with k r_1^3/2 beside it
