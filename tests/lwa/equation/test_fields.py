"""The wave equation in another field."""

import pytest
import sympy as sp

from lwa import Dimer, InputError, homogenize

m1, m2 = sp.symbols("m1 m2", positive=True)
b = m1 / (m1 + m2)
alpha = sp.Symbol("alpha", positive=True)


def same(first, second, order):
    for n in range(2, order):
        jets = set(first.coefficients[n]) | set(second.coefficients[n])
        for jet in jets:
            difference = first.coefficients[n].get(jet, 0) - second.coefficients[n].get(jet, 0)
            assert sp.cancel(difference) == 0


@pytest.mark.parametrize("closure", ["linear", "full"])
def test_a_shift_changes_G_and_H_but_not_I(closure):
    pde = homogenize(Dimer(m1, m2), closure=closure).pde
    changed = pde.in_field({2: alpha})
    k, D = pde.k, pde.cell.spacing
    assert sp.cancel(changed.G - pde.G - alpha * (k - 1) * (k - 2) * D**2) == 0
    assert sp.cancel(changed.H - pde.H - 2 * alpha * (k - 1) * D**2) == 0
    assert sp.cancel(changed.I - pde.I) == 0


def test_from_the_first_to_the_canonical_field_at_third_order():
    first, center = (
        homogenize(Dimer(m1, m2), closure="full", field=field).pde for field in ("first", "center")
    )
    same(first.in_field({2: (1 - b) * (b - sp.Rational(1, 2))}), center, 4)


@pytest.mark.parametrize("k", [2, 3])
def test_a_shift_in_the_masses_at_a_number_k(k):
    """Numbers of the shift that equal k are numbers still."""
    shift, at = k * b**3, {"m1": 3, "m2": 1}
    pde = homogenize(Dimer(m1, m2), k=k, closure="full").pde
    numbers = homogenize(Dimer(3, 1), k=k, closure="full").pde.in_field({2: k * sp.S("27/64")})
    assert pde.in_field({2: shift}).H.subs({m1: 3, m2: 1}) == numbers.H
    assert pde.in_field({2: shift}).at(**at).H == numbers.H


def test_a_shift_and_its_inverse_cancel():
    # (1 + αD²∂² )^{-1} = 1 - αD²∂² + α²D⁴∂⁴ - α³D⁶∂⁶ + …
    pde = homogenize(Dimer(2, 1), 8, closure="full").pde
    there = pde.in_field({2: alpha})
    same(there.in_field({2: -alpha, 4: alpha**2, 6: -(alpha**3)}), pde, 8)


def test_bad_shifts():
    pde = homogenize(Dimer(1, 2)).pde
    with pytest.raises(InputError, match="n is 0"):
        pde.in_field({0: 1})
    with pytest.raises(InputError, match="alpha_2"):
        pde.in_field({2: "x+y"})
