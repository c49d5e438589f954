"""The report of any scene: its table for programs, and what a notebook shows."""

import csv
import io

import numpy as np
import pytest

from lwa import InputError
from validation.pulses.sensors import record
from validation.scenes.chains import struck
from validation.studies.run import report


@pytest.fixture(scope="module")
def told():
    return report(record(struck((1, 0.5), 20, duration=20, contact_sensors=(4, 8, 18))))


def test_the_table_of_numbers_is_that_of_the_document(told):
    rows = list(csv.DictReader(io.StringIO(told.csv())))
    sensors = told.document()["sensors"]
    assert [row["missing"] for row in rows] == [s["missing"] or "" for s in sensors]
    assert sensors[2]["missing"].startswith("the pulse is not wholly in")
    for row, sensor in zip(rows, sensors, strict=True):
        assert list(row) == list(sensor)
        for name in sensor.keys() - {"kind", "number", "missing"}:
            assert row[name] == ("" if sensor[name] is None else str(sensor[name]))


def test_a_notebook_shows_the_tables_and_the_forces(told):
    shown = told._repr_html_()
    assert shown.count("<table>") == 2
    assert "<td>contact 5 → 9</td>" in shown
    assert "<svg" in shown
    (panel,) = told.panels
    assert [curve.label for curve in panel.curves] == ["contact 5", "contact 9", "contact 19"]


def test_many_sensors_are_drawn_as_a_map():
    """As curves their names alone would fill the picture."""
    heard = {"contact_sensors": (18, *range(18)), "bead_sensors": (4, 9)}
    found = record(struck((1, 0.5), 20, duration=20, samples=3001, **heard))
    few, many = report(found).panels
    assert [curve.label for curve in few.curves] == ["bead 5", "bead 10"]
    assert (many.x, many.y, many.map.label) == ("contact", "time", "force")
    assert many.map.x.tolist() == list(range(1, 20))
    run, time = found.run, many.map.y
    assert 500 < len(time) <= 1000
    assert many.map.values.shape == (len(time), 19)
    force = run.contact_force[list(run.scene.contact_sensors).index(6)]
    np.testing.assert_array_equal(many.map.values[:, 6], np.interp(time, run.time, force))


def test_a_scene_without_sensors_has_no_picture():
    bare = report(record(struck((1,), 4, duration=1)))
    assert bare.text().startswith("4 beads, 3 contacts, k = 1.5; duration 1, energy drift ")
    assert "\n" not in bare.text()
    assert bare.document()["sensors"] == bare.document()["speeds"] == []
    with pytest.raises(InputError, match="this result has no picture"):
        bare.figure()
