"""Physical answers in SI: the lattice of steel spheres, its exact wave, and the theory's wave."""

import math

import pytest

from lwa import Cell, canonical_wave
from validation import Scene, exact_wave, measure, simulate
from validation.scenes.chains import STEEL_BEAD

FROM, TO = 50, 60
"""Contacts between which the pulse is timed; at 50 sites it is the lattice's own wave to 1e-8."""


def test_answers_in_si_are_those_without_units():
    """Beads struck at 1 m/s: their pulse is the exact wave, and its units are the theory's."""
    scene = Scene.of_beads(
        [STEEL_BEAD] * 80, velocities=(1,), duration=6.7e-4,
        contact_sensors=(FROM, TO), bead_sensors=(TO,),
    )  # fmt: skip
    run = simulate(scene, rtol=1e-11)
    first, pulse = (measure(run.signal("contact", i)) for i in (FROM, TO))
    passage = pulse.arrival - first.arrival
    lattice = {
        "speed": math.fsum(scene.spacings[FROM:TO]) / passage,
        "compression": measure(run.signal("contact", TO, "compression")).peak,
        "bead_velocity": measure(run.signal("bead", TO, "velocity")).peak,
        "fwhm": pulse.fwhm,
    }
    # The units of m = A = D = F = 1
    delta = (pulse.peak / scene.stiffnesses[0]) ** (2 / 3)
    time = math.sqrt(scene.masses[0] * delta / pulse.peak)
    units = {
        "speed": scene.spacings[0] / time,
        "compression": delta,
        "bead_velocity": delta / time,
        "fwhm": time,
    }
    wave = exact_wave([1], 1.5)
    exact = {
        "speed": wave.c,
        "compression": 1,
        "bead_velocity": wave.peak("velocity"),
        "fwhm": wave.fwhm("force") / wave.c,
    }
    steel = theory(Cell.of_spheres([STEEL_BEAD]), pulse.peak)
    unit = theory(Cell([1], spacing=1), 1)
    for name, size in units.items():
        # the integrator's error
        assert lattice[name] == pytest.approx(exact[name] * size, rel=2e-8), name
        assert steel[name] == pytest.approx(unit[name] * size, rel=1e-12), name


def theory(cell, force):
    """Answers of the theory for a peak force."""
    wave = canonical_wave(cell, "3/2").at_force(force)
    answers = {"fwhm": float(wave.fwhm("force", "time"))}
    for name in ("speed", "compression", "bead_velocity"):
        answers[name] = float(getattr(wave, name))
    return answers
