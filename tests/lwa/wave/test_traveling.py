"""The traveling wave in closed form, substituted where its derivation does not go."""

import mpmath
import sympy as sp
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from lwa import Cell, Dimer, NoSolitaryWave, canonical_wave, homogenize
from lwa.base.frozen import QUANTITIES

masses = st.fractions(min_value="1/50", max_value=50, max_denominator=50)
exponents = st.fractions(min_value="21/20", max_value=6, max_denominator=20)

WAVE = homogenize(Dimer("m1", "m2")).pde.traveling_wave()


def number(value):
    real, imaginary = sp.N(value, 60).as_real_imag()
    return mpmath.mpc(mpmath.mpf(real), mpmath.mpf(imaginary))


def wave_at(k, m1, m2):
    try:
        return WAVE.at(k=k, m1=m1, m2=m2, D=1)
    except NoSolitaryWave:
        return None


def test_complex_roots_do_occur_and_leave_beta_real():
    wave = WAVE.at(k=3, m1=1, m2=2)
    assert not any(sp.N(root).is_real for root in wave.roots)
    assert wave.beta.is_real
    # here H = 0 as well, so that a = (3 - k + H/I) p - 2 does not depend on p
    assert wave.reduction().a == -2


@given(exponents, masses, masses)
def test_fwhm_is_where_the_profile_falls_to_half(k, m1, m2):
    wave = wave_at(k, m1, m2)
    assume(wave is not None)
    with mpmath.workdps(40):
        for quantity, power in (("strain", 1), ("force", wave.k), ("velocity", 1)):
            xi = wave.fwhm(quantity) / 2
            value = number(wave.profile(xi, 3) / 3) ** number(power)
            assert abs(value - mpmath.mpf(1) / 2) < mpmath.mpf(10) ** -35


def rationals(low, high):
    return st.fractions(low, high, max_denominator=100).map(sp.Rational)


reals = rationals("1/100", 1000)
beads = st.lists(st.tuples(reals, reals), min_size=1, max_size=3)


def close(found, wanted):
    return abs(sp.N(found, 40) / sp.N(wanted, 40) - 1) < 1e-34


@settings(max_examples=4)
@given(beads, reals, rationals("21/20", 4), reals)
def test_compression_speed_and_times_are_those_of_the_force(beads, D, k, F):
    """The strain is the mean of the contacts under F; widths in time are lengths over the speed."""
    masses, stiffnesses = zip(*beads, strict=True)
    wave = canonical_wave(Cell(masses, stiffnesses, D), k)
    found = wave.at_force(F)
    assert close(
        sum((F / A) ** (1 / k) for A in stiffnesses), len(masses) * D * found.strain
    )
    assert close(found.compression, D * found.strain)
    assert close(found.speed, wave.speed(found.strain) * wave.time_scale)
    assert close(found.bead_velocity, found.speed * wave.profile(0, found.strain))
    for quantity in QUANTITIES:
        assert found.fwhm(quantity) == wave.fwhm(quantity)
        assert close(found.fwhm(quantity, "time") * found.speed, found.fwhm(quantity))


def test_masses_over_the_whole_range_of_floats():
    """β at ω → ∞; SymPy fails to take square roots of integers beyond 2^1024."""
    wave = homogenize(Dimer("1e-300", "1e300", spacing=1), k="3/2").pde.traveling_wave()
    assert close(wave.beta, sp.sqrt(sp.Rational(3, 8)))
