"""The paper, equation by equation.

Porter, Daraio, Herbold, Szelengowicz and Kevrekidis, "Highly nonlinear solitary waves in periodic
dimer granular chains" (2008). Each test says which statement of the paper it checks; where the
paper gives a formula, the formula is written here as it stands there.
"""

import pytest
import sympy as sp

from lwa import D, Dimer, homogenize, k
from lwa.base.frozen import SPEED as V
from tests.identity import same

m1, m2 = sp.symbols("m1 m2", positive=True)
omega = sp.Symbol("omega", positive=True)
M = m1 + m2


@pytest.fixture(scope="module")
def theory():
    return homogenize(Dimer(m1, m2), order=4)


@pytest.fixture(scope="module")
def wave(theory):
    return theory.pde.traveling_wave()


def test_lambda_is_one_or_minus_the_mass_ratio():
    for branch, ratio in (("acoustic", 1), ("optical", -m1 / m2)):
        theory = homogenize(Dimer(m1, m2), order=1, branch=branch)
        assert theory.amplitude_ratio == ratio


def test_coefficients_of_the_ansatz(theory):
    fourth = m1 * (m1**2 - m1 * m2 + m2**2) / (3 * M**3)
    for n, printed in enumerate((1, m1 / M, (2 * m1 - m2) / (3 * M), fourth), start=1):
        assert same(theory.ansatz[n], printed)


def test_at_equal_masses_the_ansatz_is_the_taylor_expansion_of_radius_D(theory):
    for n, b in theory.ansatz.items():
        assert b.subs(m2, m1) == 1 / sp.factorial(n)


def test_coefficients_of_the_wave_equation(theory):
    assert same(theory.pde.G, D**2 * (2 - 3 * k + k**2) * m1**2 / (6 * M**2))
    assert same(
        theory.pde.H, 2 * D**2 * (k - 1) * (2 * m1**2 + m1 * m2 - m2**2) / (6 * M**2)
    )
    assert same(theory.pde.I, 2 * D**2 * (m1**2 - m1 * m2 + m2**2) / (6 * M**2))


def test_the_wave_equation_has_no_other_terms_up_to_D_k_plus_3(theory):
    assert set(theory.pde.coefficients) == {2, 3}
    assert theory.pde.vanishing == (2,)
    assert {jet.x for jet in theory.pde.coefficients[3]} == {
        ((2, 3),),
        ((2, 1), (3, 1)),
        ((4, 1),),
    }


def test_rescaled_time(theory):
    assert same(theory.pde.time_scale**2, 2 * k * D ** (k + 1) / M)


def test_the_uniform_chain_has_nesterenkos_equation():
    # with m1 = m2 the dimer's field obeys the equation of the chain with one particle per cell
    dimer = homogenize(Dimer(m1, m1), order=8).pde
    uniform = homogenize(type(dimer.cell)([m1]), order=8).pde
    for n in range(2, 8):
        assert dict(dimer.coefficients[n]) == dict(uniform.coefficients[n])


def test_integrating_factor_and_the_equation_of_z(wave):
    for root in (0, 1):
        found = wave.reduction(root)
        p = found.p
        a = 1 - k * p + 3 * (p - 1) + p * wave.H / wave.I
        assert same(found.a, a)
        assert same(found.mu, V**2 / (wave.I * (p + a)))
        assert same(found.eta, 1 + p - k * p)
        assert same(found.sigma, 1 / (wave.I * (k * p + a)))


def test_both_roots_give_the_short_beta(wave):
    for root in (0, 1):
        found = wave.reduction(root)
        assert found.p == wave.roots[root]
        assert same(found.sigma * (1 - found.eta) ** 2 / 4, wave.beta**2)


def test_the_page_wide_beta_of_hertz_contacts(wave):
    root = sp.sqrt(4 - 4 * omega + 13 * omega**2 - 18 * omega**3 + 9 * omega**4)
    front = sp.sqrt(3) * (8 - 5 * omega + 5 * omega**2 - root)
    front /= 30 - 8 * omega + 8 * omega**2
    above = (1 + omega) ** 2 * (15 - 4 * omega + 4 * omega**2)
    below = 34 - 42 * omega + 59 * omega**2 - 34 * omega**3 + 17 * omega**4
    below += (-8 + 5 * omega - 5 * omega**2) * root
    printed = front * sp.sqrt(above / (D**2 * below))
    beta = wave.at(k="3/2", m1=1, m2=omega).beta
    for ratio in ("1/100", "1/2", 1, 3, 1000):
        values = {omega: sp.Rational(ratio)}
        assert same(printed.subs(values), beta.subs(values))


@pytest.mark.parametrize(
    ("ratio", "beta", "sites"),
    [(1, sp.sqrt(10) / 5, 5), (0, sp.sqrt(10) / 10, 10), (sp.oo, sp.sqrt(6) / 4, 5)],
)
def test_equal_masses_extend_to_five_sites_and_a_light_mass_to_ten(
    wave, ratio, beta, sites
):
    """The same chain, its light beads called first, has another width in this closure."""
    assert sp.limit(wave.at(k="3/2", m1=1, m2=omega).beta, omega, ratio) == beta / D
    assert round(float(sp.pi / beta)) == sites


def test_amplitude_and_speed_scale_as_stated(wave):
    c = sp.Symbol("c", positive=True)
    ratio = wave.amplitude(c * V) / wave.amplitude(V)
    assert same(ratio, c ** (2 / (k - 1)))
    assert wave.at(k="3/2").force_exponent == 6


def test_amplitude_of_the_paper_agrees_with_direct_insertion(wave):
    at = wave.at(k="8/5", m1=2, m2=3, D=1)
    for root in (0, 1):
        found = at.reduction(root, V=2)
        inside = found.mu / (at.beta**2 * found.s * (found.s - 1))
        printed = inside ** (1 / (at.k - 1))
        assert abs(sp.N(printed / at.amplitude(2), 50) - 1) < 1e-40


@pytest.mark.parametrize(
    "values",
    [
        dict(k="3/2", m1=1, m2=1, D=1),
        dict(k="3/2", m1="9/20", m2="123/1000", D="119/25000"),
        dict(k="11/10", m1=1, m2=4, D=2),
        dict(k=3, m1=5, m2=1, D=1),
    ],
    ids=str,
)
def test_the_wave_solves_the_equation_at_fifty_digits(wave, values):
    at, xi, speed = wave.at(**values), sp.Symbol("xi"), sp.Rational(3, 2)
    v = at.amplitude(speed) * sp.cos(at.beta * xi) ** at.m
    dv, d2v, d3v = (v.diff(xi, n) for n in (1, 2, 3))
    right = v ** (at.k - 1) * dv + at.G * v ** (at.k - 3) * dv**3
    right += at.H * v ** (at.k - 2) * dv * d2v + at.I * v ** (at.k - 1) * d3v
    for phase in ("1/7", "-11/10", "3/2"):
        ratio = (right / (speed**2 * dv)).subs(xi, sp.Rational(phase) / at.beta)
        # 50 digits less the few that the sum of four terms may cancel
        assert abs(sp.N(ratio, 50) - 1) < 1e-44
