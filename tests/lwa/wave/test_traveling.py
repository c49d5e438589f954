"""The traveling wave in closed form, substituted where its derivation does not go."""

import mpmath
import pytest
import sympy as sp
from hypothesis import assume, given
from hypothesis import strategies as st

from lwa import Cell, Dimer, NoSolitaryWave, canonical_wave, homogenize
from tests.identity import same

masses = st.fractions(min_value="1/50", max_value=50, max_denominator=50)
exponents = st.fractions(min_value="21/20", max_value=6, max_denominator=20)

WAVE = homogenize(Dimer("m1", "m2")).pde.traveling_wave()
IN_UNITS = canonical_wave(Cell(["m"]), "3/2").at_force()


def number(value):
    real, imaginary = sp.N(value, 60).as_real_imag()
    return mpmath.mpc(mpmath.mpf(real), mpmath.mpf(imaginary))


def wave_at(k, m1, m2):
    try:
        return WAVE.at(k=k, m1=m1, m2=m2, D=1)
    except NoSolitaryWave:
        return None


@given(exponents, masses, masses, st.integers(0, 1))
def test_z_obeys_its_equation_for_either_root_even_complex_ones(k, m1, m2, root):
    """z = v^{1/p} put into z'' = μ z^η - σ z, at 50 digits."""
    wave = wave_at(k, m1, m2)
    assume(wave is not None)
    with mpmath.workdps(50):
        found = wave.reduction(root, V="4/3")
        p, mu, eta, sigma = map(number, (found.p, found.mu, found.eta, found.sigma))
        beta, m, B = map(number, (wave.beta, wave.m, wave.amplitude("4/3")))
        t = mpmath.mpf(2) / 5
        log_v = mpmath.log(B) + m * mpmath.log(mpmath.cos(t))
        z = mpmath.exp(log_v / p)
        # d²/dξ² of exp(log v / p), with (log v)' = -mβ tan, (log v)'' = -mβ²/cos²
        slope = -m * beta * mpmath.tan(t) / p
        second = z * (slope**2 - m * beta**2 / mpmath.cos(t) ** 2 / p)
        terms = second, mu * z**eta, sigma * z
        # 50 digits, less what the cancellation between the terms and the root p cost
        assert abs(terms[0] - terms[1] + terms[2]) < mpmath.mpf(10) ** -38 * max(map(abs, terms))


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


@pytest.mark.parametrize(
    ("k", "m1", "m2", "words"),
    [
        (1, 1, 1, "k > 1$"),
        ("1/2", 1, 1, "k > 1$"),
        (3, 1, 100, "G\\+H\\+I > 0$"),
        # k = 8/5, ω → ∞: G+H+I > 0, yet V² < 0
        ("8/5", 1, 1000, "V² > 0$"),
    ],
)
def test_no_wave_is_an_error_that_says_why(k, m1, m2, words):
    with pytest.raises(NoSolitaryWave, match=words):
        WAVE.at(k=k, m1=m1, m2=m2)
    with pytest.raises(NoSolitaryWave, match=words):
        homogenize(Dimer(m1, m2), k=k).pde.traveling_wave()


@pytest.mark.parametrize(
    ("cell", "k"),
    [
        (Dimer("m1", "m2"), "k"),
        (Cell(["m"]), "k"),
        (Cell(["m1", "m1", "m2"]), "k"),
        (Cell([1, 2, 3], [1, 8, 27]), 3),
    ],
    ids=str,
)
def test_the_canonical_wave_needs_the_dispersion_only(cell, k):
    short = canonical_wave(cell, k)
    long = homogenize(cell, 4, k=k, closure="full", field="center").pde.traveling_wave()
    k = short.k
    assert same(short.beta**2, (k - 1) ** 2 / (2 * long.I * k * (k + 1)))
    assert same(short.beta, long.beta)
    assert short.speed_factor == sp.factor(2 / (k * (k + 1)))
    assert same(long.speed_factor, short.speed_factor)
