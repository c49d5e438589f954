"""The traveling wave in closed form, where the paper's test does not go."""

import sympy as sp

from lwa import Dimer, homogenize
from tests.identity import same


def test_complex_roots_do_occur_and_leave_beta_real():
    wave = homogenize(Dimer(1, 2, spacing=1), k=3).pde.traveling_wave()
    assert not any(sp.N(root).is_real for root in wave.roots)
    assert wave.beta.is_real
    # here H = 0 as well, so that a = (3 - k + H/I) p - 2 does not depend on p
    assert wave.reduction().a == -2


def test_masses_over_the_whole_range_of_floats():
    """β at ω → ∞; SymPy fails to take square roots of integers beyond 2^1024."""
    wave = homogenize(Dimer("1e-300", "1e300", spacing=1), k="3/2").pde.traveling_wave()
    assert same(wave.beta, sp.sqrt(sp.Rational(3, 8)))
