"""The steady pulse of a struck chain: exact waves, symmetries, published ratios, its own errors."""

import math

import numpy as np
import pytest
import sympy as sp

from validation.pulses import steady
from validation.pulses.steady import LABELS, STRETCH, point
from validation.waves.newton import SpecialRatio
from validation.waves.solver import exact_wave, solve

R = sp.Rational
HERTZ = R(3, 2)
SPECIAL = R(3428457811, 10**10)
"""The first mass ratio at which a Hertz dimer has a solitary wave (Jayaprakash et al. 2011)."""


def at(k, omega, stretch=STRETCH):
    found = point(R(k), R(omega), stretch)
    assert found.missing is None, found.missing
    assert list(found.numbers) == list(LABELS)
    return found.numbers


LARGE = pytest.param(6, 1, marks=pytest.mark.slow)


@pytest.mark.parametrize(("k", "omega"), [("5/4", 1), LARGE, ("3/2", SPECIAL)])
def test_a_solitary_wave_agrees_with_newtons_method(k, omega):
    wave = (
        exact_wave([1], float(R(k)))
        if omega == 1
        else solve(SpecialRatio((1, float(omega)), 1.5))
    )
    numbers = at(k, omega)
    exact = wave.fwhm("force"), wave.fwhm("strain"), wave.c, 0.0
    for name, value in zip(LABELS, exact, strict=True):
        # the two share no equation in code; 1e-7 is the accuracy of the special ratio's wave
        assert abs(numbers[name].value - value) <= numbers[name].error + 1e-7, name
        assert numbers[name].error < 1e-5


def agree(one, other, speed=1.0):
    """Hold two measurements to their errors; the other has so many times the speed."""
    for name in LABELS:
        size = speed if name == "speed" else 1.0
        bound = one[name].error + other[name].error / size
        assert abs(one[name].value - other[name].value / size) <= bound, name


@pytest.mark.slow
def test_relabelling_the_masses_changes_the_unit_of_mass_only():
    """Masses 1, 1/ω are 1/ω times the masses ω, 1: speeds go as 1/√mass. At a stretch of 3 the
    errors cover other distances."""
    agree(at("3/2", "9/20"), at("3/2", "9/20", 3))
    agree(at("3/2", "0.75"), at("3/2", R(4, 3)), math.sqrt(0.75))


@pytest.mark.parametrize(
    ("k", "omega", "reason"),
    [
        (HERTZ, R(1, 2), "not steady: at 320 sites the highest pulse has 1"),
        (HERTZ, R(1, 10**40), "duration is "),  # longer than any run
    ],
)
def test_a_pulse_without_numbers_states_the_reason(k, omega, reason):
    found = point(k, omega, STRETCH)
    assert (found.sites, found.numbers) == (None, {})
    assert found.missing.startswith(reason)


def test_the_end_of_the_chain_is_far_from_the_last_place():
    """Twelve beads beyond the place are too few for a FWHM of 8.5 sites."""
    chain = steady.StruckDimer(1.05, 0.01, 40)
    one, other = (
        chain.passages(chain.run(places, chain.crossing(160), 1e-6))
        for places in ((40, 80), (40, 80, 160))
    )
    for name in ("arrival", "peak", "width", "strain_width"):
        assert one[name][1] == pytest.approx(other[name][1], rel=1e-5)


def measured(monkeypatch, width, peak):
    """Measure a point with given widths and peaks at n sites, by tolerance."""

    def passages(chain, run):
        places, rtol = run
        n = np.array(places, float)[:, np.newaxis].repeat(2, axis=1)
        widths = width(n, rtol)
        peaks = peak(n)
        return {
            "arrival": n,
            "peak": peaks,
            "width": widths,
            "strain_width": widths,
            "end": n,
            "highest": peaks,
        }

    monkeypatch.setattr(
        steady.StruckDimer, "run", lambda chain, places, _, rtol: (places, rtol)
    )
    monkeypatch.setattr(steady.StruckDimer, "passages", passages)
    return steady.point(R(3, 2), R(1, 2), STRETCH)


@pytest.mark.parametrize(
    ("width", "error"),
    [
        (lambda n, rtol: 1 + n**-0.5, 80**-0.5),  # what is left at the last place
        (lambda n, rtol: 1 + 0.01 * (n // 8 % 2), 0.01),
        (lambda n, rtol: 1 + 0.01 * ((rtol > steady.TOLERANCES[0]) & (n <= 80)), 0.01),
    ],
)
def test_the_error_is_the_largest_difference(monkeypatch, width, error):
    """To the limit, twice the way to a far place, to the stretch before, to a less accurate run."""

    found = measured(monkeypatch, width, np.ones_like)
    assert found.numbers["width"].error == pytest.approx(error, rel=1e-12)


def test_the_stretch_of_the_least_errors_counts_the_force_lost_over_it(monkeypatch):
    """The width's error grows slowly; the force at 16 sites is off by 5e-4, per site by 6e-5."""
    found = measured(
        monkeypatch,
        width=lambda n, rtol: 1 + 1e-3 * n / 80 * (n <= 80),
        peak=lambda n: np.exp(-5e-4 * (n == 16)),
    )
    assert found.sites == (24, 32)
