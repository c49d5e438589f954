"""Theory, Newton's method and lattice at extreme k and ω, where waves vanish or lose their meaning.

Lengths in D; m1 = A = D = 1.
"""

import math

import numpy as np
import pytest
import scipy
import sympy as sp

from lwa import NoSolitaryWave
from tests.passage import passage
from validation.scenes.chains import carrying
from validation.studies.limits import LEADING_POWERS, theory_at
from validation.waves.solver import solve


def theory_errors(wave):
    """Theory over a uniform chain's exact wave, less 1."""
    theory = theory_at(sp.Rational(str(wave.k)), sp.Integer(1)).at_force(1)
    errors = {f"FWHM of {q}": float(theory.fwhm(q)) / wave.fwhm(q) - 1 for q in ("force", "strain")}
    return errors | {"speed V_s at B = 1": float(theory.speed) / wave.c - 1}


# k near 1


def test_the_theorys_error_vanishes_by_its_law_as_k_goes_to_one():
    for epsilon in (0.01, 0.001):
        for quantity, error in theory_errors(solve((1.0, 1.0), 1 + epsilon)).items():
            law = LEADING_POWERS[quantity]
            share = error / epsilon**law.order / float(law.coefficient)
            # the next term of the series is O(ε) of this one
            assert abs(share - 1) < 3 * epsilon, quantity


def test_the_lattice_carries_the_theorys_wave_at_k_of_1_001():
    """A force of 30 sites at half maximum: a chain of 620 beads."""
    k = 1.001
    theory = theory_at(sp.Rational(str(k)), sp.Integer(1)).at_force(1)
    start, sites = 160, 300
    bead = np.arange(2 * start + sites) - start
    scene = carrying(
        (1.0,) * len(bead),
        theory.along(bead[:-1] + 0.5, "strain"),
        theory.along(bead, "velocity"),
        k=k,
        contact_sensors=(start + 60, start + sites),
        samples=4001,
        duration=(sites + 0.7 * start) / float(theory.speed),
    )
    passed = passage(scene)
    at_equal_strain = passed.speed / passed.strain ** ((k - 1) / 2)
    assert abs(at_equal_strain / float(theory.speed) - 1) < (k - 1) ** 2
    assert abs(passed.fwhm / float(theory.fwhm("force")) - 1) < k - 1
    assert abs(passed.run.energy_drift) < 1e-9


# k = 2 and 3


# k = 20, near hard spheres


def collision_fwhm(k):
    """FWHM in time of the force of a collision with peak compression 1, times the velocity.

    2 ∫ dδ / √(1 - δ^n), n = k + 1, from half of the force, δ^k = 1/2, to 1.
    """
    n = k + 1
    share = scipy.special.betaincc(1 / n, 0.5, 0.5 ** (n / k))
    return 2 * scipy.special.beta(1 / n, 0.5) / n * share


@pytest.fixture(scope="module")
def hard_wave():
    wave = solve((1.0, 1.0), 3.0)
    for exponent, points in ((5.0, 90), (8.0, 110), (12.0, 140), (20.0, 160)):
        wave = solve((1.0, 1.0), exponent, points=points, start=wave)
    return wave


def test_near_hard_spheres_a_pulse_is_a_row_of_collisions(hard_wave):
    velocity = 2 / math.sqrt(21)  # before a collision of two equal beads whose force peaks at 1
    assert hard_wave.peak("velocity")[1] == pytest.approx(velocity, rel=1e-5)
    lasted = hard_wave.fwhm("force") / hard_wave.c
    assert lasted == pytest.approx(collision_fwhm(20.0) / velocity, rel=1e-10)
    assert hard_wave.fwhm("force") < 0.2
    scene = hard_wave.launched(10, 40)
    passed = passage(scene, 1e-9)
    assert abs(passed.speed / hard_wave.c - 1) < 1e-5
    assert abs(passed.fwhm / hard_wave.fwhm("force") - 1) < 1e-4
    # a long-wave theory is several times too wide here
    assert theory_errors(hard_wave)["FWHM of force"] > 1


# ω from 1e-6 to 1e6


@pytest.fixture(scope="module")
def uniform():
    return solve((1.0, 1.0), 1.5)


def slaved(uniform, heavy, light):
    """Heavy beads with the uniform chain's wave at spacing 2D, the light ones at rest among them.

    A heavy bead has the next one behind two springs in a row, of 2^{-k}: both contacts have half of
    the strain 2 r, velocities are √2 times as large.
    """
    start, cells = 20, 60
    site = np.arange(2 * cells) - start
    pair = np.floor(site[:-1] / 2) + 0.5
    behind, ahead = (uniform.velocity(np.floor((site + i) / 2)) for i in (0, 1))
    pace = math.sqrt(2) * uniform.c / math.sqrt(heavy)
    return carrying(
        tuple(np.where(site % 2 == 0, heavy, light)),
        uniform.strain(pair),
        (behind + ahead) / 2 * math.sqrt(2 / heavy),
        k=uniform.k,
        duration=70 / pace,
        contact_sensors=(40, 80),
        samples=4001,
    )


@pytest.mark.parametrize("omega", [1e-2, 1e-3])
def test_slaved_beads_slow_the_limit_by_a_share_of_their_mass(uniform, omega):
    """Every cell has the mass 1 + ω: a speed lower by ω/2 at most, and by no less than ω/4."""
    passed = passage(slaved(uniform, 1.0, omega), 1e-9)
    off = passed.speed / (math.sqrt(2) * uniform.c) - 1
    assert -omega / 2 < off < -omega / 4
    assert abs(passed.run.momentum_drift) < 1e-12
    assert abs(passed.run.energy_drift) < 1e-9
    # light first or heavy first, the chain is the same in other units of mass
    mirrored = passage(slaved(uniform, 1 / omega, 1.0), 1e-9)
    pace = mirrored.speed / math.sqrt(omega)
    assert pace == pytest.approx(passed.speed, rel=1e-9)


# No compact wave


def test_the_closure_has_no_wave_from_three_on_at_k_of_three():
    """(G+H+I)/D² is in the ratio of (3 - ω)(2 + ω)."""
    assert theory_at(3, "2.999").width > 0
    for omega, number in (("3", "0"), ("3.001", "-")):
        with pytest.raises(NoSolitaryWave, match=rf"^\(G\+H\+I\)/D² is {number}"):
            theory_at(3, omega)


@pytest.mark.parametrize(
    ("k", "exponents", "sign"),
    [("3", (1.6, 2.0, 2.5, 3.0), r"\(G\+H\+I\)"), ("8/5", (1.6,), "V²")],
)
def test_where_the_papers_closure_has_no_wave_the_lattice_has_one(k, exponents, sign):
    """At a special ratio ω < 1 the wave is solitary; the same chain, its beads named the other way
    round, has 1/ω, which the paper's closure treats as another one."""
    wave = solve((1.0, 0.1548), 1.5, free=True)
    for exponent in exponents:
        wave = solve(wave.masses, exponent, start=wave, free=True)
    with pytest.raises(NoSolitaryWave, match=f"^{sign}"):
        theory_at(k, f"{1 / wave.omega:.4f}")
    assert wave.tail < 1e-9
    assert wave.residual < 1e-9
    passed = passage(wave.launched(24, 64, samples=8001), 1e-7)
    assert abs(passed.speed / wave.c - 1) < 1e-5
    assert abs(passed.force - 1) < 1e-4
    theory = theory_at(sp.Rational(k), sp.Rational(wave.omega), "canonical").at_force(1)
    assert abs(float(theory.speed) / wave.c - 1) < 0.05
