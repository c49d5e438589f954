"""Exact waves and struck lattices of unlike links, resonators and packings, beside the theory."""

import math

import pytest
import sympy as sp

from book.studies import links as exactly, struck as blows
from lwa import Lattice, Link, Power, loaded_wave
from validation import exact_wave

HERTZ = Power("3/2")
CHAIN = Lattice((1,), (Link(0, 1, HERTZ),))


@pytest.mark.parametrize("size", [1, 2])
def test_equal_links_have_the_wave_of_equal_beads(size):
    """Both systems of equations, against the solver of equal beads under a load."""
    lattice = Lattice((1,) * size, tuple(Link(i, i + 1, HERTZ) for i in range(size)))
    known = exact_wave([1], 1.5, background=0.5)  # strain 1/2 ahead, 1 at the peak
    wave = exactly.exact(lattice, 1.0, 0.5**1.5)
    assert wave.square == pytest.approx(known.c2, rel=1e-9)  # tails of 1e-7 on the ring
    assert wave.fwhm == pytest.approx(known.fwhm(wave.of), rel=1e-6)
    assert wave.of == ("strain" if size == 1 else "force")


def test_second_neighbours_by_newton_and_in_a_packing():
    """Along its rows a packing is a chain of range 2, with factors 2 · 2^{-5/2} and 1."""
    lattice = Lattice((1,), (Link(0, 1, HERTZ, 2.0**-1.5), Link(0, 2, HERTZ)))
    force = 1e-6 * (2.0**-1.5 + 2**2.5)  # at the compression 1e-4 of a layer
    wave = exactly.exact(lattice, force, 0.0)
    pace = math.sqrt(wave.square)
    seen = blows.packing("along", 1e-4 * pace / blows.STRIKE, pace)
    assert seen.speed == pytest.approx(pace * (seen.peak / 1e-4) ** 0.25, rel=3e-5)
    assert seen.fwhm == pytest.approx(wave.fwhm, rel=3e-5)  # it still changes a little


def test_the_theory_of_unlike_links_is_the_limit_of_weak_waves():
    """Both errors fall in proportion to the wave, which no error of an equation would do."""
    lattice = Lattice((1, 1), (Link(0, 1, HERTZ), Link(1, 2, Power(3))))
    rows = [
        exactly.Chain("", lattice, 1 + rise, 1.0).cells("") for rise in (0.02, 0.04)
    ]
    for key, most in (("excess error", 0.002), ("fwhm error", 0.0025)):
        near, far = (row[key] for row in rows)
        assert -most < near < 0
        assert far / near == pytest.approx(2, rel=0.06)


@pytest.mark.parametrize("epsilon", [0.05, 0.0125])
def test_the_width_of_the_theory_is_its_quadrature(epsilon):
    """The dispersion (K1² - K1 K2 + K2²)/(3 (K1 + K2)²) of two springs, with SciPy's quadrature."""

    def dispersion(F):
        K1, K2 = 1 / (1 + F / 2), 1 / (1 - 2 * (0.25 + epsilon) * F)
        return (K1**2 - K1 * K2 + K2**2) / (3 * (K1 + K2) ** 2)

    lattice = exactly.varying(sp.Rational(str(epsilon)))
    width = float(loaded_wave(lattice, force=1).fwhm("force"))
    assert width == pytest.approx(exactly.series_width(epsilon, dispersion), rel=1e-8)


@pytest.mark.parametrize(
    ("lattice", "mass", "speeds", "widths", "rest"),
    [(CHAIN, 1, 1e-6, 1e-4, 1e-7), (blows.resonant("1", 10.0), 2, 1e-3, 2e-3, 1e-5)],
)
def test_a_struck_chain(lattice, mass, speeds, widths, rest):
    """Equal beads carry the exact wave; stiff resonators are masses, both up to (ω0/(2πV))^-2."""
    wave, known = loaded_wave(lattice, force=1), exact_wave([1], 1.5)
    seen = blows.chain(
        lattice, float(wave.bead_velocity) / blows.STRIKE, float(wave.speed)
    )
    speed = known.c * seen.peak ** (1 / 6) / math.sqrt(mass)
    assert seen.speed == pytest.approx(speed, rel=speeds)
    assert seen.fwhm == pytest.approx(known.fwhm("force"), rel=widths)
    assert abs(seen.decay if seen.ringing is None else seen.ringing) < rest


@pytest.mark.parametrize("case", exactly.CASES)
def test_stated_errors_cover_exact_waves(case):
    report = exactly.links(case)
    assert report.ok
    rows = report.document()["rows"]
    for chain, row in zip(exactly.CASES[case](), rows, strict=True):
        wave = loaded_wave(chain.lattice, force=chain.force, precompression=chain.load)
        speed, width = wave.estimate("speed"), wave.estimate("fwhm", row["of"])
        assert abs(math.sqrt(row["square_value"]) - speed.value) < speed.error
        assert abs(row["fwhm_value"] - width.value) < width.error


def test_a_pulse_leaves_tuned_resonators_quiet():
    """By a factor of four; below 1.2 · 2πV_s no theory takes them."""
    report = blows.struck()
    assert report.ok
    rows = [r for r in report.document()["rows"] if r["case"] == "resonators"]
    for row in rows:
        assert (row["speed_error_value"] is None) == (row["tuning_value"] < 1.2)
    tuned, *beside = sorted(
        (abs(row["tuning_value"] - 1), row["ringing_value"])
        for row in rows
        if row["chain"] == "m_r = 3/10"
    )
    assert min(ringing for _, ringing in beside[:2]) > 4 * tuned[1]
