"""The study `hard`: its measures see every loss, its verdicts follow from its numbers."""

import json

import numpy as np
import pytest

from book.studies import hard as study
from tests.commands import ended


@pytest.mark.parametrize("k", [2.0, 3.0])
def test_a_contact_that_opens_leaves_k_plus_one_orders(k):
    """At k = 3/2 the case contact-loss says so."""
    steps = np.geomspace(0.15, 0.012, 4)
    slope = np.polyfit(
        np.log(steps), np.log(study.splitting_errors(k, True, steps)), 1
    )[0]
    assert (
        abs(slope - k - 1) < 0.35
    )  # the scatter of an opening's place within its step


def test_the_document_holds_the_case_that_is_asked_for(capsys):
    options = ("--case", "contact-loss", "--format", "json")
    status, out, err = ended(capsys, study.hard.main, *options)
    (contacts,) = json.loads(out)["cases"]
    assert (status, err, contacts["ok"]) == (0, "", True)
    for curve in contacts["panel"][
        "curves"
    ]:  # the fitted orders are the slopes of the lines
        slope = np.polyfit(np.log(curve["x_value"]), np.log(curve["y_value"]), 1)[0]
        assert slope == pytest.approx(
            contacts[f"order_{curve['label']}_value"], rel=1e-12
        )


def test_all_cases_hold_and_state_a_number():
    whole = study.hard().document()
    json.dumps(whole, allow_nan=False)
    cases = {case["case"]: case for case in whole["cases"]}
    assert (list(cases), whole["ok"]) == (list(study.CASES), True)
    assert all(any(key.endswith("_value") for key in case) for case in cases.values())
    assert cases["ulps"]["loss_ulps_value"] < 8
    # (k - 1)² is left of terms of order 1 at k = 1 + 1e-6
    assert cases["ulps"]["printed_loss_ulps_value"] > 1e5
    assert 0 < cases["under-load"]["loss_ulps_value"] < 8
