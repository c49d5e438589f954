"""The command `lwa shock`: text, JSON, LaTeX, SI, and refusals in one line."""

import math

import pytest
import sympy as sp

from lwa import Cell, Power, piston, shock
from tests.identity import same
from tests.lwa.command.answers import STEEL_AND_PTFE, result

EQUAL = ("shock", "--masses", "1", "--spacing", "1", "--k", "3/2")


def test_edges_and_peak_of_a_loaded_chain(capsys):
    found = result(capsys, *EQUAL, "--behind", "2", "--ahead", "1")
    expected = shock(Cell([1], spacing=1), 2, 1, law=Power("3/2"))
    assert found["kind"] == "shock"
    for rule, speed in found["leading_speed_value"].items():
        assert speed == pytest.approx(float(expected.leading_speed(rule)))
        error = found["leading_speed_error_value"][rule]
        assert error == pytest.approx(speed * expected.errors[rule])
    assert found["plateau_value"] == pytest.approx(float(expected.plateau))
    for name in ("trailing_speed", "peak", "peak_force"):
        value = float(getattr(expected, name))
        assert found[f"{name}_value"] == pytest.approx(value)
        assert found[f"{name}_error_value"] == pytest.approx(value * expected.errors[name])
    assert "acosh" in found["leading_speed"]["dispersion"]
    assert "doubling" not in found["leading_speed"]
    assert "peak" not in found


def test_beyond_a_theory_stand_null_and_a_note(capsys):
    found = result(capsys, *EQUAL, "--behind", "1")
    assert found["trailing_speed_value"] is found["leading_speed_value"]["dispersion"] is None
    assert any("no sound runs there" in note for note in found["notes"])
    speed = found["series_value"]["speed"] / (1.5**0.5)
    assert speed == pytest.approx(0.8477, abs=1e-4)
    dimer = result(
        capsys, "shock", "--behind", "2", "--ahead", "1", "--masses", "1,1/2", "--k", "3/2"
    )
    assert dimer["peak_value"] is None
    assert dimer["leading_speed_value"]["dispersion"] is None
    assert dimer["plateau_value"] > 0


def test_closed_forms_stand_in_json(capsys):
    closed = result(capsys, *EQUAL, "--behind", "p")
    p = sp.Symbol("p", positive=True)
    peak = sp.sympify(closed["peak"], locals={"p": p})
    unit = shock(Cell([1], spacing=1), 1, 0, law=Power("3/2"))
    assert same(peak, p * unit.peak)
    assert set(closed["leading_speed"]) == {"doubling"}


def test_a_wall_at_a_speed_in_si(capsys, tmp_path):
    """Steel beads of 4.76 mm, a wall at 1 m/s: the pulse's speed and force are those of the lattice
    that SI scales, v ~ c p and F ~ A (D p)^k."""
    file = tmp_path / "beads.toml"
    file.write_text(STEEL_AND_PTFE.replace('"heavy", "light"', '"heavy"'))
    found = result(capsys, "shock", "--spheres", str(file), "--piston", "1")
    assert found["plateau_value"] == pytest.approx(1)
    A, m, D = 193e9 / (1 - 0.3**2) / 3 * math.sqrt(2 * 2.38e-3), 0.45e-3, 2 * 2.38e-3
    unit = (A * D**1.5 / m * D) ** 0.5  # of speed
    plain = piston(Cell([1], spacing=1), sp.Float(1 / unit), law=Power("3/2")).wave
    assert found["series_value"]["speed"] == pytest.approx(unit * plain.speed.value, rel=1e-9)
    assert found["series_value"]["force"] == pytest.approx(A * D**1.5 * float(plain.F), rel=1e-9)
    assert found["units"]["series.speed"] == "m/s"


def test_a_piston_and_a_rarefaction(capsys):
    found = result(capsys, *EQUAL, "--piston", "1", "--ahead", "1")
    assert found["plateau_value"] == pytest.approx(1)
    bare = result(capsys, *EQUAL, "--behind", "1")
    assert any("go on oscillating" in note for note in bare["notes"])
    falls = result(capsys, *EQUAL, "--behind", "1", "--ahead", "2")
    assert falls["kind"] == "rarefaction"
    assert "peak_value" not in falls
