"""The fixed tasks on which integrators are compared: a pulse, measured at one contact far away.

uniform, dimer : a chain of 560 beads, m1 = A = D = 1 and k = 3/2, whose first is struck to velocity
    1; measured 480 contacts further. The dimer's ω = 0.2733 is that of steel and PTFE.
exact : the uniform chain's solitary wave (`validation.waves.solver`), put on the lattice and
measured
    100 sites further, where arrival, peak and width are known from the wave itself.
experiment : the 2:1 chain of Porter et al. (2008), figure 2(d): 38 beads of steel and PTFE up to a
    steel wall. In units of the striker's mass and velocity and the first contact's stiffness.

A task is read from samples of the contact's force. Through them goes a spline of degree 7, on whose
fine table `validation.pulses.pulse` finds peak and flanks: at the tasks' sampling, its own error is
below 1e-12.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from scipy.interpolate import make_interp_spline

from lwa.exact import shorten
from validation.lattice.equations import Array
from validation.pulses.pulse import Pulse, measure
from validation.scenes.chains import carrying
from validation.scenes.checks import SceneError
from validation.scenes.scene import Scene
from validation.studies.porter2008.experiment import chain_scene
from validation.waves.solver import exact_wave

NUMBERS = ("arrival", "peak", "fwhm")
"""What is compared, of a `Pulse`."""

_SAMPLING = 0.05
"""Between samples, where the pulse's FWHM is 1.4 or more."""
_FINER = 128
"""Times as dense is the table of the spline: the error of a cubic there is below 1e-12."""

_FOOT = 0.25
"""Of the peak: the table ends where the force is below it."""
_NOTHING = 1e-15
"""Of the exact wave's strain and velocity."""


@dataclass(frozen=True, eq=False)
class Task:
    """A scene with one contact sensor, recorded from ``listen`` to its end.

    windowed : whether a window may follow the pulse.
    truth : the pulse as it must be, where it is known beforehand.
    """

    title: str
    scene: Scene
    listen: float
    windowed: bool = True
    truth: Pulse | None = None

    @cached_property
    def times(self) -> Array:
        """(S,): of the samples that are read."""
        every = np.linspace(0.0, self.scene.duration, self.scene.samples)
        kept: Array = every[every >= self.listen]
        return kept

    @property
    def contact(self) -> int:
        """At which the pulse is measured."""
        return self.scene.contact_sensors[0]

    def read(self, force: Array) -> Pulse:
        """The pulse, from the contact's force at `times`.

        Raises `validation.pulses.pulse.MeasureError` when it is not wholly there.
        """
        low = np.flatnonzero(force < _FOOT * force.max())
        before, behind = np.split(low, [np.searchsorted(low, force.argmax())])
        first, last = before[-1] if len(before) else 0, behind[0] if len(behind) else -1
        start, end = self.times[first], self.times[last]
        fine = np.linspace(start, end, _FINER * len(self.times[first:last]) + 1)
        return measure(fine, make_interp_spline(self.times, force, 7)(fine))


def errors(pulse: Pulse, reference: Pulse) -> dict[str, float]:
    """Relative errors, by `NUMBERS`."""
    return {name: abs(getattr(pulse, name) / getattr(reference, name) - 1) for name in NUMBERS}


def struck(
    omega: float, beads: int, contact: int, listen: float, duration: float, title: str = "struck"
) -> Task:
    """A dimer chain, m1 = A = 1 and k = 3/2, whose first bead has velocity 1."""
    scene = Scene(
        masses=(1.0, omega) * (beads // 2),
        stiffnesses=(1.0,) * (beads // 2 * 2 - 1),
        k=1.5,
        velocities=(1.0,),
        contact_sensors=(contact,),
        duration=duration,
        samples=round(duration / _SAMPLING) + 1,
    )
    return Task(title, scene, listen)


def uniform() -> Task:
    """480 contacts of equal beads."""
    return struck(1.0, 560, 480, 562.0, 582.0, "equal beads, 480 contacts")


def dimer() -> Task:
    """480 contacts of the dimer; light beads rattle behind the pulse."""
    return struck(0.2733, 560, 480, 490.0, 510.0, "dimer ω = 0.2733, 480 contacts")


def exact(sites: int = 100) -> Task:
    """The solitary wave of equal beads, from bead 16 to the contact so many sites further."""
    start = 16
    wave = exact_wave([1], 1.5)
    bead = np.arange(start + sites + 24) - start
    strain, velocity = wave.strain(bead[:-1] + 0.5), wave.velocity(bead)
    for values in (strain, velocity):
        values[np.abs(values) < _NOTHING] = 0.0  # rounding; ahead, the chain is at rest
    arrival, width = (sites + 0.5) / wave.c, wave.fwhm("force") / wave.c
    duration = _SAMPLING * round((arrival + 10) / _SAMPLING)
    scene = carrying(
        (1.0,) * len(bead), wave.k, strain, velocity,
        contact_sensors=(start + sites,), duration=duration,
        samples=round(duration / _SAMPLING) + 1,
    )  # fmt: skip
    truth = Pulse(arrival, 1.0, arrival - width / 2, arrival + width / 2)
    return Task(f"exact solitary wave, {sites} sites", scene, arrival - 10, truth=truth)


def experiment() -> Task:
    """The 2:1 chain, struck at 1.37 m/s; the contact of beads 33 and 34, before the wall answers.

    The wall allows no window.
    """
    si = chain_scene(1.37, 38, (16, 34), 0.0, 1e-3, N=2)
    m, A = si.masses[0], si.stiffnesses[0]
    assert si.wall is not None
    scene = replace(
        si,
        masses=tuple(mass / m for mass in si.masses),
        stiffnesses=tuple(stiffness / A for stiffness in si.stiffnesses),
        wall=si.wall / A,
        velocities=(1.0,),
        bead_sensors=(),
        contact_sensors=(32,),
        spacings=(),
        duration=172.0,
        samples=689,  # the pulse's FWHM is 18
    )
    return Task("2:1 steel:PTFE, 38 beads, wall", scene, 130.0, windowed=False)


TASKS: Mapping[str, Callable[[], Task]] = {
    "uniform": uniform,
    "dimer": dimer,
    "exact": exact,
    "experiment": experiment,
}
"""The tasks by their names."""


def known(name: str, names: Collection[str] = TASKS) -> str:
    """The name of a task; raises `SceneError` for any other."""
    if name not in names:
        raise SceneError(f"task is {shorten(name)}: one of {', '.join(names)} is wanted")
    return name
