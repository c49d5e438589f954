"""The command `lwa` for other laws and for chains under load."""

import math

import pytest
import sympy as sp

from lwa import Cell, Dimer, Power, canonical_wave, loaded_wave
from tests.lwa.command.answers import result, run, said


def test_derive_a_named_law(capsys):
    found = result(capsys, "derive", "--law", "hertz2:1,1/2", "--masses", "1", "--order", "6")
    assert found["law"] == "delta**(5/2)/2 + delta**(3/2)"
    assert set(found["phi"]) == {"2", "3", "4", "5"}
    out = said(capsys, "derive", "--law", "hertz2:1,1/2")
    assert "phi2 = (15*delta + 6)/(10*delta + 12)" in out
    assert "F' u_xx + G F' u_x^-2 u_xx^3" in out
    out = said(capsys, "derive", "--law", "exponential", "--format", "latex")
    assert r"F' u_{xx} + G F' u_{x}^{-2} u_{xx}^{3}" in out
    assert result(capsys, "derive", "--law", "power:3/2") == result(capsys, "derive", "--k", "3/2")


def test_wave_on_a_background(capsys):
    found = result(capsys, "wave", "--k", "3/2", "--masses", "1,3", "--background", "1/10")
    wave = loaded_wave(Dimer(1, 3), rise=1, background="1/10", law=Power("3/2"))
    field = wave.field
    assert found["background"] == "1/10"
    assert found["speed"] == str(field.speed(field.rise))
    assert found["speed_value"] == pytest.approx(float(field.speed(sp.S.One)), rel=1e-15)
    for quantity, width in found["fwhm_value"].items():
        expected = wave.fwhm(quantity) / field.cell.spacing
        assert width == pytest.approx(float(expected), rel=1e-14)
    out = said(capsys, "wave", "--k", "3/2", "--masses", "1,3", "--background", "1/10")
    assert "FWHM of the strain at B = 1 = 2.67192774562 D\n" in out  # twelve digits are right
    options = ("--masses", "1", "--background", "p0", "--format", "latex")
    out = said(capsys, "wave", *options)
    assert all(part in out for part in (r"V_{s} &= ", r"c_{0} &= ", "p_{0} &= p_{0}"))
    kdv = field.kdv
    assert found["kdv"] == {
        "sound_speed": str(kdv.sound_speed),
        "nonlinearity": str(kdv.nonlinearity),
        "dispersion": str(kdv.dispersion),
        "speed": str(kdv.speed()),
        "width": str(kdv.width()),
    }
    symbolic = result(capsys, "wave", "--background", "p0")
    field = loaded_wave(Dimer("m1", "m2"), background="p0").field
    assert symbolic["speed"] == str(field.speed(field.rise))
    assert "speed_value" not in symbolic


@pytest.mark.parametrize("load", ["--background", "--precompression"])
def test_a_load_of_zero_changes_nothing(capsys, load):
    options = ("wave", "--k", "3/2", "--masses", "1,2", "--format", "json")
    assert run(capsys, *options, load, "0") == run(capsys, *options)


def test_softening_has_no_wave_of_that_height_and_no_value(capsys):
    found = result(capsys, "wave", "--k", "1/2", "--masses", "1", "--background", "1")
    assert "speed_value" not in found
    assert sp.sympify(found["speed"]).subs("B", -0.5) > 0
    assert found["kdv"]["width"] == "sqrt(2)*D*sqrt(-1/B)"
    assert found["kdv_value"]["width"] == pytest.approx(2**0.5)  # at B = -1
    out = said(capsys, "wave", "--k", "1/2", "--masses", "1", "--background", "1")
    assert "B < 0" in out
    assert "*I" not in out
    soft = ("wave", "--law", "polynomial:-1/2,0", "--masses", "1", "--background", "0")
    assert "speed_value" not in result(capsys, *soft)
    compact = result(capsys, "wave", "--law", "hertz2:1,1", "--masses", "1", "--background", "0")
    assert compact["kdv"] is None


