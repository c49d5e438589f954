"""Colliding pulses: the equation against the lattice, and symmetries of both."""

import numpy as np
import pytest
import sympy as sp

from book.studies.collision import Continuum, collision
from lwa import Cell, Dimer, Power
from lwa.loaded.background import Background

ONE = Cell((1,), spacing=1)


def rows(document):
    return {(row["k"], row["quantity"]): row for row in document["rows"]}


@pytest.fixture(scope="module")
def hertz():
    return collision(exponents=(sp.Rational(3, 2),)).document()


def test_the_equation_is_the_lattice_in_all_but_its_widths(hertz):
    assert hertz["ok"]
    found = {quantity: row["error_value"] for (_, quantity), row in rows(hertz).items()}
    assert found["speed"] == pytest.approx(-0.0122, abs=1e-4)
    assert found["FWHM of strain (sites)"] == pytest.approx(-0.189, abs=1e-3)
    assert abs(found["strain at x = 0, at most"]) < 0.01
    assert abs(found["strain after the collision"]) < 0.004


def test_a_collision_pushes_both_pulses_ahead(hertz):
    for side in ("equation", "lattice"):
        row = rows(hertz)["3/2", "shift by the collision (sites)"]
        assert 0.1 < row[f"{side}_value"] < 0.4
        assert row[f"{side}_error_value"] < 1e-4


@pytest.mark.slow
def test_nearer_to_k_1_the_equation_is_better(hertz):
    """A quarter of the width's error, a twentieth of the speed's, a third of the shift's."""
    near = rows(collision(exponents=(sp.Rational(11, 10),)).document())
    for (_, quantity), row in rows(hertz).items():
        assert abs(near["11/10", quantity]["error_value"]) < abs(row["error_value"]), (
            quantity
        )


# The equation by itself


@pytest.mark.parametrize(
    ("cell", "k"), [(ONE, "3/2"), (Dimer(1, "1/4", spacing=1), "2")]
)
def test_a_solitary_wave_goes_round_and_comes_back(cell, k):
    equation = Background(cell, Power(k), 0)
    interval = Continuum(equation, 24.0, 256)
    power = sp.Rational(k) - 1
    pulse = np.cosh(float(power / (2 * sp.sqrt(equation.I))) * interval.x) ** float(
        -2 / power
    )
    V = float(equation.speed(sp.S.One))
    p, v = interval.evolved(pulse, -V * pulse, [0, 24 / V])
    assert p[-1] == pytest.approx(pulse, abs=1e-7)
    energy = interval.energy(p, v)
    assert energy[1] == pytest.approx(energy[0], rel=1e-7)
