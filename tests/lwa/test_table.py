"""A law through points: smooth, rising, exact for powers, and good wherever a law is."""

import pickle

import mpmath
import numpy as np
import pytest
import sympy as sp
from hypothesis import given
from hypothesis import strategies as st

from lwa import Cell, InputError, background_wave, homogenize, shock
from lwa.base.quantities import NoSolitaryWave
from lwa.base.splines import ForceSpline
from lwa.law import DELTA, Law, named

CHAIN = Cell([1], spacing=1)


def table(function, low=0.01, high=10.0, count=40):
    places = np.geomspace(low, high, count)
    return Law.table(places, function(places))


def test_a_power_comes_back_to_rounding():
    """In SI: A δ^{3/2} with A = 3e9, from δ = 1e-9, far below the first point, to the last one."""
    places = np.geomspace(1e-7, 1e-5, 7)
    spline = ForceSpline.through(places, 3e9 * places**1.5)
    d = np.geomspace(1e-9, 1e-5, 301)
    exact = {-2: np.sqrt(4.5e9) * d**1.25 / 1.25, -1: 1.2e9 * d**2.5, 0: 3e9 * d**1.5}
    exact |= {1: 4.5e9 * np.sqrt(d), 2: 2.25e9 / np.sqrt(d)}
    for order, values in exact.items():
        assert spline(order, d) == pytest.approx(values, rel=1e-12), order


@given(st.lists(st.tuples(*2 * [st.floats(0.1, 1.0)]), min_size=4, max_size=20))
def test_any_rising_points_give_a_smooth_rising_force(steps):
    """F through the points, F′ > 0 between them, F, F′ and F″ continuous at them."""
    places, forces = np.cumsum(steps, axis=0).T
    spline = ForceSpline.through(places, forces)
    assert spline(0, places) == pytest.approx(forces, rel=1e-12)
    fine = np.geomspace(places[0] / 4, places[-1] * (1 - 1e-9), 400)
    assert (spline(1, fine) > 0).all()
    for order in (0, 1, 2):
        inner, size = places[:-1], np.abs(spline(order, fine)).max()
        jump = spline(order, inner * (1 - 1e-10)) - spline(order, inner * (1 + 1e-10))
        assert np.abs(jump).max() <= 1e-7 * size, order


@given(st.lists(st.tuples(*2 * [st.floats(0.3, 1.0)]), min_size=4, max_size=12))
def test_derivatives_and_integrals_belong_together(steps):
    """F = W′, F′, and √F′ of the integral, by central differences, 1e-5 wide."""
    places, forces = np.cumsum(steps, axis=0).T
    spline = ForceSpline.through(places, forces)
    d = np.geomspace(places[0] / 4, places[-1] * 0.999, 400)
    h = 1e-5 * d
    for order, rate in ((-1, spline(0, d)), (0, spline(1, d)), (-2, np.sqrt(spline(1, d)))):
        slope = (spline(order, d + h) - spline(order, d - h)) / (2 * h)
        assert np.abs(slope - rate).max() < 1e-4 * rate.max(), order


def test_numbers_of_mpmath_are_those_of_floats():
    spline = ForceSpline.through((1.0, 2.0, 3.0, 5.0), (1.0, 3.0, 7.0, 8.0))
    with mpmath.workdps(30):
        for place in (0.5, 1.0, 2.7, 5.0):
            for order in (-2, -1, 0, 1, 2):
                exact = spline(order, mpmath.mpf(place))
                assert float(exact) == pytest.approx(float(spline(order, place)), rel=1e-13)
        assert mpmath.isnan(spline(0, mpmath.mpf(6)))
        assert spline(0, mpmath.mpf(-1)) == spline(0, mpmath.mpf(0)) == 0
    assert np.isnan(spline(0, 5.001))
    assert spline(1, -1.0) == 0


