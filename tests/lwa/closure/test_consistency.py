"""The linear closure's defect, the orders that vanish, and the branches."""

import pytest
import sympy as sp

from lwa import Dimer, homogenize


@pytest.mark.parametrize("branch", ["acoustic", "optical"])
def test_every_second_order_vanishes(branch):
    theory = homogenize(Dimer("m1", "m2"), order=9, branch=branch)
    parity = 0 if branch == "acoustic" else 1
    for n, terms in theory.pde.coefficients.items():
        assert (len(terms) == 0) == (n % 2 == parity)


def test_the_defect_vanishes_at_equal_masses_only():
    m = sp.Symbol("m", positive=True)
    theory = homogenize(Dimer("m1", "m2"), order=8)
    assert set(theory.defect) == {3, 5, 7}
    assert homogenize(Dimer(m, m), order=8).defect == {}
    m1, m2 = theory.cell.masses
    for terms in theory.defect.values():
        for coefficient in terms.values():
            assert sp.cancel(coefficient.subs(m1, m2)) == 0
