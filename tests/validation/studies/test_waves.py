"""The theory's waves of a given momentum, and the width of the force inside a bead."""

import numpy as np
import pytest
from scipy.integrate import quad

from lwa import Dimer, homogenize
from validation.studies.paper import bead_fwhm, of_momentum

CELL = Dimer("1", "1/4", stiffnesses=(3, 3), spacing="1/2")
every_wave = pytest.mark.parametrize("k", ["3/2", "5/4", "11/10", "2"])


def wave_of(k):
    return homogenize(CELL, k=k).pde.traveling_wave()


@every_wave
@pytest.mark.parametrize("amount", [1e-3, 700.0])
def test_the_wave_has_the_momentum_it_was_made_of(k, amount):
    """The integral of mass and velocity; powers up to 2k/(k-1) = 22 of some ulp."""
    physical = of_momentum(wave_of(k), amount)
    assert float(physical.momentum) == pytest.approx(amount, rel=1e-11)
    V, end = float(physical.speed), float(physical.wave.width) / 2
    integral, _ = quad(lambda x: float(physical.curve(-x / V, "velocity")), -end, end)
    density = 1.25 / (2 * 0.5)  # mass of a cell over its length
    assert amount == pytest.approx(density * integral, rel=1e-8)


@every_wave
def test_the_width_inside_a_bead_is_where_both_arches_are_half_of_their_peak(k):
    """The sum of two arches of a contact, cos^p(β(x ± D/2)), at half of its value at 0."""
    wave = wave_of(k)
    width = bead_fwhm(wave.at_force(2))
    beta, power, D = (float(x) for x in (wave.beta, 2 * wave.k / (wave.k - 1), wave.D))

    def force(x):
        phases = beta * (x + np.array([-D / 2, D / 2]))
        return (np.cos(phases[np.abs(phases) < np.pi / 2]) ** power).sum()

    assert force(width / 2) == pytest.approx(force(0) / 2, rel=1e-11)
    assert float(wave.fwhm("force")) < width < float(wave.fwhm("force")) + D
