"""The equations of motion of a scene, integrated.

    m_i y_i'' = F_{i-1} - F_i + m_i g,    F_i = A_i [δ_i⁰ + y_i - y_{i+1}]_+^k,

where y counts from the equilibrium, δ_i⁰ is the compression of contact i there (0 without
gravity) and the wall stands at y_n = 0 (Porter et al. 2008, eq. 1, for k = 3/2). A contact that
opens carries no tension.

Integration is by SciPy's embedded Runge–Kutta steppers, whose own interpolant gives the samples;
only the sensors' samples are kept. Tolerances are relative to the scene's own scales of velocity
and compression, so that a run does not depend on the units.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy import integrate

from lwa.exact import shorten
from validation.checked import SceneError, real
from validation.scene import Scene

Array = NDArray[np.float64]

METHODS = ("DOP853", "RK45", "RK23")
"""SciPy's explicit Runge–Kutta pairs, of order 8, 5 and 3."""


class IntegrationError(RuntimeError):
    """The integrator could not go on; the message says where and why."""


@dataclass(frozen=True, eq=False)
class Run:
    """What a scene's sensors recorded, and how well the motion kept its invariants.

    Arrays are read-only; S is the number of samples.

    scene : what was simulated.
    time : (S,).
    contact_force, compression : (contacts, S), at the scene's contact sensors; a gap is a
        negative compression. Static forces are included.
    bead_force, bead_velocity : (beads, S), at the bead sensors; the force is the mean of the
        bead's two contacts.
    displacements, velocities : (n,), at the end.
    energy_drift : change of the energy above equilibrium over its initial value (0 if that is 0).
    momentum_drift : change of the momentum over Σ m|v| at the end; None with a wall.
    evaluations : of the equations of motion.
    """

    scene: Scene
    time: Array
    contact_force: Array
    compression: Array
    bead_force: Array
    bead_velocity: Array
    displacements: Array
    velocities: Array
    energy_drift: float
    momentum_drift: float | None
    evaluations: int


class _Motion:
    """The right-hand side for one scene, in the state (y_0 … y_{n-1}, v_0 … v_{n-1})."""

    def __init__(self, scene: Scene) -> None:
        wall = () if scene.wall is None else (scene.wall,)
        self.size = scene.size
        self.masses = np.array(scene.masses)
        self.stiffnesses = np.array(scene.stiffnesses + wall)
        self.k = scene.k
        weight = scene.gravity * np.cumsum(self.masses)[: len(self.stiffnesses)]
        self.rest = (weight / self.stiffnesses) ** (1 / self.k)
        # The load from the rest compressions, so that equilibrium is an exact zero.
        self.load = self.force(self.rest)

    def compression(self, y: Array) -> Array:
        """δ_i, for displacements of shape (n,) or (n, S)."""
        row = np.concatenate((y, np.zeros_like(y[:1]))) if len(self.rest) == len(y) else y
        result: Array = (self.rest + (row[:-1] - row[1:]).T).T
        return result

    def force(self, compression: Array) -> Array:
        """F_i = A_i [δ_i]_+^k."""
        result: Array = (self.stiffnesses * np.maximum(compression, 0.0).T ** self.k).T
        return result

    def bead_force(self, bead: int, force: Array) -> Array:
        """The mean of the forces of a bead's two contacts; an end without one counts as 0."""
        return np.asarray(force[max(bead - 1, 0) : bead + 1].sum(axis=0) / 2)

    def __call__(self, time: float, state: Array) -> Array:
        y, v = state[: self.size], state[self.size :]
        excess = self.force(self.compression(y)) - self.load
        push = np.zeros(self.size)
        push[: len(excess)] = -excess
        push[1:] += excess[: self.size - 1]
        return np.concatenate((v, push / self.masses))

    def energy(self, state: Array) -> float:
        """Kinetic and elastic energy, less the work of the weights: 0 in equilibrium."""
        compression, v = self.compression(state[: self.size]), state[self.size :]
        stored = (self.force(compression) * compression - self.load * self.rest) / (self.k + 1)
        work = self.load * (compression - self.rest)
        return float(self.masses @ v**2 / 2 + np.sum(stored - work))

    def scales(self, state: Array) -> tuple[float, float]:
        """The displacement and the velocity that the state's energy could give to a bead.

        Raises `SceneError` when floating point cannot hold that energy.
        """
        with np.errstate(over="ignore", invalid="ignore"):
            energy = self.energy(state)
        if not np.isfinite(energy) or (energy == 0 and np.any(state[self.size :])):
            raise SceneError(f"the scene's energy comes out as {energy:g}: choose other units")
        if energy <= 0 or not len(self.stiffnesses):
            return 1.0, 1.0
        stiffness = self.stiffnesses.max()
        free = (energy / stiffness) ** (1 / (self.k + 1))
        spring = stiffness * max(free, self.rest.max()) ** (self.k - 1)
        return math.sqrt(energy / spring), math.sqrt(energy / self.masses.mean())


