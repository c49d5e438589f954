"""Readings of sensors against the paper's experiment and the linear chain's exact waves."""

import tomllib
from dataclasses import replace

import pytest

from validation.lattice.simulate import simulate
from validation.pulses.sensors import (
    enough_samples,
    record,
    tracks,
)
from validation.scenes.chains import struck
from validation.scenes.scenefile import scene
from validation.studies.run import example


def test_the_first_example_is_right_within_its_errors():
    """Arrivals and peaks by SciPy's DOP853 at 1e-13 and roots of dF/dt; LAMMPS agrees."""
    found = record(replace(scene(tomllib.loads(example("paper"))), samples=101))
    here, (speed,) = {s.name: s.numbers for s in found.sensors}, found.speeds
    for measured, true in (
        (here["bead 15"]["arrival"], 0.00043509719567379),
        (here["bead 15"]["peak"], 6.3239617629857),
        (here["bead 34"]["arrival"], 0.00098886022177307),
        (here["bead 34"]["peak"], 9.0048584971877),
        (speed.numbers["speed"], 163.31895727503),
    ):
        assert abs(measured.value - true) <= measured.error
        assert measured.relative_error < 1e-8
        shown, about = map(float, str(measured).split(" ± "))
        assert abs(shown - true) <= about  # as printed


def test_sensors_without_a_pulse_say_why():
    sensors = {"contact_sensors": (4, 7, 28, 8, 6), "bead_sensors": (0, 29)}
    found = record(struck((1,), 30, duration=15, **sensors))
    here = {s.name: s for s in found.sensors}
    assert here["contact 29"].numbers == here["bead 30"].numbers == {}
    assert here["contact 29"].missing.startswith("no pulse is in the record")
    assert set(here["contact 5"].numbers) == {"arrival", "peak", "fwhm"}
    assert here["contact 5"].missing is None
    bead, reached, *lost, backwards = found.speeds
    assert set(reached.numbers) == {"speed_sites"}  # the scene has no spacings
    assert [s.missing for s in (*lost, bead)] == ["one of the two has no pulse"] * 3
    assert (backwards.places, backwards.numbers) == ((9, 7), {})
    assert "a speed needs a later second arrival" in backwards.missing


def test_a_chain_at_rest_has_no_pulses():
    """Rounding moves beads that carry their weight."""
    at_rest = replace(scene(tomllib.loads(example("vertical"))), velocities=())
    for reading in record(at_rest, every=True).sensors:
        # By its rounding the dynamic force is nowhere positive, or it is the static one.
        assert reading.missing.startswith("no pulse")


@pytest.mark.parametrize(
    ("velocities", "duration", "reason"),
    [
        # Blows on both ends meet in the middle, at equal times.
        ((1.0, *[0.0] * 58, -1.0), 52, "no wave is so fast"),
        # The small pulse from the left passes contact 20 before the large one from the right.
        ((0.3, *[0.0] * 58, -1.0), 52, "another pulse passes the second sensor before"),
        ((1.0,), 40, None),
    ],
)
def test_a_speed_is_that_of_one_pulse(velocities, duration, reason):
    """A heavy striker's pulses are followed, too."""
    sensors = (17, 40) if reason == "no wave is so fast" else (9, 19)
    scene = struck((1,), 60, velocities=velocities, duration=duration)
    (speed,) = record(replace(scene, contact_sensors=sensors)).speeds
    assert bool(speed.numbers) == (reason is None)
    assert (speed.missing or "").startswith(reason or "")
    heavy = replace(scene, masses=(20.0, *scene.masses[1:]), velocities=(1.0,))
    (speed,) = record(replace(heavy, contact_sensors=(9, 19))).speeds
    assert speed.numbers


def test_a_speed_under_load_is_that_of_one_pulse():
    """The force of the second pulse is compared with the dynamic force of the first."""
    blows = {"velocities": (0.1, *[0.0] * 58, -1.0), "duration": 30}
    load = {"wall": 1.0, "precompression": 3.0}
    (speed,) = record(struck((1,), 60, contact_sensors=(9, 19), **blows, **load)).speeds
    assert speed.missing == "another pulse passes the second sensor before"


def test_beads_with_one_contact_have_no_place():
    """Their force is that of a place half a site away."""
    every = dict(bead_sensors=(0, 1, 2), contact_sensors=(0, 1, 2))
    scene = struck((1,), 3, wall=1, duration=1, spacings=(1, 3), **every)
    found = tracks(simulate(scene))
    places = {f"{track.kind} {track.number}": track.along for track in found}
    assert places.pop("bead 1") == {}
    assert [place["speed"] for place in places.values()] == [1, 4, 0.5, 2.5, 5.5]
    last = replace(
        scene, bead_sensors=(1, 2), contact_sensors=(), wall=None, duration=5
    )
    (leg,) = record(last).speeds
    assert "a bead with one contact shows the pulse of the contact" in leg.missing


def test_velocities_are_measured_like_forces():
    """Force and velocity of the wave arrive together at a bead."""
    scene = struck((1,), 30, bead_sensors=(9, 19), duration=30, samples=2001)
    found = record(scene, velocities=["bead 20"])
    _, velocity = found.sensors
    highest = found.run.bead_velocity[1].max()
    assert velocity.quantity == "velocity"
    assert velocity.numbers["peak"].value == pytest.approx(highest, rel=1e-4)
    mixed, forces = (
        legs.speeds[0].numbers["speed_sites"] for legs in (found, record(scene))
    )
    assert mixed.value == pytest.approx(forces.value, rel=2e-3)


@pytest.mark.parametrize("name", ["paper", "vertical", "trimer", "striker"])
def test_default_samples_resolve_a_pulse_by_32(name):
    chain = scene(tomllib.loads(example(name)))
    step = chain.duration / (enough_samples(chain) - 1)
    for reading in record(chain).sensors:
        assert reading.numbers["fwhm"].value > 32 * step
