"""The command `lwa envelope`."""

import math

import pytest

from tests.lwa.command.answers import result, said

SPHERES = """
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


def test_a_chain_of_spheres_has_hertz_and_metres(capsys, tmp_path):
    """Aluminium and steel of 19.05 mm at 20 N: Hertz's contact and Bloch's edges by hand."""
    file = tmp_path / "spheres.toml"
    file.write_text(SPHERES)
    spheres = ("envelope", "--spheres", str(file))
    compliance = (1 - 0.33**2) / 73.5e9 + (1 - 0.3**2) / 193e9
    A = 4 / 3 * math.sqrt(9.525e-3 / 2) / compliance
    K2, static = 1.5 * A ** (2 / 3) * 20 ** (1 / 3), (20 / A) ** (2 / 3)
    heavy, light = 28.84e-3, 9.75e-3
    found = result(capsys, *spheres, "--wavenumber", "0", "--branch", "1")
    hertz = math.sqrt(K2 * (2 / heavy + 2 / light)) / (2 * math.pi)
    assert found["frequency_value"] == pytest.approx(hertz, rel=1e-12)
    assert found["units"]["frequency"] == "Hz"
    f0 = math.sqrt(2 * K2 / light) / (2 * math.pi)
    bands = result(capsys, "dispersion", "--spheres", str(file))
    edges = [0, math.sqrt(2 * K2 / heavy) / (2 * math.pi), f0, hertz]
    found_edges = [f for band in bands["band_edges_frequency_value"] for f in band]
    assert found_edges == pytest.approx(edges, rel=1e-12, abs=1e-9)
    assert f0 == pytest.approx(8101, abs=1)  # kHz: 4.711, 8.101, 9.371
    found = result(capsys, *spheres, "--frequency", f"{0.995 * f0:.17g}")
    assert found["detuning_value"] == pytest.approx(0.005, rel=1e-9)
    amplitude = static * math.sqrt(32 * 0.005 / 0.75)  # U = δ0 √(32 ν/(k (k - 1)))
    assert found["amplitude_value"] == pytest.approx([0, amplitude], rel=1e-9)
    assert found["units"]["amplitude"] == "m"
    out = said(capsys, *spheres, "--detuning", "1/200")
    assert "frequency ω/(2π) = 8101." in out
