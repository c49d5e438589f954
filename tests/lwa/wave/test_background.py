"""Waves on a background: limits, an independent integration, exact waves of two lattices."""

import math
from functools import cache, partial

import mpmath
import numpy as np
import pytest
import sympy as sp
from hypothesis import given
from hypothesis import strategies as st

from book.studies.hard import true_wave
from lwa import (
    Cell,
    Dimer,
    InputError,
    KdV,
    Law,
    Material,
    NoSolitaryWave,
    Power,
    PrecompressedWave,
    Sphere,
    background_wave,
    canonical_wave,
    general,
    homogenize,
)
from lwa.law import DELTA, named
from tests.identity import same

CHAIN = Cell([1], spacing=1)
p0, B, k = sp.symbols("p0 B k", positive=True)


def compression(cell=CHAIN, law="3/2", load=1):
    return background_wave(cell, load, law=Power(law))


@cache
def numeric_wave(k):
    return compression(law=k).numeric()


@pytest.mark.parametrize("cell", [Cell([1]), Dimer("m1", "m2"), Dimer(3, 1, N=2)])
def test_without_load_the_wave_is_the_compact_wave(cell):
    compact = canonical_wave(cell, "3/2")
    wave = compact.on_background(0)
    assert same(wave.speed(7), compact.speed(7))
    for quantity in ("strain", "force", "velocity"):
        assert sp.simplify(wave.fwhm(2, quantity) / compact.fwhm(quantity)) == 1
    one, two = (w.profile("xi", B=3) for w in (wave, compact))
    assert sp.simplify(one.args[0][0] / two.args[0][0]) == 1


def test_a_weak_wave_is_that_of_kdv():
    """The difference falls as B: speed at the order after, width by one order."""
    cell = Dimer(3, 1, spacing=1)
    errors = []
    for size in ("1/100", "1/1000"):
        wave = compression(cell, "3/2", 2)
        kdv = wave.kdv
        width = 2 * sp.acosh(sp.sqrt(2)) * kdv.width(size)
        errors.append(
            (
                abs(wave.speed(size).n(30) - kdv.speed(size).n(30)),
                abs(wave.fwhm(size) / width.n(30) - 1),
                abs(wave.profile(10, size) / kdv.profile(10, size).n(30) - 1),
            )
        )
    speed, width, profile = (float(sp.log(a / b, 10)) for a, b in zip(*errors, strict=True))
    assert speed == pytest.approx(2, abs=0.01)
    assert width == pytest.approx(1, abs=0.01)
    assert profile > 0.9


def test_kdv_in_closed_form():
    field = background_wave(Dimer("m1", "m2"))
    c0 = p0 ** ((k - 1) / 2)
    expected = KdV(c0, (k - 1) * c0 / (2 * p0), field.I * c0 / 2)
    for name in ("sound_speed", "nonlinearity", "dispersion"):
        assert same(getattr(field.kdv, name), getattr(expected, name))
    x, t = sp.symbols("x t", real=True)
    kdv = KdV(sp.Integer(3), sp.Rational(2, 5), sp.Rational(1, 7))
    v = kdv.profile(x - kdv.speed(2) * t, 2)
    left = v.diff(t) + 3 * v.diff(x) + 2 * v * v.diff(x) / 5 + v.diff(x, 3) / 7
    assert abs(left.subs({x: 1, t: sp.Rational(1, 3)}).n(30)) < 1e-25


WAVES = [
    (Power("3/2"), 1, "1/2"),
    (Power("1/2"), 1, "-1/2"),
    (named("lennard-jones", 1), 0, "1/10"),
]


@pytest.mark.parametrize(("law", "load", "rise"), WAVES, ids=str)
def test_the_profile_obeys_the_canonical_equation(law, load, rise):
    """V² v = F(p0+v) - F(p0) + I (F′ v″ + ½ F″ v′²), by a polynomial through 80 places."""
    wave, B = background_wave(CHAIN, load, law=law), float(sp.Rational(rise))
    profile = partial(wave.numeric().profile, p0=float(load), B=B)
    v = np.polynomial.Chebyshev.interpolate(profile, 79, domain=[-2, 2])
    x = np.linspace(-1, 1, 5)
    p = sp.Symbol("p", positive=True)
    F, F1, F2 = (sp.lambdify(p, wave.force(p, n))(load + v(x)) for n in range(3))
    left = float(wave.speed(rise)) ** 2 * v(x) - F + float(wave.force(sp.S(load)))
    right = float(wave.I) * (F1 * v.deriv(2)(x) + F2 * v.deriv()(x) ** 2 / 2)
    assert left == pytest.approx(right, rel=1e-7)  # v″ loses 80² of the digits of v
    half = wave.profile(wave.fwhm(rise) / 2, rise)
    assert half == pytest.approx(B / 2, rel=1e-12)


