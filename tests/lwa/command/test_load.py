"""The command `lwa` for other laws and for chains under load."""

import math
import re

import pytest

from tests.lwa.command.answers import result, run, said


@pytest.mark.parametrize("load", ["--background", "--precompression"])
def test_a_load_of_zero_changes_nothing(capsys, load):
    options = ("wave", "--k", "3/2", "--masses", "1,2", "--format", "json")
    assert run(capsys, *options, load, "0") == run(capsys, *options)


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
    assert re.search("dx/dt = .* 1.67102\n  FWHM of the force = .* 2.09636", out)


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
    sound = 0.00476 * math.sqrt(2 * K / (heavy + light))
    assert found["sound_speed_value"] == pytest.approx(sound, rel=1e-13)
