"""Periodic orbits of loaded chains: quadrature, linear modes, envelopes, and the engine itself."""

import math

import numpy as np
import pytest

from book.studies.breather import NoOrbit, PressedChain, orbit
from validation import Scene, simulate

HERTZ = 1.5


def dimer(beads, wall=False):
    """Masses 1 and 1/2 with a light bead in the middle, A = F0 = 1; and its index."""
    middle = beads // 2
    masses = np.where((np.arange(beads) - middle) % 2, 1.0, 0.5)
    return PressedChain(masses, np.ones(beads - 1 + wall), HERTZ, 1.0), middle


def linear_modes(chain):
    """Squared frequencies of the chain's linear modes, and their displacements in columns."""
    B, masses = chain.strains.toarray(), chain.masses
    stiffness = B.T @ np.diag(chain.slopes(np.zeros(len(masses)))) @ B
    squares, modes = np.linalg.eigh(stiffness / np.sqrt(np.outer(masses, masses)))
    return squares, modes / np.sqrt(masses)[:, None]


def test_a_small_orbit_is_a_linear_mode_with_its_multipliers():
    """e^{±iΩT} of all modes of the linear chain, at an amplitude of 1e-6."""
    chain, middle = dimer(9)
    squares, modes = linear_modes(chain)
    mode = modes[:, -1]
    omega = math.sqrt(squares[-1])
    shift = 1e-7  # of the frequency: it fixes the amplitude
    found = orbit(chain, omega * (1 - shift), 1e-3 * mode / np.abs(mode).max())
    ratio = found.amplitude / mode
    assert ratio == pytest.approx(ratio[middle], rel=1e-3)
    swing = squares[-1] * np.sum(chain.masses * found.amplitude**2) / 2
    assert found.energy == pytest.approx(swing, rel=1e-3)
    phases = np.sqrt(np.abs(squares[1:-1])) * found.period
    expected = np.sort(np.concatenate((np.cos(phases), np.cos(phases), [1] * 4)))
    assert np.sort(found.multipliers.real) == pytest.approx(expected, abs=1e-3)
    assert np.abs(found.multipliers) == pytest.approx(1, abs=1e-3)


def test_the_engine_returns_to_the_orbit():
    """A gap mode at a heavier light bead, over a hundred periods: a free breather would be pushed
    away by the wall, which the engine's scenes under load have."""
    chain, middle = dimer(61, wall=True)
    masses = chain.masses.copy()
    masses[middle] = 0.7
    pinned = PressedChain(masses, chain.stiffnesses, HERTZ, 1.0)
    squares, modes = linear_modes(pinned)
    in_gap = (squares > 3.1) & (squares < 5.95)
    place = int(np.argmax(np.where(in_gap, np.abs(modes[middle]), 0)))
    start = 0.3 * modes[:, place] / np.abs(modes[:, place]).max()
    found = orbit(pinned, 0.995 * math.sqrt(squares[place]), start, harmonics=12)
    size = np.abs(found.amplitude).max()
    assert size > 0.1 * chain.rest[0]
    assert found.residual < 1e-10
    start = found.displacements(0.0)
    scene = Scene(
        masses=masses, stiffnesses=chain.stiffnesses[:-1], wall=chain.stiffnesses[-1], k=HERTZ,
        precompression=chain.load, displacements=start, duration=100 * found.period, samples=2,
    )  # fmt: skip
    assert simulate(scene, rtol=1e-12).displacements == pytest.approx(
        start, abs=1e-7 * size
    )
    # five harmonics are as good as their residual
    rough = orbit(pinned, found.frequency, found.coefficients, harmonics=5)
    assert rough.amplitude[middle] == pytest.approx(found.amplitude[middle], rel=1e-5)
    assert rough.residual > 1e3 * found.residual


def test_without_an_orbit_newtons_method_says_so():
    chain, middle = dimer(21)
    start = np.zeros(21)
    start[middle] = 1e-4
    with pytest.raises(
        NoOrbit, match=r"^frequency is 2\.3: Newton's method finds no orbit"
    ):
        orbit(chain, 2.3, start)
