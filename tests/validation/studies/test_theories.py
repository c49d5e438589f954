"""Theories against true waves: slopes in ε, and error estimates that bound the errors."""

import csv
import io
from functools import cache
from itertools import pairwise

import numpy as np
import pytest
import sympy as sp

from lwa import Cell, expand
from validation.pulses.pulse import MeasureError
from validation.pulses.steady import STRETCH, point
from validation.studies.theories import HERTZ, QUANTITIES, STRUCK_CHAIN, THEORIES, ladder, place
from validation.waves.solution import solve
from validation.waves.solver import exact_wave
from validation.waves.theory import theory_at

WIDTHS = ("strain", "force", "velocity")


@cache
def true(k, omega):
    """The lattice's wave, with its c² and widths; a dimer's may have a tail."""
    k, omega = float(sp.Rational(k)), float(sp.Rational(omega))
    wave = exact_wave([1], k) if omega == 1 else solve((1.0, omega), k)
    return wave, {"c2": wave.c2} | {name: wave.fwhm(name) for name in WIDTHS}


@cache
def series(omega, order):
    expansion = expand(Cell([1]) if omega == "1" else Cell([1, omega]), order)
    return {"c2": expansion.c2} | {name: expansion.fwhm(name) for name in WIDTHS}


@pytest.mark.parametrize(
    ("omega", "order", "exponents"),
    [
        ("1", 1, ("26/25", "53/50", "27/25")),
        ("1/20", 1, ("26/25", "21/20", "53/50")),
        ("1/20", 3, ("26/25", "21/20", "53/50")),
    ],
)
def test_error_of_n_terms_falls_as_the_next_power(omega, order, exponents):
    """Near k = 1 radiation is below 1e-9; ε of the next order bends the slope."""
    epsilon = [float(sp.Rational(k) - 1) for k in exponents]
    for name, row in series(omega, order).items():
        pairs = ((row.pade(sp.Rational(k), order, 0), true(k, omega)[1][name]) for k in exponents)
        errors = [abs(float(value) / exact - 1) for value, exact in pairs]
        slopes = np.diff(np.log(errors)) / np.diff(np.log(epsilon))
        assert slopes == pytest.approx([order + 1] * 2, abs=0.35), name


def test_the_profile_is_the_exact_waves():
    """The error at k = 1.05 of a dimer's logarithm to ε^5 is of the order of ε^6."""
    wave, xi = true("21/20", "1/20")[0], np.linspace(-6, 6, 25)
    orders = expand(Cell([1, "1/20"]), 5, k="21/20").log_force()
    log = sum(sp.Rational(1, 20) ** n * phi for n, phi in orders.items())
    force = sp.lambdify(sp.Symbol("X"), sp.exp(log))
    top, _ = wave.peak("force")
    assert np.abs(force(xi / np.sqrt(20)) - wave.force(top + xi)).max() < 0.05**5


@pytest.mark.parametrize(
    ("k", "omega"),
    [("21/20", "1/20"), pytest.param("11/10", "1/5", marks=pytest.mark.slow)],
)
def test_estimates_bound_the_errors_of_dimers(k, omega):
    """Also where radiation makes the wave a nanopteron, whose numbers vary by its tail."""
    wave, values = true(k, omega)
    for name, value in values.items():
        found = series(omega, 8)[name].at(k)
        assert abs(found.value - value) <= found.error + 3 * wave.tail * value, name


@pytest.mark.parametrize(("omega", "bound"), [("1/100", 1e-3), ("4/5", 1e-2)])
def test_hertz_dimer_to_a_percent_against_struck_chains(omega, bound):
    numbers = point(HERTZ, sp.Rational(omega), STRETCH).numbers
    expansion = expand(Cell([1, omega]), 8)
    for name, row in (("width", expansion.fwhm("force")), ("speed", expansion.c)):
        found, truth = row.at(HERTZ), numbers[name]
        assert abs(found.value / truth.value - 1) < bound
        assert abs(found.value - truth.value) <= found.error + truth.error
        assert found.asymptotic


def test_between_resonances_the_series_claims_no_digit():
    """ω = 0.55: no solitary wave is near, and the true decay per site is measurable."""
    found = series("11/20", 8)["force"].at(HERTZ)
    assert found.asymptotic
    assert found.error > 0.2 * found.value


@pytest.fixture(scope="module")
def places():
    """Equal beads at k = 1.1, where every theory has a wave, and the third special ratio."""
    return place(sp.Rational(11, 10), sp.S.One), place(HERTZ, sp.Rational("0.0901277691"))


def test_ladder_in_all_forms(places):
    report = ladder(places[:1])
    (document,) = report.document()["theories"]
    rows = {row["theory"]: row for row in document["rows"]}
    assert list(rows) == list(THEORIES)
    errors = {theory: abs(row["error_value"]["force"]) for theory, row in rows.items()}
    speed = float(theory_at("11/10", 1).at_force(1).speed)
    off = speed / document["truth_value"]["speed"] - 1
    assert rows["linear closure"]["error_value"]["speed"] == pytest.approx(off, rel=1e-9)
    # For equal beads all closures are one theory; each order of the series is better.
    assert errors["linear closure"] == pytest.approx(errors["full closure"], rel=1e-9)
    rising = [errors[name] for name in THEORIES if name.startswith("ε")]
    assert all(b < a for a, b in pairwise(rising))
    assert errors["canonical field"] > rising[0]
    assert (document["k"], document["omega"], document["truth"]) == ("11/10", "1", "solitary wave")
    lines = csv.DictReader(io.StringIO(report.csv()))
    assert [line["quantity"] for line in lines] == list(QUANTITIES)
    assert all(
        document[f"truth{part}_value"][name] > 0 for part in ("", "_error") for name in QUANTITIES
    )
    for theory, row in rows.items():
        assert row["seconds"] >= 0
        assert theory.startswith("ε") is (row["estimate_value"] is not None)
        for name, estimate in (row["estimate_value"] or {}).items():  # it bounds the error
            assert abs(row["error_value"][name]) <= estimate + 1e-13
    printed = report.text()
    assert max(map(len, printed.splitlines())) <= 100
    assert printed.count("theory over truth - 1") == len(QUANTITIES)
    assert "(ms of CPU): linear closure " in printed


def test_theories_without_a_wave_are_left_out(places):
    """The approximants are those of equal beads; no error is claimed for others."""
    report = ladder(places)
    (row,) = [row for row in report.document()["theories"][1]["rows"] if row["theory"] == "[1/1]"]
    assert (row["error_value"], row["missing"]) == (None, "a formula for equal beads")
    beads, dimers = ({c.label: c.style for c in panel.curves} for panel in report.panels)
    assert set(beads) == set(THEORIES)
    assert dimers.items() <= beads.items()
    assert "[1/1]" not in dimers
    assert "[1/1] " not in ladder(places[1:]).text().splitlines()[-1]


def test_missing_truths_and_sums_are_named():
    """A pulse that a later one overtakes, and a series of one order at k = 3."""
    with pytest.raises(MeasureError, match=r"^not steady: "):
        place(HERTZ, sp.Rational(11, 20), STRUCK_CHAIN)
    missing = {row["theory"]: row["missing"] for row in place(sp.S(3), sp.S.One)["rows"]}
    assert missing["ε^1"].startswith("no sum at k = 3: to ε^1")
    assert missing["linear closure"] is None
