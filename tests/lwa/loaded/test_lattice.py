"""Lattices: static states, the Bloch coefficient, closed forms with symbols, refusals."""

import mpmath
import numpy as np
import pytest
import sympy as sp
from hypothesis import given, settings, strategies as st

from lwa import Lattice, Law, Link, Power, loaded_wave
from lwa.law import DELTA, named
from tests.lwa.linear.exact import squares

HERTZ = Power("3/2")
SQUARED = Power(2)
A, C, F = sp.symbols("A C F", positive=True)


SPRING = Law(DELTA)  # also pulls
SHORT = mpmath.mpf(10) ** -10


def springs_of(*ends):
    return [Link(i, j, SPRING, factor) for i, j, factor in ends]


@mpmath.workdps(60)
def bloch(masses, springs):
    """I and c² by Ω²/q² = c² (1 - I q² + …) at q = 1e-10 and twice that."""
    one, two = (squares(masses, springs, q)[0] / q**2 for q in (SHORT, 2 * SHORT))
    return float((one - two) / (3 * one * SHORT**2)), float(one)


springs = st.floats(0.2, 5)


@settings(max_examples=16)
@given(st.data())
def test_the_coefficient_is_that_of_the_bloch_branch(data):
    """Random cells of P = 1 … 4 particles, links of range 1 … 3 in any order, and eigenvalues."""
    P = data.draw(st.integers(1, 4))
    ends = [(i, i + 1, data.draw(springs)) for i in range(P)]
    for _ in range(data.draw(st.integers(0, 3))):
        i = data.draw(st.integers(0, P - 1))
        ends.append((i, i + data.draw(st.integers(1, 3)), data.draw(springs)))
    masses = [data.draw(springs) for _ in range(P)]
    lattice = Lattice(masses, springs_of(*data.draw(st.permutations(ends))))
    I, square = bloch(masses, ends)
    found = lattice.statics.samples(np.array(1.0))
    # I is a difference of terms of the size P²/12 < 2.
    assert found.dispersion == pytest.approx(I, rel=1e-12, abs=1e-13)
    assert found.slope / float(lattice.mass) == pytest.approx(square, rel=1e-12)


@pytest.mark.parametrize(("K2", "digits"), [(5, 1e-14), (5e6, 1e-9), (5e14, 1e-7)])
def test_the_coefficient_of_a_pair_in_closed_form(K2, digits):
    """Half of the digits at least are left, however unlike the springs."""
    m1, m2, K1 = 1, 2, 3 / 4  # a spring 3 counts by its cosine 1/2 squared
    expected = (K1**2 + K2**2) * (m1 + m2) ** 2
    expected += 2 * K1 * K2 * (m1**2 - 4 * m1 * m2 + m2**2)
    expected /= 3 * (K1 + K2) ** 2 * (m1 + m2) ** 2
    links = [Link(0, 1, Power(1), 3, "1/2"), Link(1, 2, Power(1), K2)]
    found = Lattice([m1, m2], links).statics.samples(np.array(1.0))
    assert found.dispersion == pytest.approx(expected, rel=digits)
    assert found.slope == pytest.approx(2 * K1 * K2 / (K1 + K2), rel=digits)


def test_hertz_and_linear_contacts_in_turn():
    """V² = 2A^{2/3}C (5A^{2/3}F² + 4C F^{5/3}) / (5 (A^{2/3}F + C F^{2/3})²)."""
    pair = Lattice([1, 1], [Link(0, 1, HERTZ, A), Link(1, 2, Power(1), C)])
    a = A ** sp.Rational(2, 3)
    top = 2 * a * C * (5 * a * F**2 + 4 * C * F ** sp.Rational(5, 3))
    expected = top / (5 * (a * F + C * F ** sp.Rational(2, 3)) ** 2)
    wave = loaded_wave(pair, force=F)
    assert sp.simplify(wave.speed**2 / expected) == 1
    assert wave.sound_speed == 0
    links = [Link(0, 1, HERTZ, 2), Link(1, 2, Power(1), 3)]
    number = loaded_wave(Lattice([1, 1], links), force="5/4")
    known = float(wave.speed.subs({A: 2, C: 3, F: sp.Rational(5, 4)})) ** 2
    assert number._quadrature.square == pytest.approx(known, rel=2e-14)


@pytest.mark.parametrize("force", ["1/1000", "1", "40"])
def test_static_states_balance(force):
    """The links of a cell that are not in series: equilibrium, mean force and its slopes."""
    law = named("hertz2", 1, "1/2")
    ends = [(0, 1, HERTZ), (1, 2, law), (2, 3, SQUARED), (0, 2, law), (1, 4, HERTZ)]
    links = [Link(i, j, kind, 2) for i, j, kind in ends]
    lattice, F = Lattice([1, 2, 3], links), float(sp.Rational(force))
    state = lattice.equilibrium(force)
    net, mean = np.zeros(3), 0.0
    for link, delta in zip(links, state.compressions, strict=True):
        pushed = 2 * float(link.law.at(delta))
        net[link.i] -= pushed
        net[link.j % 3] += pushed
        mean += (link.j - link.i) * pushed / 3
    assert np.abs(net).max() < 1e-13 * F
    assert mean == pytest.approx(F, rel=1e-13)
    statics, e = lattice.statics, float(state.strain)
    h = 1e-4 * e
    below, here, above = statics.force(np.array([e - h, e, e + h]))
    F1, F2, _ = statics.samples(np.array(e))
    # h² and rounding over h
    assert (above - below) / (2 * h) == pytest.approx(F1, rel=1e-7)
    assert (above - 2 * here + below) / h**2 == pytest.approx(F2, rel=1e-6)
