"""The limit k → 1: laws by the series in k - 1, finer waves, and wrong theories refused."""

import json

import pytest
import sympy as sp

from lwa import Cell, Estimate, expand
from validation.studies.limits import (
    EXPONENTS,
    LEADING_POWERS,
    QUANTITIES,
    SPEED,
    compared,
    lattice_numbers,
    limits,
    theory_numbers,
)

eps, X = sp.symbols("epsilon X", positive=True)


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
    # at half maximum, 3X² = log 2: a shift ε d of the log moves X by ε d/(6X)
    at_half = difference / (6 * X**2)
    return 1, sp.expand(at_half.subs(X, sp.sqrt(sp.log(2) / 3)))


@pytest.mark.parametrize("quantity", QUANTITIES)
def test_the_laws_follow_from_the_series(quantity):
    order, coefficient = law(quantity)
    assert LEADING_POWERS[quantity].order == order
    assert sp.simplify(LEADING_POWERS[quantity].coefficient - coefficient) == 0


def test_all_hold():
    document = json.loads(json.dumps(limits().document(), allow_nan=False))
    assert document["ok"] is True
    assert len(document["rows"]) == len(document["findings"]) == 5 * len(QUANTITIES)
    for row in document["rows"]:
        assert row["error_value"] == row["theory_value"] / row["lattice_value"] - 1
        assert abs(row["error_value"]) <= row["bound_value"]


@pytest.fixture(scope="module", params=QUANTITIES)
def numbers(request):
    """A quantity, and its values by the theory and on the lattice at all exponents."""
    theory = [theory_numbers(k)[request.param] for k in EXPONENTS]
    return request.param, theory, [lattice_numbers(k)[request.param] for k in EXPONENTS]


def hold(quantity, theory, lattice):
    return [row["ok"] for row in compared(quantity, theory, lattice)]


@pytest.mark.parametrize("wrong", ["0.9995", "1.0005"])
def test_a_theory_off_by_half_a_permille_is_refused(numbers, wrong):
    """By the limit k → 1. An error of a tenth fails every row."""
    quantity, theory, lattice = numbers
    assert all(hold(*numbers))
    of_wrong = [value * sp.Rational(wrong) for value in theory]
    assert not hold(quantity, of_wrong, lattice)[-1]
    rough = [Estimate(number.value, 0.1 * number.value) for number in lattice]
    assert not any(hold(quantity, theory, rough)[: len(EXPONENTS)])


def test_bounds_are_as_tight_as_the_numbers_allow(numbers):
    """At most twice the errors; a coefficient's bound is that of the test before."""
    *rows, order, _ = compared(*numbers)
    used = [abs(row["error_value"]) / row["bound_value"] for row in (*rows, order)]
    assert max(used[:-1]) > 1 / 2
    assert used[-1] > 1 / 2


@pytest.mark.parametrize("quantity", QUANTITIES)
@pytest.mark.parametrize("factor", ["0.75", "1.3"])
def test_an_order_that_is_off_by_a_third_is_refused(quantity, factor):
    """By exact numbers, whose error is a pure power of k - 1."""
    power = LEADING_POWERS[quantity]
    lattice = [Estimate(1.0, 0.0)] * len(EXPONENTS)

    def order_holds(order):
        theory = [1 + power.coefficient * (k - 1) ** order for k in EXPONENTS]
        return hold(quantity, theory, lattice)[-2]

    assert order_holds(power.order)
    assert not order_holds(power.order * sp.Rational(factor))
