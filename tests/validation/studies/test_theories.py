"""Theories against true waves: slopes in ε, and error estimates that bound the errors."""

from __future__ import annotations

import csv
import io
from functools import cache
from itertools import pairwise

import numpy as np
import pytest
import sympy as sp

from lwa import Cell, Expansion, expand
from validation.pulses.pulse import MeasureError
from validation.pulses.steady import STRETCH, point
from validation.studies.theories import (
    HERTZ,
    QUANTITIES,
    STRUCK_CHAIN,
    THEORIES,
    Place,
    ladder,
    place,
)
from validation.waves.profile import ExactWave
from validation.waves.solution import solve
from validation.waves.solver import exact_wave


@cache
def true(k: str, omega: str) -> ExactWave:
    if omega == "1":
        return exact_wave([1], float(sp.Rational(k)))
    return solve((1.0, float(sp.Rational(omega))), float(sp.Rational(k)))


@cache
def series(omega: str, order: int) -> Expansion:
    return expand(Cell([1]) if omega == "1" else Cell([1, omega]), order)


def values(wave: ExactWave) -> dict[str, float]:
    return {
        "c2": wave.c2,
        **{name: wave.fwhm(name) for name in ("strain", "force", "velocity")},
    }


@pytest.mark.parametrize("omega", ["1", "1/20"])
@pytest.mark.parametrize("order", [1, 3])
def test_error_of_n_terms_falls_as_the_next_power(omega: str, order: int) -> None:
    """Fitted from k = 1.04 to 1.08, where radiation is below 1e-9; ε of the next order bends it."""
    exponents = ("26/25", "53/50", "27/25")
    if omega == "1/20":
        exponents = ("26/25", "21/20", "53/50")
    errors = {name: [] for name in ("c2", "strain", "force", "velocity")}
    for k in exponents:
        exact = values(true(k, omega))
        expansion = series(omega, order)
        for name, row in errors.items():
            cut = expansion.c2 if name == "c2" else expansion.fwhm(name)
            row.append(abs(float(cut.pade(sp.Rational(k), order, 0)) / exact[name] - 1))
    logs = [float(sp.log(sp.Rational(k) - 1)) for k in exponents]
    for name, row in errors.items():
        slopes = [
            (np.log(b) - np.log(a)) / (y - x)
            for (a, b), (x, y) in zip(pairwise(row), pairwise(logs), strict=True)
        ]
        assert np.allclose(slopes, order + 1, atol=0.35), (name, slopes)


def profile(cell: Cell, order: int, k: sp.Rational):
    """The force exp Σ ε^n φ_n(√ε ξ) as a function of ξ."""
    orders, epsilon, xi = expand(cell, order, k=k).log_force(), k - 1, sp.Symbol("xi")
    log = sum(epsilon**n * phi for n, phi in orders.items())
    return sp.lambdify(xi, sp.exp(log).subs(sp.Symbol("X"), sp.sqrt(epsilon) * xi))


def test_the_profile_is_the_exact_waves() -> None:
    """The error at k = 1.05 of a logarithm to ε^4 is of the order of ε^5."""
    k, wave = sp.Rational(21, 20), true("21/20", "1")
    force = profile(Cell([1]), 4, k)
    xi = np.linspace(-6, 6, 25)
    assert np.abs(force(xi) - wave.force(xi)).max() < 2 * 0.05**5
    dimer, b = true("21/20", "1/20"), sp.Rational(1, 20)
    top, _ = dimer.peak("force")
    force = profile(Cell([1, b]), 5, k)
    assert np.abs(force(xi) - dimer.force(top + xi)).max() < 0.05**5


@pytest.mark.parametrize("k", ["11/10", "3/2", "3"])
def test_estimates_bound_the_errors_of_the_equal_chain(k: str) -> None:
    exact = values(true(k, "1"))
    expansion = series("1", 10)
    for name, value in exact.items():
        found = (expansion.c2 if name == "c2" else expansion.fwhm(name)).at(k)
        # The exact waves are good to some 1e-14.
        assert abs(found.value - value) <= found.error + 3e-14 * value, name


def test_the_equal_chain_reaches_hertz() -> None:
    """1e-6 at k = 3/2 and 1e-4 at k = 2, from order 10."""
    expansion = series("1", 10)
    for k, bound in (("3/2", 1e-6), ("2", 1e-4)):
        exact = values(true(k, "1"))
        for name, value in exact.items():
            found = (expansion.c2 if name == "c2" else expansion.fwhm(name)).at(k)
            assert abs(found.value / value - 1) < bound, (k, name)