@pytest.mark.parametrize(
    ("law", "load", "rise"),
    [
        (Power("1/2"), 1.0, -0.5),
        (Power("11/10"), 0.0, 1.0),
        (Power("11/10"), 0.01, 1.0),
        (Power(5), 0.5, 1.0),
        (named("lennard-jones", 1), 0.0, 0.1),
        (named("lennard-jones", 1), 0.0, 0.8),
    ],
    ids=str,
)
def test_profiles_in_float64(law, load, rise):
    """To 1e-9 of the larger of v and B/1000, the heights at places that mpmath computes."""
    heights = rise * np.array([0.99, 0.7, 0.5, 0.3, 0.01, 1e-6])
    with mpmath.workdps(30):
        _, place, _ = true_wave(law, load, rise)
        places = [float(place(mpmath.mpf(v))) for v in heights]
    found = background_wave(CHAIN, law=law).numeric().profile(places, load, rise)
    assert np.all(np.abs(found - heights) <= 1e-9 * np.maximum(abs(heights), 1e-3 * abs(rise)))


@given(
    st.floats(-12, 12),
    st.floats(0.1, 10),
    st.sampled_from(["11/10", "3/2", "2", "5"]),
    st.sampled_from(["strain", "force"]),
)
def test_float64_over_all_loads(exponent, rise, k, quantity):
    """V² to 8 ulps and FWHM to 1e-12 of their definitions at 120 digits."""
    load = 10.0**exponent * rise
    numeric = numeric_wave(k)
    with mpmath.workdps(120):
        speed, place, height = true_wave(Power(k), load, rise)
        found = float(numeric.speed_squared(load, rise))
        assert abs(found - speed**2) <= 8 * np.spacing(found)
        expected = 2 * float(place(height if quantity == "force" else mpmath.mpf(rise) / 2))
    assert float(numeric.fwhm(load, rise, quantity)) == pytest.approx(expected, rel=1e-12)


@pytest.mark.parametrize("load", ["1e-6", "1e-2", "1"])
def test_the_foot_of_a_wave_falls_exponentially(load):
    """Far from the peak v′/v = -√((V² - c0²)/(I c0²)), by the last node of the rule and beyond."""
    wave = compression(load=load)
    rate = sp.sqrt((wave.speed(1) ** 2 / wave.sound_speed**2 - 1) / wave.I)
    far = 3 + 30 / rate.n()
    one, two = (wave.profile(x, 1) for x in (far, far + 1 / rate.n()))
    assert float(sp.log(one / two)) == pytest.approx(1, rel=1e-3)


def test_arrays_broadcast():
    numeric = numeric_wave("3/2")
    loads, rises = np.array([[0.0], [1.0], [1e6]]), np.array([0.5, 2.0])
    for function in (numeric.speed, numeric.fwhm):
        found = function(loads, rises)
        assert found.shape == (3, 2)
        assert found[1, 1] == pytest.approx(float(function(1.0, 2.0)), rel=1e-15)
    assert numeric.profile(np.zeros((2, 3)), 1.0, 1.0) == pytest.approx(np.ones((2, 3)), rel=1e-15)
    assert numeric.profile([1e3, 1e9], 0.0, 1.0).tolist() == [0.0, 0.0]


