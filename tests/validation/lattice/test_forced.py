"""Damped contacts and driven chains: exact collisions, exact motion, contacts that are missed."""

import math

import numpy as np
import pytest

from tests.validation.lattice.scenes import chain
from validation.lattice.simulate import simulate
from validation.scenes.forcing import Damping, Drive


@pytest.mark.parametrize(
    ("k", "v", "share"), [(1, 1, 0.3), (1.5, 1, 0.9), (1.5, 10, 0.05), (3, 0.2, 0.3)]
)
def test_beads_part_with_a_share_of_their_speed(k, v, share):
    scene = chain(
        (1, 3), stiffnesses=(2,), k=k, velocities=(v,), contact_sensors=(0,),
        duration=12 * v ** (2 / (k + 1) - 1), damping=Damping("restitution", share),
    )  # fmt: skip
    run = simulate(scene, rtol=1e-12)
    assert run.velocities[1] - run.velocities[0] == pytest.approx(share * v, rel=1e-10)
    assert run.contact_force.min() == 0  # no contact pulls
    assert run.dissipated == pytest.approx((1 - share**2) * 0.75 * v**2 / 2, rel=1e-10)
    assert abs(run.energy_drift) < 1e-11
    assert abs(run.momentum_drift) < 1e-12


def test_a_bead_leaves_a_wall_with_a_share_of_its_speed():
    """A wall has infinite mass."""
    damping = Damping("restitution", 0.4)
    scene = chain((3,), wall=2, velocities=(1,), duration=30, damping=damping)
    assert simulate(scene).velocities == pytest.approx([-0.4], abs=1e-8)


@pytest.mark.parametrize(
    "drive", [None, Drive(amplitude=0.0, frequency=1.0), Drive(velocity=0.0)]
)
def test_a_scene_at_rest_stays_at_rest(drive):
    damping = Damping("kuwabara_kono", 0.1)
    run = simulate(chain(2, duration=3, drive=drive, damping=damping))
    assert not np.any((run.velocities, run.displacements))
    assert run.energy_drift == run.dissipated == run.work == 0


def test_a_shaken_linear_bead_oscillates_with_the_exact_amplitude():
    """One free bead between the driven bead and a wall, k = 1: y = a κ/(2κ - w²) sin(wt), in steady
    motion, with a resonant part that a long ramp does not excite."""
    w, a = 0.5, 0.01
    scene = chain(
        2, wall=1, k=1, precompression=1, bead_sensors=(0, 1), duration=400, samples=4001,
        drive=Drive(amplitude=a, frequency=w / (2 * math.pi), ramp=300),
    )  # fmt: skip
    run = simulate(scene)
    late = run.time > 330
    given, free = run.bead_displacement[:, late]
    assert given == pytest.approx(a * np.sin(w * run.time[late]), abs=1e-15)
    assert free == pytest.approx(given / (2 - w * w), abs=1e-7)


def test_a_drive_from_rows_is_the_motion_that_they_sample():
    t = np.linspace(0, 20, 400)
    drive = Drive(time=t, displacement=0.1 * t**3 / 400)
    run = simulate(chain(3, duration=20, bead_sensors=(0,), drive=drive))
    assert run.bead_displacement[0] == pytest.approx(0.1 * run.time**3 / 400, abs=1e-13)
    assert run.momentum_drift is None


def test_scipys_methods_are_references_of_forced_scenes():
    """A chain under load, whose damped contacts stay closed: motion, work and dissipated energy."""
    scene = chain(
        (1, 0.5, 1), stiffnesses=(1, 2), wall=1, precompression=1, duration=10,
        damping=Damping("contact", 0.1), drive=Drive(amplitude=0.1, frequency=0.2, ramp=3),
    )  # fmt: skip
    ours, theirs = (simulate(scene, method=m, rtol=1e-10) for m in ("RKN86", "DOP853"))
    for name in ("displacements", "velocities", "dissipated", "work"):
        expected = getattr(ours, name)
        np.testing.assert_allclose(getattr(theirs, name), expected, atol=3e-9)
    assert min(ours.dissipated, ours.work) > 1e-3


def test_samples_between_the_ends_of_steps_are_as_good_as_the_ends():
    """Samples between some forty steps of a damped and driven bead err by one tolerance."""
    scene = chain(
        2,
        wall=1,
        duration=8,
        samples=400,
        bead_sensors=(1,),
        damping=Damping("kuwabara_kono", 0.05),
        drive=Drive(amplitude=0.5, frequency=0.1),
    )
    found, exact = (simulate(scene, rtol=r).bead_velocity for r in (1e-10, 1e-13))
    # Polynomials of degree 7 erred by 8 tolerances.
    assert abs(found - exact).max() < 2e-10
