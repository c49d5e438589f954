"""The expansion in ε = k - 1: the lattice's equations, identities, the theory it continues."""

from functools import cache
from itertools import pairwise

import mpmath
import pytest
import sympy as sp

from lwa import Cell, Dimer, canonical_wave
from lwa.expansion.expand import expand
from lwa.expansion.observables import Observables, shares_model
from lwa.expansion.recursion import Recursion
from tests.identity import same
from tests.lwa.expansion.test_exact_waves import series

HALF = sp.Rational(1, 2)
OMEGA = sp.Symbol("omega", positive=True)

CELLS = {
    "equal": Cell([1]),
    "dimer": Cell([1, HALF / 2]),
    "contacts": Cell([1, 1], [1, 8]),
    "three": Cell([1, 2, 5]),
}


@cache
def wave(name, order=4):
    return expand(CELLS[name], order, k=3 if name == "contacts" else "k")


def contact(log, I, epsilon):
    """Strain of a contact, over its share, as a function of ξ: the given terms of log f in t."""

    def strain(xi):
        Z, t = mpmath.sqrt(epsilon / I) * xi, mpmath.sqrt(epsilon / I**3)
        total = -(Z**2) / 4
        for n, polynomial in enumerate(log):
            for (d,), c in polynomial.terms():
                total += exact(c) * Z ** int(d) * t**n
        return mpmath.exp(total / (1 + epsilon))

    return strain


def exact(value):
    """A rational of FLINT or SymPy in mpmath's precision."""
    return mpmath.mpf(int(value.p)) / int(value.q)


@pytest.mark.parametrize("name", ["equal", "dimer", "three"])
def test_residual_of_newtons_equations_falls_as_the_order_promises(name):
    """γ c_i r_i'' = (f_{i+1} - f_i)/(P μ_{i+1}) - (f_i - f_{i-1})/(P μ_i), with 50 digits."""
    cell, order, residuals = CELLS[name], 3, []
    expansion, P = wave(name), cell.size
    fields = Recursion(shares_model(cell, sp.S.One), order + 1)
    assert expansion.c2.prefactor == P / (cell.mass * expansion.compliance)
    with mpmath.workdps(50):
        mu = [exact(m / cell.mass) for m in cell.masses]
        I = exact(Observables(fields).I)
        gamma = [exact(a) for a in expansion.c2.coefficients[: order + 1]]
        for small in (mpmath.mpf(1) / n for n in (400, 800, 1600)):
            c2 = mpmath.polyval(gamma[::-1], small)
            logs = (pulse.log[: 2 * order + 1] for pulse in fields.force)
            strains = [contact(log, I, small) for log in logs]
            worst = mpmath.mpf(0)
            for at in (-1.5, -0.3, 0.4, 1.1):
                xi = mpmath.mpf(at) / mpmath.sqrt(small)
                force = {  # of contact i, next cells included
                    i: strains[i % P](xi + i // P * P) ** (1 + small)
                    for i in range(-1, P + 1)
                }
                for i in range(P):
                    ahead = (force[i + 1] - force[i]) / (P * mu[(i + 1) % P])
                    behind = (force[i] - force[i - 1]) / (P * mu[i])
                    left = c2 * mpmath.diff(strains[i], xi, 2)
                    worst = max(worst, abs(left - ahead + behind))
            residuals.append(worst)
        slopes = [mpmath.log(a / b, 2) for a, b in pairwise(residuals)]
    # What is missing is ε^{order+1/2} of the wave, and beads of unlike mass feel it at once; where
    # the wave is even it is ε^{order+1}, in terms of the size ε. Next orders shift slopes by O(ε).
    expected = order + (2 if name == "equal" else 0.5)
    assert slopes == pytest.approx([expected] * 2, abs=0.05)


@pytest.mark.parametrize("name", ["equal", "dimer"])
def test_the_long_wave_has_the_lattice_s_momentum_as_k_tends_to_1(name):
    """The error of the canonical wave falls as k - 1."""
    errors = []
    cell = Cell(CELLS[name].masses, spacing=1)
    for k in ("1.004", "1.002"):
        long_wave = canonical_wave(cell, k).at_force(1)
        ours = expand(cell, 16, k=k).momentum.at()
        errors.append(float(long_wave.momentum) / ours.value - 1)
    assert abs(errors[0]) < 0.004
    assert errors[1] == pytest.approx(
        errors[0] / 2, rel=0.02
    )  # the next order in k - 1


@pytest.mark.parametrize("size", [2, 3])
def test_equal_beads_in_any_cell_are_the_uniform_chain(size):
    many = series(expand(Cell([1] * size), 4))
    for name, row in series(wave("equal")).items():
        assert many[name].coefficients == row.coefficients
        assert same(many[name].prefactor, row.prefactor)


def test_three_unlike_contacts_in_numbers_have_the_decimals_of_their_exact_series():
    cell = Cell([1, 2, 1], [1, 2, "3e-9"])
    exact = Observables(Recursion(shares_model(cell, sp.Rational(3, 2)), 1))
    _, true = exact.coefficients("force", 1)
    _, found = expand(cell, 1, k="3/2").fwhm("force", 1).coefficients
    assert found.is_Float
    assert abs(found / true.n(40) - 1) < 1e-28


def test_first_correction_of_a_dimer_is_a_closed_form():
    w_1 = expand(Dimer(1, OMEGA), 1).fwhm("force").coefficients[1]
    top = (6 - sp.log(2)) * (OMEGA**4 + 34 * OMEGA**3 - 69 * OMEGA**2 + 34 * OMEGA + 1)
    assert same(w_1, top / (60 * (OMEGA**2 - OMEGA + 1) ** 2))