def test_nesterenkos_relation_for_equal_spheres():
    """As Daraio, Nesterenko, Herbold and Jin print it, Phys. Rev. E 73, 026610 (2006), eqs. 3–5.

    c0 with its constant 0.9314, and V_s in f_r = F_m/F_0.
    """
    E, nu, a, F0, fr = 193e9, 0.3, 4.76e-3, 2.38, 7.5
    mass = 0.45e-3
    rho = mass / (math.pi * a**3 / 6)
    steel = Material(E=str(E), nu=str(nu))
    chain = Cell.of_spheres([Sphere(mass=str(mass), radius=str(a / 2), material=steel)])
    wave = canonical_wave(chain, "3/2").at_force(F0 * fr, precompression=F0)
    sound = (4 * E**2 * F0 / (a**2 * rho**3 * (1 - nu**2) ** 2)) ** (1 / 6)
    assert float(wave.sound_speed) / sound == pytest.approx(0.9314, abs=1e-4)  # printed, cut off
    root = math.sqrt(4 / 15 * (3 + 2 * fr ** (5 / 3) - 5 * fr ** (2 / 3)))
    printed = root / (fr ** (2 / 3) - 1)
    assert float(wave.speed / wave.sound_speed) == pytest.approx(printed, rel=1e-13)
    zeta = sp.Symbol("zeta", positive=True)
    V2 = compression(load=1).stiffness(zeta - 1)
    relation = sp.Rational(4, 15) * (3 + 2 * zeta ** sp.Rational(5, 2) - 5 * zeta) / (zeta - 1) ** 2
    assert same(V2, relation)


def exact_speed_squared(force, slope, guess, height, length, points=160):
    """c² of the chain's own wave R of this height: c² R″ = F(R)(x+1) - 2F(R) + F(R)(x-1).

    In Fourier space c² R = sinc²(q/2) F(R); Newton on even R over [0, length] and c², with R(0)
    fixed, is spectrally accurate.
    """
    j = np.arange(points + 1)
    x = j * length / points
    cosines = np.cos(np.pi * np.outer(j, j) / points)
    smear = cosines @ np.diag(np.sinc(j / (2 * length)) ** 2) @ np.linalg.inv(cosines)
    R, c2 = guess(x), 1 + abs(height) / 3
    for _ in range(30):
        residual = np.append(c2 * R - smear @ force(R), R[0] - height)
        jacobian = np.block(
            [[c2 * np.eye(points + 1) - smear * slope(R), R[:, None]], [np.eye(1, points + 1), 0.0]]
        )
        step = np.linalg.solve(jacobian, -residual)
        R, c2 = R + step[:-1], c2 + step[-1]
        if np.abs(step).max() < 1e-13:
            return c2
    raise AssertionError("no wave was found")


@pytest.mark.parametrize(("alpha", "beta"), [(1, 0), (0, 1), ("1/2", 1)])
def test_the_lattices_own_wave_of_fermi_pasta_ulam_and_tsingou(alpha, beta):
    """Newton on the lattice; the error falls as the fourth power of the inverse width."""
    law = named("polynomial", alpha, beta)
    a, b = float(sp.Rational(alpha)), float(beta)
    wave = background_wave(CHAIN, 0, law=law)
    force = lambda R: R + a * R**2 + b * R**3  # noqa: E731
    slope = lambda R: 1 + 2 * a * R + 3 * b * R**2  # noqa: E731
    found = []
    for height in (0.04, 0.02) if alpha else (0.12, 0.06):
        width = float(wave.numeric().fwhm(0.0, height))
        guess = lambda x, h=height: wave.numeric().profile(x, 0.0, h)  # noqa: E731
        exact = exact_speed_squared(force, slope, guess, height, 11 * width)
        found.append((width, abs(exact - float(wave.speed(height)) ** 2)))
    (w1, e1), (w2, e2) = found
    assert math.log(e1 / e2) / math.log(w2 / w1) == pytest.approx(4, abs=0.12)
    assert e2 > 1e-9  # above rounding


def test_waves_exist_on_the_stiffening_side_only():
    cases = [
        (Power("3/2"), 1, "-1/2", "only B > 0"),
        (Power("1/2"), 1, "1/2", "only B < 0"),
        (Power("1/2"), 1, -1, "would open"),
        (Power("1/2"), 0, -1, "no load"),
        (Power(1), 1, 1, "linear"),
        (named("polynomial", 1, 0), 0, "-1/10", "does not stiffen"),
        (named("polynomial", -1, 0), 0, "7/10", "not positive"),
        (named("polynomial", 1, -1), 0, "67/100", "does not stiffen"),
    ]
    for law, load, rise, reason in cases:
        wave = background_wave(CHAIN, load, law=law)
        with pytest.raises(NoSolitaryWave, match=reason):
            wave.speed(rise)
        with pytest.raises(NoSolitaryWave, match=reason):
            wave.numeric().speed([load, load], float(sp.Rational(rise)))
    with pytest.raises(NoSolitaryWave, match="no sound"):
        _ = compression(load=0).kdv