def simulate(
    scene: Scene, *, rtol: float = 1e-9, atol: float = 1e-9, method: str = "DOP853"
) -> Run:
    """Integrate a scene and return what its sensors recorded.

    Parameters
    ----------
    rtol, atol : local error per step, relative to each component and to the scene's own scale
        of displacement and velocity.
    method : one of `METHODS`.

    A contact that opens within a step is a kink which the error estimate may miss, as the run's
    energy drift then shows.

    Raises `SceneError` for a tolerance or method that cannot be meant and `IntegrationError`
    when the integrator fails.

    >>> run = simulate(Scene(masses=(1, 1), stiffnesses=(1,), k=1.5, duration=9, velocities=(1,)))
    >>> run.velocities.round(6) + 0.0  # equal masses exchange their velocities
    array([0., 1.])
    """
    if method not in METHODS:
        raise SceneError(f"method is {shorten(method)}: one of {', '.join(METHODS)} is wanted")
    for name, tolerance in (("rtol", rtol), ("atol", atol)):
        if not 1e-13 <= real(tolerance, name) <= 1e-2:
            raise SceneError(f"{name} is {tolerance:g}: it lies between 1e-13 and 0.01")
    motion = _Motion(scene)
    start = np.zeros(2 * scene.size)
    start[: len(scene.displacements)] = scene.displacements
    start[scene.size : scene.size + len(scene.velocities)] = scene.velocities
    y, v = motion.scales(start)
    stepper = getattr(integrate, method)(
        motion,
        0.0,
        start,
        scene.duration,
        rtol=rtol,
        atol=atol * np.repeat([y, v], scene.size),
        first_step=min(1e-3 * y / v, scene.duration),  # SciPy's own guess depends on the units
    )
    time = np.linspace(0.0, scene.duration, scene.samples)
    recorder = _Recorder(motion, scene)
    done = 0
    while stepper.status == "running":
        message = stepper.step()
        if stepper.status == "failed":
            raise IntegrationError(f"integration stopped at t = {stepper.t:g}: {message}")
        until = int(np.searchsorted(time, stepper.t, side="right"))
        if recorder.listening and until > done:
            recorder.store(slice(done, until), stepper.dense_output()(time[done:until]))
            done = until
    return _result(scene, motion, recorder, time, start, stepper)


class _Recorder:
    """The sensors' samples."""

    def __init__(self, motion: _Motion, scene: Scene) -> None:
        self.motion = motion
        self.contacts = list(scene.contact_sensors)
        self.beads = list(scene.bead_sensors)
        self.listening = bool(self.contacts or self.beads)
        self.contact_force, self.compression = np.empty((2, len(self.contacts), scene.samples))
        self.bead_force, self.bead_velocity = np.empty((2, len(self.beads), scene.samples))

    def store(self, samples: slice, states: Array) -> None:
        """Keep what the sensors see of the states, of shape (2n, samples)."""
        compression = self.motion.compression(states[: self.motion.size])
        force = self.motion.force(compression)
        self.compression[:, samples] = compression[self.contacts]
        self.contact_force[:, samples] = force[self.contacts]
        self.bead_velocity[:, samples] = states[self.motion.size :][self.beads]
        for row, bead in enumerate(self.beads):
            self.bead_force[row, samples] = self.motion.bead_force(bead, force)


def _result(
    scene: Scene, motion: _Motion, recorder: _Recorder, time: Array, start: Array, stepper: Any
) -> Run:
    n, end = scene.size, stepper.y
    before, after = motion.energy(start), motion.energy(end)
    momentum = None
    if scene.wall is None:
        total = motion.masses @ np.abs(end[n:])
        change = motion.masses @ (end[n:] - start[n:])
        momentum = float(change / total) if total else 0.0
    arrays = {
        "time": time,
        "contact_force": recorder.contact_force,
        "compression": recorder.compression,
        "bead_force": recorder.bead_force,
        "bead_velocity": recorder.bead_velocity,
        "displacements": end[:n].copy(),
        "velocities": end[n:].copy(),
    }
    for array in arrays.values():
        array.setflags(write=False)
    return Run(
        scene=scene,
        **arrays,
        energy_drift=(after - before) / before if before else 0.0,
        momentum_drift=momentum,
        evaluations=int(stepper.nfev),
    )
