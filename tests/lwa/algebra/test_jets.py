"""Total derivatives of jets and their antiderivatives."""

import sympy as sp
from hypothesis import given
from hypothesis import strategies as st

from lwa import Cell, Power
from lwa.algebra.model import Model

MODEL = Model(Cell([1]), Power("k"))


@given(st.integers(2, 5), st.data())
def test_antiderivative_undoes_dx(weight, data):
    algebra = MODEL.algebra(weight + 1)
    k = algebra.k
    f = algebra.zero
    for partition in sp.utilities.iterables.partitions(weight):
        term = algebra.one * data.draw(st.integers(-5, 5))
        for n, e in partition.items():
            term = term * algebra.r[n] ** e
        f = f + term * (k + 1)
    assert algebra.antiderivative(algebra.dx(f, k), k) == f


def test_other_expressions_have_no_antiderivative():
    algebra = MODEL.algebra(4)
    k, r = algebra.k, algebra.r
    assert algebra.antiderivative(r[2] ** 2, k) is None
    assert algebra.antiderivative(r[1] ** 3, k) is None
    assert (
        algebra.antiderivative(r[1] * r[2], k) is None
    )  # exact only with k r_1^3/2 beside it
