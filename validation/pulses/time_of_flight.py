"""A wave put into a chain with its own strains and velocities, and measured between two contacts.

m1 = A = D = 1. Runs are made at two tolerances, whose difference is the error.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from validation.lattice.simulate import simulate
from validation.pulses.pulse import Measured, derived, measure, speed
from validation.scenes.scene import Scene
from validation.waves.profile import ExactWave

METHOD = "SRKN14"


@dataclass(frozen=True)
class Passage:
    """A pulse between two contacts, at a tolerance and at a ten times coarser one.

    speed in sites per time; fwhm of the force, in sites, force and strain at the second contact.
    """

    speed: Measured
    fwhm: Measured
    force: Measured
    strain: Measured
    energy_drift: float
    momentum_drift: float
    evaluations: int


def carrying(
    masses: Sequence[float], k: float, compression: ArrayLike, velocity: ArrayLike, **rest: Any
) -> Scene:
    """A chain with these compressions of its contacts and velocities of its beads."""
    strain = np.asarray(compression, float)
    return Scene(
        masses=tuple(masses),
        stiffnesses=(1.0,) * len(strain),
        k=k,
        # The beads behind have moved by all compressions before them.
        displacements=tuple(np.append(np.cumsum(strain[::-1])[::-1], 0.0)),
        velocities=tuple(np.asarray(velocity, float)),
        **rest,
    )


def passage(scene: Scene, rtol: float = 1e-6) -> Passage:
    """Run a scene with two contact sensors and measure the pulse on its way between them."""
    a, b = scene.contact_sensors
    rows = []
    for tolerance in (rtol, 10 * rtol):
        run = simulate(scene, method=METHOD, rtol=tolerance, window=False)
        first, second = (measure(run.time, force) for force in run.contact_force)
        V = speed(first, second, b - a)
        deepest = measure(run.time, run.compression[1]).peak
        rows.append(((V, second.fwhm * V, second.peak, deepest), run))
    (fine, run), (coarse, _) = rows
    measured = (Measured(x, y) for x, y in zip(fine, coarse, strict=True))
    pace, fwhm, force, strain = measured
    return Passage(
        pace, fwhm, force, strain, run.energy_drift, run.momentum_drift or 0.0, run.evaluations
    )


def ratio(measured: Measured, expected: float) -> Measured:
    """measured / expected - 1, with its error."""
    return derived(lambda value: value / expected - 1, measured)


def uniform(wave: ExactWave, start: int, sites: int) -> Scene:
    """A uniform chain with its wave at bead ``start``, to run ``sites`` further."""
    n = 2 * start + sites
    bead = np.arange(n) - start
    return carrying(
        (1.0,) * n, wave.k, wave.strain(bead[:-1] + 0.5), wave.velocity(bead),
        contact_sensors=(start + sites // 2, start + sites), samples=4001,
        duration=(sites + start // 2) / wave.c,
    )  # fmt: skip
