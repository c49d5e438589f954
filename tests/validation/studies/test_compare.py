"""Measured records against their scene: shifts, scales and pulses that are known."""

from pathlib import Path

import numpy as np
import pytest

from validation import simulate
from validation.scenes.scene import SceneError
from validation.scenes.scenefile import read_scene
from validation.studies.records import compare

SCENE = """
duration = 40
samples = 4001
precompression = 0.1
wall = {stiffness = 1}
chain = {cell = [1, 0.5], repeat = 14, k = 1.5}
striker = {velocity = 1}
sensors = {contacts = [12, 18]}
"""
LATE, STRONGER = 2.5, 1.02
HEADER = "time,contact 12 force,contact 18 dynamic force"


@pytest.fixture
def rows(folder):
    """Times and forces of the scene, whose file is in the folder; one of them is stronger."""
    Path("scene.toml").write_text(SCENE)
    run = simulate(read_scene("scene.toml"), rtol=1e-10)
    first, second = run.contact_force
    return np.array((run.time - LATE, first, STRONGER * (second - 0.1)))


def test_a_shift_and_a_scale_come_back(document, rows, saved):
    found = document(f"compare scene.toml {saved(rows, HEADER)} --plot p.svg")
    assert found["shift_value"] == pytest.approx(LATE, abs=1e-6)
    by_name = {(row["number"], row["quantity"]): row for row in found["rows"]}
    assert list(by_name) == [
        (i, name) for i in (12, 18) for name in ("arrival", "peak", "fwhm")
    ]
    for (number, quantity), row in by_name.items():
        scale = STRONGER if (number, quantity) == (18, "peak") else 1.0
        errors = [row[f"{name}_error_value"] for name in ("simulated", "measured")]
        assert row["difference_error_value"] == pytest.approx(sum(errors), rel=1e-12)
        # Behind the dip after the pulse the fit's residuals hide a part of its error.
        bound = 10 * row["difference_error_value"] + 1e-9
        assert (
            abs(row["measured_value"] - scale * row["simulated_value"]) <= bound < 1e-3
        )
    assert "contact 12, simulated" in Path("p.svg").read_text()


def test_a_single_sensor_needs_no_name_and_the_clock_starts_anywhere(rows, saved):
    Path("scene.toml").write_text(SCENE.replace("[12, 18]", "[12]"))
    named = compare("scene.toml", saved(rows, HEADER)).document()
    assert compare("scene.toml", saved(rows[:2], "time,force")).document() == named
    rows[0] += 5000
    late = compare("scene.toml", saved(rows, HEADER)).document()
    assert late["shift_value"] == pytest.approx(LATE - 5000, abs=1e-6)


def test_the_error_of_a_later_arrival_holds_that_of_the_shift(rows, saved):
    """Without the first sensor's column the second is the one by which records are shifted."""
    rows[1:] += 0.005 * np.random.default_rng(7).normal(size=rows[1:].shape)
    errors = []
    for columns, header in (
        (rows, HEADER),
        (rows[::2], HEADER.replace("contact 12 force,", "")),
    ):
        found = compare("scene.toml", saved(columns, header)).document()["rows"]
        errors += [
            row["measured_error_value"] for row in found if row["quantity"] == "arrival"
        ]
    first, second, alone = errors
    assert second == pytest.approx(np.hypot(first, alone), rel=1e-6)
    assert second > 1.05 * alone


UNITS = {"time": "s", "contact 12 force": "N", "contact 18 force": "N"}


@pytest.mark.parametrize(
    ("header", "options", "named"),
    [
        (HEADER, {"units": UNITS}, "units = 'SI'"),
        ("time,force,x", {}, "is contact 12 or contact 18; try columns="),
    ],
)
def test_bad_records_and_options_are_refused(rows, saved, header, options, named):
    with pytest.raises(SceneError, match=named):
        compare("scene.toml", saved(rows, header), **options)
