"""Contact laws other than powers: Toda's exact soliton, SciPy, and bad laws."""

import numpy as np
import pytest
import sympy as sp

from lwa.law import Law, named
from validation.lattice.simulate import simulate
from validation.scenes.forcing import Drive
from validation.scenes.scene import Scene

NAMES = ("contact_force", "compression", "bead_velocity", "displacements", "velocities")


def test_todas_soliton_runs_through_200_beads_at_its_own_speed():
    """e^{δ_n} - 1 = sinh²κ sech²(κ n - t sinh κ) (Toda 1967), with dδ_n/dt = v_n - v_{n+1}."""
    n, kappa, first = 200, 1.0, 20
    c = np.sinh(kappa)

    def compression(i, t):
        return np.log1p((c / np.cosh(kappa * (i - first) - c * t)) ** 2)

    beads = np.arange(n)
    y = np.append(np.cumsum(compression(beads[:-1], 0)[::-1])[::-1], 0)
    v = c * np.diff(np.tanh(kappa * (np.arange(-1, n) - first)))
    scene = Scene(
        masses=[1] * n, stiffnesses=[1] * (n - 1), law=named("exponential", 1), displacements=y,
        velocities=v, duration=140 * kappa / c, contact_sensors=(90, 150), samples=501,
    )  # fmt: skip
    run = simulate(scene, rtol=1e-12)
    for i, row in zip(scene.contact_sensors, run.compression, strict=True):
        assert np.abs(row - compression(i, run.time)).max() < 1e-9
    assert abs(run.energy_drift) < 1e-10


@pytest.mark.parametrize(
    ("law", "loaded"),
    [
        (named("hertz2", 1, "1/2"), False),
        (named("magnetic", 4, 2), False),
        (named("exponential", 1), False),
        (Law(sp.tanh(sp.Symbol("x")), sp.Symbol("x")), True),
    ],
)
def test_random_chains_agree_with_scipy(law, loaded):
    random = np.random.default_rng((24, len(str(law)), loaded))
    n = 8
    scene = Scene(
        masses=random.uniform(0.5, 2, n), stiffnesses=random.uniform(0.5, 2, n - 1), wall=1.0,
        law=law, velocities=random.uniform(-0.3, 0.3, n), duration=5, samples=201,
        contact_sensors=(0, 3, 7), bead_sensors=(0, 4, 7), precompression=0.2 * loaded,
    )  # fmt: skip
    exact = simulate(scene, method="DOP853", rtol=1e-12)
    run = simulate(scene)
    for record in NAMES:
        difference = np.abs(getattr(run, record) - getattr(exact, record)).max()
        assert difference < 1e-7, (
            record
        )  # chaotic rattling amplifies 1e-9 where contacts open
    assert abs(run.energy_drift) < 1e-7
    # contacts of a law with F'(0) > 0 pull
    assert loaded or (exact.contact_force.min() < 0) == (law.name != "hertz2")


def test_a_wall_recedes_from_a_chain_that_softens():
    """δ - δ² reaches its greatest force at δ = ½, which no energy of the scene may pass."""
    scene = Scene(
        masses=[1] * 80, stiffnesses=[1] * 79, wall=1.0, law=named("polynomial", -1, 0),
        precompression=0.24, drive=Drive(velocity=-0.2087), duration=55.0,
    )  # fmt: skip
    fast, other = simulate(scene), simulate(scene, method="DOP853")
    assert np.abs(fast.displacements - other.displacements).max() < 1e-7
