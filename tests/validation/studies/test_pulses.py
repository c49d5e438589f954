"""Pulses of measured records: against the run that made the records, and against known pulses."""

import json

import numpy as np
import pytest

from tests.commands import ended
from validation import cli
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


@pytest.fixture
def files(tmp_path):
    scene, records = tmp_path / "scene.toml", tmp_path / "records.csv"
    scene.write_text(SCENE)
    return str(scene), str(records)


def test_the_records_of_a_run_have_the_pulses_of_the_run(capsys, files):
    scene, records = files
    options = ("--format", "json")
    status, out, _ = ended(capsys, cli.main, "run", scene, "--out", records, *options)
    wanted = json.loads(out)
    assert status == 0
    status, out, err = ended(capsys, cli.main, "pulses", records, "--distance", "2", *options)
    assert (status, err) == (0, "")
    found = json.loads(out)
    for table, names in (
        ("sensors", ("arrival_value", "peak_value", "fwhm_value", "static_force_value")),
        ("speeds", ("speed_sites_value", "speed_value")),
    ):
        assert len(found[table]) == len(wanted[table]) > 0
        for ours, theirs in zip(found[table], wanted[table], strict=True):
            assert list(ours) == list(theirs)
            assert all(ours[n] == theirs[n] for n in ("kind", "number", "from", "to") if n in ours)
            # the static force is the mean of what comes before: waves of 1e-6 run ahead
            assert [ours[n] for n in names] == pytest.approx([theirs[n] for n in names], rel=2e-5)
    rows = {(row["kind"], row["number"]): row for row in found["sensors"]}
    for leg in found["speeds"]:  # stands in the row of its second sensor, too
        assert rows[leg["kind"], leg["to"]]["speed_value"] == leg["speed_value"]


def noisy(tmp_path, header):
    """Two Gaussian pulses, 50 µs apart, of 12 and 10 N and FWHM 40 µs; times from -200 µs on."""
    t = np.arange(-200.0, 400.0)
    rng, width = np.random.default_rng(5), 40 / np.sqrt(4 * np.log(2))
    forces = [F * np.exp(-(((t - at) / width) ** 2)) for F, at in ((12, 0), (10, 50))]
    forces = [3 + f + 0.05 * rng.normal(size=len(t)) for f in forces]
    file = tmp_path / "records.csv"
    np.savetxt(file, np.transpose((t, *forces)), delimiter=",", header=header, comments="")
    return str(file)


def test_the_error_of_a_speed_is_that_of_both_arrivals(tmp_path):
    first, second = (row := pulses(noisy(tmp_path, "time,1 force,2 force")).document())["sensors"]
    (speed,) = row["speeds"]
    late = np.hypot(first["arrival_error_value"], second["arrival_error_value"])
    assert speed["speed_sites_error_value"] * 50 == pytest.approx(
        speed["speed_sites_value"] * late, rel=0.02
    )
    assert speed["speed_value"] is None


def test_a_sensor_without_a_pulse_has_no_numbers(capsys, tmp_path):
    """The reason stands in its row; a file in which no sensor has a pulse is refused."""
    file, t = tmp_path / "records.csv", np.arange(400.0)
    late, early = (np.exp(-(((t - at) / 30) ** 2)) for at in (260, 60))
    for forces, status in (((late, early), 0), ((early,), 2)):
        names = ",".join(f"{i + 1} force" for i in range(len(forces)))
        np.savetxt(file, np.transpose((t, *forces)), "%s", ",", header=f"time,{names}", comments="")
        code, out, err = ended(capsys, cli.main, "pulses", str(file), "--format", "json")
        assert code == status
        if status:
            assert "no sensor has a pulse" in err
            assert "noise" in err
        else:
            row = json.loads(out)["sensors"][1]
            assert row["peak_value"] is None
            assert "noise" in row["missing"]


@pytest.mark.parametrize(
    ("header", "options", "named"),
    [
        ("time,contact 1 strain,bead 2 force x", {}, "no line names time, force"),
        ("time,force,2 force", {}, "'force' has no number"),
        ("time,bead 2 force,bead 2 dynamic force", {}, "two columns of"),
        ("time,1 force,2 force", {"distance": "2 ft"}, "distance is '2 ft'"),
        ("time,1 force,2 force", {"of": "wall"}, "of is 'wall'"),
        ("time,1 force,x", {"renamed": {"3 sped": "x"}}, "column is '3 sped'"),
        ("time,force s,contact 1 strange force", {}, "no column is the force of a sensor"),
    ],
)
def test_bad_records_are_refused(tmp_path, header, options, named):
    with pytest.raises(SceneError) as refused:
        pulses(noisy(tmp_path, header), **options)
    assert named in str(refused.value)
    assert "\n" not in str(refused.value)
