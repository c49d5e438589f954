"""Pulses of measured records: against the run that made the records, and against known pulses."""

import json

import numpy as np
import pytest

from tests.commands import ended
from validation import cli
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


def test_the_records_of_a_run_have_the_pulses_of_the_run(capsys, folder):
    (folder / "scene.toml").write_text(SCENE)
    wanted, found = (
        json.loads(ended(capsys, cli.main, *line.split(), "--format", "json")[1])
        for line in (
            "run scene.toml --out records.csv",
            "pulses records.csv --distance 2",
        )
    )
    for table, names in (
        (
            "sensors",
            ("arrival_value", "peak_value", "fwhm_value", "static_force_value"),
        ),
        ("speeds", ("speed_sites_value", "speed_value")),
    ):
        assert len(found[table]) == len(wanted[table]) > 0
        for ours, theirs in zip(found[table], wanted[table], strict=True):
            assert list(ours) == list(theirs)
            assert all(
                ours[n] == theirs[n]
                for n in ("kind", "number", "from", "to")
                if n in ours
            )
            # the static force is the mean of what comes before: waves of 1e-6 run ahead
            assert [ours[n] for n in names] == pytest.approx(
                [theirs[n] for n in names], rel=2e-5
            )
    rows = {(row["kind"], row["number"]): row for row in found["sensors"]}
    for leg in found["speeds"]:  # stands in the row of its second sensor, too
        assert rows[leg["kind"], leg["to"]]["speed_value"] == leg["speed_value"]


def noisy(header):
    """Two Gaussian pulses, 50 µs apart, of 12 and 10 N and FWHM 40 µs; times from -200 µs on."""
    t = np.arange(-200.0, 400.0)
    rng, width = np.random.default_rng(5), 40 / np.sqrt(4 * np.log(2))
    forces = [F * np.exp(-(((t - at) / width) ** 2)) for F, at in ((12, 0), (10, 50))]
    forces = [3 + f + 0.05 * rng.normal(size=len(t)) for f in forces]
    return saved((t, *forces), header)


def saved(columns, header):
    """Save columns to a file of the current folder; return its name."""
    np.savetxt(
        "records.csv", np.transpose(columns), delimiter=",", header=header, comments=""
    )
    return "records.csv"


def test_the_error_of_a_speed_is_that_of_both_arrivals(folder):
    first, second = (row := pulses(noisy("time,1 force,2 force")).document())["sensors"]
    (speed,) = row["speeds"]
    late = np.hypot(first["arrival_error_value"], second["arrival_error_value"])
    assert speed["speed_sites_error_value"] * 50 == pytest.approx(
        speed["speed_sites_value"] * late, rel=0.02
    )
    assert speed["speed_value"] is None


def test_a_sensor_without_a_pulse_has_no_numbers(folder):
    """The reason stands in its row; a file in which no sensor has a pulse is refused."""
    t = np.arange(400.0)
    pulse = np.exp(-(((t - 260) / 30) ** 2))
    table = saved((t, pulse, 0 * t), "time,1 force,2 force")
    row = pulses(table).document()["sensors"][1]
    assert row["peak_value"] is None
    assert "constant" in row["missing"]
    with pytest.raises(MeasureError, match=r"no sensor has a pulse: .* constant"):
        pulses(saved((t, 0 * t), "time,1 force"))


@pytest.mark.parametrize(
    ("header", "options", "named"),
    [
        ("time,force,2 force", {}, "each of several sensors needs its number"),
        ("time,1 force,2 force", {"distance": "2 ft"}, "distance is '2 ft'"),
        ("time,1 force,2 force", {"of": "wall"}, "of is 'wall'"),
    ],
)
def test_bad_records_are_refused(folder, header, options, named):
    with pytest.raises(SceneError, match=rf"^[^\n]*{named}[^\n]*$"):
        pulses(noisy(header), **options)


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


def test_forces_of_falling_beads_count_from_the_start(capsys, folder):
    """Beads that fall carry no static load at the start: one rule for run, pulses and compare."""
    (folder / "fall.toml").write_text(FALLING)
    found = []
    for line in ("run fall.toml --out fall.csv", "pulses fall.csv"):
        _, out, _ = ended(capsys, cli.main, *line.split(), "--format", "json")
        found.append(json.loads(out)["sensors"])
    for ours, theirs in zip(*found, strict=True):
        assert ours["static_force_value"] == theirs["static_force_value"] == 0
        for name in ("arrival", "peak", "fwhm"):
            error = ours[f"{name}_error_value"] + theirs[f"{name}_error_value"]
            assert abs(ours[f"{name}_value"] - theirs[f"{name}_value"]) < error
    _, out, _ = ended(
        capsys, cli.main, "compare", "fall.toml", "fall.csv", "--format", "json"
    )
    for row in json.loads(out)["rows"]:
        assert abs(row["difference_value"]) <= row["difference_error_value"]
