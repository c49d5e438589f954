"""FWHM down the paper's chain; its published errors: the check of `book/column.md`."""

import numpy as np
import pytest

from book.studies.widths import FIRST_BEAD, widths
from validation.scenes.chains import DIAMETER
from validation.studies.paper import paper


@pytest.fixture(scope="module")
def computed():
    return widths()


def test_widths_alternate_from_bead_to_bead(computed):
    times = np.array(computed.data["fwhm_value"])
    late = times[computed.data["beads"].index(FIRST_BEAD) :]
    even, odd = late[::2], late[1::2]
    assert np.all(odd > 1.4 * even)  # steel beads carry the humps of both neighbours
    assert np.ptp(even) < 0.02 * even.mean()
    assert np.ptp(odd) < 0.02 * odd.mean()


def test_no_definition_has_all_three_errors(computed):
    """Of ten; that of the PTFE beads in time has two of them."""
    met = {}
    for one in computed.document()["definitions"]:
        met[one["quantity"], one["unit"]] = len(one["reproduced"])
    assert len(met) == 10
    assert met.pop(("PTFE beads' force, contact's theory", "s")) == 2
    assert max(met.values()) < 2


def test_the_width_agrees_with_the_experiment_of_the_paper_command(computed):
    found = {
        row["quantity"]: row["lattice_value"] for row in paper().document()["rows"]
    }
    late = computed.data["fwhm_value"][computed.data["beads"].index(34)]
    width = late * found["speed V_s"] / DIAMETER
    assert width == pytest.approx(found["FWHM of F_34"], rel=1e-6)
