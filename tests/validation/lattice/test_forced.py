"""Damped contacts and driven chains: exact collisions, the ledger of energy, pulses."""

import math

import numpy as np
import pytest

from lwa.law import named
from validation.lattice.simulate import simulate
from validation.scenes.forcing import Damping, Drive, damping_ratio, restitution
from validation.scenes.scene import Scene

TIGHT = dict(rtol=1e-12)


@pytest.mark.parametrize(
    ("k", "v", "share"), [(1, 1, 0.3), (1.5, 1, 0.9), (1.5, 10, 0.05), (3, 0.2, 0.3)]
)
def test_beads_part_with_a_share_of_their_speed(k, v, share):
    scene = Scene(
        masses=(1.0, 3.0), stiffnesses=(2.0,), k=k, velocities=(v,), contact_sensors=(0,),
        duration=12 * v ** (2 / (k + 1) - 1), damping=Damping("restitution", share),
    )  # fmt: skip
    run = simulate(scene, **TIGHT)
    assert run.velocities[1] - run.velocities[0] == pytest.approx(share * v, rel=1e-10)
    assert run.contact_force.min() == 0  # no contact pulls
    assert run.dissipated == pytest.approx((1 - share**2) * 0.75 * v**2 / 2, rel=1e-10)
    assert abs(run.energy_drift) < 1e-11
    assert abs(run.momentum_drift) < 1e-12


def test_the_damping_ratio_of_a_share():
    """The share is 1 - πζ + O(ζ²) of a nearly elastic contact, and e^{-2} at ζ = 1."""
    assert damping_ratio(1 - 1e-7) == pytest.approx(1e-7 / math.pi, rel=2e-7)
    assert damping_ratio(math.exp(-2)) == pytest.approx(1, abs=1e-8)
    for share in (0.01, 0.1, 0.5, 0.9):
        assert restitution(damping_ratio(share)) == pytest.approx(share, rel=1e-14)


@pytest.mark.parametrize("kind", ["contact", "kuwabara_kono"])
def test_the_energy_lost_is_the_energy_dissipated(kind):
    scene = Scene(
        masses=(1, 0.4, 2, 1, 1), stiffnesses=(1, 2, 1, 1), wall=1, k=1.5, gravity=0.1,
        velocities=(1, 0, -0.5), duration=20, damping=Damping(kind, 0.05), contact_sensors=(0, 4),
    )  # fmt: skip
    run = simulate(scene, **TIGHT)
    assert 0.1 < run.dissipated < 1
    # The force jumps where a contact closes.
    assert abs(run.energy_drift) < 2e-11
    force = run.signal("contact", 4)
    np.testing.assert_allclose(force(run.time), run.contact_force[1], atol=1e-14)


@pytest.mark.parametrize(
    "drive", [None, Drive(amplitude=0.0, frequency=1.0), Drive(velocity=0.0)]
)
def test_a_scene_at_rest_stays_at_rest(drive):
    scene = Scene(
        masses=(1, 1), stiffnesses=(1,), k=1.5, duration=3, bead_sensors=(0, 1), drive=drive,
        damping=Damping("kuwabara_kono", 0.1),
    )  # fmt: skip
    run = simulate(scene)
    for name in (
        "bead_displacement",
        "velocities",
        "energy_drift",
        "dissipated",
        "work",
    ):
        assert not np.any(getattr(run, name)), name


@pytest.mark.parametrize(
    ("masses", "k", "frequency", "rtol"),
    [
        ((1, 1), 1.5, 0.3, 1e-6),
        ((1, 0.2, 0.2, 0.2), 1.5, 0.3, 1e-10),
        ((1,), 1, 1.0, 1e-10),
    ],
)
def test_the_work_of_a_shaken_bead_whose_contact_opens(masses, k, frequency, rtol):
    """The drive's speed changes within the steps in which its contact opens and closes."""
    scene = Scene(
        masses=masses, stiffnesses=(1.0,) * (len(masses) - 1), wall=1, k=k, duration=60,
        drive=Drive(amplitude=0.5, frequency=frequency, ramp=3),
    )  # fmt: skip
    assert abs(simulate(scene, rtol=rtol).energy_drift) < 5 * rtol


def test_a_drive_that_leaves_its_contact_is_on_its_books():
    """Nothing but the drive moves: rounding is no response that sets scales."""
    away = Drive(
        time=(0, 0.3, 0.6, 0.9, 1.2), displacement=(-0.7, -1.2, -1.3, -1.8, -1.9)
    )
    scene = Scene(
        masses=(0.64, 0.3), stiffnesses=(1,), wall=0.1, k=1.5, duration=1, drive=away
    )
    run = simulate(scene)
    assert abs(run.work) > 0.1
    assert abs(run.energy_drift) < 1e-14


def test_the_error_is_that_of_the_response():
    """A fast drive leaves the chain; a slow collision behind it is as accurate as without it."""
    damped = dict(k=1.5, duration=80.0, damping=Damping("kuwabara_kono", 0.1))
    alone = Scene(masses=(1, 1), stiffnesses=(1,), velocities=(0.01,), **damped)
    away = dict(velocities=(0, 0.01), drive=Drive(velocity=-50))
    pulled = Scene(masses=(1, 1, 1), stiffnesses=(1, 1), **away, **damped)
    exact, run = (
        simulate(alone, rtol=1e-11).velocities,
        simulate(pulled, rtol=1e-6).velocities[1:],
    )
    assert np.abs(run - exact).max() < 1e-6 * 0.01


