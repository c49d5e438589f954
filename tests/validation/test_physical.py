"""The theory's physical answers against the lattice of steel spheres, in SI units."""

import math

import pytest
import sympy as sp

from lwa import Cell, canonical_wave, homogenize
from validation import Scene, exact_wave, measure, simulate
from validation.scenes.chains import STEEL_BEAD

FROM, TO = 50, 60
"""Contacts between which the pulse is timed; at 50 sites it is the lattice's own wave to 1e-8."""


@pytest.fixture(scope="module")
def chain():
    """The paper's steel beads, struck at 1 m/s, and their pulse at contact and bead `TO`."""
    watched = dict(contact_sensors=(FROM, TO), bead_sensors=(TO,), samples=6001)
    scene = Scene.of_beads(
        [STEEL_BEAD] * 80, velocities=(1.0,), duration=6.7e-4, **watched
    )
    run = simulate(scene, rtol=1e-11)
    rows = *run.contact_force, run.compression[1], *run.bead_velocity
    first, pulse, strain, moved = (measure(run.time, row) for row in rows)
    found = {
        "force": pulse.peak,
        "compression": strain.peak,
        "bead_velocity": moved.peak,
    }
    length = math.fsum(scene.spacings[FROM:TO])
    passed = length / (pulse.arrival - first.arrival)
    return scene, found | {"speed": passed, "fwhm": pulse.fwhm}


def test_the_lattice_is_the_exact_wave_in_si(chain):
    """The exact wave of m = A = D = F = 1, by Newton's method, with its units of δ and t."""
    scene, found = chain
    wave = exact_wave([1], 1.5)
    delta = (found["force"] / scene.stiffnesses[0]) ** (2 / 3)
    time = math.sqrt(scene.masses[0] * delta / found["force"])
    scaled = {
        "speed": wave.c * scene.spacings[0] / time,
        "compression": delta,
        "bead_velocity": wave.peak("velocity") * delta / time,
        "fwhm": wave.fwhm("force") / wave.c * time,
    }
    for name, value in scaled.items():
        # the integrator's error
        assert found[name] == pytest.approx(value, rel=2e-8), name


def test_the_theorys_error_is_the_same_in_si_and_without_units(chain):
    """c² by 4/5 : 0.8199588213, the force's width by 1.49094 : 1.411928; no error in δ(F)."""
    found = chain[1]
    for wave in (
        canonical_wave(Cell.of_spheres([STEEL_BEAD]), "3/2"),
        homogenize(Cell.of_spheres([STEEL_BEAD] * 2), k="3/2").pde.traveling_wave(),
    ):
        answer = wave.at_force(found["force"])
        slow = math.sqrt(0.8 / 0.8199588213)
        wide = float(sp.sqrt(10) * sp.acos(2 ** sp.Rational(5, 6) / 2)) / 1.411928
        assert float(answer.speed) / found["speed"] == pytest.approx(slow, rel=2e-8)
        assert float(answer.compression) == pytest.approx(
            found["compression"], rel=2e-9
        )
        time = float(answer.fwhm("force", "time")) / found["fwhm"]
        # Seven digits are given above.
        assert time == pytest.approx(wide / slow, rel=5e-7)
        # u_x is its mean over a site, the compression, and what the site's ends add: 10 % here
        assert float(answer.bead_velocity) == pytest.approx(
            found["bead_velocity"], rel=0.1
        )
