"""Measured records against their scene: shifts, scales and pulses that are known."""

import json
from pathlib import Path

import numpy as np
import pytest

from tests.commands import ended
from validation import cli, simulate
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
def files(folder):
    Path("scene.toml").write_text(SCENE)
    run = simulate(read_scene("scene.toml"), rtol=1e-10)
    first, second = run.contact_force
    save(np.column_stack((run.time - LATE, first, STRONGER * (second - 0.1))))
    return "scene.toml", "measured.csv"


def save(rows, header=HEADER):
    np.savetxt("measured.csv", rows, delimiter=",", header=header, comments="")


def saved():
    return np.loadtxt("measured.csv", delimiter=",", skiprows=1)


def test_a_shift_and_a_scale_come_back(capsys, files):
    options = ("--format", "json", "--plot", "p.svg")
    status, out, err = ended(capsys, cli.main, "compare", *files, *options)
    assert (status, err) == (0, "")
    found = json.loads(out)
    assert found["shift_value"] == pytest.approx(LATE, abs=1e-6)
    rows = {(row["number"], row["quantity"]): row for row in found["rows"]}
    assert list(rows) == [
        (i, name) for i in (12, 18) for name in ("arrival", "peak", "fwhm")
    ]
    for (number, quantity), row in rows.items():
        scale = STRONGER if (number, quantity) == (18, "peak") else 1.0
        errors = [row[f"{name}_error_value"] for name in ("simulated", "measured")]
        assert row["difference_error_value"] == pytest.approx(sum(errors), rel=1e-12)
        # Behind the dip after the pulse the fit's residuals hide a part of its error.
        bound = 10 * row["difference_error_value"] + 1e-9
        assert (
            abs(row["measured_value"] - scale * row["simulated_value"]) <= bound < 1e-3
        )
    assert "contact 12, simulated" in Path("p.svg").read_text()


def test_a_single_sensor_needs_no_name_and_the_clock_starts_anywhere(files):
    Path("scene.toml").write_text(SCENE.replace("[12, 18]", "[12]"))
    rows, named = saved(), compare(*files).document()
    save(rows[:, :2], "time,force")
    assert compare(*files).document() == named
    save(np.add(rows, (5000, 0, 0)))
    assert compare(*files).document()["shift_value"] == pytest.approx(
        LATE - 5000, abs=1e-6
    )


def test_the_error_of_a_later_arrival_holds_that_of_the_shift(files):
    """Without the first sensor's column the second is the one by which records are shifted."""
    rows, errors = saved(), []
    rows[:, 1:] += 0.005 * np.random.default_rng(7).normal(size=rows[:, 1:].shape)
    for columns, header in (
        ([0, 1, 2], HEADER),
        ([0, 2], HEADER.replace("contact 12 force,", "")),
    ):
        save(rows[:, columns], header)
        found = compare(*files).document()["rows"]
        errors += [
            row["measured_error_value"] for row in found if row["quantity"] == "arrival"
        ]
    first, second, alone = errors
    assert second == pytest.approx(np.hypot(first, alone), rel=1e-6)
    assert second > 1.05 * alone


FALL = """
duration = 4
samples = 4001
gravity = 9.81
wall = {stiffness = 1000}
chain = {cell = [1], repeat = 5, k = 1, stiffnesses = 1000}
start = {displacements = [-5.5, -4.5, -3.5, -2.5, -1.5]}
sensors = {beads = [1, 2, 3, 4, 5]}
"""


def test_forces_of_a_fall_count_from_the_start(capsys, folder):
    """Beads above a floor carry no weight before they meet: the record begins without any."""
    Path("scene.toml").write_text(FALL)
    _, pulses, compared = (
        json.loads(ended(capsys, cli.main, *line.split(), "--format", "json")[1])
        for line in (
            "run scene.toml --out measured.csv",
            "pulses measured.csv",
            "compare scene.toml measured.csv",
        )
    )
    peaks = {}
    assert len(compared["rows"]) == 15
    for row in compared["rows"]:
        assert abs(row["difference_value"]) <= row["difference_error_value"]
        if row["quantity"] == "peak":
            peaks[row["number"]] = row["simulated_value"], row["simulated_error_value"]
    for sensor in pulses["sensors"]:
        peak, error = peaks[sensor["number"]]
        assert sensor["static_force_value"] == 0
        assert abs(sensor["peak_value"] - peak) <= error + sensor["peak_error_value"]


UNITS = {"time": "s", "contact 12 force": "N", "contact 18 force": "N"}
RECORD = "".join(f"{t},1\n" for t in range(9))


@pytest.mark.parametrize(
    ("text", "options", "named"),
    [
        (None, {"units": UNITS}, "units = 'SI'"),
        (f"time,force\n{RECORD}", {}, "is contact 12 or contact 18; try columns="),
    ],
)
def test_bad_records_and_options_are_refused(files, text, options, named):
    if text is not None:
        Path(files[1]).write_text(text)
    with pytest.raises(SceneError, match=named):
        compare(*files, **options)
