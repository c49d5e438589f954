"""Identities of the proof that waves in any lattice obey one relation, on the page of proofs.

With exponentials of u_x for the coefficients: all others are sums of such.
"""

import sympy as sp

from tests.book.prose import said

x, t, a = sp.symbols("x t a")
u = sp.Function("u")(x, t)
DERIVATIVES = (x,), (t,), (x, x), (x, t), (t, t)
u_x, u_t, u_xx, u_xt, u_tt = (u.diff(*by) for by in DERIVATIVES)
c = sp.exp(a * u_x)


def euler(density):
    """The Euler-Lagrange expression of a density in first and second derivatives of u."""
    parts = (
        (-1) ** len(by) * density.diff(u.diff(*by)).diff(*by) for by in DERIVATIVES
    )
    return sp.expand(sum(parts))


def test_one_derivative_more_leaves_a_term_that_is_no_divergence():
    said("proofs", r"\mathrm{EL}(c\,u_{tt}) = c''(u_x)\,(u_{xt}^2 - u_{xx}u_{tt})")
    assert sp.expand(euler(c * u_tt) - a**2 * c * (u_xt**2 - u_xx * u_tt)) == 0
    assert euler(c * u_xx) == euler(c * u_xt) == 0


def test_the_slope_of_a_density_in_the_velocity_has_the_slope_of_its_equation():
    """EL(∂L/∂u_t) = ∂EL(L)/∂u_t for densities without u."""
    for density in (
        c * u_t**3,
        c * u_t**2 * u_xx,
        u_x**2 * u_t**2 * u_tt,
        c * u_t * u_xt * u_xx,
    ):
        assert sp.expand(euler(density.diff(u_t)) - euler(density).diff(u_t)) == 0
        assert euler(density) != 0


def test_one_function_is_left():
    """u_tt = ∂_x (F + J u_xxx + J′ u_xx²/2) with J = I F′ is that of u_t²/2 - W + J u_xx²/2."""
    W, J = sp.exp(2 * u_x), c
    force = 2 * W + J * u_xx.diff(x) + a * J * u_xx**2 / 2
    found = euler(u_t**2 / 2 - W + J * u_xx**2 / 2)
    assert sp.expand(found + u_tt - force.diff(x)) == 0
    # u_xt² is u_xx u_tt but for divergences
    assert euler(u_xt**2 - u_xx * u_tt) == 0