def test_wave_in_forces(capsys):
    options = ("--k", "3/2", "--masses", "2", "--stiffnesses", "5", "--spacing", "1/100")
    found = result(capsys, "wave", *options, "--precompression", "3", "--force", "10")
    wave = canonical_wave(Cell([2], [5], "1/100"), "3/2").at_force(10, precompression=3)
    assert found["speed_value"] == pytest.approx(float(wave.speed), rel=1e-14)
    assert found["sound_speed_value"] == pytest.approx(float(wave.sound_speed), rel=1e-14)
    for extent, name in (("length", "fwhm_value"), ("time", "fwhm_time_value")):
        expected = {q: float(wave.fwhm(q, extent)) for q in ("strain", "force", "velocity")}
        assert found[name] == pytest.approx(expected, rel=1e-14)
    out = said(capsys, "wave", *options, "--precompression", "3", "--force", "10")
    assert f"{sp.N(wave.speed, 15)}"[:16] in out


def test_the_canonical_numbers_stand_beside_the_linear_closures(capsys):
    """The lattice's pulse at the paper's masses has the speed 1.705 and the FWHM 2.50."""
    options = ("wave", "--k", "3/2", "--spacing", "1")
    for force in ((), ("--force", "1")):
        light, heavy = (
            result(capsys, *options, "--masses", masses, *force)
            for masses in ("0.123,0.45", "0.45,0.123")
        )
        assert light["speed_value"] < 0.6 * heavy["speed_value"]
        assert light["canonical"]["speed_value"] == heavy["canonical"]["speed_value"]
        assert light["canonical"]["fwhm_value"] == heavy["canonical"]["fwhm_value"]
    assert heavy["canonical"]["speed_value"] == pytest.approx(1.705, rel=0.02)
    assert heavy["canonical"]["fwhm_value"]["force"] == pytest.approx(2.50, rel=0.17)
    full = (*options, "--masses", "0.123,0.45", "--closure", "full", "--field", "center")
    own = result(capsys, *full, "--force", "1")
    assert "canonical" not in own
    assert own["speed_value"] == pytest.approx(heavy["canonical"]["speed_value"], rel=1e-14)
    out = said(capsys, *options, "--masses", "0.123,0.45", "--force", "1")
    assert "dx/dt 1.67102, FWHM of the force 2.09636" in out


def test_bands_in_si(capsys):
    """ω of the diatomic chain's band edges, √(2K/m), with K = (3/2) A^{2/3} F0^{1/3}."""
    heavy, light, A, F0 = 0.45e-3, 0.123e-3, 1e9, 2.0
    options = ("--stiffnesses", "1e9,1e9", "--spacing", "0.00476", "--precompression", "2")
    found = result(capsys, "dispersion", "--masses", f"{heavy},{light}", *options)
    K = 1.5 * A ** (2 / 3) * F0 ** (1 / 3)
    edges = [
        [0, math.sqrt(2 * K / heavy)],
        [math.sqrt(2 * K / light), math.sqrt(2 * K * (1 / heavy + 1 / light))],
    ]
    for row, expected in zip(found["band_edges_value"], edges, strict=True):
        assert row == pytest.approx(expected, rel=1e-13, abs=1e-9)
    assert found["gaps_value"][0] == pytest.approx([edges[0][1], edges[1][0]], rel=1e-13)
    sound = 0.00476 * math.sqrt(2 * K / (heavy + light))
    assert found["sound_speed_value"] == pytest.approx(sound, rel=1e-13)
    first, last = found["branches_value"][0], found["branches_value"][-1]
    assert first["group_velocities"] == pytest.approx([sound, 0], rel=1e-12, abs=1e-6)
    assert last["frequencies"] == pytest.approx([edges[0][1], edges[1][0]], rel=1e-12)
    out = said(capsys, "dispersion", "--masses", "1", "--precompression", "2")
    assert "band 1" in out
    symbolic = result(capsys, "dispersion", "--precompression", "F0")
    assert "band_edges_value" not in symbolic
