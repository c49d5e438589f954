"""The study `hard`: its measures see every loss, its verdicts follow from its numbers."""

import json

import mpmath as mp
import numpy as np
import pytest
import sympy as sp

from lwa import Cell, Dimer, InputError, Power, background_wave, homogenize
from tests.commands import ended
from validation import cli
from validation.lattice.simulate import simulate
from validation.studies import hard as module
from validation.studies.hard import (
    ALLOWED,
    CASES,
    CLOSURES,
    FORMS,
    PRINTED,
    REFERENCE_DIGITS,
    closed_wave,
    energy_errors,
    form,
    hard,
    in_ulps,
    losses,
    printed_beta,
    splitting_errors,
    spreading,
    three_beads,
    true_values,
)

# The last digits


def test_neighbours_are_one_ulp_apart_and_rounding_costs_half():
    x = np.array([1.0, -3.7, 1e-300, 2.0**-20])
    true = np.array([mp.mpf(float(value)) for value in x], object)
    assert in_ulps(x, true).tolist() == [0, 0, 0, 0]
    assert in_ulps(x + np.spacing(np.abs(x)), true).tolist() == [1, 1, 1, 1]
    with mp.workdps(50):
        third = np.array([mp.mpf(1) / 3], object)
    assert 0 < in_ulps(np.array([1 / 3]), third)[0] <= 0.5


def test_an_error_of_nan_is_infinite_where_a_wave_exists():
    true = np.array([mp.mpf(1), mp.mpf(1), mp.mpf(1), None], object)
    found = in_ulps(np.array([np.nan, np.inf, 1.0, np.nan]), true)
    assert found[:3].tolist() == [np.inf, np.inf, 0.0]
    assert np.isnan(found[3])


@pytest.mark.parametrize("closure", CLOSURES)
def test_the_reference_is_the_exact_wave_of_these_numbers(closure):
    """mpmath at the symbols' values, against SymPy with the values put in before the algebra."""
    k, omega = np.array([1.5, 2.5]), np.array([0.2733, 1.5])
    symbolic = closed_wave(closure)
    for arguments in FORMS.values():
        found = true_values(symbolic, form(symbolic, *arguments), k, omega)
        for i in range(2):
            cell = Dimer(1, sp.Rational(omega[i]), spacing=1)
            pde = homogenize(cell, k=sp.Rational(k[i]), **CLOSURES[closure]).pde
            number = sp.N(form(pde.traveling_wave(), *arguments), 40)
            assert abs(sp.Float(found[i], 40) / number - 1) < sp.Float("1e-37"), arguments


CORNERS = np.array([1 + 1e-6, 1.5, 3.0, 20.0]), np.array([1e-6, 0.2733, 3.0, 1e6])
"""Corners of the grid, points in its middle, and some without a wave."""


def test_every_form_loses_little_and_the_printed_route_more():
    for (name, source), lost in losses(*CORNERS).items():
        known = lost[np.isfinite(lost)]
        if source == PRINTED:
            # (k - 1)² is left of terms of order 1 at k = 1 + 1e-6: some 1e6 ulps are lost at least
            assert known.max() > 1e5
        else:
            assert not np.isinf(lost).any(), (name, source)
            assert known.max() <= ALLOWED, (name, source)
            assert np.isnan(lost).any() or source != "paper's closure"


def test_the_printed_route_is_the_same_theory():
    """The same β to 1e-13, the rounding of ten operations, where no terms cancel."""
    k, omega = np.meshgrid([1.5, 2.0, 2.5], [0.1, 0.2733, 1.0])
    wave = closed_wave("paper's closure").numeric()
    np.testing.assert_allclose(printed_beta(k, omega), wave.beta(k, omega), rtol=1e-13)


def printed_hertz_beta(w):
    """β D at k = 3/2 as the expression in ω of Porter et al. (2008), in float64."""
    root = np.sqrt(4 - 4 * w + 13 * w**2 - 18 * w**3 + 9 * w**4)
    quotient = ((1 + w) ** 2 * (15 - 4 * w + 4 * w**2)) / (
        34 - 42 * w + 59 * w**2 - 34 * w**3 + 17 * w**4 + (-8 + 5 * w - 5 * w**2) * root
    )
    arch = np.sqrt(3) * (8 - 5 * w + 5 * w**2 - root) * np.sqrt(quotient)
    return arch / (30 - 8 * w + 8 * w**2)


def test_the_expression_of_beta_at_three_halves_is_sound_as_printed():
    wave = closed_wave("paper's closure")
    ratios = module.RATIOS
    true = true_values(wave, wave.beta, np.full(len(ratios), 1.5), ratios)
    assert in_ulps(printed_hertz_beta(ratios), true).max() < 8


