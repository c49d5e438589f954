"""Contact laws: Toda's exact soliton, and digits of small forces and energies."""

import math

import mpmath
import numpy as np
import pytest

from lwa.law import named
from validation.lattice.laws import Contact
from validation.lattice.simulate import simulate
from validation.scenes.scene import Scene


def test_todas_soliton_runs_through_200_beads_at_its_own_speed():
    """e^{δ_n} - 1 = sinh²κ sech²(κ n - t sinh κ) (Toda 1967), with dδ_n/dt = v_n - v_{n+1}."""
    n, kappa, first = 200, 1.0, 20
    c = np.sinh(kappa)

    def compression(i, t):
        return np.log1p((c / np.cosh(kappa * (i - first) - c * t)) ** 2)

    v = c * np.diff(np.tanh(kappa * (np.arange(-1, n) - first)))
    strain = compression(np.arange(n - 1), 0)
    scene = Scene(
        masses=(1,) * n, stiffnesses=(1,) * (n - 1), law=named("exponential", 1),
        displacements=np.cumsum(strain[::-1])[::-1], velocities=v,
        duration=140 * kappa / c, contact_sensors=(90, 150), samples=501,
    )  # fmt: skip
    run = simulate(scene, rtol=1e-12)
    for i, row in zip(scene.contact_sensors, run.compression, strict=True):
        assert np.abs(row - compression(i, run.time)).max() < 1e-9
    assert abs(run.energy_drift) < 1e-10


def test_a_small_force_has_all_digits():
    force = Contact(1, named("exponential", 1)).force(np.array([1e-9]))
    assert force == pytest.approx([math.expm1(1e-9)], rel=1e-15, abs=0)


@pytest.mark.parametrize("k", [1.5, 20])
@pytest.mark.parametrize("part", [-2.0, -0.01, 1e-9, 0.049, 3.0])
def test_the_energy_above_a_load_has_all_digits(k, part):
    """``∫ (F(r + s) - F(r)) ds``, of which floats would lose up to eighteen digits."""
    rest, change = 0.7, 0.7 * part
    with mpmath.workdps(50):
        r, x = mpmath.mpf(rest), mpmath.mpf(change)
        exact = (max(r + x, 0) ** (k + 1) - r ** (k + 1)) / (k + 1) - r**k * x
    found = Contact(k).energy_above(np.array([rest]), np.array([change]))
    assert found == pytest.approx([float(exact)], rel=1e-13, abs=0)
