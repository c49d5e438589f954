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
from lwa.expansion.series import radiated
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


def contact(fields, I, i, order, epsilon):
    """Strain of contact i, over its share, as a function of ξ: the series cut after ε^order."""
    log = fields.force[i].log[: 2 * order + 1]

    def strain(xi):
        Z, t = mpmath.sqrt(epsilon / I) * xi, mpmath.sqrt(epsilon / I**3)
        total = -(Z**2) / 4
        for n, polynomial in enumerate(log):
            for (d,), c in polynomial.terms():
                total += mpmath.mpf(int(c.p)) / int(c.q) * Z ** int(d) * t**n
        return mpmath.exp(total / (1 + epsilon))

    return strain


@pytest.mark.parametrize("name", ["equal", "dimer", "three"])
def test_residual_of_newtons_equations_falls_as_the_order_promises(name):
    """γ c_i r_i'' = (f_{i+1} - f_i)/(P μ_{i+1}) - (f_i - f_{i-1})/(P μ_i), with 50 digits."""
    cell, order, residuals = CELLS[name], 3, []
    expansion, P = wave(name), cell.size
    fields = Recursion(shares_model(cell, sp.S.One), order + 1)
    assert expansion.c2.prefactor == P / (cell.mass * expansion.compliance)
    for epsilon in (sp.Rational(1, n) for n in (400, 800, 1600)):
        coefficients = enumerate(expansion.c2.coefficients[: order + 1])
        c2 = sp.N(sum(a * epsilon**n for n, a in coefficients), 50)
        with mpmath.workdps(50):
            c2, small = mpmath.mpmathify(c2), mpmath.mpf(1) / epsilon.q
            mu = [mpmath.mpmathify(sp.N(m / cell.mass, 50)) for m in cell.masses]
            I = mpmath.mpmathify(Observables(fields).I)
            strains = [contact(fields, I, i, order, small) for i in range(P)]
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
    assert all(abs(s - expected) < 0.05 for s in slopes), slopes


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


def test_first_correction_of_a_dimer_is_a_closed_form():
    w_1 = expand(Dimer(1, OMEGA), 1).fwhm("force").coefficients[1]
    top = (6 - sp.log(2)) * (OMEGA**4 + 34 * OMEGA**3 - 69 * OMEGA**2 + 34 * OMEGA + 1)
    assert same(w_1, top / (60 * (OMEGA**2 - OMEGA + 1) ** 2))
    uniform = wave("equal").fwhm("force").coefficients[1]
    assert same(w_1.subs(OMEGA, 1), uniform)
    assert same(w_1.subs(OMEGA, 1 / OMEGA), w_1)


def test_unlike_contacts_have_unlike_widths():
    """The widths of both contacts of a struck chain, contacts 1 and 6/25 at k = 11/10."""
    wave = expand(Cell([1, 1], [1, "6/25"]), 8, k="11/10")
    for contact, width in enumerate((5.035, 4.549)):
        found = wave.fwhm("force", contact).at()
        assert abs(found.value - width) <= found.error < (5.035 - 4.549) / 10


def test_radiation_vanishes_for_equal_beads_and_near_k_of_1():
    contrasts = [
        radiated(Dimer(1, omega), sp.Rational(6, 5)) for omega in ("1/2", "9/10", 1)
    ]
    assert contrasts == sorted(contrasts, reverse=True)
    assert contrasts[-1] == 0
    losses = [radiated(CELLS["three"], 1 + sp.Rational(1, n)) for n in (2, 8, 32)]
    assert losses[0] > 2 * losses[1] > 6 * losses[2] > 0
