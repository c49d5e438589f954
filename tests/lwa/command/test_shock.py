"""The command `lwa shock`: text, JSON, LaTeX, SI, and refusals in one line."""

import math

import pytest
import sympy as sp

from lwa import Cell, Power, piston, shock
from tests.identity import same
from tests.lwa.command.answers import STEEL_AND_PTFE, result

EQUAL = ("shock", "--masses", "1", "--spacing", "1", "--k", "3/2")


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
    plain = piston(Cell([1], spacing=1), sp.Float(1 / unit), law=Power("3/2"))
    speed = unit * float(plain.leading_speed())
    assert found["leading_speed_value"]["doubling"] == pytest.approx(speed, rel=1e-9)
    force = A * D**1.5 * float(plain.peak_force)
    assert found["peak_force_value"] == pytest.approx(force, rel=1e-9)
    assert found["units"]["peak_force"] == "N"
