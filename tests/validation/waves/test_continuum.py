"""The integrated long-wave equation: its waves, its dispersion, its energy, and its order."""

import numpy as np
import pytest
import sympy as sp

from lwa import Cell, Dimer, Power
from lwa.equation.evolution import Evolution
from lwa.law import named
from validation.scenes.checks import SceneError
from validation.waves.theory import Continuum


@pytest.mark.parametrize(
    ("cell", "k"), [(Cell((1,), spacing=1), "3/2"), (Dimer(1, "1/4", spacing=1), "2")]
)
def test_a_solitary_wave_goes_round_and_comes_back(cell, k):
    equation = Evolution(cell, Power(k))
    interval = Continuum(equation, 24.0, 256)
    xi = sp.Symbol("xi")
    pulse = sp.lambdify(xi, equation.profile(xi, 1), "numpy")(interval.x)
    V = float(equation.speed(1))
    p, v = interval.evolved(pulse, -V * pulse, [0, 24 / V])
    assert p[-1] == pytest.approx(pulse, abs=1e-7)
    energy = interval.energy(p, v)
    assert energy[1] == pytest.approx(energy[0], rel=1e-7)


@pytest.mark.parametrize("n", [1, 5, 60])
def test_small_waves_have_the_frequency_of_the_equation_down_to_the_grid(n):
    """cos(Ωτ) on a strain 1; short waves do not grow."""
    equation = Evolution(Cell((1,), spacing=1), Power("3/2"))
    interval = Continuum(equation, 20.0, 128)
    q = 2 * np.pi * n / 20.0
    wave = 1e-6 * np.cos(q * interval.x)
    tau = 7.0
    p, _ = interval.evolved(1 + wave, 0 * wave, [0, tau], rtol=1e-12)
    omega = float(equation.frequency(sp.Float(q, 30), 1))
    assert (p[-1] - 1) == pytest.approx(wave * np.cos(omega * tau), abs=1e-10)


def test_a_law_with_tension_is_not_cut():
    """Toda's contacts pull: a wave of both signs keeps its energy."""
    interval = Continuum(Evolution(Cell((1,), spacing=1), named("exponential", 1)), 20.0, 128)
    wave = 0.1 * np.sin(2 * np.pi * interval.x / 20)
    p, v = interval.evolved(wave, 0 * wave, [0, 30])
    energy = interval.energy(p, v)
    assert energy[1] == pytest.approx(energy[0], rel=1e-8)
    assert p[-1].min() < -0.01


def test_bad_input_is_refused():
    with pytest.raises(SceneError, match="'m1' has no value"):
        Continuum(Evolution(Dimer("m1", "m2", spacing=1), Power("3/2")), 10, 64)
    with pytest.raises(SceneError, match="length is 0"):
        Continuum(Evolution(Cell((1,), spacing=1), Power(2)), 0, 64)
    with pytest.raises(SceneError, match="points is 4"):
        Continuum(Evolution(Cell((1,), spacing=1), Power(2)), 10, 4)
