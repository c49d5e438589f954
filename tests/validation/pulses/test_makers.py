"""Files as recorders and programs write them, read to the pulses they hold.

Pulses at two contacts, in N or in volts of 12.5 N, each microsecond, with noise of half a percent.
"""

import json
import math
import shlex
import tomllib
from pathlib import Path

import numpy as np
import pytest
from scipy.signal import lfilter

from tests.commands import ended
from validation import cli
from validation.scenes.checks import SceneError
from validation.studies.records import pulses

ARRIVALS = {8: 2.5e-4, 14: 4.3e-4}  # in s, from the blow
PEAKS = {8: 41.2, 14: 40.9}  # in N
WIDTH = 55e-6  # FWHM in s
SPACING = 19.05e-3
CLOCK = 1_764_237_753  # s
TRIGGER = 1.9e-4  # time at which the clock of the recorder is 0
CONSTANT = 1e-3  # of a sensor that loses its charge


@pytest.fixture(scope="module")
def record():
    """Times by the recorder's clock, and noisy forces at both contacts: Gaussian pulses."""
    rng = np.random.default_rng(2)
    t = np.linspace(0, 7e-4, 701)
    forces = []
    for contact, peak in PEAKS.items():
        x = (t - ARRIVALS[contact]) / WIDTH
        noise = 0.005 * peak * rng.normal(size=len(t))
        forces.append(peak * np.exp(-4 * math.log(2) * x**2) + noise)
    return t - TRIGGER, np.array(forces)


LAYOUTS = tomllib.loads(Path(__file__).with_name("layouts.toml").read_text("utf-8"))


def written(layout, record):
    """Write the record in a layout to the folder; return the file's name."""
    time, forces = record
    given = LAYOUTS[layout]
    *_, last = forms = given["rows"]
    kept = math.exp(-1e-6 / CONSTANT)
    lost = lfilter(math.sqrt(kept) * np.array([1, -1]), [1, -kept], forces[0])
    lines = []
    for i, row in enumerate(zip(time, *forces / 12.5, *forces, lost, strict=True)):
        numbers = dict(zip("tabFGQ", row, strict=True))
        numbers |= {"i": i, "us": 1e6 * row[0], "late": CLOCK + row[0]}
        numbers["milli"] = 1e3 * numbers["F"]
        form = forms[i] if i < len(forms) else last
        lines.append(form.format(**numbers))
    lines.append(given.get("end", ""))
    text = given["head"] + "\n".join(lines)
    for plain, other in given.get("other", {}).items():
        text = text.replace(plain, other)
    Path("record.txt").write_bytes(text.encode("latin-1"))
    return "record.txt"


@pytest.mark.parametrize("layout", LAYOUTS)
def test_pulses_are_read_within_three_errors(capsys, record, folder, layout):
    """A column without a kind is of the kind that is given; by a step the clock starts at 0."""
    given = LAYOUTS[layout]
    stated = given["options"]
    line = ["pulses", written(layout, record), *shlex.split(stated), "--of", "bead"]
    line += ["--distance", str(SPACING), "--format", "json"]
    status, out, err = ended(capsys, cli.main, *line)
    assert status == 0, err
    found = json.loads(out)
    both = "14 force" in stated + given["head"]
    assert [row["kind"] for row in found["sensors"]] == ["bead"] * (1 + both)
    start = TRIGGER - given.get("clock", 0)
    if "--step" in stated:
        start = 0.0
    for row in found["sensors"]:
        arrival, peak = ARRIVALS[row["number"]] - start, PEAKS[row["number"]]
        for name, value, size in (
            ("arrival", arrival, WIDTH),
            ("peak", peak, peak),
            ("fwhm", WIDTH, WIDTH),
        ):
            off = row[f"{name}_value"] - value
            assert abs(off) < 3 * row[f"{name}_error_value"] < 0.03 * size, name
    for row in found["speeds"]:
        speed = 6 * SPACING / (ARRIVALS[14] - ARRIVALS[8])
        error = row["speed_error_value"]
        assert abs(row["speed_value"] - speed) < 3 * error < 0.02 * speed


@pytest.mark.parametrize("layout", LAYOUTS)
def test_a_refusal_ends_in_the_line_that_reads_the_file(record, folder, capsys, layout):
    """At most two lines are pasted; a gap or a name that is not there needs the user's own word."""
    line = ["pulses", written(layout, record)]
    refused = []
    status = 2
    while status == 2 and len(refused) < 3:
        status, _, err = ended(capsys, cli.main, *line)
        if status == 2:
            reason, _, proposed = err.partition("; try: ")
            assert reason not in refused
            refused.append(reason)
            assert proposed, err
            # A step that the file does not tell is the user's own.
            _, *line = shlex.split(proposed.replace("'? us'", "'1 us'"))
    assert status == 0, refused


def test_sensors_without_numbers_are_numbered_in_the_order_of_files_and_columns(
    record, folder
):
    time, forces = record
    files = ("a.csv", "b.csv")
    for file, force in zip(files, forces, strict=True):
        np.savetxt(file, np.c_[time, force], delimiter=",")
    header = "time (s),force (N),force (N)"
    np.savetxt("c.csv", np.c_[time, *forces], delimiter=",", header=header)
    stated = {"columns": {"time": "1", "force": "2"}, "units": {"time": "s", "2": "N"}}
    # Names of one column are those of the files in turn.
    turns = {**stated, "columns": {"time": "1", "8 force": "2", "14 force": "2"}}
    for given, options, numbers in (
        (files, stated, [1, 2]),
        (files, turns, [8, 14]),
        ("c.csv", {}, [1, 2]),
    ):
        found = pulses(given, **options).document()["sensors"]
        assert [row["number"] for row in found] == numbers
        peaks = [row["peak_value"] for row in found]
        assert peaks == pytest.approx([*PEAKS.values()], rel=0.01)
    # An unknown sensitivity moves no arrival.
    unknown, _ = pulses("c.csv", units={"2": "? N/V"}).document()["sensors"]
    assert unknown["peak_value"] is None
    assert unknown["arrival_value"] == pytest.approx(found[0]["arrival_value"])
    with pytest.raises(SceneError, match="bead 3 is there twice"):
        pulses(files, columns={"time": "1", "bead 3 force": "2"})
