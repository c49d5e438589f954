"""The fixed tasks on which integrators are compared: a pulse, measured at one contact far away.

uniform, dimer : a chain of 560 beads, m1 = A = D = 1 and k = 3/2, whose first is struck to velocity
    1; measured 480 contacts further. The dimer's ω = 0.2733 is that of steel and PTFE.
exact : the uniform chain's solitary wave (`validation.waves.solver`), put on the lattice and
    measured 100 sites further, where arrival, peak and width are known from the wave itself.
experiment : the 2:1 chain of Porter et al. (2008), figure 2(d): 38 beads of steel and PTFE up to a
    steel wall. In units of the striker's mass and velocity and the first contact's stiffness.

The contact's force is a spline of degree 7 through its samples, whose own error is below 1e-12.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property, partial
from typing import Any

import numpy as np
import scipy

from lwa.base.arrays import Array
from validation.lattice.equations import Motion
from validation.lattice.run import Run
from validation.pulses.pulse import Pulse, measure
from validation.scenes import chains
from validation.scenes.chains import chain_scene
from validation.scenes.scene import Scene
from validation.waves.solver import exact_wave

NUMBERS = ("arrival", "peak", "fwhm")
"""What is compared, of a `Pulse`."""

_SAMPLING = 0.05  # time between samples, where the pulse's FWHM is 1.4 or more
_FINER = 128  # times as dense is the table of the spline
_FOOT = 0.25  # of the peak, where the table ends


@dataclass(frozen=True, eq=False)
class Task:
    """A scene with one contact sensor, recorded from ``listen`` to its end; ``truth`` is the pulse
    as it must be, where it is known beforehand."""

    scene: Scene
    listen: float
    truth: Pulse | None = None

    @property
    def windowed(self) -> bool:
        """Whether a window may follow the pulse: no waves come back."""
        return self.scene.wall is None

    @cached_property
    def times(self) -> Array:
        """(S,): of the samples that are read."""
        every = np.linspace(0.0, self.scene.duration, self.scene.samples)
        return np.asarray(every[every >= self.listen])

    @property
    def contact(self) -> int:
        """At which the pulse is measured."""
        return self.scene.contact_sensors[0]

    def force(self, run: Run) -> Array:
        """(S,): of the contact at `times`, in a run of the scene."""
        return np.asarray(run.contact_force[0, -len(self.times) :])

    def force_at(self, displacements: Array) -> Array:
        """(S,): the same, from the displacements of all beads (n, S) at `times`."""
        motion = Motion(self.scene)
        return np.asarray(motion.force(motion.compression(displacements))[self.contact])

    def read(self, force: Array) -> Pulse:
        """The pulse of the dynamic force, from the contact's force at `times`.

        Raises `validation.pulses.pulse.MeasureError` when it is not wholly there.
        """
        force = force - self.scene.load[self.contact]
        low = np.flatnonzero(force < _FOOT * force.max())
        before, behind = np.split(low, [np.searchsorted(low, force.argmax())])
        first, last = before[-1] if len(before) else 0, behind[0] if len(behind) else -1
        start, end = self.times[first], self.times[last]
        fine = np.linspace(start, end, _FINER * len(self.times[first:last]) + 1)
        return measure(fine, scipy.interpolate.make_interp_spline(self.times, force, 7)(fine))


def settings(first: float, last: float) -> tuple[float, ...]:
    """By half a decade: 1e-5, 3e-6, 1e-6, …."""
    steps = round(2 * np.log10(first / last))
    return tuple(float(f"{first * 10 ** (-i / 2):.0e}") for i in range(steps + 1))


def errors(pulse: Pulse, reference: Pulse) -> dict[str, float]:
    """Relative errors, by `NUMBERS`."""
    return {name: abs(getattr(pulse, name) / getattr(reference, name) - 1) for name in NUMBERS}


def struck(omega: float, beads: int, contact: int, listen: float, duration: float) -> Task:
    """A dimer chain, m1 = A = 1 and k = 3/2, whose first bead has velocity 1."""
    scene = chains.struck((1.0, omega), beads, contact_sensors=(contact,), **_recorded(duration))
    return Task(scene, listen)


def _recorded(duration: float) -> dict[str, Any]:
    """For so long, at `_SAMPLING`."""
    count = round(duration / _SAMPLING)
    return {"duration": _SAMPLING * count, "samples": count + 1}


def exact(sites: int = 100) -> Task:
    """The solitary wave of equal beads, from bead 16 to the contact so many sites further."""
    start, wave = 16, exact_wave([1], 1.5)
    arrival, width = (sites + 0.5) / wave.c, wave.fwhm("force") / wave.c
    recorded = {"contact_sensors": (start + sites,), **_recorded(arrival + 10)}
    truth = Pulse(arrival, 1.0, arrival - width / 2, arrival + width / 2)
    return Task(chains.launched(wave, start, sites, **recorded), arrival - 10, truth=truth)


def experiment() -> Task:
    """The 2:1 chain, struck at 1.37 m/s; contact of beads 33 and 34, before the wall answers."""
    si = chain_scene(1.37, 38, (16, 34), 0.0, 1e-3, N=2)
    m, A = si.masses[0], si.stiffnesses[0]
    assert si.wall is not None
    scene = Scene(
        masses=tuple(mass / m for mass in si.masses),
        stiffnesses=tuple(stiffness / A for stiffness in si.stiffnesses),
        wall=si.wall / A, k=si.k, velocities=(1.0,), contact_sensors=(32,),
        duration=172.0, samples=689,  # the pulse's FWHM is 18
    )  # fmt: skip
    return Task(scene, 130.0)


def precompressed(beads: int = 200, sites: int = 150) -> Task:
    """Equal beads under a static force of 1; from the first to the contact so many sites further,
    where the pulse passes at 0.814 units of time a site."""
    arrival = 0.814 * sites
    scene = Scene(
        masses=(1.0,) * beads, stiffnesses=(1.0,) * (beads - 1), wall=1.0, precompression=1.0,
        k=1.5, velocities=(1.0,), contact_sensors=(sites,), **_recorded(arrival + 10),
    )  # fmt: skip
    return Task(scene, arrival - 10)


TASKS: Mapping[str, Callable[[], Task]] = {
    "uniform": partial(struck, 1.0, 560, 480, 562.0, 582.0),
    "dimer": partial(struck, 0.2733, 560, 480, 490.0, 510.0),
    "exact": exact,
    "experiment": experiment,
    "precompressed": precompressed,
}
"""The tasks by their names."""
