"""The paper's experiment on the lattice: exact scaling, closed loops, published numbers."""

import numpy as np
import pytest

from validation.lattice.simulate import simulate
from validation.pulses.pulse import first_pulse
from validation.scenes.chains import DIAMETER
from validation.studies.paper import SENSORS, SOURCES, paper, recorded_chain


@pytest.fixture(scope="module")
def result():
    return paper()


def rows(result):
    return {row["quantity"]: row for row in result.document()["rows"]}


def lattice(result):
    return {name: row["lattice_value"] for name, row in rows(result).items()}


def test_every_number_has_its_error_and_its_theory(result):
    for row in rows(result).values():
        # two runs, at local errors of 1e-7 and 1e-10 a step over some thousand steps
        assert 0 < row["lattice_error_value"] < 1e-5 * row["lattice_value"]
        assert set(row["theory_value"]) == set(SOURCES)
    assert rows(result)["peak bead force F_m"]["error_value"]["F_m"] == pytest.approx(
        0, abs=1e-12
    )


def test_the_theory_within_the_papers_reach(result):
    """The paper calls speed and force very good: the speed from F_m holds to half a percent."""
    by_name = rows(result)
    assert abs(by_name["speed V_s"]["error_value"]["F_m"]) < 0.005
    # A striker leaves a little behind, so the theory that takes it all overshoots, a little.
    assert 0 < by_name["peak bead force F_m"]["error_value"]["striker"] < 0.02


def test_unlike_beads_do_not_time_the_pulse(result):
    """The theory misses the speed between beads of one kind, 164.1 m/s, by 0.9 %."""
    by_name = rows(result)
    like = [by_name[f"speed from bead {pair}"] for pair in ("15 to 33", "16 to 34")]
    assert by_name["speed V_s"]["lattice_value"] == pytest.approx(163.32, abs=0.005)
    assert all(164.05 < row["lattice_value"] < 164.2 for row in like)
    assert all(
        row["error_value"]["F_m"] == pytest.approx(-0.0087, abs=3e-4) for row in like
    )


def test_the_chain_scales_exactly_with_the_blow(result):
    """Without gravity F ∝ v^{6/5} and V ∝ v^{1/5}, in two runs with the errors tested above."""
    slow, fast = lattice(result), lattice(paper(velocity=13.7))
    powers = {
        "speed V_s": 1 / 5,
        "peak bead force F_m": 6 / 5,
        "peak contact force": 6 / 5,
    }
    for name, power in (
        powers | {"FWHM of F_34": 0, "FWHM of contact force": 0}
    ).items():
        assert np.log10(fast[name] / slow[name]) == pytest.approx(power, abs=1e-6), name


def test_means_and_units(result):
    """Numbers of contacts are means over the two contacts of both beads."""
    found, run = lattice(result), simulate(recorded_chain(SENSORS))
    contacts = [first_pulse(run.signal("contact", i)) for i in (13, 14, 32, 33)]
    force, fwhm = np.mean([(pulse.peak, pulse.fwhm) for pulse in contacts], axis=0)
    assert found["peak contact force"] == pytest.approx(force, rel=1e-8)
    assert found["FWHM of contact force in time"] == pytest.approx(1e6 * fwhm, rel=1e-8)
    pair = found["peak bead force F_15"], found["peak bead force F_34"]
    assert found["peak bead force F_m"] == pytest.approx(np.mean(pair), rel=1e-14)
    pair = found["FWHM of F_15"], found["FWHM of F_34"]
    assert found["FWHM of bead force"] == pytest.approx(np.mean(pair), rel=1e-14)
    in_time = 1e-6 * found["FWHM of bead force in time"] * found["speed V_s"] / DIAMETER
    assert found["FWHM of bead force"] == pytest.approx(in_time, rel=1e-14)
