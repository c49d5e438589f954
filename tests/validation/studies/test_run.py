"""The report of any scene: its table for programs, and its view in a notebook."""

from dataclasses import replace

import numpy as np

from validation.pulses.sensors import record
from validation.scenes.chains import struck
from validation.scenes.forcing import Damping
from validation.studies.run import report


def test_many_sensors_are_drawn_as_a_map():
    """A legend of so many curves would fill the picture."""
    sensors = {"contact_sensors": (18, *range(18)), "bead_sensors": (4, 9)}
    found = record(struck((1, 0.5), 20, duration=20, samples=3001, **sensors))
    few, many = report(found).panels
    assert [curve.label for curve in few.curves] == ["bead 5", "bead 10"]
    assert (many.x, many.y, many.map.label) == ("contact", "time", "force")
    assert many.map.x.tolist() == list(range(1, 20))
    run, time = found.run, many.map.y
    assert 500 < len(time) <= 1000
    assert many.map.values.shape == (len(time), 19)
    force = run.contact_force[list(run.scene.contact_sensors).index(6)]
    np.testing.assert_array_equal(
        many.map.values[:, 6], np.interp(time, run.time, force)
    )


def test_every_pulse_of_a_train_is_listed():
    """A heavy striker sends a train; each pulse is the higher the earlier it arrives."""
    chain = struck((1.0,), 61, duration=60, contact_sensors=(30,))
    scene = replace(chain, masses=(10.0, *chain.masses[1:]))
    found = record(scene, every=True)
    rows = report(found, every=True).document()["sensors"]
    assert [row["pulse"] for row in rows] == list(range(1, len(rows) + 1))
    assert len(rows) >= 4
    arrivals, peaks = (
        [row[name] for row in rows] for name in ("arrival_value", "peak_value")
    )
    assert arrivals == sorted(arrivals)
    assert peaks == sorted(peaks, reverse=True)
    (first,) = record(scene).sensors
    assert first.numbers == found.sensors[0].numbers
    assert "pulse" not in report(record(scene)).document()["sensors"][0]


def test_a_report_states_what_is_conserved_and_what_is_lost():
    free = struck((1.0, 0.5), 20, duration=20, contact_sensors=(8, 12))
    shown = report(record(free, rtol=1e-9)).document()
    assert abs(shown["energy_drift_value"]) < 1e-8
    damped = replace(free, wall=1.0, gravity=0.01, damping=Damping("contact", 0.05))
    shown = report(found := record(damped, rtol=1e-8))
    assert shown.document()["dissipated_value"] == found.run.dissipated > 0
    assert f"dissipated {found.run.dissipated:.6g}" in " ".join(shown.text().split())
    assert "work_value" not in shown.document()
    silent = report(record(replace(free, contact_sensors=())))
    assert "No sensors" in silent.text()
