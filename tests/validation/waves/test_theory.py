"""The theory's wave as floats: against its exact form, and against quadrature."""

import numpy as np
import pytest
import sympy as sp
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import quad

from lwa import Dimer, homogenize
from validation.scenes.checks import SceneError
from validation.waves.theory import Compacton

WAVES = {
    k: homogenize(Dimer("1", "1/4", stiffnesses=(3, 3), spacing="1/2"), k=k).pde.traveling_wave()
    for k in ("3/2", "5/4", "11/10", "2")
}
waves = st.sampled_from(list(WAVES.values()))
amplitudes = st.floats(1e-3, 1e3)

ROUNDING = 1e-11  # powers up to 2/(k-1) = 20 of numbers good to some ulp


@pytest.mark.parametrize("wave", WAVES.values(), ids=WAVES)
def test_profile_and_speed_are_the_theorys(wave):
    compacton = Compacton(wave, 0.7)
    x = sp.Symbol("x")
    D, A = 0.5, 3.0
    for at in (0, "1/10", "-1/3", 5):
        v = float(wave.profile(x, "7/10").subs(x, sp.Rational(at)))
        at = float(sp.Rational(at))
        assert compacton.compression(at) == pytest.approx(D * v, rel=1e-12)
        assert compacton.velocity(at) == pytest.approx(compacton.speed * v, rel=1e-12)
        force = A * (D * v) ** float(wave.k)
        assert compacton.contact_force(at) == pytest.approx(force, rel=1e-12)
    # dx/dt = V_s τ/t, τ/t = √(2k A D^{k+1}/M)
    k = float(wave.k)
    scale = np.sqrt(2 * k * A * D ** (k + 1) / 1.25)
    assert compacton.speed == pytest.approx(float(wave.speed("7/10")) * scale, rel=1e-13)


@given(waves, amplitudes)
def test_amplitude_from_speed_force_or_momentum(wave, B):
    c = Compacton(wave, B)
    for again in (
        Compacton.of_speed(wave, c.speed),
        Compacton.of_bead_force(wave, float(c.bead_force(0.0))),
        Compacton.of_momentum(wave, c.momentum),
    ):
        assert pytest.approx(B, rel=ROUNDING) == again.B


@given(waves, amplitudes)
def test_momentum_is_the_integral_of_mass_and_velocity(wave, B):
    c = Compacton(wave, B)
    integral, _ = quad(lambda x: float(c.velocity(x)), -c.support / 2, c.support / 2)
    assert c.momentum == pytest.approx(1.25 / (2 * 0.5) * integral, rel=1e-8)


@given(waves, amplitudes)
def test_widths_are_where_the_quantities_are_half(wave, B):
    c = Compacton(wave, B)
    for quantity, signal in (
        ("strain", c.compression),
        ("force", c.contact_force),
        ("bead force", c.bead_force),
    ):
        assert signal(c.fwhm(quantity) / 2) == pytest.approx(signal(0.0) / 2, rel=ROUNDING)
    # averaging over a spacing widens and lowers the pulse
    assert c.fwhm("force") < c.fwhm("bead force") < c.fwhm("force") + c.spacing
    assert c.bead_force(0.0) < c.contact_force(0.0)


@pytest.mark.parametrize("B", [0, -1, float("nan"), float("inf"), "1"])
def test_bad_amplitudes(B):
    with pytest.raises(SceneError, match=r"^B is "):
        Compacton(WAVES["3/2"], B)


@pytest.mark.parametrize("amount", [0, -1, float("nan"), float("inf"), "1"])
@pytest.mark.parametrize("name", ["speed", "bead_force", "momentum"])
def test_bad_amounts(name, amount):
    """A speed -1 gave a wave of speed 1."""
    with pytest.raises(SceneError, match=rf"^{name.removeprefix('bead_')} is [^\n]*$"):
        getattr(Compacton, f"of_{name}")(WAVES["3/2"], amount)


@pytest.mark.parametrize("amount", [1e-300, 1e300])
def test_an_amount_whose_strain_is_no_float(amount):
    with pytest.raises(SceneError, match=r"^speed is 1e.300: the strain e\^-?\d+ is no float$"):
        Compacton.of_speed(WAVES["11/10"], amount)
