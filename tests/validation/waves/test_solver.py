"""Exact waves: other discretisations, published numbers, the equations of motion, the lattice."""

import json
import re
from dataclasses import replace

import numpy as np
import pytest
import sympy as sp
from scipy.signal import find_peaks

from book.studies.accuracy import launched
from lwa.base.words import QUANTITIES
from validation import simulate
from validation.scenes.checks import SceneError
from validation.studies.exact import exact, resonances as special_ratios
from validation.waves.newton import Problem, SpecialRatio
from validation.waves.solver import NoWave, exact_wave, resonances, solve


@pytest.fixture(scope="module")
def hertz():
    return exact_wave([1], 1.5)


@pytest.fixture(scope="module")
def specials():
    return resonances(1.5, 3)


SECOND = np.array([2, -27, 270, -490, 270, -27, 2]) / 180
FIRST = np.array([-1, 9, -45, 0, 45, -9, 1]) / 60


@pytest.mark.parametrize(
    ("k", "p0"),
    [
        (1.02, 0),
        (1.5, 1e-9),
        (1.5, 0.3),
        (1.5, 0.9999),
        (3, 1e-3),
        (6, 0.23),
        (20, 0),
        pytest.param(60, 0, marks=pytest.mark.slow),
    ],
)
def test_the_equations_of_motion_hold_at_any_point(k, p0):
    """c² r'' = F(ξ+1) - 2F(ξ) + F(ξ-1) and c v' = F(ξ+½) - F(ξ-½), F = (p0 + r)_+^k, derivatives
    by differences of sixth order; for a multiple of the wave at its own speed."""
    wave = exact_wave([1], k, background=p0)
    assert wave.solitary
    assert wave.residual < 5e-16 * max(k, 20)  # rounding of the strain, k times in F
    assert p0 + wave.strain(0.0) == pytest.approx(1, abs=1e-13)
    more = wave.times(2.5)
    xi = wave.fwhm("strain") * np.linspace(-1.1, 1.5, 41)
    h = wave.fwhm("force") / 60

    def force(xi):
        return np.maximum(2.5 * p0 + more.strain(xi), 0) ** k

    def weighted(f, weights):
        terms = [w * f(xi + j * h) for j, w in enumerate(weights, start=-3)]
        return sum(terms)

    push = force(xi + 1) - 2 * force(xi) + force(xi - 1)
    bent = more.c2 * weighted(more.strain, SECOND) / h**2
    assert bent == pytest.approx(push, abs=1e-6 * np.abs(push).max())
    push = force(xi + 0.5) - force(xi - 0.5)
    faster = more.c * weighted(more.velocity, FIRST) / h
    assert faster == pytest.approx(push, abs=1e-6 * np.abs(push).max())
    for name in QUANTITIES:
        assert more.fwhm(name) == pytest.approx(wave.fwhm(name), rel=1e-10)
    assert more.background == pytest.approx(2.5 * p0, rel=1e-15)


def test_the_residual_under_load_is_a_share_of_the_waves_own_peak():
    """Small waves are alike but for their size, and so are their errors on a coarse grid."""
    residuals = []
    for load in (0.9, 0.99):
        wave = exact_wave([1], 1.5, background=load)
        points = int(0.35 * len(wave.series))
        coarse = Problem((1.0, 1.0), 1.5, wave.half_period, points, load)
        residuals.append(solve(coarse, wave).residual)
    assert residuals[0] == pytest.approx(residuals[1], rel=0.5)


def came_back(wave, sites=100):
    """The largest change of strain and velocity when a chain's wave is ``sites`` on; the run."""
    scene = launched(wave, 20, sites, duration=sites / wave.c)
    run = simulate(scene, method="symplectic", rtol=1e-11)
    compression, velocity = -np.diff(scene.displacements), np.array(scene.velocities)
    strain = np.abs(-np.diff(run.displacements)[sites:] - compression[:-sites]).max()
    return max(strain, np.abs(run.velocities[sites:] - velocity[:-sites]).max()), run


def test_the_wave_put_into_the_lattice_comes_back_to_itself(hertz):
    """After 100 sites to rounding, 1e-13; a speed wrong by 1e-8 would show."""
    assert came_back(hertz)[0] < 1e-11
    assert came_back(replace(hertz, c2=hertz.c2 * (1 + 2e-8)))[0] > 1e-7


def test_a_dimers_wave_keeps_its_shape_only_at_a_special_ratio(specials):
    """The wave returns at the first ratio; with light beads 2 % heavier it sheds motion at once."""
    off = replace(specials[0], masses=(1.0, 1.02 * specials[0].omega))
    assert came_back(specials[0])[0] < 1e-11
    assert np.abs(came_back(off)[1].velocities[40:100]).max() > 1e-4


def test_the_special_ratios_are_the_published_ones(specials):
    """Jayaprakash et al. (2011); independent of the box."""
    ratios = [wave.omega for wave in specials]
    assert ratios == pytest.approx([0.3428, 0.1548, 0.0901], abs=6e-5)
    found = special_ratios(sp.Rational(3, 2), 1).document()
    assert (found["k_value"], found["mass_ratios"]) == (1.5, ratios[:1])
    for wave in specials:
        assert wave.solitary
        assert wave.residual < 1e-12
        box = SpecialRatio(wave.masses, 1.5, 1.2 * wave.half_period)
        assert solve(box, wave).omega == pytest.approx(wave.omega, rel=1e-10)


