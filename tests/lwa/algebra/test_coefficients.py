"""The coefficient ring and its conversion to SymPy."""

import sympy as sp
from flint import fmpq_mpoly_ctx

from lwa import Cell, Power
from lwa.algebra.model import Model
from tests.identity import same

m1, m2, A1, A2, k = sp.symbols("m1 m2 A1 A2 k", positive=True)


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
            context = fmpq_mpoly_ctx.get(ring.names, "lex")
            pairs = [
                (ring.exponent(context), exponent),
                *zip(ring.masses.elements(context), cell.fractions, strict=True),
                *zip(
                    ring.contacts.elements(context), cell.shares(exponent), strict=True
                ),
            ]
            for element, value in pairs:
                assert same(ring.expression(list(element.terms())), value)
