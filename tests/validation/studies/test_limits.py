"""The limits: laws by the series in k - 1, runs against each other, and wrong theories refused."""

import json

import pytest
import sympy as sp

from lwa import Cell, Estimate, expand
from validation.studies.limits import (
    EQUAL,
    EXPONENTS,
    LEADING_POWERS,
    LIGHT,
    PLACES,
    QUANTITIES,
    SPEED,
    SUPPORT,
    compared,
    lattice_wave,
    limits,
    theory_at,
)
from validation.waves.solver import exact_wave

eps, X = sp.symbols("epsilon X", positive=True)


@pytest.fixture(scope="module")
def report():
    return limits()


@pytest.fixture(scope="module")
def rows(report):
    """Pairs of the theory's and the lattice's number, by quantity, k and ω."""
    (table,) = report.tables
    names = [column.key or column.label for column in table.columns]
    found = {}
    for cells in table.rows:
        row = dict(zip(names, cells, strict=True))
        pair = row["theory"], row["lattice"]
        found[row["quantity"], row["k"], row["omega"]] = pair
    return found


def law(quantity):
    """Order and coefficient in ε of theory/lattice - 1, by the series of `lwa.expand`."""
    k, series = 1 + eps, expand(Cell([1]), 2)
    if quantity == SPEED:
        terms = [c * eps**n for n, c in enumerate(series.c2.coefficients)]
        c2 = sum(terms)  # at strain 1
        error = sp.series(sp.sqrt(2 / (k + 1) / c2), eps, 0, 3).removeO() - 1
        coefficient, power = sp.expand(error).as_coeff_exponent(eps)
        return power, coefficient
    # log of the theory's strain, 2/ε log cos(βx), with β = ε √(6/(k(k+1))) for D = 1
    angle = eps * sp.sqrt(6 / (k * (k + 1))) * X / sp.sqrt(eps)
    theory = 2 / eps * (-(angle**2) / 2 - angle**4 / 12)
    theory = sp.series(sp.expand(theory), eps, 0, 2).removeO()
    # log of the lattice's strain, -3X² + ε (18/5 X² - 3/10 X⁴) + …: 3X² = log 2 + ε first there
    first = sp.Rational(18, 5) * X**2 - sp.Rational(3, 10) * X**4
    widened = first.subs(X, sp.sqrt(sp.log(2) / 3)) / (2 * sp.log(2))
    assert sp.expand(series.fwhm("strain").coefficients[1] - widened) == 0
    difference = sp.expand(theory.coeff(eps, 1) - first)
    assert sp.expand(theory.coeff(eps, 0) + 3 * X**2) == 0
    if quantity == SUPPORT:
        # mean over the Gaussian e^{-3X²}: ⟨X²⟩ = 1/6, ⟨X⁴⟩ = 1/12
        return 1, difference.coeff(X, 2) / 6 + difference.coeff(X, 4) / 12
    # at half maximum, 3X² = log 2: a shift ε d of the log moves X by ε d/(6X)
    at_half = difference / (6 * X**2)
    return 1, sp.expand(at_half.subs(X, sp.sqrt(sp.log(2) / 3)))


@pytest.mark.parametrize("quantity", QUANTITIES)
def test_the_laws_follow_from_the_series(quantity):
    order, coefficient = law(quantity)
    assert LEADING_POWERS[quantity].order == order
    assert sp.simplify(LEADING_POWERS[quantity].coefficient - coefficient) == 0


def test_all_hold(report):
    document = json.loads(json.dumps(report.document(), allow_nan=False))
    assert document["ok"] is report.ok is True
    assert len(document["rows"]) == len(document["findings"]) == 40
    for row in document["rows"]:
        assert row["error_value"] == row["theory_value"] / row["lattice_value"] - 1
        assert abs(row["error_value"]) <= row["bound_value"]
    assert report.text().count("  ok") == 40


def test_the_errors_cover_the_exact_waves_of_equal_beads(rows):
    """At k = 3/2 the integrator's error is left, which a ± of rtol/100 covers."""
    shares = []
    for k in EXPONENTS:
        wave = exact_wave([1], float(k))
        true = wave.fwhm("force"), wave.fwhm("strain"), wave.c / float(k) ** 0.5
        for quantity, value in zip((*QUANTITIES[:2], SPEED), true, strict=True):
            _, number = rows[quantity, k, EQUAL]
            shares.append(number.error / abs(number.value - value))
    assert min(shares) >= 1
    assert sum(share < 30 for share in shares) >= 8


@pytest.mark.slow
@pytest.mark.parametrize("omega", [EQUAL, LIGHT])
@pytest.mark.parametrize("k", EXPONENTS)
def test_the_errors_cover_three_times_the_way(rows, k, omega):
    """All four quantities, with light beads too."""
    farther = lattice_wave(theory_at(k, omega), [3 * place for place in PLACES])
    for quantity, far in farther.items():
        _, number = rows[quantity, k, omega]
        off = abs(number.value - far.value)
        assert off <= number.error < max(40 * off, 3e-11 * number.value)


@pytest.mark.parametrize("quantity", QUANTITIES)
@pytest.mark.parametrize(
    ("omega", "wrong"),
    [(EQUAL, 0.9995), (EQUAL, 1.0005), (LIGHT, 0.998), (LIGHT, 1.002)],
)
def test_a_theory_off_by_half_a_permille_is_refused(rows, quantity, omega, wrong):
    """At ω = 1/1000 by 2 ‰: the law there holds to O(ω). An error of a tenth fails every row."""

    def hold(theory, lattice):
        return [row["ok"] for row in compared(quantity, omega, theory, lattice)]

    pairs = [rows[quantity, k, omega] for k in EXPONENTS]
    theory, lattice = zip(*pairs, strict=True)
    assert all(hold(theory, lattice))
    of_wrong = hold([value * sp.Rational(str(wrong)) for value in theory], lattice)
    assert not of_wrong[-1]  # the limit k → 1
    rough = [Estimate(number.value, 0.1 * number.value) for number in lattice]
    assert not any(hold(theory, rough)[: len(EXPONENTS)])


@pytest.mark.parametrize("quantity", QUANTITIES)
@pytest.mark.parametrize("factor", [0.75, 1.3])
def test_an_order_that_is_off_by_a_third_is_refused(quantity, factor):
    """By exact numbers, whose error is a pure power of k - 1."""
    power = LEADING_POWERS[quantity]
    lattice = [Estimate(1.0, 0.0)] * len(EXPONENTS)

    def order_holds(order):
        theory = [1 + power.coefficient * (k - 1) ** order for k in EXPONENTS]
        *_, fitted, _ = compared(quantity, EQUAL, theory, lattice)
        return fitted["ok"]

    assert order_holds(power.order)
    assert not order_holds(power.order * sp.Rational(str(factor)))