def test_the_tail_grows_from_none_at_a_special_ratio(specials):
    """The odd part outside the pulse: in proportion to the distance, with its sign."""
    L, tails = specials[0].half_period, []
    for off in (-1e-4, 1e-5):
        masses = (1.0, specials[0].omega * (1 + off))
        wave = solve(Problem(masses, 1.5, L), specials[0])
        x = L * np.linspace(0.6, 1, 4001)
        odd = (wave.strain(x) - wave.strain(-x)) / 2
        assert wave.tail == pytest.approx(np.abs(odd).max(), rel=1e-4)
        assert not wave.solitary
        tails.append(odd[1000])
    assert tails[0] / tails[1] == pytest.approx(-10, rel=0.2)


@pytest.mark.parametrize(
    ("k", "count"), [(2, 2), pytest.param(5, 6, marks=pytest.mark.slow)]
)
def test_no_special_ratio_is_left_out(k, count):
    """The light beads oscillate once more at each; their velocity has as many crests."""
    xi = np.linspace(-4, 4, 8001)
    for crests, wave in enumerate(resonances(k, count), start=2):
        assert wave.solitary
        places, _ = find_peaks(wave.velocity(xi, 1), 0.01)
        assert len(places) == crests


@pytest.mark.slow
def test_no_special_ratio_is_left_out_near_k_1():
    """There √(m1/m2) grows from 1 by equal steps."""
    waves = resonances(1.3, 6)
    assert all(wave.solitary and wave.residual < 1e-11 for wave in waves)
    roots = np.array([wave.omega**-0.5 for wave in waves])
    assert np.diff(roots) == pytest.approx(roots[1] - roots[0], rel=0.25)
    assert roots[0] - 1 < 2 * (roots[1] - roots[0])


def test_units_of_mass_and_relabelling(specials):
    """c² ∝ 1/m; m1 ↔ m2 is the mirror image, contact 0 for contact 1; bead 1 for bead 0."""
    special, unit = specials[1], 1e-6
    one = exact_wave([unit, unit * special.omega], 1.5)
    other = exact_wave([unit * special.omega, unit], 1.5)
    xi = np.linspace(-2, 2, 21)
    assert one.c2 * unit == pytest.approx(special.c2, rel=1e-12)
    assert one.strain(xi) == pytest.approx(special.strain(xi), abs=1e-12)
    assert other.masses == pytest.approx(one.masses[::-1], rel=1e-12)
    assert other.c2 == pytest.approx(one.c2, rel=1e-12)
    assert other.strain(xi) == pytest.approx(one.strain(xi, 1), abs=1e-12)
    assert other.velocity(xi, 1) == pytest.approx(one.velocity(xi), abs=1e-9 * one.c)


def test_a_ratio_in_seven_digits_is_the_special_ratio(specials):
    """The wave has the special ratio's masses, and the report says so."""
    given = (2, 2 * specials[1].omega * (1 - 5e-8))
    found = exact(1.5, given).document()["masses_value"]
    assert found == pytest.approx((2, 2 * specials[1].omega), rel=1e-13)


@pytest.mark.parametrize("omega", [0.3428457811 * (1 + 2e-7), 1 / 0.6])
def test_a_ratio_without_a_solitary_wave_names_the_ways_on(omega):
    masses = re.escape(f"k = 1.5, masses 1, {omega:.10g}")
    ways = r"the nearest ratio with one is .* lwa-validate sweep --k .* measures a pulse; try "
    with pytest.raises(NoWave, match=f"{masses}: {ways}"):
        exact_wave([1, omega], 1.5)


def test_the_report_holds_every_number_of_a_wave(hertz):
    found = json.loads(json.dumps(exact(1.5, (1,)).document(), allow_nan=False))
    assert found["c_value"] ** 2 == pytest.approx(found["c2_value"], rel=1e-14)
    for key, read in (("fwhm", hertz.fwhm), ("amplitude", hertz.peak)):
        assert found[f"{key}_value"] == {name: read(name) for name in QUANTITIES}
    assert all(0 < error < 1e-11 for error in found["fwhm_error_value"].values())
    numbers = found["solitary"], found["tail_value"], found["residual_value"]
    assert numbers == (True, 0, hertz.residual)


@pytest.mark.parametrize(
    ("masses", "options", "named"),
    [
        ([1, 2, 3], {}, "3 masses"),
        ([1, 1e-4], {}, "masses is 0.0001: the ratio"),
        ([1], {"k": 61}, "k is 61"),
        ([1], {"k": 9, "background": 0.5}, "k is 9"),
        ([1, 0.5], {"k": 5.5}, "k is 5.5"),
        ([1], {"background": 1e-300}, "background is 1e-300"),
        ([1, 0.5], {"background": 0.1}, "background is 0.1"),
    ],
)
def test_bad_input(masses, options, named):
    with pytest.raises(SceneError, match=rf"^{re.escape(named)}\W"):
        exact_wave(masses, **{"k": 1.5} | options)


def test_a_multiple_beyond_floats_is_refused():
    """s^20 of s = 1e30 is no float."""
    with pytest.raises(ValueError, match=r"^s is 1e"):
        exact_wave([1], 20).times(1e30)
