"""The closure against computations that share no code with it.

The lattice's own equations of motion are expanded numerically with mpmath at 50 digits; at k = 1
the exact dispersion relation of the linear chain must come out to order 12, both branches.
"""

from fractions import Fraction
from functools import cache

import mpmath
import pytest
import sympy as sp
from hypothesis import given, settings
from hypothesis import strategies as st

from lwa import Cell, Dimer, InputError, homogenize
from lwa.equation.terms import Jet
from tests.lwa.series import exponential, fraction, taylor

masses = st.fractions(min_value="1/20", max_value=20, max_denominator=20)


# --- the lattice equations, expanded at 50 digits ----------------------------------------------


# A concrete field u(x) = Σ w e^{ax}: u_x > 0 around x = 0, and no derivative vanishes.
FIELD = (
    (sp.Integer(2), sp.Integer(1)),
    (sp.Rational(-1, 4), sp.Rational(-2, 3)),
    (sp.Integer(3), sp.Rational(1, 5)),
)


def number(value):
    """A rational in mpmath's working digits."""
    return mpmath.mpf(int(value.p)) / int(value.q)


def exponentials():
    return [(number(w), number(a)) for w, a in FIELD]


@cache
def derivative(n, x=0):
    """∂_x^n u, at 70 digits."""
    return mpmath.fsum(w * a**n * mpmath.exp(a * x) for w, a in exponentials())


def slaved(ansatz, x, D):
    """w = Σ b_n D^n ∂_x^n u."""
    return mpmath.fsum(
        w * mpmath.exp(a * x) * mpmath.fsum(b * (a * D) ** n for n, b in enumerate(ansatz))
        for w, a in exponentials()
    )


def evaluate(terms, x=0):
    """Σ coefficient · Π (∂^i u/u_x)^e."""
    total = mpmath.mpf(0)
    for jet, coefficient in terms.items():
        product = number(coefficient)
        for i, e in jet.x:
            product *= (derivative(i, x) / derivative(1, x)) ** e
        total += product
    return total


def lattice_accelerations(theory, order):
    """E_n, n < order, of u_ττ by both equations of motion, with the theory's ansatz for w."""
    m1, m2 = map(number, theory.cell.masses)
    k = number(theory.k)
    ansatz = [mpmath.mpf(1), *map(number, theory.ansatz.values())]
    p = derivative(1)

    @cache
    def forces(D):
        u, right = derivative(0), derivative(0, 2 * D)
        w, left = slaved(ansatz, 0, D), slaved(ansatz, -2 * D, D)
        own = ((w - u) / (D * p)) ** k
        return own - ((u - left) / (D * p)) ** k, ((right - w) / (D * p)) ** k - own

    unit = 2 * k / (m1 + m2)
    first = [c / (m1 * unit) for c in taylor(lambda D: forces(D)[0], order)]
    second = [c / (m2 * unit) for c in taylor(lambda D: forces(D)[1], order)]
    return first, second, ansatz


@pytest.mark.parametrize(("k", "m1", "m2"), [("3/2", "9/20", "123/1000"), ("2/3", 7, 2)])
def test_against_the_lattice_at_fifty_digits(k, m1, m2):
    order = 7
    with mpmath.workdps(70):
        theory = homogenize(Dimer(m1, m2), order=order, k=k)
        first, second, ansatz = lattice_accelerations(theory, order - 1)
        bound = mpmath.mpf(10) ** -45  # 70 digits less the Cauchy integrals' own loss
        assert abs(first[0]) < bound
        assert abs(first[1] - derivative(2) / derivative(1)) < bound
        for n in range(2, order):
            assert abs(first[n] - evaluate(theory.pde.coefficients[n])) < bound
        for n in range(1, order):
            by_second = first[n] - evaluate(theory.defect.get(n, {}))
            assert abs(second[n] - ansatz_on_second(theory, ansatz, n) - by_second) < bound


def ansatz_on_second(theory, ansatz, n):
    """What w = Lu adds to w_ττ: Σ_{0<j<n} b_j ∂_x^j u_ττ at D^{n-1} over u_x^k.

    u_ττ is that of the second equation, the theory's less its defect.
    """
    k = number(theory.k)
    total = mpmath.mpf(0)
    for j in range(1, n):
        order = n - j
        parts = dict(theory.pde.coefficients.get(order, {})) if order > 1 else {Jet(((2, 1),)): 1}
        for jet, value in theory.defect.get(order, {}).items():
            parts[jet] = parts.get(jet, 0) - value
        parts = {jet: sp.sympify(value) for jet, value in parts.items()}
        field = taylor(lambda x, parts=parts: derivative(1, x) ** k * evaluate(parts, x), j)
        total += ansatz[j] * field[j] * mpmath.factorial(j)
    return total / derivative(1) ** k


