"""Theory, Newton's method and lattice at extreme k and ω, where waves vanish or lose their meaning.

Lengths in D; m1 = A = D = 1.
"""

import math

import pytest
import scipy
import sympy as sp

from lwa import NoSolitaryWave
from tests.passage import passage
from validation.studies.limits import theory_at
from validation.waves.solver import solve

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


# No compact wave


@pytest.mark.parametrize(
    ("k", "exponents", "sign"), [("3", (1.6, 2.0, 2.5, 3.0), r"\(G\+H\+I\)"), ("8/5", (1.6,), "V²")]
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
