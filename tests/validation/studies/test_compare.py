"""Measured records against their scene: shifts, scales and pulses that are known."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import scipy

from tests.commands import ended
from validation import cli, simulate
from validation.scenes.scene import SceneError
from validation.scenes.scenefile import read_scene
from validation.studies.compare import compare

SCENE = """
duration = 25
precompression = 0.1
wall = {stiffness = 1}
chain = {cell = [1, 0.5], repeat = 10, k = 1.5}
striker = {velocity = 1}
sensors = {contacts = [4, 8]}
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
        header="time (s),contact 4 force (N),contact 8 dynamic force (N)",
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
    assert list(rows) == [(i, name) for i in (4, 8) for name in ("arrival", "peak", "fwhm")]
    for (number, name), row in rows.items():
        scale = STRONGER if (number, name) == (8, "peak") else 1.0
        # Behind the dip after the pulse the fit's residuals hide a part of its error.
        bound = 10 * row["difference_error_value"] + 1e-9
        assert abs(row["measured_value"] - scale * row["simulated_value"]) <= bound < 1e-3
    assert "contact 4, simulated" in picture.read_text()


def test_a_single_sensor_needs_no_name(files, tmp_path):
    scene, measured = tmp_path / "one.toml", tmp_path / "plain.csv"
    scene.write_text(SCENE.replace("[4, 8]", "[4]"))
    lines = [line.split(",")[:2] for line in Path(files[1]).read_text().splitlines()[1:]]
    measured.write_text("\n".join(map(",".join, [["time", "force (N)"], *lines])))
    named = compare(str(scene), files[1]).document()
    assert compare(str(scene), str(measured)).document() == named
    assert named["shift_value"] == pytest.approx(LATE, abs=1e-6)


def amplified(time, force, T):
    """First-order high-pass by SciPy's bilinear filter, on evenly spaced samples."""
    g = 2 * T / (time[1] - time[0])
    return scipy.signal.lfilter([g, -g], [1 + g, 1 - g], force)


def test_the_simulation_passes_the_amplifier(files, tmp_path):
    """A record through a filter of SciPy's; without the option its peaks are some percent lower."""
    T, filtered = 20.0, tmp_path / "filtered.csv"
    run = simulate(replace(read_scene(files[0]), samples=20_001), rtol=1e-10)
    columns = (run.time, *(amplified(run.time, f - 0.1, T) for f in run.contact_force))
    header = "time,contact 4 dynamic force,contact 8 dynamic force"
    np.savetxt(filtered, np.transpose(columns), delimiter=",", header=header, comments="")
    rows = compare(files[0], str(filtered), time_constant="20").document()["rows"]
    assert len(rows) == 6
    for row in rows:  # the bilinear filter errs by 1e-6
        assert row["measured_value"] == pytest.approx(row["simulated_value"], rel=2e-6)
    plain = compare(files[0], str(filtered)).document()["rows"]
    assert all(r["difference_value"] < -0.02 * r["simulated_value"] for r in plain[1::3])


@pytest.mark.parametrize(
    ("kind", "true", "guess"),
    [("contact", 0.01, 0.03), ("kuwabara_kono", 0.02, 0.005), ("restitution", 0.97, 0.9)],
)
def test_the_damping_comes_back_from_noisy_peaks(files, tmp_path, kind, true, guess):
    """Within four standard deviations; the error is below two percent of the loss."""
    text = SCENE.replace("repeat = 10", "repeat = 12").replace("[4, 8]", "[4, 8, 12, 16]")
    scene, measured = tmp_path / "damped.toml", tmp_path / "noisy.csv"
    scene.write_text(f"{text}damping = {{{kind} = {true}}}\n")
    run = simulate(replace(read_scene(scene), samples=4001), rtol=1e-8)
    noise = 0.002 * np.random.default_rng(4).normal(size=run.contact_force.shape)
    header = ",".join(["time", *(f"contact {i} force" for i in (4, 8, 12, 16))])
    columns = np.transpose((run.time, *(run.contact_force + noise)))
    np.savetxt(measured, columns, delimiter=",", header=header, comments="")
    scene.write_text(f"{text}damping = {{{kind} = {guess}}}\n")
    found = compare(str(scene), str(measured), damping=True).document()
    error = found["damping_error_value"]
    assert abs(found["damping_value"] - true) < 4 * error
    assert 0 < error < 0.02 * (1 - true if kind == "restitution" else true)


RECORD = "".join(f"{t},1\n" for t in range(9))


@pytest.mark.parametrize(
    ("text", "options", "named"),
    [
        (None, {"damping": True}, "damping is to be fitted"),
        (None, {"time_constant": "1 h"}, "time_constant is '1 h'"),
        (None, {"time_constant": "1e-9"}, "time_constant is 1e-09"),
        (None, {"renamed": {"contact 5 force": "contact 4 force"}}, "column is 'contact 5 force'"),
        (SCENE, {}, "one column time is wanted, the header has"),
        (f"time,force\n{RECORD}", {}, "no column is contact 4 force or contact 8 force$"),
        (f"time,bead 4 force\n{RECORD}", {}, "no column is contact 4 force or contact 8 force$"),
        ("time,contact 4 force\n0,1\n9e6,1\n", {}, r"from 0 to 9e\+06, .* 0 to 25"),
    ],
)
def test_bad_records_and_options_are_refused(files, text, options, named):
    if text is not None:
        Path(files[1]).write_text(text)
    with pytest.raises(SceneError, match=named):
        compare(*files, **options)