# --- the linear limit ---------------------------------------------------------------------------


def truncated_product(a, b, order):
    c = [Fraction(0)] * (order + 1)
    for i, x in enumerate(a[: order + 1]):
        for j, y in enumerate(b[: order + 1 - i]):
            c[i + j] += x * y
    return c


@given(masses, masses)
@settings(max_examples=5)
@pytest.mark.parametrize("branch", ["acoustic", "optical"])
def test_k_equal_one_is_the_exact_dispersion_relation_to_order_12(branch, m1, m2):
    """With u = e^{qx} (q = iκ) both equations of motion become identities in q, order by order.

    In time t: m1 s = -2 + ρ (1 + e^{-2q}) and m2 s ρ = e^{2q} + 1 - 2ρ, where s = u_tt/u and ρ is
    the amplitude ratio w/u, both series in q that the theory gives (D = 1).
    """
    order = 12
    theory = homogenize(Dimer(m1, m2, spacing=1), order=order, k=1, branch=branch)
    ratio = fraction(theory.amplitude_ratio)
    rho = [ratio] + [ratio * fraction(b) for b in theory.ansatz.values()]
    scale = fraction(theory.pde.time_scale**2)
    # the coefficient of q^n in u_ττ/u: acoustic q² + …, optical -1 + …
    s = [Fraction(0)] * (order + 1)
    s[0 if branch == "optical" else 2] = Fraction(-1 if branch == "optical" else 1)
    for n, terms in theory.pde.coefficients.items():
        for jet, coefficient in terms.items():
            ((i, e),) = jet.x  # at k = 1 nothing but linear terms is left
            assert e == 1
            s[i] += fraction(coefficient)
            assert i == n + (branch == "acoustic")
    s = [scale * c for c in s]
    minus = exponential(Fraction(-2), order)
    plus = exponential(Fraction(2), order)
    one_plus_minus = [minus[0] + 1, *minus[1:]]
    first = truncated_product(rho, one_plus_minus, order)
    first[0] -= 2
    assert [m1 * c for c in s] == first
    second = [a - 2 * b for a, b in zip(plus, rho, strict=True)]
    second[0] += 1
    assert [m2 * c for c in truncated_product(s, rho, order)] == second
    assert theory.defect == {}


# --- structure --------------------------------------------------------------------------------


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


def test_the_defect_is_the_difference_between_both_equations():
    theory = homogenize(Dimer("m1", "m2"), order=4)
    m1, m2 = theory.cell.masses
    k, b = theory.k, m1 / (m1 + m2)
    G2 = (k - 1) * (k - 2) * (b**2 - 8 * b + 4) / 6
    H2 = (k - 1) * (sp.Rational(5, 3) - 3 * b)
    terms = theory.pde.coefficients[3]
    assert sp.cancel(terms[((2, 3),)] - theory.defect[3][((2, 3),)] - G2) == 0
    assert sp.cancel(terms[((2, 1), (3, 1))] - theory.defect[3][((2, 1), (3, 1))] - H2) == 0
    assert set(theory.defect[3]) == {Jet(((2, 3),)), Jet(((2, 1), (3, 1)))}


def test_amplitude_ratios_are_all_the_uniform_motions():
    """m1 ü = 2s and m2 λ ü = -2s, s the force of a contact: m2 λ s + m1 s = 0 for the ratios only.

    s is odd in the strain (λ - 1) u and vanishes with it alone: where a power (λ - 1)^k would do.
    """
    m1, m2 = sp.symbols("m1 m2", positive=True)
    lam = sp.Symbol("lam")
    branches = ("acoustic", "optical")
    found = {homogenize(Dimer(m1, m2), 1, branch=branch).amplitude_ratio for branch in branches}
    for s in (lam - 1, (lam - 1) ** 3):
        assert set(sp.solve(m2 * lam * s + m1 * s, lam)) == found
    assert homogenize(Dimer(3, 5), branch="optical").amplitude_ratio == sp.Rational(-3, 5)


def test_one_mass_has_no_optical_branch():
    with pytest.raises(InputError, match="1 masses"):
        homogenize(Cell([1]), branch="optical")
