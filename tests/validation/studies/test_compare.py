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


@pytest.fixture
def files(tmp_path):
    scene, measured = tmp_path / "scene.toml", tmp_path / "measured.csv"
    scene.write_text(SCENE)
    run = simulate(read_scene(scene), rtol=1e-10)
    first, second = run.contact_force
    np.savetxt(
        measured,
        np.column_stack((run.time - LATE, first, STRONGER * (second - 0.1))),
        delimiter=",",
        header="time,contact 12 force,contact 18 dynamic force",
        comments="",
    )
    return str(scene), str(measured)


def test_a_shift_and_a_scale_come_back(capsys, files, tmp_path):
    picture = tmp_path / "p.svg"
    options = ("--format", "json", "--plot", str(picture))
    status, out, err = ended(capsys, cli.main, "compare", *files, *options)
    assert (status, err) == (0, "")
    found = json.loads(out)
    assert found["shift_value"] == pytest.approx(LATE, abs=1e-6)
    rows = {(row["number"], row["quantity"]): row for row in found["rows"]}
    assert list(rows) == [(i, name) for i in (12, 18) for name in ("arrival", "peak", "fwhm")]
    for (number, name), row in rows.items():
        scale = STRONGER if (number, name) == (18, "peak") else 1.0
        # Behind the dip after the pulse the fit's residuals hide a part of its error.
        bound = 10 * row["difference_error_value"] + 1e-9
        assert abs(row["measured_value"] - scale * row["simulated_value"]) <= bound < 1e-3
    assert "contact 12, simulated" in picture.read_text()


def test_the_clock_of_a_record_may_start_anywhere(files):
    scene, measured = files
    header, *lines = Path(measured).read_text().splitlines()
    rows = [line.split(",", 1) for line in lines]
    late = [f"{float(time) + 5000!r},{rest}" for time, rest in rows]
    Path(measured).write_text("\n".join([header, *late]) + "\n")
    assert compare(scene, measured).document()["shift_value"] == pytest.approx(
        LATE - 5000, abs=1e-6
    )


def test_a_single_sensor_needs_no_name(files, tmp_path):
    scene, measured = tmp_path / "one.toml", tmp_path / "plain.csv"
    scene.write_text(SCENE.replace("[12, 18]", "[12]"))
    lines = [line.split(",")[:2] for line in Path(files[1]).read_text().splitlines()[1:]]
    measured.write_text("\n".join(map(",".join, [["time", "force"], *lines])))
    named = compare(str(scene), files[1]).document()
    assert compare(str(scene), str(measured)).document() == named
    assert named["shift_value"] == pytest.approx(LATE, abs=1e-6)


def test_the_error_of_a_later_arrival_holds_that_of_the_shift(files):
    """Without the first sensor's column the second is the one by which records are shifted."""

    def errors():
        rows = compare(*files).document()["rows"]
        return [row["measured_error_value"] for row in rows if row["quantity"] == "arrival"]

    names, *lines = Path(files[1]).read_text().splitlines()
    rows = np.array([line.split(",") for line in lines], float)
    rows[:, 1:] += 0.005 * np.random.default_rng(7).normal(size=rows[:, 1:].shape)
    np.savetxt(files[1], rows, delimiter=",", header=names, comments="")
    first, second = errors()
    header = names.replace("contact 12 force,", "")
    np.savetxt(files[1], rows[:, [0, 2]], delimiter=",", header=header, comments="")
    (alone,) = errors()
    assert second == pytest.approx(np.hypot(first, alone), rel=1e-6)
    assert second > 1.05 * alone


RECORD = "".join(f"{t},1\n" for t in range(9))


@pytest.mark.parametrize(
    ("text", "options", "named"),
    [
        (None, {"renamed": {"contact 5 fore": "contact 12 force"}}, "column is 'contact 5 fore'"),
        (None, {"units": {"time": "s"}}, "units = 'SI'"),
        (SCENE, {}, "no line names time, force"),
        (f"time,force\n{RECORD}", {}, "no column is contact 12 force or contact 18 force$"),
        ("time,contact 12 force\n0,1\n9e6,1\n", {}, r"from 0 to 9e\+06, .* 0 to 40"),
    ],
)
def test_bad_records_and_options_are_refused(files, text, options, named):
    if text is not None:
        Path(files[1]).write_text(text)
    with pytest.raises(SceneError, match=named):
        compare(*files, **options)
