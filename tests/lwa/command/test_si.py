"""Chains of files, in SI: values of Python and numbers worked by hand, units, loads, strikers."""

import json
import math

import numpy as np
import pytest
import sympy as sp

import lwa
from lwa import LoadedChain, pulse_of_strike
from lwa.command.chain import read_chain
from tests.lwa.command.answers import STEEL_AND_PTFE, result, said

CHAIN = {
    "cell": [4.5e-4, 4.5e-4],
    "k": 1.5,
    "stiffnesses": 8.4e7,
    "spacings": 4.76e-3,
    "repeat": 19,
}
MASSES = {"duration": 1e-3, "units": "SI", "precompression": 2.0, "chain": CHAIN}
MASSES |= {"wall": {"stiffness": 8.4e7}, "damping": {"contact": 1.0}}
ALUMINIUM = """
precompression = 20
[materials]
steel = {E = 193e9, nu = 0.3}
aluminium = {E = 73.5e9, nu = 0.33}
[beads]
heavy = {mass = 28.84e-3, radius = 9.525e-3, material = "steel"}
light = {mass = 9.75e-3, radius = 9.525e-3, material = "aluminium"}
[chain]
cell = ["heavy", "light"]
"""
ONE_KIND = STEEL_AND_PTFE.replace('"heavy", "light"', '"heavy"')


@pytest.fixture
def file(tmp_path):
    """Write a file of a chain: TOML, or an object as JSON; the fixture returns its path."""

    def write(content):
        path = tmp_path / ("chain.toml" if isinstance(content, str) else "chain.json")
        path.write_text(content if isinstance(content, str) else json.dumps(content))
        return str(path)

    return write


def test_a_scene_of_masses_is_the_chain_of_its_options(capsys, file):
    options = "--k 3/2 --masses 4.5e-4 --stiffnesses 8.4e7 --spacing 4.76e-3 --precompression 2"
    expected = result(capsys, "wave", *options.split(), "--force", "20")
    found = result(capsys, "wave", "--spheres", file(MASSES), "--force", "20")
    assert found["units"]["speed"] == "m/s"
    for name, value in expected.items():
        if name.endswith("_value"):
            assert found[name] == pytest.approx(value, rel=1e-14), name


def test_the_cell_is_the_smallest_one_and_lengths_may_have_no_unit(file):
    chain = CHAIN | {"cell": [1, 2, 1, 2], "stiffnesses": [3, 4, 3, 4]}
    found = read_chain(file(MASSES | {"chain": chain}))
    assert (found.cell.masses, found.cell.stiffnesses) == ((1, 2), (3, 4))
    found = read_chain(file({"chain": {"cell": [1, 2, 1], "k": 2}}))
    assert (found.cell.masses, found.precompression) == ((1, 2), None)
    assert found.cell.spacing.is_Symbol


def test_a_stiffness_has_a_unit_under_powers_alone(file):
    bare = {name: value for name, value in CHAIN.items() if name != "k"}
    for law, stiffness in (
        ("hertz", "8.4e+07 N/m^(3/2);"),
        ("hertz2:1,2", "8.4e+07;"),
    ):
        chain = bare | {"law": law}
        assert f"A = {stiffness}" in read_chain(file(MASSES | {"chain": chain})).text


def test_a_wave_of_spheres_has_the_values_of_python(capsys, file):
    options = ("wave", "--spheres", file(STEEL_AND_PTFE))
    cell = read_chain(options[-1]).cell
    found = result(capsys, *options, "--force", "10")
    lattice = lwa.lattice_wave(cell, k="3/2", force=10)
    for name in ("speed", "momentum", "energy"):
        estimate = lattice.estimate(name)
        assert found["lattice"][f"{name}_value"] == estimate.value
        assert found["lattice"][f"{name}_error_value"] == estimate.error
    symbolic = result(capsys, *options)
    unit = symbolic["speed_value"]
    assert unit == pytest.approx(found["speed_value"] / 10 ** (1 / 6), rel=1e-14)
    # The command's own text, which SymPy is promised to read.
    speed = float(sp.sympify(symbolic["speed"]).subs("F", 1))
    assert speed == pytest.approx(unit, rel=1e-14)
    out = said(capsys, *options)
    A = float(cell.stiffnesses[0])
    for words in ("450 mg, 123 mg", f"A = {A:.6g} N/m^(3/2)", "D = 4.76 mm"):
        assert words in out
    assert f"{unit:.6g} F^(1/6) m/s" in out


FACTORS = {
    "": 1.0, "kg": 1e3, "m": 1e3, "s": 1e3, "N": 1.0, "m/s": 1.0, "1/m": 1e-3, "Hz": 1e-3,
    "cells/s": 1e-3, "cells²/s": 1e-3, "1/(s kg m²)": 1e-12,
}  # fmt: skip
"""Numbers in grams, millimetres and milliseconds over those in SI; N are N, and E is in 10^6 Pa."""


