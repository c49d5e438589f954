"""Chains of random masses: without disorder nothing decays, with it as a power of the spread."""

import csv
import io
import json

import numpy as np
import pytest

from book.studies.disorder import disorder
from tests.commands import ended

FEW = {"chains": 12, "sites": 100}


def run(capsys, *arguments):
    return ended(capsys, disorder.main, "--chains", "4", "--sites", "60", *arguments)


def test_equal_beads_keep_their_pulse():
    found = disorder(spread=0.0, chains=2, sites=200)
    assert abs(found.document()["decay_value"]) < 1e-7  # the pulse is still shedding at site 20
    assert found.document()["decay_error_value"] == 0


def test_the_decay_grows_as_a_power_between_two_and_three():
    """From s to 2s: what each bead throws back is at least second order in s."""
    half, whole = (disorder(spread=s, chains=30).document() for s in (0.1, 0.2))
    ratio = whole["decay_value"] / half["decay_value"]
    error = ratio * np.hypot(*(d["decay_error_value"] / d["decay_value"] for d in (half, whole)))
    assert half["decay_value"] > 5 * half["decay_error_value"]
    assert ratio + 2 * error > 4
    assert ratio - 2 * error < 8


def test_errors_are_those_of_a_mean_over_chains():
    """Twelve other chains are within the errors of the first twelve; the same seed, the same."""
    one, again, other = (disorder(seed=seed, **FEW).document() for seed in (1, 1, 2))
    assert one == again
    both = np.hypot(one["decay_error_value"], other["decay_error_value"])
    assert 0 < abs(one["decay_value"] - other["decay_value"]) < 3 * both
    last = one["rows"][-1]
    assert last["log_force_error_value"] == pytest.approx(last["scatter_value"] / np.sqrt(12))


def test_more_chains_go_on_with_the_same_ones():
    few, more = (disorder(chains=n, sites=60).document()["rows"] for n in (2, 3))
    assert few[-1]["log_force_value"] != more[-1]["log_force_value"]
    three = [disorder(chains=n, sites=60).document()["rows"][-1] for n in (2, 3)]
    assert three == [few[-1], more[-1]]


def test_the_command(capsys):
    status, out, err = run(capsys, "--format", "json")
    assert (status, err) == (0, "")
    found = json.loads(out)
    assert found["ok"] is True
    status, out, _ = run(capsys, "--format", "csv")
    rows = list(csv.DictReader(io.StringIO(out)))
    assert [{name: float(value) for name, value in row.items()} for row in rows] == found["rows"]
    status, out, _ = run(capsys)
    assert out.startswith("4 chains of 60 sites, masses in 1 ± 0.1, k = 1.5; decay of ")


@pytest.mark.parametrize(
    ("option", "value", "message"),
    [
        ("spread", 0.6, "spread is 0.6: one from 0 to 0.5 is wanted"),
        ("spread", float("nan"), "spread is nan"),
        ("chains", 1, "chains is 1: one of 2 … 10000 is wanted"),
        ("sites", 10, "sites is 10: one of 50 … 10000 is wanted"),
        ("seed", -1, "seed is -1"),
        ("k", 0.5, "k is 1/2: a compact wave needs k > 1"),
    ],
)
def test_what_cannot_be_meant_is_refused(option, value, message):
    with pytest.raises(ValueError, match=message):
        disorder(**{option: value})