def test_order_of_the_damped_steps_and_of_their_interpolant():
    """Both errors fall like h^6 at least at fixed steps, under a smooth law."""
    scene = Scene(
        masses=(1, 0.7, 1), stiffnesses=(1, 1), law=named("exponential", 1), velocities=(0.8,),
        duration=8, damping=Damping("contact", 0.2), bead_sensors=(0, 1, 2), samples=98,
    )  # fmt: skip
    exact = simulate(scene, rtol=1e-13)
    errors = []
    for h in (0.2, 0.1):
        run = simulate(scene, rtol=1e-2, step=h)
        moved = np.abs(run.bead_velocity - exact.bead_velocity).max()
        errors.append((np.abs(run.velocities - exact.velocities).max(), moved))
    assert np.log2(np.divide(*errors)).min() > 5.8


def test_a_shaken_linear_bead_oscillates_with_the_exact_amplitude():
    """One free bead between the driven bead and a wall, k = 1: y = a κ/(2κ - w²) sin(wt), in steady
    motion, with a resonant part that a long ramp does not excite."""
    w, a = 0.5, 0.01
    scene = Scene(
        masses=(1, 1), stiffnesses=(1,), wall=1, k=1, precompression=1, bead_sensors=(0, 1),
        duration=400, samples=4001,
        drive=Drive(amplitude=a, frequency=w / (2 * math.pi), ramp=300),
    )  # fmt: skip
    run = simulate(scene)
    late = run.time > 330
    given, free = run.bead_displacement[:, late]
    assert given == pytest.approx(a * np.sin(w * run.time[late]), abs=1e-15)
    assert free == pytest.approx(given / (2 - w * w), abs=1e-7)


def test_a_drive_from_rows_is_the_motion_that_they_sample():
    t = np.linspace(0, 20, 400)
    driven = dict(drive=Drive(time=t, displacement=0.1 * t**3 / 400), bead_sensors=(0,))
    run = simulate(
        Scene(masses=(1, 1, 1), stiffnesses=(1, 1), k=1.5, duration=20, **driven)
    )
    assert run.bead_displacement[0] == pytest.approx(0.1 * run.time**3 / 400, abs=1e-13)
    assert run.momentum_drift is None


def test_scipys_methods_are_references_of_forced_scenes():
    """A chain under load, whose damped contacts stay closed: motion, work and dissipated energy."""
    scene = Scene(
        masses=(1, 0.5, 1), stiffnesses=(1, 2), wall=1, k=1.5, precompression=1, duration=10,
        damping=Damping("contact", 0.1), drive=Drive(amplitude=0.1, frequency=0.2, ramp=3),
    )  # fmt: skip
    ours, theirs = (simulate(scene, method=m, rtol=1e-10) for m in ("RKN86", "DOP853"))
    for name in ("displacements", "velocities", "dissipated", "work"):
        np.testing.assert_allclose(
            getattr(theirs, name), getattr(ours, name), atol=3e-9
        )
    assert min(ours.dissipated, ours.work) > 1e-3


@pytest.mark.parametrize("short", [2e-3, 5e-4, 1e-5])
@pytest.mark.parametrize(
    "damping", [None, Damping("contact", 0.3), Damping("restitution", 0.7)]
)
def test_a_driven_bead_that_touches_between_two_steps_is_seen(short, damping):
    """The drive goes ``short`` beyond the second bead; steps of 1e-4 are too short to miss it."""
    scene = Scene(
        masses=(1, 1), stiffnesses=(1e6,), k=1.5, duration=1, displacements=(0, 1 - short),
        drive=Drive(amplitude=1, frequency=1), damping=damping,
    )  # fmt: skip
    exact = simulate(scene, rtol=1e-12, step=1e-4).velocities[1]
    assert exact > 0
    for rtol in 10.0 ** np.arange(-11, -4):
        velocity = simulate(scene, rtol=rtol).velocities[1]
        assert velocity == pytest.approx(exact, abs=10 * rtol * 2 * np.pi), rtol


@pytest.mark.parametrize("short", [0.1, 1e-2, 1e-3, 1e-4])
def test_a_thrown_bead_meets_a_plate_near_the_apex_of_its_flight(short):
    """Against gravity 1 a velocity of 10 reaches 50; the plate is ``short`` before the apex."""
    plate = Drive(time=(0, 6, 13, 20), displacement=(short - 50,) * 4)
    scene = Scene(
        masses=(1e-6, 1), stiffnesses=(1e6,), wall=1e4, k=1.5, gravity=1, duration=15,
        velocities=(0, -10), drive=plate,
    )  # fmt: skip
    exact = simulate(scene, rtol=1e-13, step=1e-3).velocities[1]
    assert exact > 5 + np.sqrt(
        2 * short
    )  # 5 without a collision, 5 + 2 √(2 short) at a hard plate
    for rtol in 10.0 ** np.arange(-12, -4):
        velocity = simulate(scene, rtol=rtol).velocities[1]
        assert velocity == pytest.approx(exact, abs=100 * rtol * 10), rtol
