"""The theory's waves of a given momentum, and the width of the force inside a bead."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import quad

from lwa import Dimer, homogenize
from validation.scenes.checks import SceneError
from validation.studies.paper import bead_fwhm, of_momentum

WAVES = {
    k: homogenize(
        Dimer("1", "1/4", stiffnesses=(3, 3), spacing="1/2"), k=k
    ).pde.traveling_wave()
    for k in ("3/2", "5/4", "11/10", "2")
}
waves = st.sampled_from(list(WAVES.values()))
amounts = st.floats(1e-3, 1e3)


@given(waves, amounts)
def test_the_wave_has_the_momentum_it_was_made_of(wave, amount):
    found = float(of_momentum(wave, amount).momentum)
    assert found == pytest.approx(
        amount, rel=1e-11
    )  # powers up to 2k/(k-1) = 22 of some ulp


@pytest.mark.parametrize("wave", WAVES.values(), ids=WAVES)
def test_momentum_is_the_integral_of_mass_and_velocity(wave):
    physical = wave.at_force(2)
    V, end = float(physical.speed), float(wave.width) / 2
    integral, _ = quad(lambda x: float(physical.curve(-x / V, "velocity")), -end, end)
    assert float(physical.momentum) == pytest.approx(
        1.25 / (2 * 0.5) * integral, rel=1e-8
    )


@pytest.mark.parametrize("wave", WAVES.values(), ids=WAVES)
def test_the_width_inside_a_bead_is_where_both_arches_are_half_of_their_peak(wave):
    """The sum of two arches of a contact, cos^p(β(x ± D/2)), at half of its value at 0."""
    width = bead_fwhm(wave.at_force(2))
    beta, power, D = (float(x) for x in (wave.beta, 2 * wave.k / (wave.k - 1), wave.D))

    def force(x):
        phases = beta * (x + np.array([-D / 2, D / 2]))
        return (np.cos(phases[np.abs(phases) < np.pi / 2]) ** power).sum()

    assert force(width / 2) == pytest.approx(force(0) / 2, rel=1e-11)
    assert float(wave.fwhm("force")) < width < float(wave.fwhm("force")) + D


def test_bad_amounts():
    for amount in (0, float("nan"), "1"):
        with pytest.raises(SceneError, match=r"^momentum is [^\n]*$"):
            of_momentum(WAVES["3/2"], amount)
