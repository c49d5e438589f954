"""The expansion in ε = k - 1: the lattice's equations, identities, the theory it continues."""

from __future__ import annotations

from functools import cache
from itertools import pairwise

import mpmath
import numpy as np
import pytest
import sympy as sp
from flint import fmpq

from lwa import Cell, Dimer, Dispersion, InputError, homogenize
from lwa.base.quantities import QUANTITIES
from lwa.cell import k as symbol_k
from lwa.expansion.expand import Expansion, expand
from lwa.expansion.observables import Observables, shares_model
from lwa.expansion.pulse import exp_term, logarithm, power, product
from lwa.expansion.radiation import amplitude, parameters, radiated
from lwa.law import DELTA, Law, Power, general, named
from tests.identity import same

HALF = sp.Rational(1, 2)
OMEGA = sp.Symbol("omega", positive=True)

CELLS = {
    "equal": Cell([1]),
    "dimer": Cell([1, HALF / 2]),
    "contacts": Cell([1, 1], [1, 8]),
    "three": Cell([1, 2, 5]),
}


@cache
def wave(name: str, order: int = 4) -> Expansion:
    return expand(CELLS[name], order, k=3 if name == "contacts" else "k")


def contact(cell: Cell, expansion: Expansion, i: int, order: int, k: mpmath.mpf):
    """Strain of contact i, over its share, as a function of ξ: the series cut after ε^order."""
    X = sp.Symbol("X")
    parts = [
        (n, [mpmath.mpf(c.p) / c.q for c in sp.Poly(p, X).all_coeffs()])
        for n, p in expansion.log_force(i).items()
        if n <= order
    ]
    epsilon = k - 1

    def strain(xi: mpmath.mpf) -> mpmath.mpf:
        at = mpmath.sqrt(epsilon) * xi
        log = sum(
            epsilon ** (mpmath.mpf(n.p) / n.q) * mpmath.polyval(coeffs, at) for n, coeffs in parts
        )
        return mpmath.exp(log / k)

    return strain


