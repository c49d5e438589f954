"""Identities of the proof that waves in any lattice obey one relation, on the page of proofs.

With exponentials of u_x for the coefficients: all others are sums of such.
"""

import sympy as sp

x, t, a = sp.symbols("x t a")
u = sp.Function("u")(x, t)
DERIVATIVES = (x,), (t,), (x, x), (x, t), (t, t)
u_x, u_t, u_xx, u_xt, u_tt = (u.diff(*by) for by in DERIVATIVES)
c = sp.exp(a * u_x)


def euler(density):
    """The Euler-Lagrange expression of a density in first and second derivatives of u."""
    total = 0
    for by in DERIVATIVES:
        total += (-1) ** len(by) * density.diff(u.diff(*by)).diff(*by)
    return sp.expand(total)


def test_one_derivative_more_leaves_no_term():
    assert euler(c * u_xx) == euler(c * u_xt) == 0
    assert euler(c * u_xx**2) != 0


def test_one_function_is_left():
    """The equation of the field is that of u_t²/2 - W + J u_xx²/2 with J = I F′."""
    W, J = sp.exp(2 * u_x), c
    force = 2 * W + J * u_xx.diff(x) + a * J * u_xx**2 / 2
    found = euler(u_t**2 / 2 - W + J * u_xx**2 / 2)
    assert sp.expand(found + u_tt - force.diff(x)) == 0
    # two integrations by parts turn u_xt² into u_xx u_tt
    assert sp.expand(euler(c * (u_xt**2 - u_xx * u_tt))) == 0
