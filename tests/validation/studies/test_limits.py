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
    QUANTITIES,
    limits,
    quantity_rows,
)
from validation.waves.solver import exact_wave

eps, X = sp.symbols("epsilon X", positive=True)


@pytest.fixture(scope="module")
def report():
    return limits()


@pytest.fixture(scope="module")
def found(report):
    """The theory's and the lattice's number, by quantity, k and ω."""
    return {(row[0], row[3], row[4]): (row[5], row[7]) for row in report.tables[0].rows}


def law(quantity):
    """Order and coefficient in ε of theory/lattice - 1, by the series of `lwa.expand`."""
    k, series = 1 + eps, expand(Cell([1]), 2)
    if quantity.startswith("speed"):
        c2 = sum(
            c * eps**n for n, c in enumerate(series.c2.coefficients)
        )  # at strain 1
        error = sp.series(sp.sqrt(2 / (k + 1) / c2), eps, 0, 3).removeO() - 1
        (coefficient, power) = sp.expand(error).as_coeff_exponent(eps)
        return power, coefficient
    # log of the theory's strain, 2/ε log cos(βx), with β = ε √(6/(k(k+1))) for D = 1
    angle = eps * sp.sqrt(6 / (k * (k + 1))) * X / sp.sqrt(eps)
    theory = 2 / eps * (-(angle**2) / 2 - angle**4 / 12)
    theory = sp.series(sp.expand(theory), eps, 0, 2).removeO()
    force = series.log_force(X=X)  # k times the log of the strain
    difference = sp.expand(theory.coeff(eps, 1) - (force[1] - force[0]))
    assert sp.expand(theory.coeff(eps, 0) - force[0]) == 0
    if quantity.startswith("support"):
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
    assert max(map(len, report.text().splitlines())) <= 100


def test_the_errors_cover_the_exact_waves_of_equal_beads(found):
    """The error is what the pulse has yet to shed; it is not thirty times too large."""
    shares = []
    for k in EXPONENTS:
        wave = exact_wave([1], float(k))
        true = wave.fwhm("force"), wave.fwhm("strain"), wave.c / float(k) ** 0.5
        for quantity, value in zip((*QUANTITIES[:2], QUANTITIES[3]), true, strict=True):
            _, number = found[quantity, k, EQUAL]
            shares.append(abs(number.value - value) / number.error)
            assert k != EXPONENTS[0] or number.error < 1e-6
    assert 1 / 30 < max(shares) <= 1


@pytest.mark.parametrize("quantity", QUANTITIES)
@pytest.mark.parametrize(
    ("omega", "wrong"),
    [(EQUAL, 0.9995), (EQUAL, 1.0005), (LIGHT, 0.998), (LIGHT, 1.002)],
)
def test_a_theory_off_by_half_a_permille_is_refused(found, quantity, omega, wrong):
    """At ω = 1/1000 by 2 ‰: the law there holds to O(ω). An error of a tenth fails every row."""

    def hold(theory, lattice):
        return [
            finding.ok for _, finding in quantity_rows(quantity, omega, theory, lattice)
        ]

    theory, lattice = map(
        list, zip(*(found[quantity, k, omega] for k in EXPONENTS), strict=True)
    )
    assert all(hold(theory, lattice))
    assert not all(hold([value * sp.Rational(str(wrong)) for value in theory], lattice))
    rough = [Estimate(number.value, 0.1 * number.value) for number in lattice]
    assert not any(hold(theory, rough)[: len(EXPONENTS)])
