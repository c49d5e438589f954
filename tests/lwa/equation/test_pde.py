"""The wave equation: its form, conservation, lazy coefficients."""

import pytest
import sympy as sp

from lwa import D, Dimer, InputError, homogenize
from tests.lwa.equation.test_conservation import at_a_point, variational_derivative

x = sp.Symbol("x")


@pytest.mark.parametrize(("masses", "conservative"), [((1, 1), True), ((3, 1), False)])
def test_conservation_form_agrees_with_the_euler_operator(masses, conservative):
    pde = homogenize(Dimer(*masses), order=4, k=3).pde
    u = sp.Function("u")(x)
    # at a polynomial with all jets alive: an expression that vanishes does so for any field
    value = at_a_point(variational_derivative(pde.right_side(u, x), u, 4).subs(D, 1), u)
    assert (value == 0) == conservative == pde.conservative


def test_G_H_I_need_order_four_and_the_acoustic_branch():
    with pytest.raises(InputError, match="from order 4 on"):
        homogenize(Dimer(1, 2), order=3).pde.G  # noqa: B018
    with pytest.raises(InputError, match="acoustic"):
        homogenize(Dimer(1, 2), branch="optical").pde.traveling_wave()


def test_unequal_contacts_have_no_closed_wave_in_the_linear_closure():
    with pytest.raises(InputError, match="stiffnesses"):
        homogenize(Dimer(1, 1, stiffnesses=(1, 2)), k=2).pde.traveling_wave()