@pytest.mark.parametrize("name", ["equal", "dimer", "three"])
def test_residual_of_newtons_equations_falls_as_the_order_promises(name: str) -> None:
    """γ c_i r_i'' = (f_{i+1} - f_i)/(P μ_{i+1}) - (f_i - f_{i-1})/(P μ_i), with 50 digits."""
    cell, order = CELLS[name], 3
    expansion, P = wave(name), cell.size
    mu = [mpmath.mpf(m.p) / m.q / (mpmath.mpf(cell.mass.p) / cell.mass.q) for m in cell.masses]
    residuals = []
    steps = [mpmath.mpf(1) / n for n in (400, 800, 1600)]
    with mpmath.workdps(50):
        for epsilon in steps:
            k = 1 + epsilon
            strains = [contact(cell, expansion, i, order, k) for i in range(P)]
            unit = expansion.c2.prefactor
            c2 = sum(
                mpmath.mpf(a.p) / a.q * epsilon**n
                for n, a in enumerate(expansion.c2.coefficients[: order + 1])
            )
            assert unit == P / (cell.mass * expansion.compliance)
            worst = mpmath.mpf(0)
            for at in (-1.5, -0.3, 0.4, 1.1):
                xi = mpmath.mpf(at) / mpmath.sqrt(epsilon)

                force = {  # of contact i, next cells included
                    i: strains[i % P](xi + i // P * P) ** k for i in range(-1, P + 1)
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


@pytest.mark.parametrize("name", CELLS)
def test_virial_theorem(name: str) -> None:
    """(k + 3) T = (k + 1) E. Of a family of waves scaled in amplitude dE = c dP holds for the
    canonical momentum P = 2 T / c, and E ∝ F^{(k+1)/k}, c ∝ F^{(k-1)/2k}."""
    expansion = wave(name)
    T, E = expansion.kinetic.coefficients, expansion.energy.coefficients
    ratio = expansion.kinetic.prefactor / expansion.energy.prefactor
    assert same(ratio, 1)
    for n in range(len(E)):  # (4 + ε) T = (2 + ε) E
        left = 4 * T[n] + (T[n - 1] if n else 0)
        right = 2 * E[n] + (E[n - 1] if n else 0)
        assert same(left, right)


@pytest.mark.parametrize("size", [2, 3])
def test_equal_beads_in_any_cell_are_the_uniform_chain(size: int) -> None:
    one, many = wave("equal"), expand(Cell([1] * size), 4)
    assert many.c2.coefficients == one.c2.coefficients
    for quantity in QUANTITIES:
        assert many.fwhm(quantity).coefficients == one.fwhm(quantity).coefficients
    assert same(many.energy.prefactor, one.energy.prefactor)
    assert many.energy.coefficients == one.energy.coefficients


def test_first_correction_of_a_dimer_is_a_closed_form() -> None:
    """w_1(ω); at ω = 1 and ω → 0 both are those of chains of equal beads."""
    w_1 = expand(Dimer(1, OMEGA), 1).fwhm("force").coefficients[1]
    form = (
        (6 - sp.log(2))
        * (OMEGA**4 + 34 * OMEGA**3 - 69 * OMEGA**2 + 34 * OMEGA + 1)
        / (60 * (OMEGA**2 - OMEGA + 1) ** 2)
    )
    assert same(w_1, form)
    uniform = wave("equal").fwhm("force").coefficients[1]
    assert same(w_1.subs(OMEGA, 1), uniform)
    assert same(w_1.subs(OMEGA, 1 / OMEGA), w_1)


def jets(series: list, top: int, derivative) -> dict[int, list]:
    """i → ∂^{i-1} s / s as a list over t^n, s = e^{-Z²/4} Σ S_n t^n."""
    inverse, found, row = power(series, fmpq(-1)), {}, series
    for i in range(2, top + 1):
        row = [0 * series[0], *(derivative(S) for S in row[:-1])]
        found[i] = product(row, inverse)
    return found


def power_of_slope(wave, log: list, share: fmpq) -> list:
    """s^{share (k-1)} as a series in t; log s = -Z²/4 + Σ log_n t^n, k - 1 = I³ t²."""
    whole = [log[0] - wave.Z**2 / 4, *log[1:]]
    exponent = [wave.zero, wave.zero, *(wave.epsilon * share * term for term in whole[:-2])]
    result: list = []
    for _ in exponent:
        result.append(exp_term(exponent, result))
    return result


def residual_order(cell: Cell, closure: str, terms: int) -> int:
    """The first power of t that the expansion leaves of the PDE cut after D^{k+2 terms+1}."""
    order = 2 * terms + 1
    theory = homogenize(cell, order + 1, closure=closure)
    wave = Observables(shares_model(cell, symbol_k), terms + 2).wave
    size = order + 3
    slope = [*wave.fields.slope[0]][:size]
    log = logarithm(slope)
    jet = jets(slope, order + 2, wave.derivative)
    gamma = wave.gamma[:size]
    epsilon_powers = [wave.epsilon**n for n in range(size)]

    def in_k(coefficient: sp.Expr) -> list:
        """A polynomial in k as a series in t."""
        k = next(iter(coefficient.free_symbols), sp.Symbol("k"))
        rows = [wave.zero] * size
        for (n,), c in sp.Poly(coefficient.subs(k, 1 + k), k).terms():
            if 2 * n < size:
                rows[2 * n] = rows[2 * n] + epsilon_powers[n] * int(c.p) / int(c.q)
        return rows

    minus_half = power_of_slope(wave, log, fmpq(-1, 2))
    lean = product(minus_half, minus_half)  # s^{1-k}
    kinetic = product(product(gamma, lean), jet[2])  # k V² u'' / u_x^k
    total = [wave.zero] * size
    for coefficients in [{(): sp.S.One}, *theory.pde.coefficients.values()]:
        for key, coefficient in coefficients.items():
            x, t = (((2, 1),), ()) if key == () else (key.x, key.t)
            part = in_k(coefficient)
            for i, e in x:
                for _ in range(e):
                    part = product(part, jet[i])
            times = sum(e for _, e in t)
            for i, e in t:  # ∂^i u_τ / u_x^{(k+1)/2} = -V jet_{i+1} s^{(1-k)/2}
                for _ in range(e):
                    part = product(part, product(jet[i + 1], minus_half))
            assert times % 2 == 0
            k_inverse = [
                (-wave.epsilon) ** (n // 2) if n % 2 == 0 else wave.zero for n in range(size)
            ]
            for _ in range(times // 2):  # V² = γ/k
                part = product(part, product(gamma, k_inverse))
            total = [a + b for a, b in zip(total, part, strict=True)]
    k = [1 + wave.zero, wave.zero, wave.epsilon, *[wave.zero] * (size - 3)]
    rest = [a - b for a, b in zip(kinetic, product(k, total), strict=True)]
    return next(n for n, r in enumerate(rest) if r)


@pytest.mark.parametrize("masses", [(1,), (1, 3)], ids=["equal", "dimer"])
@pytest.mark.parametrize("terms", [1, 3])
def test_full_closure_cut_after_each_order_gives_that_many_terms(
    masses: tuple[int, ...], terms: int
) -> None:
    """The equation's leading terms are t^3; the wave solves it up to t^{2 terms + 1}, not beyond.

    For a dimer an even power, t^{2 terms + 2}, may be the first that is left.
    """
    order = residual_order(Cell(masses), "full", terms)
    assert order == 2 * terms + 3 or (len(masses) == 2 and order == 2 * terms + 2)


def test_linear_closure_gives_the_leading_term_only() -> None:
    dimer = Cell([1, 3])
    assert residual_order(dimer, "linear", 1) >= 4
    assert residual_order(dimer, "linear", 3) < 6


def test_pade_agrees_with_its_series() -> None:
    """[L/M] reproduces the coefficients up to L + M."""
    series = wave("equal").c2
    epsilon = sp.Symbol("e")
    for L, M in ((1, 2), (2, 1), (0, 3)):
        k = sp.Symbol("k", positive=True)
        form = series.pade(k, L, M)
        form = form.subs(next(iter(form.free_symbols)), 1 + epsilon)
        again = sp.series(form, epsilon, 0, L + M + 1).removeO()
        assert [again.coeff(epsilon, n) for n in range(L + M + 1)] == list(
            series.coefficients[: L + M + 1]
        )


def test_radiation_falls_exponentially_and_vanishes_for_equal_beads() -> None:
    """log R is about linear in 1/ε while R is small: e^{-S/ε}."""
    assert radiated(Cell([1, 1]), sp.Rational(3, 2)) == 0
    cell = Dimer(1, sp.Rational(1, 20))
    for each in (cell, CELLS["three"]):  # the lowest optical frequency; 1/Π of a dimer
        lowest = Dispersion(each).bands.branches(0.0)[1]
        assert parameters(each, symbol_k).optical == pytest.approx(lowest**2, rel=1e-13)
    inverse = np.array([8, 7, 6, 5])
    logs = np.log([amplitude(cell, 1 + sp.Rational(1, n)) for n in inverse.tolist()])
    slopes = np.diff(logs) / np.diff(inverse)
    assert np.all(slopes < -1)
    assert np.ptp(slopes) < 0.6 * abs(slopes.mean())


def test_only_a_power_law_has_an_expansion():
    """ε = k - 1: another law's k is another at every strain."""
    for law in (named("hertz2"), general(), Law(sp.exp(DELTA) - 1, DELTA)):
        with pytest.raises(InputError, match="only a power law has a k"):
            expand(Cell([1]), 2, law=law)
    assert expand(Cell([1]), 2, law=Power(2)) == expand(Cell([1]), 2, k=2)
    with pytest.raises(InputError, match="one of them"):
        expand(Cell([1]), 2, k=3, law=Power(2))
