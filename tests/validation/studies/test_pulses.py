"""Pulses of measured records: against the run that made the records, and against known pulses."""

from pathlib import Path

import numpy as np
import pytest

from validation.pulses.pulse import MeasureError
from validation.scenes.scene import SceneError
from validation.studies.records import pulses

SCENE = """
duration = 60
samples = 4001
precompression = 0.05
wall = {stiffness = 1}
chain = {cell = [1], repeat = 40, k = 1.5, spacings = 2}
striker = {velocity = 1}
sensors = {beads = [10, 20], contacts = [10, 20]}
"""
NAMES = {
    "sensors": ("arrival_value", "peak_value", "fwhm_value", "static_force_value"),
    "speeds": ("speed_sites_value", "speed_value"),
}


def test_the_records_of_a_run_have_the_pulses_of_the_run(document):
    """The static force is the mean of what comes before: waves of 1e-6 run ahead."""
    Path("scene.toml").write_text(SCENE)
    wanted = document("run scene.toml --out records.csv")
    found = document("pulses records.csv --distance 2")
    for table, names in NAMES.items():
        assert len(found[table]) == len(wanted[table]) > 0
        for ours, theirs in zip(found[table], wanted[table], strict=True):
            assert list(ours) == list(theirs)
            for name, value in theirs.items():
                if name in names:
                    assert ours[name] == pytest.approx(value, rel=2e-5)
                elif not name.endswith("_value"):
                    assert ours[name] == value
    rows = {(row["kind"], row["number"]): row for row in found["sensors"]}
    for leg in found["speeds"]:  # stands in the row of its second sensor, too
        assert rows[leg["kind"], leg["to"]]["speed_value"] == leg["speed_value"]


def test_the_error_of_a_speed_is_that_of_both_arrivals(saved):
    """Two Gaussian pulses, 50 µs apart, of 12 and 10 N."""
    t = np.arange(-200.0, 400.0)
    rng = np.random.default_rng(5)
    forces = []
    for peak, at in ((12, 0), (10, 50)):
        pulse = 3 + peak * np.exp(-(((t - at) / 24) ** 2))
        forces.append(pulse + 0.05 * rng.normal(size=len(t)))
    found = pulses(saved((t, *forces), "time,1 force,2 force")).document()
    (speed,) = found["speeds"]
    late = np.hypot(*(row["arrival_error_value"] for row in found["sensors"]))
    assert speed["speed_sites_error_value"] * 50 == pytest.approx(
        speed["speed_sites_value"] * late, rel=0.02
    )
    assert speed["speed_value"] is None


def test_a_sensor_without_a_pulse_has_no_numbers(saved):
    """The reason stands in its row; a file in which no sensor has a pulse is refused."""
    t = np.arange(400.0)
    pulse = np.exp(-(((t - 260) / 30) ** 2))
    table = saved((t, pulse, 0 * t), "time,1 force,2 force")
    row = pulses(table).document()["sensors"][1]
    assert row["peak_value"] is None
    assert "constant" in row["missing"]
    with pytest.raises(MeasureError, match=r"no sensor has a pulse: .* constant"):
        pulses(saved((t, 0 * t), "time,1 force"))


@pytest.mark.parametrize("options", [{"distance": "2 ft"}, {"of": "wall"}])
def test_bad_options_are_refused(options):
    ((name, value),) = options.items()
    with pytest.raises(SceneError, match=f"^{name} is '{value}'"):
        pulses("none.csv", **options)


FALLING = """
duration = 2
samples = 2001
gravity = 9.81
units = "SI"
chain = {cell = [1], repeat = 2, k = 1, stiffnesses = 1000, spacings = 1}
wall = {stiffness = 1000}
start = {displacements = [-2, -1]}
sensors = {beads = [1, 2]}
"""


def test_forces_of_falling_beads_count_from_the_start(document):
    """Beads that fall carry no static load at the start: one rule for run, pulses and compare."""
    Path("fall.toml").write_text(FALLING)
    ran = document("run fall.toml --out fall.csv")["sensors"]
    read = document("pulses fall.csv")["sensors"]
    for ours, theirs in zip(ran, read, strict=True):
        assert ours["static_force_value"] == theirs["static_force_value"] == 0
        for name in ("arrival", "peak", "fwhm"):
            error = ours[f"{name}_error_value"] + theirs[f"{name}_error_value"]
            assert abs(ours[f"{name}_value"] - theirs[f"{name}_value"]) < error
    rows = document("compare fall.toml fall.csv")["rows"]
    assert len(rows) == 6
    for row in rows:
        assert abs(row["difference_value"]) <= row["difference_error_value"]
