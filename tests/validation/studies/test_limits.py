"""The limit k → 1: laws by the series in k - 1, and wrong theories refused."""

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


@pytest.mark.parametrize("quantity", QUANTITIES)
def test_the_laws_follow_from_the_series(quantity):
    """Of `lwa.expand`, so near k = 1 that 20 digits are those of the leading power."""
    law = LEADING_POWERS[quantity]
    epsilon = sp.Rational(1, 10**20)
    wave = expand(Cell([1], spacing=1), 2)
    series = wave.c2
    if quantity != SPEED:
        series = wave.fwhm(quantity.removesuffix(" FWHM"))
    terms = [c * epsilon**n for n, c in enumerate(series.coefficients)]
    lattice = series.prefactor * epsilon**series.power * sum(terms)
    if quantity == SPEED:
        lattice = sp.sqrt(lattice)
    error = sp.N(theory_numbers(1 + epsilon)[quantity] / lattice - 1, 60)
    assert abs(error / epsilon**law.order - law.coefficient) < 1e-15


def test_all_hold():
    document = json.loads(json.dumps(limits().document(), allow_nan=False))
    assert document["ok"] is True
    assert len(document["rows"]) == len(document["findings"]) == 4 * len(QUANTITIES)
    for row in document["rows"]:
        assert row["error_value"] == row["theory_value"] / row["lattice_value"] - 1


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
    *rows, _ = compared(*numbers)
    used = [abs(row["error_value"]) / row["bound_value"] for row in rows]
    assert max(used) > 1 / 2


@pytest.mark.parametrize("quantity", QUANTITIES)
@pytest.mark.parametrize("factor", ["0.75", "1.3"])
def test_an_order_that_is_off_by_a_third_is_refused(quantity, factor):
    """By the limit, of exact numbers whose error is a pure power of k - 1."""
    power = LEADING_POWERS[quantity]
    lattice = [Estimate(1.0, 0.0)] * len(EXPONENTS)

    def order_holds(order):
        theory = [1 + power.coefficient * (k - 1) ** order for k in EXPONENTS]
        return hold(quantity, theory, lattice)[-1]

    assert order_holds(power.order)
    assert not order_holds(power.order * sp.Rational(factor))
