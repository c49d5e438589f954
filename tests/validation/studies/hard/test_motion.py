"""Hard cases of the integration: orders with and without lost contacts, drift, a light bead."""

from dataclasses import replace

import numpy as np
import pytest

from validation.lattice.simulate import simulate
from validation.scenes.chains import struck
from validation.studies.hard import motion as module
from validation.studies.hard.motion import (
    _box,
    _closures,
    _energy,
    _errors,
    light_bead,
    overflow,
    spreading,
)


@pytest.mark.parametrize(
    ("k", "opens", "steps", "order"),
    [
        (1.5, False, (0.2, 0.1), 6.0),
        (1.5, True, (0.2, 0.012), 2.5),
        (3.0, True, (0.15, 0.012), 4.0),
    ],
)
def test_a_contact_that_opens_leaves_k_plus_one_orders(k, opens, steps, order):
    steps = np.geomspace(*steps, 4)
    errors, again = _errors(k, opens, steps)
    slope = np.polyfit(np.log(steps), np.log(errors), 1)[0]
    assert abs(slope - order) < 0.35  # the scatter of an opening's place within its step
    assert (again > 0) is opens


def test_closures_are_counted():
    record = np.array([[1.0, 0.0, -1.0, 2.0, 0.0, 1.0], [-1.0, -1.0, 1.0, 1.0, 1.0, 1.0]])
    assert _closures(record) == 3


def test_a_step_that_is_not_refused_fails_and_one_that_is_too_long_is_told():
    scene = struck((1.0,), 20, k=20.0, duration=20.0)
    assert not overflow("fine", scene, rtol=1e-7).ok
    told = overflow("coarse", scene, step=2.5)
    assert told.ok
    assert told.says == "the motion overflows: a step of 2.5 is too long"


def test_spreading_tells_a_walk_from_a_drift_and_from_a_swing():
    """Exponent 1/2 of independent steps, 1 of equal ones, 0 of what stays where it is."""
    noise = np.random.default_rng(1).normal(size=4000)
    assert spreading(np.cumsum(noise)) == pytest.approx(0.5, abs=0.05)
    assert spreading(np.arange(200.0)) == pytest.approx(1.0, abs=1e-12)
    assert spreading(noise) == pytest.approx(0.0, abs=0.05)


def test_segments_hand_on_their_state(monkeypatch):
    """Two halves are one run: the energy's error at the end is the same."""
    monkeypatch.setattr(module, "_SEGMENTS", 2)
    halves = _energy(_box(False, 50.0), 0.5)
    whole = simulate(_box(False, 100.0), method="SRKN14", step=0.5).energy_drift
    # the energies of the middle are rounded once more
    assert halves[-1] == pytest.approx(whole, abs=1e-14)


def test_closed_contacts_do_not_drift_over_ten_thousand_time_units(monkeypatch):
    monkeypatch.setattr(module, "_SEGMENTS", 20)
    energy = _energy(_box(False, 500.0), 0.5)
    early, late = np.abs(energy[1:11]).max(), np.abs(energy[11:]).max()
    assert late < 2 * early < 1e-4
    # order 6: a step of half the size errs by 2^-6, a little less where it swings
    fine = np.abs(_energy(_box(False, 500.0), 0.25)).max()
    assert fine < np.abs(energy).max() / 30


def test_the_light_bead_holds_and_another_one_than_the_references_does_not(monkeypatch, failing):
    references, moved = {}, []

    def once(scene, **rest):  # DOP853 takes most of the time, and is the same both times
        moved.append(scene)
        if rest["method"] != "DOP853":
            return simulate(scene, **rest)
        if scene.stiffnesses not in references:
            references[scene.stiffnesses] = simulate(scene, **rest)
        return references[scene.stiffnesses]

    monkeypatch.setattr(module, "simulate", once)
    assert failing(light_bead()) == []
    # the steps are told in that of the chain without the light bead, and with no weak contact
    assert {*moved[0].masses, *moved[0].stiffnesses} == {1.0}
    monkeypatch.setattr(
        module, "simulate", lambda scene, **rest: once(spoiled(scene, rest), **rest)
    )
    assert "contacts of 1: largest error of a force at any time, over the peak" in failing(
        light_bead()
    )


def spoiled(scene, rest):
    """The engine's runs get a light bead that is a thousandth heavier than the reference's."""
    if rest["method"] == "DOP853":
        return scene
    masses = tuple(m * 1.001 if m < 1 else m for m in scene.masses)
    return replace(scene, masses=masses)