def test_a_table_is_a_value():
    law, same = (table(lambda d: d**1.5) for _ in range(2))
    assert law == same == pickle.loads(pickle.dumps(law))
    assert hash(law) == hash(same)
    assert law != table(lambda d: d**2)
    assert law.points[0][-1] == 10
    assert eval(repr(law), {"Law": Law}) == law
    assert (str(law.slope()), str(law.energy)) == ("table′(delta)", "∫table(delta)")
    assert law.F.diff(DELTA, 2) == law.slope(2)
    assert law.at(sp.S.Half, 1) == pytest.approx(1.5 * 0.5**0.5, rel=1e-12)
    assert law.at(sp.S.Zero, 1) == 0
    assert law.replaced({}) == law


@pytest.mark.parametrize(("p0", "B"), [(0.1, 2.0), (1.0, 4.0), (0.5, 0.01)])
def test_waves_are_those_of_the_law_it_was_made_of(p0, B):
    """F = δ^{3/2} + δ^{5/2} at 80 points: its waves, by the law itself, to 3e-5."""
    law = named("hertz2", 1, 1)
    ours = background_wave(CHAIN, p0, law=table(lambda d: d**1.5 + d**2.5, count=80))
    exact = background_wave(CHAIN, p0, law=law)
    assert float(ours.speed(B)) == pytest.approx(float(exact.speed(B)), rel=1e-6)
    for quantity in ("strain", "force"):
        width = float(exact.fwhm(B, quantity))
        assert float(ours.fwhm(B, quantity)) == pytest.approx(width, rel=3e-5)
    assert float(ours.profile(0.7, B)) == pytest.approx(float(exact.profile(0.7, B)), rel=3e-5)
    assert float(ours.kdv.nonlinearity) == pytest.approx(float(exact.kdv.nonlinearity), rel=5e-3)


def test_a_shock_is_that_of_the_law_it_was_made_of():
    ours = shock(CHAIN, table(lambda d: d**1.5 + d**2.5, count=80), 0.6, 0.3)
    exact = shock(CHAIN, named("hertz2", 1, 1), 0.6, 0.3)
    for name in ("plateau", "rise", "peak"):
        assert float(getattr(ours, name)) == pytest.approx(float(getattr(exact, name)), rel=1e-6)


@pytest.mark.parametrize(
    ("compressions", "forces", "named_value"),
    [
        ((1, 2, 3), (1, 2, 3), "compressions holds 3"),
        (5, (1, 2, 3, 4), "compressions is 5"),
        ((1, 2, 3, 4), (1, 2, 3, 4, 5), "4 compressions and 5 forces"),
        ((1, 2, 2, 4), (1, 2, 3, 4), "compressions has 2 after 2"),
        ((1, 2, 3, 4), (1, 3, 2, 4), "forces has 2 after 3"),
        ((0, 1, 2, 3), (1, 2, 3, 4), "compressions has 0 after 0"),
        ((1, 2, 3, 4), (-1, 2, 3, 4), "forces has -1 after 0"),
        ((1, 2, 3, float("nan")), (1, 2, 3, 4), "compressions number 4 is nan"),
        ((1, 2, 3, "x"), (1, 2, 3, 4), "compressions number 4 is 'x'"),
    ],
)
def test_bad_tables_are_refused(compressions, forces, named_value):
    with pytest.raises(InputError, match=named_value):
        Law.table(compressions, forces)


def test_beyond_the_last_point_and_beyond_the_second_derivative_is_refused():
    law = table(lambda d: d**1.5, high=1.0)
    with pytest.raises(InputError, match=r"compression is 2: the table ends at 1\.0"):
        law.at(sp.Integer(2))
    with pytest.raises(InputError, match="does not reach it"):
        law.compression(CHAIN, sp.Integer(3))
    wave = background_wave(CHAIN, "1/2", law=law)
    for compute in (wave.speed, wave.fwhm):
        with pytest.raises(NoSolitaryWave):
            compute("3/5")
    with pytest.raises(InputError, match="higher derivatives"):
        law.slope(3)
    theory = homogenize(CHAIN, law=law, order=4)  # in φ_2, φ_3, as under any law
    assert "phi3" in str(theory.pde.G)