def test_a_law_that_begins_as_a_power_has_waves_without_a_load():
    """V² = 2W(B)/B² at any B, and the width of a small wave."""
    wave = background_wave(CHAIN, 0, law=named("hertz2", 1, 1))
    for B in map(sp.Rational, ("1e-30", "1e-3", "1")):
        square = 2 * (B ** sp.Rational(5, 2) / 5 + B ** sp.Rational(7, 2) / 7) * 2 / B**2
        assert abs(sp.N(wave.speed(B) ** 2 / square, 30) - 1) < 1e-14
        assert wave.numeric().speed_squared(0, float(B)) == pytest.approx(float(square), rel=1e-14)
    width = float(canonical_wave(CHAIN, "3/2").fwhm())
    assert float(wave.fwhm("1e-30")) == pytest.approx(width, rel=1e-12)


def test_a_slope_whose_terms_cancel_is_not_called_negative():
    """1 - cos δ is 0 in floats below 1e-8; a larger wave on a load is that of δ³/6."""
    wave = background_wave(CHAIN, 0, law=Law(DELTA - sp.sin(DELTA)))
    exact = background_wave(CHAIN, 1, law=Power(3)).speed("1e-3") / sp.sqrt(2)
    assert float(wave.on("1e-2").speed("1e-5")) == pytest.approx(float(exact) * 1e-2, rel=1e-4)
    for call in (lambda: wave.speed("1e-3"), lambda: wave.numeric().speed(0, 1e-3)):
        with pytest.raises(NoSolitaryWave, match="cancel"):
            call()


def test_bad_arguments_are_refused():
    wave = background_wave(Cell(["m"]), law=Power("3/2"))
    for call, reason in (
        (lambda: compression(load=-1), "must not be negative"),
        (lambda: wave.speed(0), "B is 0"),
        (lambda: wave.fwhm(1), "has no value"),
        (lambda: compression().fwhm(1, "colour"), "quantity"),
        (lambda: background_wave(CHAIN, 1, law=general()).fwhm(1), "no expression"),
        (lambda: compression().profile("x", 1), "has no value"),
        (lambda: background_wave(Cell([1]), "B"), "means the peak strain"),
        (lambda: background_wave(Dimer(1, 1, stiffnesses=[1, 2]), law=general()), "shares"),
        (lambda: background_wave(Cell([1]), law=Power("k")).numeric(), "has no value"),
        (lambda: numeric_wave("3/2").speed(math.nan, 1.0), "finite"),
        (lambda: canonical_wave(Cell([1]), 2).at_force(1, precompression=-1), "positive"),
        (lambda: PrecompressedWave(CHAIN, named("polynomial", -1, 0), 2, 1).speed, "not reach"),
        (lambda: homogenize(Dimer(1, 2)).pde.traveling_wave().on_background(1), "canonical"),
    ):
        with pytest.raises(InputError, match=reason):
            call()


def test_in_space_and_time():
    """Without load, and in symbols; tests/lwa/links has the numbers of unlike contacts."""
    cell = Dimer(2, 1, stiffnesses=[3, 5], spacing="1/2")
    light = canonical_wave(cell, "3/2").at_force(7, precompression="1e-30")
    free = canonical_wave(cell, "3/2").at_force(7)
    assert float(light.speed) == pytest.approx(float(free.speed), rel=1e-12)
    assert canonical_wave(cell, "3/2").at_force(7, precompression=0) == free
    symbolic = canonical_wave(Cell(["m"], ["A"]), "3/2").at_force("F", precompression="F0")
    numbers = symbolic.at(m=2, A=3, F=7, F0=2, D=1)
    assert numbers == canonical_wave(Cell([2], [3], 1), "3/2").at_force(7, precompression=2)
