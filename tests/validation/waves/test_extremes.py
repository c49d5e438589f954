"""The lattice has waves where the paper's closure has none; lengths in D, m1 = A = D = 1."""

import pytest
import sympy as sp

from lwa import NoSolitaryWave
from tests.passage import passage
from validation.studies.limits import theory_at
from validation.waves.solver import solve


@pytest.mark.parametrize(
    ("k", "exponents", "sign"), [("3", (1.6, 2.0, 2.5, 3.0), r"\(G\+H\+I\)"), ("8/5", (1.6,), "V²")]
)
def test_where_the_papers_closure_has_no_wave_the_lattice_has_one(k, exponents, sign):
    """At a special ratio ω < 1; with its beads named the other way round the chain has 1/ω."""
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
