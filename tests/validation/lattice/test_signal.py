"""Signals: the motion at a sensor at any time, against exact motions and the run's own samples."""

import pickle
from dataclasses import replace

import numpy as np
import pytest

from tests.validation.lattice.scenes import TODA, chain
from validation.lattice import knots
from validation.lattice.laws import Contact
from validation.lattice.signal import RECORDS
from validation.lattice.simulate import simulate
from validation.scenes.forcing import Damping
from validation.scenes.scene import SceneError

LINEAR = chain(
    2, k=1, velocities=(1,), duration=17.58, samples=1759, bead_sensors=(0,), contact_sensors=(0,)
)  # fmt: skip


@pytest.mark.parametrize("rtol", [1e-5, 1e-7, 1e-9, 1e-11])
def test_a_contact_that_touches_and_closes_and_one_that_opens(rtol):
    """k = 1: the force's slope jumps at the start and, in a long step, where the beads part."""
    run, end = simulate(LINEAR, rtol=rtol), np.pi / np.sqrt(2)
    exact = np.where(run.time < end, (1 + np.cos(np.sqrt(2) * run.time)) / 2, 0.0)
    assert np.abs(run.bead_velocity[0] - exact).max() < 3 * rtol
    velocity = run.signal("bead", 0, "velocity")
    assert velocity.times[[0, -1]].tolist() == [0, 17.58]
    assert np.abs(velocity.times - end).min() < 10 * rtol


@pytest.mark.parametrize(
    ("method", "damping"),
    [
        ("RKN86", None),
        ("RKN86", Damping("kuwabara_kono", 0.03)),
        ("symplectic", None),
        ("LSODA", None),
    ],
)
def test_samples_are_values_of_the_signals(method, damping):
    """Every quantity, at times of any shape; the last bead touches a wall under a load."""
    bare = chain(
        (1, 0.4, 2, 1), stiffnesses=(1, 3, 1), wall=2, precompression=0.3,
        gravity=0.1, velocities=(1.5,), duration=9, samples=501, damping=damping,
    )  # fmt: skip
    scene = replace(bare, contact_sensors=(0, 3), bead_sensors=(3, 1))
    run = simulate(scene, method=method, rtol=1e-6)
    # Watching a bead changes no digit of the motion.
    unwatched = simulate(bare, method=method, rtol=1e-6)
    np.testing.assert_array_equal(unwatched.end, run.end)
    assert unwatched.contact_force.shape == unwatched.bead_velocity.shape == (0, 501)
    with pytest.raises(ValueError, match="read-only"):
        run.time[0] = 1
    table = np.arange(500)[::-1].reshape(5, 100)  # in any order
    for (kind, quantity), name in RECORDS.items():
        numbers = scene.sensors[kind]
        for number, row in zip(numbers, getattr(run, name), strict=True):
            signal = run.signal(kind, number, quantity)
            np.testing.assert_allclose(signal(run.time[table]), row[table], atol=1e-14)
            assert np.isnan(signal([-1e-9, 9.0001])).all()
            assert (np.diff(signal.times) > 0).all()


def test_the_law_of_a_pickled_run_is_at_its_new_address(monkeypatch):
    """A law's machine code lies elsewhere in another process."""
    run = simulate(replace(LINEAR, law=TODA))
    stored = pickle.dumps(run)
    force = pickle.loads(stored).signal("contact", 0)
    assert force(0.5) == run.signal("contact", 0)(0.5) > 0
    monkeypatch.setattr(Contact, "addresses", {"force": 7})
    assert pickle.loads(stored).path.chain.laws["force"][0] == 7


def test_the_samples_of_a_run_that_is_too_long_for_signals(monkeypatch):
    run = simulate(LINEAR)
    monkeypatch.setattr(knots, "BUFFER", 40)  # room for seven steps
    monkeypatch.setattr(knots, "_MOST_BYTES", 400)
    long = simulate(LINEAR)
    np.testing.assert_array_equal(long.bead_velocity, run.bead_velocity)
    with pytest.raises(SceneError, match="too many steps to keep the motion"):
        long.signal("contact", 0)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("contact", 1), "number is 1"),
        (
            ("bead", 0, "compression"),
            "quantity is 'compression': .* velocity is wanted",
        ),
    ],
)
def test_a_missing_sensor_or_quantity_is_refused(arguments, message):
    with pytest.raises(SceneError, match=f"^{message}"):
        simulate(LINEAR).signal(*arguments)
