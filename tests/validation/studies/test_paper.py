"""The paper's experiment on the lattice: exact scaling, closed loops, published numbers."""

import numpy as np
import pytest

from validation.lattice.simulate import simulate
from validation.pulses.pulse import first_pulse
from validation.scenes.chains import DIAMETER
from validation.studies.paper import SENSORS, paper, recorded_chain, stated_errors


@pytest.fixture(scope="module")
def rows():
    return by_name(paper())


def by_name(result):
    return {row["quantity"]: row for row in result.document()["rows"]}


def value(rows, name):
    return rows[name]["lattice_value"]


def test_the_theory_within_the_papers_reach(rows):
    """The paper calls speed and force very good: the speed from F_m holds to half a percent."""
    assert all({*row["theory_value"]} == {"F_m", "striker"} for row in rows.values())
    peak = rows["peak bead force F_m"]["error_value"]
    assert peak["F_m"] == pytest.approx(0, abs=1e-12)
    # A striker leaves a little behind, so the theory that takes it all overshoots, a little.
    assert 0 < peak["striker"] < 0.02
    assert abs(rows["speed V_s"]["error_value"]["F_m"]) < 0.005


def test_unlike_beads_do_not_time_the_pulse(rows):
    """The theory misses the speed between beads of one kind, 164.1 m/s, by 0.9 %."""
    assert value(rows, "speed V_s") == pytest.approx(163.32, abs=0.005)
    for pair in ("15 to 33", "16 to 34"):
        row = rows[f"speed from bead {pair}"]
        assert 164.05 < row["lattice_value"] < 164.2
        assert row["error_value"]["F_m"] == pytest.approx(-0.0087, abs=3e-4)


@pytest.mark.parametrize("kind", ["bead", "contact"])
def test_widths_in_sites_err_as_those_in_time_times_the_speed(rows, kind):
    names = "speed V_s", f"FWHM of {kind} force in time", f"FWHM of {kind} force"
    for theory in ("F_m", "striker"):
        errors = (rows[name]["error_value"][theory] for name in names)
        speed, time, sites = (1 + error for error in errors)
        assert time * speed == pytest.approx(sites, rel=1e-9)


def test_the_error_that_figure_3b_states_is_that_of_both_kinds_of_contacts(rows):
    """At the contacts' own force: the FWHM in time goes as F^{-1/6}."""
    names = "FWHM of contact force in time", "peak contact force"
    time, peak = (1 + rows[name]["error_value"]["F_m"] for name in names)
    _, real, _ = stated_errors()
    # With one contact less, of one kind, it is 0.0034 more.
    assert 1 + real["error_value"] == pytest.approx(time * peak ** (1 / 6), abs=1e-3)


def test_the_chain_scales_exactly_with_the_blow(rows):
    """Without gravity F ∝ v^{6/5} and V ∝ v^{1/5}."""
    fast = by_name(paper(velocity=13.7))
    powers = {
        "speed V_s": 1 / 5,
        "peak bead force F_m": 6 / 5,
        "peak contact force": 6 / 5,
        "FWHM of F_34": 0,
        "FWHM of contact force": 0,
    }
    for name, power in powers.items():
        found = np.log10(value(fast, name) / value(rows, name))
        assert found == pytest.approx(power, abs=1e-6), name


def test_means_and_units(rows):
    """Means over both beads or their four contacts; sites at the speed V_s."""
    run = simulate(recorded_chain(SENSORS))
    sites = value(rows, "speed V_s") / DIAMETER
    for kind, sensors in (("bead", (14, 33)), ("contact", (13, 14, 32, 33))):
        pulses = [first_pulse(run.signal(kind, i)) for i in sensors]
        peak, fwhm = np.mean([(pulse.peak, pulse.fwhm) for pulse in pulses], axis=0)
        width = f"FWHM of {kind} force"
        mean = {
            f"peak {kind} force{' F_m' * (kind == 'bead')}": peak,
            width: fwhm * sites,
            f"{width} in time": 1e6 * fwhm,
        }
        for name, number in mean.items():
            assert value(rows, name) == pytest.approx(number, rel=1e-8)
    for bead, pulse in zip(SENSORS, run.scene.bead_sensors, strict=True):
        found = first_pulse(run.signal("bead", pulse))
        assert value(rows, f"peak bead force F_{bead}") == pytest.approx(found.peak)
        wide = value(rows, f"FWHM of F_{bead}")
        assert wide == pytest.approx(found.fwhm * sites)
