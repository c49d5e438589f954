"""The coefficient ring and its conversion to SymPy."""

import sympy as sp
from flint import fmpq, fmpq_mpoly_ctx
from hypothesis import given
from hypothesis import strategies as st

from lwa import Cell, Power
from lwa.algebra.model import Model
from tests.identity import same

m1, m2, A1, A2, k = sp.symbols("m1 m2 A1 A2 k", positive=True)


def elements(ring):
    context = fmpq_mpoly_ctx.get(ring.names or ("unused",), "lex")
    return ring.masses.elements(context), ring.contacts.elements(context), ring.exponent(context)


def through(ring, polynomial):
    count = len(ring.names)
    return ring.expression([(tuple(e[:count]), c) for e, c in polynomial.terms()])


def test_ring_elements_convert_back_to_their_expressions():
    for cell in (
        Cell([m1, m2]),
        Cell([m1, m2], stiffnesses=[A1, A2]),
        Cell([m1, m1, m2], stiffnesses=[A1, A1, A2]),
        Cell([m1, 2 * m1, m2, 3]),
        Cell([1, 2, 3], stiffnesses=[1, 2, 2]),
        Cell([sp.sqrt(2), 1]),
    ):
        for exponent in (k, sp.Rational(3, 2)):
            ring = Model(cell, Power(exponent)).ring
            fractions, shares, own = elements(ring)
            expected = [*cell.fractions, *cell.shares(exponent), exponent]
            for element, value in zip([*fractions, *shares, own], expected, strict=True):
                assert same(through(ring, element), value)


def test_rational_values_need_no_generator():
    assert Model(Cell([1, 2]), Power(sp.Rational(3, 2))).ring.names == ()
    assert Model(Cell([m1, 2 * m1]), Power(k)).ring.names == ("k",)
    # 8^(-2/3) = 1/4
    assert Model(Cell([1, 1], stiffnesses=[1, 8]), Power(sp.Rational(3, 2))).ring.names == ()


@given(
    st.lists(
        st.tuples(st.tuples(st.integers(0, 3), st.integers(0, 3)), st.fractions(max_denominator=9)),
        max_size=5,
    )
)
def test_factored_expressions_equal_the_polynomial(terms):
    ring = Model(Cell([m1, m2]), Power(k)).ring
    flint_terms = [(e, fmpq(c.numerator, c.denominator)) for e, c in terms]
    plain = sum(
        (
            sp.Rational(c.numerator, c.denominator) * k**i * (m1 / (m1 + m2)) ** j
            for (i, j), c in terms
        ),
        sp.Integer(0),
    )
    assert sp.cancel(ring.expression(flint_terms) - plain) == 0