@pytest.mark.parametrize(
    ("k", "omega"),
    [
        ("21/20", "1/20"),
        pytest.param("11/10", "1/5", marks=pytest.mark.slow),
    ],
)
def test_estimates_bound_the_errors_of_dimers(k: str, omega: str) -> None:
    """Also where radiation makes the wave a nanopteron, whose numbers vary by its tail."""
    wave = true(k, omega)
    expansion = series(omega, 8)
    for name, value in values(wave).items():
        found = (expansion.c2 if name == "c2" else expansion.fwhm(name)).at(k)
        assert abs(found.value - value) <= found.error + 3 * wave.tail * value, name


@pytest.mark.parametrize(("omega", "bound"), [("1/100", 1e-3), ("4/5", 1e-2)])
def test_hertz_dimer_to_a_percent_against_struck_chains(omega: str, bound: float) -> None:
    numbers = point(HERTZ, sp.Rational(omega), STRETCH).numbers
    expansion = series(omega, 8)
    for name, row in (("width", expansion.fwhm("force")), ("speed", expansion.c)):
        found, truth = row.at(HERTZ), numbers[name]
        assert abs(found.value / truth.value - 1) < bound
        assert abs(found.value - truth.value) <= found.error + truth.error
        assert found.asymptotic


def test_between_resonances_the_series_claims_no_digit() -> None:
    """ω = 0.55: no solitary wave is near, and the true decay per site is measurable."""
    found = series("11/20", 8).fwhm("force").at(HERTZ)
    assert found.asymptotic
    assert found.error > 0.2 * found.value


@cache
def equal() -> Place:
    """Equal beads at k = 1.1."""
    return place(sp.Rational(11, 10), sp.S.One)


def test_ladder_in_all_forms() -> None:
    at = equal()
    errors = {theory: abs(row["force"]) for theory, row in at.errors.items()}
    # For equal beads all closures are one theory; each order of the series is better.
    assert errors["linear closure"] == pytest.approx(errors["full closure"], rel=1e-9)
    rising = [errors[name] for name in THEORIES if name.startswith("ε")]
    assert rising == sorted(rising, reverse=True)
    assert errors["canonical field"] > rising[0]
    assert all(row["seconds"] >= 0 for row in at.rows)
    report = ladder([at])
    printed = report.text()
    assert "linear closure" in printed
    assert printed.count("theory over truth - 1") == len(QUANTITIES)
    assert "(ms of CPU): linear closure " in printed
    (document,) = report.document()["theories"]
    assert (document["k"], document["omega"], document["truth"]) == ("11/10", "1", at.kind)
    assert [row["theory"] for row in document["rows"]] == list(THEORIES)
    lines = list(csv.DictReader(io.StringIO(report.csv())))
    for line, name in zip(lines, QUANTITIES, strict=True):
        assert line["quantity"] == name
        assert float(line["truth_value"]) == document["truth_value"][name] == at.truth[name].value
        assert document["truth_error_value"][name] == at.truth[name].error
        for row in document["rows"]:
            assert float(line[f"error_value.{row['theory']}"]) == row["error_value"][name]
            assert row["theory"].startswith("ε") is (row["estimate_value"] is not None)
            if row["estimate_value"]:  # an estimate bounds the error
                assert abs(row["error_value"][name]) <= row["estimate_value"][name] + 1e-13
    page = report._repr_html_()
    assert page.count("<tr>") == 2 * len(QUANTITIES)
    assert "<svg" in page


def test_a_sum_that_is_refused_is_missing() -> None:
    """One order has no sum at k = 3; the other theories are still compared."""
    at = place(sp.S(3), sp.S.One)
    assert "ε^1" not in at.errors
    (reason,) = (row["missing"] for row in at.rows if row["theory"] == "ε^1")
    assert reason.startswith("no sum at k = 3: to ε^1")


def test_theories_without_a_wave_are_left_out() -> None:
    """The approximants are those of equal beads; no error is claimed for others."""
    at = place(HERTZ, sp.Rational("0.0901277691"))
    assert "[1/1]" not in at.errors
    assert "[1/1] " not in ladder([at]).text().splitlines()[-1]
    report = ladder([at, equal()])
    (row,) = [row for row in report.document()["theories"][0]["rows"] if row["theory"] == "[1/1]"]
    assert (row["error_value"], row["missing"]) == (None, "a formula for equal beads")
    beads, dimers = report.panels
    assert {curve.label for curve in beads.curves} == set(THEORIES)
    assert {c.label: c.style for c in dimers.curves}.items() <= {
        c.label: c.style for c in beads.curves
    }.items()
    assert "[1/1]" not in {curve.label for curve in dimers.curves}


def test_a_pulse_that_is_not_steady_is_no_truth() -> None:
    """ω = 0.55 at k = 3/2: a later pulse overtakes the leading one."""
    with pytest.raises(MeasureError, match=r"^not steady: "):
        place(HERTZ, sp.Rational(11, 20), STRUCK_CHAIN)
