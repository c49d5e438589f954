"""The equations of motion against what is known exactly: no stored outputs."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings, strategies as st

from tests.validation.lattice.scenes import chain, on_springs
from validation.lattice.simulate import COMPILED, simulate
from validation.pulses.pulse import highest_pulse, measure
from validation.scenes.chains import struck
from validation.scenes.scene import Scene

exponents = st.floats(1.0, 3.0)
positive = st.floats(0.1, 10.0)


@settings(max_examples=15)
@given(exponents, positive, positive, positive, positive)
def test_two_beads_collide(k, m1, m2, A, v):
    """Contact time, greatest force and final velocities, in closed form for every k.

    With μ = m1 m2/(m1 + m2) the compression peaks at δ_m = ((k+1) μ v²/(2A))^{1/(k+1)} and lasts
    T = 2 δ_m/v ∫ dx/√(1 - x^{k+1}) over 0 … 1; for k = 3/2, T = 2.943 δ_m/v (Hertz).
    """
    mu = m1 * m2 / (m1 + m2)
    deepest = ((k + 1) * mu * v**2 / (2 * A)) ** (1 / (k + 1))
    q = 1 / (k + 1)
    lasting = (
        2 * deepest / v * math.sqrt(math.pi) * math.gamma(1 + q) / math.gamma(0.5 + q)
    )
    pair = chain(
        (m1, m2), stiffnesses=(A,), k=k, velocities=(v,), duration=1.2 * lasting,
        contact_sensors=(0,),
    )  # fmt: skip
    run = simulate(pair, rtol=1e-11)
    common = m1 * v / (m1 + m2)
    assert run.velocities == pytest.approx([2 * common - v, 2 * common], abs=2e-11 * v)
    pulse = measure(run.signal("contact", 0))
    assert pulse.peak == pytest.approx(A * deepest**k, rel=1e-9)
    assert pulse.arrival == pytest.approx(lasting / 2, rel=1e-9)


@pytest.mark.parametrize(
    ("method", "rtol"), [("DOP853", 1e-13), ("RKN86", 1e-13), ("symplectic", 1e-10)]
)
def test_the_linear_chain_moves_by_the_exponential_of_its_matrix(method, rtol):
    """k = 1, all contacts closed by the weight: exact. 1e-12 of 0.03 a step, 400 steps."""
    masses = 1.0, 0.3, 2.0, 0.7, 1.1
    stiffnesses = 1.0, 2.0, 0.5, 1.5, 3.0
    y = 0.01, -0.02, 0.0, 0.015, 0.0
    v = 0.0, 0.01, -0.02, 0.0, 0.03
    scene = chain(
        masses, stiffnesses=stiffnesses[:-1], wall=stiffnesses[-1], gravity=1, k=1,
        displacements=y, velocities=v, duration=20,
    )  # fmt: skip
    run = simulate(scene, rtol=rtol, method=method)
    exact = on_springs(masses, stiffnesses, y, v, 20)
    np.testing.assert_allclose(
        (run.displacements, run.velocities), exact, atol=10 * rtol
    )


@given(
    exponents,
    st.lists(positive, min_size=1, max_size=6),
    positive,
    st.sampled_from((0.0, 2.0)),
)
@settings(max_examples=10)
def test_equilibrium_stays_and_carries_the_weight_and_the_load(k, masses, A, load):
    n = len(masses)
    scene = chain(
        masses, stiffnesses=[A] * (n - 1), wall=A, k=k, gravity=1, precompression=load,
        duration=10, contact_sensors=range(n), bead_sensors=range(n),
    )  # fmt: skip
    run = simulate(scene, method="DOP853")
    # exactly: the load is computed as the force is
    assert not run.end.any()
    assert run.energy_drift == 0
    # a fused product keeps the rounding of the load, and no step is too long for so little
    for method in COMPILED:
        moved = simulate(scene, method=method).displacements
        assert np.abs(moved).max() < 1e-9 * (load + sum(masses))
    weight = load + np.cumsum(masses)
    # A ((F/A)^{1/k})^k = F up to some ulp, k ≤ 3
    np.testing.assert_allclose(run.contact_force[:, 0], weight, rtol=1e-14)
    behind = np.append(0, weight[:-1])  # bead 1 has no contact behind it
    np.testing.assert_allclose(run.bead_force[:, 0], (behind + weight) / 2, rtol=1e-14)


some_chains = st.integers(2, 6).flatmap(
    lambda n: st.builds(
        Scene,
        masses=st.tuples(*[positive] * n),
        stiffnesses=st.tuples(*[positive] * (n - 1)),
        k=st.floats(1.1, 2.5),
        velocities=st.tuples(st.floats(0.5, 2), *[st.floats(-1, 0.4)] * (n - 1)),
        duration=st.just(6),
    )
)


@settings(max_examples=25)
@given(some_chains)
def test_what_the_equations_of_motion_keep(scene):
    """Energy, momentum, and the motion if time is reversed."""
    run = simulate(scene, rtol=1e-11)
    # Contacts that open are kinks of F''; with k near 1 they cost the step control digits.
    assert abs(run.energy_drift) < 1e-7
    # By Newton's third law, to rounding; every Runge–Kutta step keeps what is linear.
    gained = np.multiply(scene.masses, run.velocities - scene.velocities)
    assert abs(gained.sum()) < 1e-12 * np.dot(scene.masses, np.abs(run.velocities))
    # Collisions amplify the integrator's error, here by at most some thousand.
    end = {"velocities": -run.velocities, "displacements": run.displacements}
    back = simulate(replace(scene, **end), rtol=1e-11)
    np.testing.assert_allclose(-back.velocities, scene.velocities, atol=1e-6)
    np.testing.assert_allclose(back.displacements, 0, atol=1e-6)


@pytest.mark.parametrize("method", ["RKN86", "symplectic", "DOP853"])
def test_a_single_bead_flies_or_bounces_off_a_wall(method):
    free = chain(1, duration=20, velocities=(1,))
    assert simulate(free, method=method).displacements == pytest.approx([20])
    walled = simulate(replace(free, wall=1.0), method=method)
    assert walled.velocities == pytest.approx([-1], abs=1e-6)


@pytest.mark.parametrize(
    ("method", "k", "wall", "most"),
    [
        *(("RKN86", k, None, 1) for k in (1.0001, 1.5, 20)),
        *(("symplectic", k, None, 10) for k in (1.1, 5)),
        *(("symplectic", k, None, 200) for k in (1.0001, 20)),
        ("RKN86", 1.5, 1e5, 10),
    ],
)
def test_the_tolerance_is_an_error_of_the_peak(method, k, wall, most):
    """As `simulate` says: of a struck chain's pulse, also at a wall 1e5 times as stiff."""
    sensor = 39 if wall else 16
    scene = struck((1,), 40, k=k, wall=wall, duration=60, contact_sensors=(sensor,))

    def peak(**options):
        return highest_pulse(simulate(scene, **options).signal("contact", sensor)).peak

    exact = peak(rtol=1e-12)
    for rtol in (1e-4, 1e-6):
        assert abs(peak(method=method, rtol=rtol) / exact - 1) < most * rtol
