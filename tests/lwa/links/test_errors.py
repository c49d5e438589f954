"""Errors of waves of lattices: they cover the differences to exact waves, and not 30 times."""

import math

import pytest

from book.studies.links import exact
from lwa import Lattice, Link, Power, lattice_wave

HERTZ, CUBIC = Power("3/2"), Power(3)


def pair(law, factor=1):
    return Lattice([1, 1], [Link(0, 1, HERTZ), Link(1, 2, law, factor)])


def chain(law, second=None):
    farther = [] if second is None else [Link(0, 2, law, second)]
    return Lattice([1], [Link(0, 1, law), *farther])


@pytest.mark.parametrize(
    ("lattice", "force", "load"),
    [
        *((pair(CUBIC), force, 1.0) for force in (1.02, 1.5, 3.0)),
        (pair(HERTZ, 8), 3.0, 1.0),
        (pair(Power(6)), 2.0, 1.0),
        (pair(Power(1)), 1.5, 1.0),
        (pair(Power(1), 3), 1.2, 1.0),
        (chain(HERTZ), 1.0, 0.0),
        (chain(HERTZ), 1.5, 1.0),
        (chain(CUBIC), 1.0, 0.0),
        (chain(HERTZ, "1/4"), 1.2, 1.0),
        (chain(HERTZ, "1/4"), 3.0, 1.0),
        (chain(HERTZ, "1/4"), 1.0, 0.0),
    ],
    ids=str,
)
def test_errors_cover_the_exact_wave(lattice, force, load):
    known, wave = exact(lattice, force, load), lattice_wave(lattice, force, load)
    missed = abs(float(wave.speed) - math.sqrt(known.square))
    assert missed < wave.speed_error < 30 * missed
    missed = abs(float(wave.fwhm(known.of)) - known.fwhm)
    assert missed < wave.fwhm_error(known.of) < 30 * missed
