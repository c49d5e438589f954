"""Chains of random masses: without disorder nothing decays, with it as a power of the spread."""

import sys

import numpy as np
import pytest

from book.studies.disorder import disorder, single_losses
from tests.book.prose import BOOK

sys.path.append(str(BOOK))  # the pages' own modules
from turned import LOSSES


def test_equal_beads_keep_their_pulse():
    found = disorder(spread=0.0, chains=2, sites=200)
    assert (
        abs(found.document()["decay_value"]) < 1e-7
    )  # the pulse is still shedding at site 20
    assert found.document()["decay_error_value"] == 0


def test_the_theory_is_the_mean_loss_at_single_beads():
    """That the decay is, too, is a table of `book/column.md`."""
    spread = 0.2
    found = disorder(spread=spread, chains=2).document()
    last, first = found["rows"][-1], found["rows"][0]
    line = found["theory_value"] * (first["site"] - last["site"])
    e, loss = (
        np.array([one[f"{n}_value"] for one in found["single"]])
        for n in ("excess", "loss")
    )
    sides = [
        np.polynomial.Polynomial.fit(abs(e[s]), loss[s], 4) for s in (e < 0, e > 0)
    ]
    mean = sum(side.integ(lbnd=0)(spread) for side in sides) / (2 * spread)
    assert found["theory_value"] == pytest.approx(mean, rel=1e-6)
    assert last["theory_value"] == pytest.approx(line, rel=1e-12)


@pytest.mark.parametrize(
    ("side", "sign", "bound"), [("heavier", 1, 0.0015), ("lighter", -1, 0.017)]
)
def test_losses_at_single_beads(side, sign, bound):
    """The formula of `book/column.md` by the digits that it prints."""
    excess = np.array([0.0025, 0.005, 0.01, 0.02])
    known = LOSSES[side]
    formula = known["square"] * excess**2 + known["power"] * excess**2.5
    losses = [loss.value for loss in single_losses(sign * excess)]
    off = np.abs(formula / losses - 1).max()
    assert 0.8 * bound < off < bound


def test_a_decay_that_changes_along_the_chain_fails():
    """The pulse disintegrates at spread 0.5; its local decays: the check of `book/column.md`."""
    wide = disorder(spread=0.5, chains=20)
    assert not wide.ok
    assert wide.document()["decay_change_value"] < -2e-3


def test_more_chains_go_on_with_the_same_ones():
    """The scatter of three is that of the first two, as mean and scatter tell them, and a third."""
    few, more = (disorder(chains=n, sites=60).document()["rows"][-1] for n in (2, 3))
    apart = few["scatter_value"] / np.sqrt(2)
    one, two = few["log_force_value"] - apart, few["log_force_value"] + apart
    third = 3 * more["log_force_value"] - one - two
    assert more["scatter_value"] == pytest.approx(
        np.std([one, two, third], ddof=1), rel=1e-9
    )
