"""Rational expressions in lowest terms, against SymPy's own polynomials."""

import sympy as sp
from hypothesis import assume, example, given
from hypothesis import strategies as st

from lwa.algebra.rational import factored

x, y = sp.symbols("x y", positive=True)
leaves = st.sampled_from(
    [x, y, sp.Rational(2, 3), sp.Integer(-3), sp.sqrt(2), x**y, sp.sin(x)]
)
expressions = st.recursive(
    leaves,
    lambda parts: st.one_of(
        st.builds(sp.Add, parts, parts),
        st.builds(sp.Mul, parts, parts),
        st.builds(sp.Pow, parts, st.integers(-2, 3)),
    ),
    max_leaves=6,
)


@given(expressions)
@example(x + x**-y)
@example((x**y + x**-y) * x**y)
def test_factored_expressions_are_equal_and_in_lowest_terms(value):
    assume(not value.has(sp.zoo, sp.nan))
    # x^{-y} is a symbol of its own there, and 1/p here
    assume(not any((power.exp / y).is_negative for power in value.atoms(sp.Pow)))
    found = factored(value)
    plain = {
        sp.sqrt(2): sp.Symbol("r"),
        x**y: sp.Symbol("p"),
        sp.sin(x): sp.Symbol("s"),
    }
    difference = sp.cancel((found - value).subs(plain))
    assert difference == 0
    numerator, denominator = sp.fraction(sp.cancel(value.subs(plain)))
    above, below = sp.fraction(found.subs(plain))
    gens = (*plain.values(), x, y)
    for one, two in ((numerator, above), (denominator, below)):
        assert sp.Poly(one, *gens).total_degree() == sp.Poly(two, *gens).total_degree()
