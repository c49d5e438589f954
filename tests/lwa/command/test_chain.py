"""Chains of scene files: `lwa wave --spheres` and `lwa expansion --spheres`."""

import json

import pytest
import sympy as sp

from lwa import pulse_of_strike
from lwa.command.chain import read_chain
from tests.lwa.command.answers import result, run, said

MASSES = {
    "duration": 1e-3,
    "units": "SI",
    "precompression": 2.0,
    "chain": {
        "cell": [4.5e-4, 4.5e-4],
        "k": 1.5,
        "stiffnesses": 8.4e7,
        "spacings": 4.76e-3,
        "repeat": 19,
    },
    "wall": {"stiffness": 8.4e7},
    "damping": {"contact": 1.0},
}
BEADS = {
    "duration": 1e-3,
    "precompression": 2.0,
    "beads": {"ball": {"radius": 2.38e-3, "mass": 0.45e-3, "material": "steel 316"}},
    "chain": {"cell": ["ball"], "repeat": 38},
    "wall": {"material": "steel 316"},
}


@pytest.fixture
def scene(tmp_path):
    """Write a scene to a file, with some entries of its chain replaced."""

    def write(content, **chain):
        file = tmp_path / "scene.json"
        file.write_text(json.dumps(content | {"chain": content["chain"] | chain}))
        return str(file)

    return write


def without_load(content):
    return {key: value for key, value in content.items() if key != "precompression"}


def test_a_scene_of_masses_is_the_chain_of_its_options(capsys, scene):
    options = ("--k", "3/2", "--masses", "4.5e-4", "--stiffnesses", "8.4e7")
    options += ("--spacing", "4.76e-3", "--force", "20", "--precompression", "2")
    expected = result(capsys, "wave", *options)
    found = result(capsys, "wave", "--spheres", scene(MASSES), "--force", "20")
    assert found["units"]["speed"] == "m/s"
    for name, value in expected.items():
        if name.endswith("_value"):
            assert found[name] == pytest.approx(value, rel=1e-14), name


def test_a_load_in_the_file_speeds_the_wave_up(capsys, scene):
    loaded = result(capsys, "wave", "--spheres", scene(BEADS), "--force", "20")
    free = result(capsys, "wave", "--spheres", scene(without_load(BEADS)), "--force", "20")
    assert loaded["speed_value"] > free["speed_value"]


def test_the_cell_is_the_smallest_one_and_lengths_may_have_no_unit(scene):
    found = read_chain(scene(MASSES, cell=[1, 2, 1, 2], stiffnesses=[3, 4, 3, 4]))
    assert (found.cell.masses, found.cell.stiffnesses) == ((1, 2), (3, 4))
    bare = without_load(MASSES) | {"chain": {"cell": [1, 2, 1], "k": 2}}
    found = read_chain(scene(bare))
    assert found.cell.masses == (1, 2)
    assert found.cell.spacing.is_Symbol
    assert found.precompression == 0


def test_an_error_that_was_not_measured_is_null(capsys, tmp_path):
    """A strike at k = 6/5: beyond the exponents at which the rule's error was measured."""
    file = tmp_path / "chain.toml"
    file.write_text("[chain]\ncell = [1]\nk = 1.2\nspacings = [1]\n")
    options = ("strike", "--spheres", str(file), "--velocity", "1")
    assert result(capsys, *options)["force_error_value"] is None
    for style, words in (("text", "error unknown"), ("latex", "F &= 0.4995")):
        out = said(capsys, *options, "--format", style)
        assert words in out
        assert "NaN" not in out


def test_a_strike_in_si(capsys, scene):
    """The striker is one of the beads unless its mass is given; 0.5 m of fall are 3.13 m/s."""
    file = scene(without_load(BEADS))
    found = result(capsys, "strike", "--spheres", file, "--drop", "0.5")
    cell = read_chain(file).cell
    expected = pulse_of_strike(cell, cell.masses[0], drop="0.5")
    assert found["force_value"] == expected.force.value
    assert found["force_error_value"] == expected.force.error
    assert found["velocity_value"] == pytest.approx((2 * 9.81 * 0.5) ** 0.5)
    for extent, width in found["fwhm_value"].items():
        assert width == expected.fwhm("force", extent).value
    assert found["fwhm_value"]["length"] / found["fwhm_value"]["time"] == pytest.approx(
        found["speed_value"]
    )
    high = result(capsys, "strike", "--spheres", file, "--drop", "1e308")
    assert high["force_value"] / found["force_value"] == pytest.approx(
        1e308**0.6 * 2**0.6, rel=1e-10
    )
    heavy = ("strike", "--spheres", file, "--velocity", "1", "--mass", "2e-3")
    assert "further pulses" in result(capsys, *heavy)["notes"][0]
    out = said(capsys, *heavy)
    assert "peak contact force = " in out


def test_the_striker_of_a_file_is_the_default(capsys, scene):
    """Its velocity, and the mass of the bead that it is like; options replace them."""
    heavy = {"heavy": BEADS["beads"]["ball"] | {"mass": 0.9e-3}}
    chain = without_load(BEADS) | {"beads": BEADS["beads"] | heavy}
    file = scene(chain | {"striker": {"velocity": 1.25, "like": "heavy"}})
    named = result(capsys, "strike", "--spheres", file)
    slower = result(capsys, "strike", "--spheres", file, "--velocity", "1", "--mass", "1e-3")
    file = scene(chain)
    given = ("strike", "--spheres", file, "--velocity", "1.25", "--mass", "9e-4")
    assert named["force_value"] == result(capsys, *given)["force_value"]
    given = ("strike", "--spheres", file, "--velocity", "1", "--mass", "1e-3")
    assert slower["force_value"] == result(capsys, *given)["force_value"]
    file = scene(chain | {"striker": {"velocity": 1, "like": "wood"}})
    status, _, err = run(capsys, "strike", "--spheres", file)
    assert (status, err.count("\n"), "striker.like is 'wood'" in err) == (2, 1, True)


def test_a_blow_beyond_hertzs_contact_has_a_note(capsys, scene):
    """a/R = √(δ/2R) is 1/10 where the compression is 1/100 of the spacing."""
    file = scene(without_load(BEADS))
    cell = read_chain(file).cell
    for share, noted in (("0.009", False), ("0.011", True)):
        force = cell.stiffnesses[0] * (cell.spacing * sp.Rational(share)) ** sp.Rational(3, 2)
        found = result(capsys, "wave", "--spheres", file, "--force", f"{float(force):.10g}")
        assert ("notes" in found) == noted
    fast = result(capsys, "strike", "--spheres", file, "--velocity", "1e6")
    assert "Hertz's contact is that of elastic spheres" in fast["notes"][0]
