"""The study `hard`: its measures see every loss, its verdicts follow from its numbers."""

import numpy as np
import pytest

from book.studies import hard as study


@pytest.mark.parametrize("k", [2.0, 3.0])
def test_a_contact_that_opens_leaves_k_plus_one_orders(k):
    """At k = 3/2 the case contact-loss says so."""
    steps = np.geomspace(0.15, 0.012, 4)
    errors = study.splitting_errors(k, True, steps)
    slope = np.polyfit(np.log(steps), np.log(errors), 1)[0]
    # the scatter of an opening's place within its step
    assert abs(slope - k - 1) < 0.35


def test_all_cases_hold():
    report = study.hard()
    assert report.ok
    rows = report.document()["rows"]
    assert {row["case"].partition("\n")[0] for row in rows} == set(study.CASES)
    document = report.document()
    assert document["loss_ulps_value"] < 8
    assert 0 < document["load_ulps_value"] < 8


def test_a_lost_digit_is_seen():
    """(k - 1)² is left of terms of order 1 at k = 1 + 1e-6: the paper's route loses its square."""
    wave = study.closed_wave("paper's closure")
    k, omega = np.array([1 + 1e-6]), np.array([0.2733])
    true = study.true_values(wave, wave.beta, k, omega)
    assert study.in_ulps(wave.numeric().beta(k, omega), true) < 8
    assert study.in_ulps(study.printed_beta(k, omega), true) > 1e5
    assert study.in_ulps(np.array([np.nan]), true) == np.inf
