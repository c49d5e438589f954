"""Damped contacts and driven chains: exact collisions, exact motion, contacts that are missed."""

import math

import numpy as np
import pytest

from lwa.law import named
from tests.validation.lattice.scenes import chain
from validation.lattice.simulate import simulate
from validation.scenes.forcing import Damping, Drive


@pytest.mark.parametrize(
    ("k", "v", "share"), [(1, 1, 0.3), (1.5, 1, 0.9), (1.5, 10, 0.05), (3, 0.2, 0.3)]
)
@pytest.mark.parametrize(
    "colliding",
    [{"masses": (1, 3), "stiffnesses": (2,)}, {"masses": (0.75,), "wall": 2}],
)
def test_beads_part_with_a_share_of_their_speed(k, v, share, colliding):
    """Two beads, and a bead and a wall, of infinite mass: the reduced mass is 3/4."""
    scene = chain(
        **colliding, k=k, velocities=(v,), contact_sensors=(0,),
        duration=12 * v ** (2 / (k + 1) - 1), damping=Damping("restitution", share),
    )  # fmt: skip
    run = simulate(scene, rtol=1e-12)
    parting = -run.motion.rate(run.velocities)
    assert parting == pytest.approx([share * v], rel=1e-10)
    assert run.contact_force.min() == 0  # no contact pulls
    assert run.dissipated == pytest.approx((1 - share**2) * 0.75 * v**2 / 2, rel=1e-10)
    assert abs(run.energy_drift) < 1e-11


@pytest.mark.parametrize(("method", "share"), [("RKN86", 1), ("DOP853", 2)])
@pytest.mark.parametrize(
    ("drive", "least"),
    [
        (None, 1),
        (Drive(velocity=0.0), 1),
        (Drive(amplitude=0.0, frequency=1.0), 48),  # 16 in a period
        (Drive(time=range(4), displacement=(0,) * 4), 6),  # two between its times
    ],
)
def test_a_scene_at_rest_stays_at_rest(drive, least, method, share):
    """Its steps resolve the drive, which error estimates alone would not."""
    damping = Damping("kuwabara_kono", 0.1)
    scene = chain(2, duration=3, drive=drive, damping=damping)
    run = simulate(scene, method=method)
    assert not np.any((run.velocities, run.displacements))
    assert run.energy_drift == run.dissipated == run.work == 0
    assert run.steps >= least / share


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


# A chain under load, whose damped contacts stay closed
DAMPED = chain(
    (1, 0.5, 1), stiffnesses=(1, 2), wall=1, precompression=1, duration=10,
    damping=Damping("contact", 0.1), drive=Drive(amplitude=0.1, frequency=0.2, ramp=3),
)  # fmt: skip
# A wall recedes from a chain that softens: δ - δ² reaches its greatest force at δ = ½, which no
# energy of the scene may pass.
SOFT = chain(
    80, wall=1, law=named("polynomial", -1, 0), precompression=0.24, duration=55,
    drive=Drive(velocity=-0.2087),
)  # fmt: skip


@pytest.mark.parametrize("scene", [DAMPED, SOFT])
def test_scipys_methods_are_references_of_forced_scenes(scene):
    """Motion, work and dissipated energy."""
    ours, theirs = (simulate(scene, method=m, rtol=1e-10) for m in ("RKN86", "DOP853"))
    np.testing.assert_allclose(theirs.end, ours.end, atol=3e-9)


BOUNCE = chain(
    (0.73,), wall=1, k=2, displacements=(-0.07,), velocities=(0.98,), duration=10,
    damping=Damping("kuwabara_kono", 0.69),
)  # fmt: skip
SHAKEN = chain(
    (0.9, 0.55), wall=1, k=3, velocities=(0, 0.05), duration=10,
    damping=Damping("contact", 0.71), drive=Drive(amplitude=0.61, frequency=0.33),
)  # fmt: skip
# A driven bead alone: no bead errs, and only quadratures of powers do. By the pair's three
# solutions, without a least error of integrals, the energy was off by 27 tolerances.
STEPS = np.random.default_rng(5).normal(size=17)
DRIVEN = chain(
    1, k=3, wall=1, gravity=0.2, duration=8, damping=Damping("contact", 0.9),
    drive=Drive(time=np.linspace(0, 8, 17), displacement=np.cumsum(STEPS) / 10),
)  # fmt: skip
# A bead between a record and a wall: no motion of another bead limits the steps; 37 tolerances.
BETWEEN = chain(
    1, k=5.25, wall=1, duration=8,
    drive=Drive(time=range(9), displacement=(0, 1, 0, 3, -1, -4, 9, 6, 2)),
)  # fmt: skip
MANY = np.geomspace(1e-5, 1e-10, 61)


@pytest.mark.parametrize(
    ("scene", "most", "tolerances"),
    [
        (BOUNCE, 5, MANY),
        (SHAKEN, 10, MANY),
        (DRIVEN, 12, [1e-10]),
        (BETWEEN, 1, [1e-12]),
    ],
)
def test_the_energy_is_kept_at_each_of_many_tolerances(scene, most, tolerances):
    """Without errors of the heat by the contact's curve 8 of BOUNCE are above; without those of a
    contact that a jump beside it clips 11 of SHAKEN."""
    for rtol in tolerances:
        assert abs(simulate(scene, rtol=rtol).energy_drift) < most * rtol


@pytest.mark.parametrize(
    ("k", "damping", "duration", "most"),
    [(120, 0.01, 1.2, 10), (200, 0.01, 2.2, 25), (200, None, 1.2, 1)],
)
def test_steep_forces_at_each_of_91_tolerances(k, damping, duration, most):
    """Errors were 40 and 85 tolerances, where an estimate was small by chance, and 3,790, where the
    rule of a contact's integrals saw little of the force."""
    scene = chain(
        3, k=k, velocities=(1,), duration=duration,
        damping=damping and Damping("contact", damping),
    )  # fmt: skip
    exact = simulate(scene, rtol=1e-13, step=2e-4).velocities
    tolerances = np.geomspace(3e-5, 1e-9, 91)
    if damping is None:
        tolerances = np.geomspace(3e-12, 1e-12, 20)
    for rtol in tolerances:
        off = np.abs(simulate(scene, rtol=rtol).velocities - exact).max()
        assert off < most * rtol


def test_heat_where_a_record_touches_the_wall_at_a_knot():
    """δ^0.3 dδ/dt makes 1e-5 of the rounding of δ there: it was 79 and 2,340 tolerances."""
    y = 0, 0.3, 0, 1.1, 0, -0.7, 0, 2, 0
    scene = chain(
        1, k=1.3, wall=1, duration=0.1, damping=Damping("kuwabara_kono", 0.02),
        drive=Drive(time=np.linspace(0, 0.1, 9), displacement=y),
    )  # fmt: skip
    exact = simulate(scene, rtol=1e-13, step=1e-5).dissipated
    for rtol in (1e-6, 1e-8, 1e-10):
        run = simulate(scene, rtol=rtol)
        most = 3 * rtol * run.motion.scales.energy
        assert run.dissipated == pytest.approx(exact, abs=most)
