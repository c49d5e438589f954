"""The study `hard`: its measures see every loss, its verdicts follow from its numbers."""

import json

import numpy as np
import pytest

from book.studies import hard as study
from tests.commands import ended

CORNERS = np.array([1 + 1e-6, 1.5, 3.0, 20.0]), np.array([1e-6, 0.2733, 3.0, 1e6])
"""Corners of the grid, points in its middle, and some without a wave."""


def test_every_form_loses_little_and_the_printed_route_more():
    for (name, source), lost in study.losses(*CORNERS).items():
        known = lost[np.isfinite(lost)]
        if source == study.PRINTED:
            # (k - 1)² is left of terms of order 1 at k = 1 + 1e-6: some 1e6 ulps are lost at least
            assert known.max() > 1e5
        else:
            assert not np.isinf(lost).any(), (name, source)
            assert known.max() <= study.PROMISED, (name, source)
            assert np.isnan(lost).any() or source != "paper's closure"


@pytest.mark.parametrize(
    ("k", "opens", "steps", "order"),
    [
        (1.5, False, (0.1, 0.05), 4.0),
        (1.5, True, (0.2, 0.012), 2.5),
        pytest.param(2.0, True, (0.15, 0.012), 3.0, marks=pytest.mark.slow),
        (3.0, True, (0.15, 0.012), 4.0),
    ],
)
def test_a_contact_that_opens_leaves_k_plus_one_orders(k, opens, steps, order):
    steps = np.geomspace(*steps, 4)
    slope = np.polyfit(np.log(steps), np.log(study.splitting_errors(k, opens, steps)), 1)[0]
    assert abs(slope - order) < 0.35  # the scatter of an opening's place within its step


def test_closed_contacts_do_not_drift_over_ten_thousand_time_units():
    energy = study.energy_errors(False, 0.2, 1e4, 20)
    early, late = np.abs(energy[1:11]).max(), np.abs(energy[11:]).max()
    assert late < 2 * early < 1e-4
    # order 4: a step of half the size errs by 2^-4, a little less where it swings
    fine = np.abs(study.energy_errors(False, 0.1, 1e4, 20)).max()
    assert fine < np.abs(energy).max() / 10


def test_the_document_holds_the_case_that_is_asked_for(capsys):
    options = ("--case", "contact-loss", "--format", "json")
    status, out, err = ended(capsys, study.hard.main, *options)
    (contacts,) = json.loads(out)["cases"]
    assert (status, err, contacts["ok"]) == (0, "", True)
    for curve in contacts["panel"]["curves"]:  # the fitted orders are the slopes of the lines
        slope = np.polyfit(np.log(curve["x_value"]), np.log(curve["y_value"]), 1)[0]
        assert slope == pytest.approx(contacts[f"order_{curve['label']}_value"], rel=1e-12)


@pytest.mark.slow
def test_all_cases_hold_and_state_a_number():
    whole = study.hard().document()
    json.dumps(whole, allow_nan=False)
    cases = {case["case"]: case for case in whole["cases"]}
    assert (list(cases), whole["ok"]) == (list(study.CASES), True)
    assert all(any(key.endswith("_value") for key in case) for case in cases.values())
    assert cases["ulps"]["loss_ulps_value"] < 8
    assert cases["ulps"]["printed_loss_ulps_value"] > 1e5  # near k = 1, as above
    assert 0 < cases["under-load"]["loss_ulps_value"] < 8
