"""The expansion's wave in a cell's own units: errors and the command."""

import json

import pytest

from lwa import Cell, ExpandedWave, InputError, expand
from lwa.command.cli import main
from tests.commands import ended

BEADS = """
[materials]
steel = {E = 193e9, nu = 0.3}
[beads]
ball = {mass = 0.45e-3, radius = 2.38e-3, material = "steel"}
[chain]
cell = ["ball"]
"""


def wave(F, **cell):
    return ExpandedWave(expand(Cell([1], **cell), 8, k="3/2"), F)


def test_the_error_of_a_time_is_that_of_width_and_speed():
    found = wave(3, spacing=1)
    width, time = found.fwhm(), found.fwhm("strain", "time")
    shares = width.error / width.value + found.speed.error / found.speed.value
    assert time.error == pytest.approx(time.value * shares, rel=1e-12)


def test_the_command_in_si_units(tmp_path, capsys):
    file = tmp_path / "beads.toml"
    file.write_text(BEADS)
    options = ("--spheres", str(file), "--force", "50", "--order", "8")
    status, out, err = ended(capsys, main, "expansion", *options, "--format", "json")
    assert (status, err) == (0, "")
    found = json.loads(out)["physical"]
    status, out, _ = ended(capsys, main, "wave", *options[:4], "--format", "json")
    leading = json.loads(out)
    # the long wave's speed is off by 1.2 % (validation's limits), its width by 5.6 %
    assert found["speed_value"] == pytest.approx(leading["speed_value"], rel=0.015)
    assert found["fwhm_value"]["force"] == pytest.approx(leading["fwhm_value"]["force"], rel=0.06)
    assert 0 < found["speed_error_value"] < 2e-5 * found["speed_value"]
    status, out, _ = ended(capsys, main, "expansion", *options)
    assert "peak contact force 50" in out


@pytest.mark.parametrize("F", [0, -1, "F", float("nan")])
def test_only_positive_forces_are_accepted(F):
    with pytest.raises(InputError, match=r"^force is "):
        wave(F, spacing=1)
    with pytest.raises(InputError, match="spacing is D: a number is wanted"):
        wave(1)