@pytest.mark.parametrize(
    "line",
    [
        "wave --force 10",
        "wave --force 10 --precompression 1",
        "envelope --precompression 20 --detuning 1/200",
        "shock --piston 1 --ahead 1e-4",
        "strike --velocity 1",
    ],
)
def test_the_units_are_what_the_values_are_in(capsys, file, line):
    content = STEEL_AND_PTFE if line[0] in "we" else ONE_KIND
    small = content.replace("e9", "e3")
    for length in ("2.38", "0.45", "0.123"):
        small = small.replace(f"{length}e-3", length)
    command, *options = line.split()
    ours, theirs = (
        result(capsys, command, "--spheres", file(text), *options)
        for text in (content, small)
    )
    for key, value in ours.items():
        name = key.removesuffix("_value")
        if name == key:
            continue
        units = ours["units"].get(name.removesuffix("_error"), "")
        pairs = [(value, theirs[key], units)]
        if isinstance(value, dict):
            pairs = [(value[i], theirs[key][i], units[i]) for i in value]
        for one, two, unit in pairs:
            expected = one and pytest.approx(np.multiply(FACTORS[unit], one), rel=1e-13)
            assert two == expected, key


def test_bands_and_breathers_have_hertz_and_metres(capsys, file):
    """Aluminium and steel of 19.05 mm at 20 N, as the chain of this load has them."""
    spheres = file(ALUMINIUM)
    chain = read_chain(spheres)
    loaded = LoadedChain(chain.cell, chain.law, 20)
    edges = loaded.bands.edges()
    in_hertz = edges / (2 * math.pi)
    bands = result(capsys, "dispersion", "--spheres", spheres)
    assert bands["band_edges_value"] == edges.tolist()
    assert bands["band_edges_frequency_value"] == in_hertz.tolist()
    assert bands["sound_speed_value"] == float(loaded.sound_speed)
    envelope = ("envelope", "--spheres", spheres)
    found = result(capsys, *envelope, "--frequency", f"{0.995 * in_hertz[1, 0]:.17g}")
    assert found["detuning_value"] == pytest.approx(0.005, rel=1e-9)
    # U = δ0 √(32 ν/(k (k - 1)))
    static = float(chain.law.compression(chain.cell, chain.precompression))
    amplitude = static * math.sqrt(32 * 0.005 / 0.75)
    assert found["amplitude_value"] == pytest.approx([0, amplitude], rel=1e-9)
    assert found["units"]["amplitude"] == "m"
    assert "frequency ω/(2π) = 8.101" in said(capsys, *envelope, "--detuning", "1/200")


def test_a_strike(capsys, file):
    """The striker is one of the beads unless its mass is given; 0.5 m of fall are 3.13 m/s."""
    strike = ("strike", "--spheres", file(ONE_KIND))
    found = result(capsys, *strike, "--drop", "0.5")
    cell = read_chain(strike[-1]).cell
    expected = pulse_of_strike(cell, cell.masses[0], drop="0.5")
    assert found["force_value"] == expected.force.value
    assert found["force_error_value"] == expected.force.error
    assert found["velocity_value"] == pytest.approx((2 * 9.81 * 0.5) ** 0.5)
    for extent, width in found["fwhm_value"].items():
        assert width == expected.fwhm("force", extent).value
    length, time = (found["fwhm_value"][extent] for extent in ("length", "time"))
    assert length / time == pytest.approx(found["speed_value"])
    high = result(capsys, *strike, "--drop", "1e308")
    ratio = high["force_value"] / found["force_value"]
    assert ratio == pytest.approx(1e308**0.6 * 2**0.6, rel=1e-10)
    heavy = result(capsys, *strike, "--velocity", "1", "--mass", "2e-3")
    assert "further pulses" in heavy["notes"][0]


def test_the_striker_of_a_file_is_the_default(capsys, file):
    """Its velocity, and the mass of the bead that it is like; options replace them."""
    striker = ONE_KIND + '[striker]\nvelocity = 1.25\nlike = "light"\n'
    for given in ((), ("--velocity", "1"), ("--mass", "1e-3")):
        named = result(capsys, "strike", "--spheres", file(striker), *given)
        options = ("--velocity", "1.25", "--mass", "0.123e-3", *given)
        plain = result(capsys, "strike", "--spheres", file(ONE_KIND), *options)
        assert named["force_value"] == plain["force_value"]


def test_a_blow_beyond_hertzs_contact_has_a_note(capsys, file):
    """a/R = √(δ/2R) is 1/10 where the compression is 1/100 of the spacing."""
    spheres = ("--spheres", file(ONE_KIND))
    cell = read_chain(spheres[-1]).cell
    for share, noted in ((0.009, False), (0.011, True)):
        force = float(cell.stiffnesses[0]) * (share * float(cell.spacing)) ** 1.5
        found = result(capsys, "wave", *spheres, "--force", f"{force:.10g}")
        assert ("notes" in found) == noted
    fast = result(capsys, "strike", *spheres, "--velocity", "1e6")
    assert "Hertz's contact is that of elastic spheres" in fast["notes"][0]


def test_an_error_that_was_not_measured_is_null(capsys, file):
    """A strike at k = 6/5: beyond the exponents at which the rule's error was measured."""
    chain = file("[chain]\ncell = [1]\nk = 1.2\nspacings = [1]\n")
    options = ("strike", "--spheres", chain, "--velocity", "1")
    assert result(capsys, *options)["force_error_value"] is None
    for style, words in (("text", "error unknown"), ("latex", "F &= 0.5186")):
        out = said(capsys, *options, "--format", style)
        assert words in out
        assert "NaN" not in out
