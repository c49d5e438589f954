"""Hard cases in k: the collision of two beads, the pulse against it, and wrong theories refused."""

import math

import mpmath as mp
import numpy as np
import pytest
import sympy as sp

from validation.pulses.time_of_flight import passage, ratio
from validation.scenes.chains import carrying, launched
from validation.studies.hard import exponents as module
from validation.studies.hard.exponents import (
    collision_fwhm,
    contact_time,
    hard_spheres,
    vanishing_terms,
)
from validation.waves.solver import solve
from validation.waves.theory import Compacton, theory_at


def test_two_linear_springs_touch_for_half_a_period():
    assert contact_time(1.0, 1.0) == pytest.approx(math.pi / math.sqrt(2), rel=1e-14)
    assert contact_time(1.0, 0.25) == pytest.approx(math.pi * math.sqrt(0.2), rel=1e-14)
    # of a half sine, between the angles π/6 and 5π/6
    assert collision_fwhm(1.0) == pytest.approx(2 * math.pi / 3, rel=1e-14)


@pytest.mark.parametrize("k", [1.5, 5.0, 20.0])
def test_a_collision_is_an_incomplete_beta_function(k):
    """∫ dδ / √(1 - δ^n) from d to 1 is ∫ x^{1/n - 1} (1 - x)^{-1/2} dx / n from d^n, by x = δ^n."""
    n = k + 1

    def twice(start):
        return float(2 * mp.betainc(1 / n, 0.5, start, 1) / n)

    assert collision_fwhm(k) == pytest.approx(twice(0.5 ** (n / k)), rel=1e-13)
    deepest = (n * 0.5 / 2) ** (1 / n)  # the reduced mass of 1 and 1 is 1/2
    assert contact_time(k, 1.0) == pytest.approx(deepest * twice(0), rel=1e-13)


def test_a_chain_carries_the_strains_and_velocities_it_is_given():
    scene = carrying((1.0, 2.0, 1.0), 1.5, [0.3, 0.1], [1.0, 0.5, 0.25], duration=1.0)
    assert -np.diff(scene.displacements) == pytest.approx([0.3, 0.1], abs=1e-15)
    assert (scene.displacements[-1], scene.velocities) == (0.0, (1.0, 0.5, 0.25))


def test_a_wave_that_is_off_is_seen_on_the_lattice():
    """Velocities 1 % too large are another pulse; the exact ones are the wave to 1e-6."""
    wave = solve((1.0, 1.0), 2.0)
    scene = launched(wave, 12, 40)
    passed = passage(scene, 1e-6)
    assert abs(ratio(passed.speed, wave.c).value) < 1e-6
    faster = carrying(
        scene.masses, 2.0, -np.diff(scene.displacements), 1.01 * np.array(scene.velocities),
        contact_sensors=scene.contact_sensors, samples=4001, duration=scene.duration,
    )  # fmt: skip
    assert ratio(passage(faster, 1e-6).speed, wave.c).value > 1e-3


def test_hard_spheres_hold_but_for_a_wrong_contact_time(monkeypatch, failing):
    monkeypatch.setattr(module, "contact_time", lambda k, omega: 1.0001 * contact_time(k, omega))
    monkeypatch.setattr(module, "collision_fwhm", lambda k: 0.9999 * collision_fwhm(k))
    assert failing(hard_spheres()) == [
        "two beads, 1 : 1: time of contact/closed form - 1",
        "two beads, 1 : 0.3: time of contact/closed form - 1",
        "Newton's wave: FWHM of force in time/that of a collision of two - 1",
    ]


def test_vanishing_terms_hold_but_for_a_kink_in_the_theory(monkeypatch, failing):
    def kinked(k, omega):
        return theory_at(sp.Rational("2.01") if k == 2 else k, omega)

    monkeypatch.setattr(module, "theory_at", kinked)
    assert set(failing(vanishing_terms())) == {
        f"k = 2, {quantity}: less its mean at k ± 0.05"
        for quantity in ("FWHM of force", "FWHM of strain", "speed V_s at B = 1")
    }


def test_the_lattice_carries_the_theorys_wave_at_an_exponent_near_one():
    """As `near_linear`, at k = 1.05: the theory is off by its law there, and the lattice shows it.

    Not the theory's speed but the wave's that forms: 1.5 ε² below it is more than is allowed.
    """
    k = sp.Rational("1.05")
    wave = solve((1.0, 1.0), 1.05)
    theory = Compacton(theory_at(k, sp.Integer(1)), 1.0)
    # theory/Newton - 1 = -(3/40) ε² + O(ε³)
    assert (theory.speed / wave.c - 1) / 0.05**2 == pytest.approx(-3 / 40, rel=0.06)