def test_nesterenkos_relation_as_printed_loses_two_digits_a_decade():
    """V²/c0² = (4/15) (3 + 2 ζ^{5/2} - 5 ζ)/(ζ - 1)², ζ = 1 + B/p0, cancels at large loads."""
    wave, B, loads = background_wave(Cell([1], spacing=1), law=Power("3/2")), 0.7, [1e2, 1e4, 1e8]
    zeta = 1 + 1 / np.array(loads)
    relation = 4 * (3 + 2 * zeta**2.5 - 5 * zeta) / (15 * (zeta - 1) ** 2)
    with mp.workdps(REFERENCE_DIGITS):
        squared = [
            mp.mpf(sp.N(wave.on(sp.Rational(p0 * B)).stiffness(sp.Rational(B)), REFERENCE_DIGITS))
            for p0 in loads
        ]
        for p0, found in zip(loads, squared, strict=True):
            nodes = [0, 1e-12, 1e-9, 1e-6, 1e-3, 1]
            integral = mp.quad(lambda s, p=p0: 2 * (1 - s) * mp.sqrt(B * (mp.mpf(p) + s)), nodes)
            assert abs(found / integral - 1) < 1e-14  # p0 B is rounded
    lost = in_ulps(relation * np.sqrt(np.array(loads) * B), np.array(squared, object))
    assert np.log10(lost[1] / lost[0]) == pytest.approx(4, abs=1.5)
    assert lost[2] > 2**50


# Motion


@pytest.mark.parametrize(
    ("k", "opens", "steps", "order"),
    [
        (1.5, False, (0.2, 0.1), 6.0),
        (1.5, True, (0.2, 0.012), 2.5),
        pytest.param(2.0, True, (0.15, 0.012), 3.0, marks=pytest.mark.slow),
        (3.0, True, (0.15, 0.012), 4.0),
    ],
)
def test_a_contact_that_opens_leaves_k_plus_one_orders(k, opens, steps, order):
    steps = np.geomspace(*steps, 4)
    slope = np.polyfit(np.log(steps), np.log(splitting_errors(k, opens, steps)), 1)[0]
    assert abs(slope - order) < 0.35  # the scatter of an opening's place within its step


def test_the_exponent_of_spreading_of_a_walk_a_drift_and_a_swing():
    """Exponent 1/2 of independent steps, 1 of equal ones, 0 of what stays where it is."""
    noise = np.random.default_rng(1).normal(size=4000)
    assert spreading(np.cumsum(noise)) == pytest.approx(0.5, abs=0.05)
    assert spreading(np.arange(200.0)) == pytest.approx(1.0, abs=1e-12)
    assert spreading(noise) == pytest.approx(0.0, abs=0.05)


def test_segments_hand_on_their_state():
    """Two halves are one run: the energy's error at the end is the same."""
    halves = energy_errors(False, 0.5, 100.0, 2)
    whole = simulate(three_beads(False, 100.0), method="SRKN14", step=0.5).energy_drift
    # the energies of the middle are rounded once more
    assert halves[-1] == pytest.approx(whole, abs=1e-14)


def test_closed_contacts_do_not_drift_over_ten_thousand_time_units():
    energy = energy_errors(False, 0.5, 1e4, 20)
    early, late = np.abs(energy[1:11]).max(), np.abs(energy[11:]).max()
    assert late < 2 * early < 1e-4
    # order 6: a step of half the size errs by 2^-6, a little less where it swings
    fine = np.abs(energy_errors(False, 0.25, 1e4, 20)).max()
    assert fine < np.abs(energy).max() / 30


# The command


def test_the_document_holds_the_contract(capsys, tmp_path):
    picture = tmp_path / "hard.svg"
    options = ("--case", "contact-loss", "--format", "json", "--plot", str(picture))
    status, out, err = ended(capsys, cli.main, "hard", *options)
    document = json.loads(out)
    assert (status, err, document["ok"]) == (0, "", True)
    (contacts,) = document["cases"]
    assert (contacts["case"], contacts["ok"]) == ("contact-loss", True)
    assert contacts["question"].endswith("which order does the splitting keep?")
    assert 2 < contacts["order_opening_value"] < 3
    for curve in contacts["panel"]["curves"]:  # the fitted orders are the slopes of the lines
        slope = np.polyfit(np.log(curve["x_value"]), np.log(curve["y_value"]), 1)[0]
        assert slope == pytest.approx(contacts[f"order_{curve['label']}_value"], rel=1e-12)
    assert contacts["statements"] == []
    assert "<!-- contact-loss -->" in picture.read_text()
    for finding in contacts["findings"]:
        assert finding["least_value"] <= finding["measured_value"] <= finding["most_value"]


def test_a_case_that_does_not_exist_is_named(capsys):
    status, out, err = ended(capsys, cli.main, "hard", "--case", "tea")
    assert (status, out, err.count("\n")) == (2, "", 1)
    assert "'tea'" in err
    with pytest.raises(InputError, match=r"^case is 'tea'"):
        hard(["tea"])


@pytest.mark.slow
def test_all_cases_hold_and_state_a_number():
    whole = hard().document()
    assert whole["ok"]
    assert [case["case"] for case in whole["cases"]] == list(CASES)
    for case in whole["cases"]:
        assert case["ok"]
        assert any(key.endswith("_value") for key in case), case["case"]
    json.dumps(whole, allow_nan=False)
    (ulps,) = (case for case in whole["cases"] if case["case"] == "ulps")
    assert ulps["loss_ulps_value"] < 8
    assert ulps["printed_loss_ulps_value"] > 2**52  # no digit is left
    (load,) = (case for case in whole["cases"] if case["case"] == "under-load")
    assert 0 < load["loss_ulps_value"] < 8
