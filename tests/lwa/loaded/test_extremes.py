"""Waves under a load where floats lose digits: poles, open contacts, steep laws, limits."""

import math

import mpmath
import numpy as np
import pytest
import sympy as sp

from book.studies.hard import true_wave
from lwa import Cell, Lattice, Law, Link, Power, Resonator, canonical_wave, loaded_wave
from lwa.base.exact import number
from lwa.law import DELTA, named

CHAIN = Cell([1], spacing=1)
HERTZ = Power("3/2")
LIMITED = Law(
    DELTA + DELTA**2 - DELTA**3
)  # Q(v) = 1 + 2v/3 - v²/2 about 0: waves up to 2/3

CASES = [
    (Power("1/2"), 1, -0.999),
    (Power("11/10"), 0, 1.0),
    (HERTZ, 1, 1e-12),
    (HERTZ, 1e-9, 3.0),
    (Power(5), 7, 2.0),
    (named("magnetic", 4, 1), 0, 0.99),
    (LIMITED, 0, 0.6666),
]
SHARP = [(named("lennard-jones", 1), 0, 0.99)]  # profiles are refused


def wave_of(law, load, rise, cell=CHAIN):
    return loaded_wave(cell, rise=rise, background=load, law=law)


@pytest.mark.parametrize(("law", "p0", "B"), CASES + SHARP, ids=str)
def test_speed_widths_and_profile_to_the_last_digits(law, p0, B):
    """To 1e-12 of mpmath's quadrature, 1e-9 of the larger of v and B/1000 along the profile.

    Next to a pole the rounding of p0 + B counts.
    """
    heights = B * np.array([0.99, 0.7, 0.5, 0.3, 0.01, 1e-6])
    with mpmath.workdps(
        30 + 3 * max(0, int(-np.log10(abs(B))))
    ):  # Q cancels at small B
        speed, place, height = true_wave(law, p0, B)
        widths = [2 * float(place(v)) for v in (mpmath.mpf(B) / 2, height)]
        places = [float(place(mpmath.mpf(v))) for v in heights]
    wave = wave_of(law, p0, B)
    assert float(wave.field.speed(wave.strain)) == pytest.approx(
        float(speed), rel=2e-14
    )
    for quantity, width in zip(("strain", "force"), widths, strict=True):
        assert float(wave.fwhm(quantity)) == pytest.approx(width, rel=1e-12)
    if (law, p0, B) in CASES:
        # One place a call: other places would refine the grid.
        found = [wave.along(place, "strain") for place in places]
        off = np.abs(found - heights)
        assert np.all(off <= 1e-9 * np.maximum(abs(heights), 1e-3 * abs(B)))


NETWORK = Lattice(
    [1, 2], [Link(0, 1, HERTZ), Link(1, 2, HERTZ), Link(0, 2, Power(2))], spacing="1/2"
)
RINGING = Lattice([1], [Link(0, 1, Power(2))], [Resonator(0, "1/2", 200)])
LAWS = HERTZ, named("hertz2", 1, 1), named("magnetic", 4, 3)


@pytest.mark.parametrize("chain", [*LAWS, NETWORK, RINGING], ids=str)
@pytest.mark.parametrize("excess", ["1e-6", "1e-15"])
def test_a_force_hardly_above_the_load(chain, excess):
    """Width and excess of V over sound are those of KdV, for F - F0 = F′ δ, δ with all digits."""
    known = chain in LAWS
    options = {"law": chain} if known else {}
    lattice, tiny = CHAIN if known else chain, sp.Rational(excess)
    wave = loaded_wave(lattice, force=1 + tiny, precompression=1, **options)
    slope = (wave.sound_speed / lattice.spacing) ** 2 * lattice.mass
    off = float(excess) + (1e-13 if known else 1e-8)
    rise = sp.N(wave.strain, 20, maxn=200)
    assert float(rise * lattice.spacing * slope / tiny) == pytest.approx(1, rel=off)
    width = 2 * math.acosh(math.sqrt(2)) * float(sp.N(wave.kdv.width(rise), 20))
    assert float(wave.fwhm("strain")) == pytest.approx(width, rel=off + 1e-12)
    if known or excess == "1e-6":  # 20 digits of V, or 15 for a lattice
        above = sp.N(wave.speed / wave.sound_speed - 1, 10, maxn=400)
        expected = wave.kdv.nonlinearity * rise / 3 / wave.sound_speed
        assert float(above / expected) == pytest.approx(1, rel=off + 1e-3)


@pytest.mark.parametrize("ratio", [1e-300, 1e-100, 1e100, 1e308])
def test_ratios_of_load_and_wave_that_no_difference_survives(ratio):
    """The compact wave's numbers at small p0/B and those of KdV at large, to the last digits."""
    wave, compact = wave_of(HERTZ, ratio, 1), canonical_wave(CHAIN, "3/2")
    if ratio < 1:
        speed, width = compact.speed(1) * compact.time_scale, float(compact.fwhm())
    else:
        speed = wave.sound_speed
        width = float(2 * mpmath.acosh(mpmath.sqrt(2)) * sp.N(wave.kdv.width(1), 20))
    assert number(wave.speed) == pytest.approx(float(speed), rel=1e-14)
    assert float(wave.fwhm("strain")) == pytest.approx(width, rel=1e-13)


def test_a_weak_link_in_series_next_to_its_pole():
    """V² = 2W/B² by the energies of both links.

    Newton's method in δ itself finds no state; one that moves each link alone finds some.
    """
    weak = sp.Rational(1, 10000)
    links = [Link(0, 1, HERTZ), Link(1, 2, named("magnetic", 2, 1), weak)]
    near = 1 - 1 / math.sqrt(1 + 1 / weak)  # weak ((1-δ)^-2 - 1) = 1
    energy = 2 / 5 + weak * (1 / (1 - near) - 1 - near)
    rise = (1 + near) / 2
    wave = loaded_wave(Lattice([1, 1], links), force=1)
    assert float(wave.strain) == pytest.approx(rise, rel=1e-14)
    assert float(wave.speed) ** 2 == pytest.approx(energy / rise**2, rel=1e-12)
