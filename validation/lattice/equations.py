"""The equations of motion of a scene, and its characteristic scales.

    m_i y_i'' = F_{i-1} - F_i + m_i g,    F_i = A_i [δ_i⁰ + y_i - y_{i+1}]_+^k,

where F_{-1} is the precompression F0, y counts from the equilibrium, δ_i⁰ is the compression of
contact i there (0 without gravity and F0) and the wall stands at y_n = 0 (Porter et al. 2008,
eq. 1, for k = 3/2). A contact that opens carries no tension. Damping makes forces depend on
velocities, and a drive makes the motion of bead 0 depend on time.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from lwa.base.arrays import Array
from lwa.base.files import LEAST
from validation.lattice.laws import Contact
from validation.scenes.checks import SceneError
from validation.scenes.scene import Scene


@dataclass(frozen=True)
class Scales:
    """Characteristic scales of a scene.

    energy : initial energy above equilibrium. compression : greatest compression by the energy or
    the static forces. displacement, velocity : displacement and velocity of a bead with this
    energy; in equilibrium the static compression, and this compression divided by ``time``; 1
    without compression. time : shortest √(m/spring) of a bead between its contacts at the greatest
    compression; infinite without compression. rounding : rounding error of the static compressions
    divided by the displacement.
    """

    energy: float
    compression: float
    displacement: float
    velocity: float
    time: float
    rounding: float = 0.0


class Motion:
    """The time derivative of a scene's state, and its invariants.

    The state is (y_0 … y_{n-1}, v_0 … v_{n-1}, dissipated energy, work of the drive).

    start : initial state. loaded : True with gravity or precompression. rest, load : static
    compressions and forces of the contacts. contact : law of the contacts. response : greatest
    energy of the motion, if it is known; by default the initial energy and an estimate of the
    energy that a drive gives.
    """

    def __init__(self, scene: Scene, response: float | None = None) -> None:
        n, damping, self.response = scene.size, scene.damping, response
        several = isinstance(damping and damping.value, tuple)
        if isinstance(scene.k, tuple) or isinstance(scene.law, tuple) or several:
            raise SceneError("contacts with laws of their own are not simulated yet")
        wall = () if scene.wall is None else (scene.wall,)
        self.scene, self.size, self.k = scene, n, float(scene.k)
        rows = (
            scene.masses,
            scene.stiffnesses + wall,
            scene.displacements,
            scene.velocities,
        )
        # np.array takes 1.7 times as long, which counts in chains of 200,000 beads.
        self.masses, self.stiffnesses, y, v = (
            np.fromiter(row, float, len(row)) for row in rows
        )
        contacts = len(self.stiffnesses)
        damping_power = None if damping is None else damping.power(scene.k)
        self.contact = Contact(scene.k, scene.law, damping_power)
        self.damping = self.rest = self.load = np.zeros(contacts)
        if damping is not None:
            ahead = np.append(self.masses[1:], math.inf)[
                :contacts
            ]  # a wall has infinite mass
            reduced = 1 / (1 / self.masses[:contacts] + 1 / ahead)
            self.damping = damping.coefficients(self.k, self.stiffnesses, reduced)
        self.loaded = bool(scene.gravity or scene.precompression)
        if self.loaded:
            with np.errstate(over="ignore", invalid="ignore"):
                self.rest = self.contact.compressed_by(
                    np.array(scene.load) / self.stiffnesses
                )
                # The load from the rest compressions, so that equilibrium is an exact zero.
                self.load = self.force(self.rest)
            for name, values in (("compression", self.rest), ("force", self.load)):
                _check_range(f"static {name}", values.min(), values.max())
        self.start = np.zeros(2 * n + 2)
        self.start[: len(y)], self.start[n : n + len(v)] = y, v
        if scene.drive is not None:
            self.start[0], self.start[n], _ = scene.drive.at(0.0)

    def rate(self, v: Array) -> Array:
        """Return the rates dδ_i/dt of the compressions at velocities of shape (n,) or (n, S)."""
        wall = np.zeros_like(v[:1])
        row = np.concatenate((v, wall)) if len(self.rest) == len(v) else v
        return np.asarray(row[:-1] - row[1:])

    def compression(self, y: Array) -> Array:
        """Return the compressions δ_i at displacements of shape (n,) or (n, S)."""
        dynamic = self.rate(y)
        return np.asarray((self.rest + dynamic.T).T) if self.loaded else dynamic

    def force(self, compression: Array) -> Array:
        """Return the elastic forces A_i F(δ_i); A_i [δ_i]_+^k for a power law."""
        return np.asarray((self.stiffnesses * self.contact.force(compression).T).T)

    def __call__(self, time: float, state: Array) -> Array:
        """Return the time derivative of a state, which ``scipy.integrate`` takes as it is."""
        n, drive, given, work = self.size, self.scene.drive, 0.0, 0.0
        y, v = state[: 2 * n].reshape(2, n).copy()
        if drive is not None:
            y[0], v[0], given = drive.at(time)
        compression, rate = self.compression(y), self.rate(v)
        elastic = self.force(compression)
        force = self.contact.damped(elastic, self.damping, compression, rate)
        push = np.zeros(n)
        push[: len(force)] = self.load - force
        push[1:] += (force - self.load)[: n - 1]
        acceleration = push / self.masses
        if drive is not None:
            acceleration[0] = given
            work = v[0] * (self.masses[0] * given - push[0])
        return np.concatenate(
            (v, acceleration, (((force - elastic) * rate).sum(), work))
        )

    def energy(self, state: Array) -> float:
        """Return kinetic and elastic energy less the static forces' work; 0 in equilibrium."""
        compression, v = (
            self.compression(state[: self.size]),
            state[self.size : 2 * self.size],
        )
        stored = self.stiffnesses * self.contact.energy(compression)
        if self.loaded:
            stored -= self.stiffnesses * self.contact.energy(self.rest)
            stored -= self.load * (compression - self.rest)
        return float(np.sum(self.masses * v * v) / 2 + stored.sum())

    @cached_property
    def initial_energy(self) -> float:
        """Energy of the initial state."""
        return self.energy(self.start)

    @property
    def free_energy(self) -> float:
        """Initial energy of the contacts and of the beads that are not driven."""
        driven = self.scene.drive is not None
        given = self.masses[0] * self.start[self.size] ** 2 / 2 if driven else 0.0
        return float(self.initial_energy - given)

    def momentum_drift(self, end: Array) -> float | None:
        """Return the momentum's change up to ``end`` divided by Σ m|v|; None with wall or drive."""
        if self.scene.wall is not None or self.scene.drive is not None:
            return None
        moving = slice(self.size, 2 * self.size)
        before, after = self.start[moving], end[moving]
        total = np.sum(
            self.masses * np.abs(after)
        )  # no BLAS: its threads cost more than they gain
        return float(np.sum(self.masses * (after - before)) / total) if total else 0.0

    @cached_property
    @np.errstate(all="ignore")
    def scales(self) -> Scales:
        """Characteristic scales; raises `SceneError` if a scale over- or underflows."""
        energy, n, A = self.response, self.size, self.stiffnesses
        if energy is None:
            fastest = 0.0 if self.scene.drive is None else self.scene.drive.fastest
            energy = self.initial_energy + float(self.masses.mean() * fastest * fastest)
        deepest = at_rest = self.rest.max(initial=0.0) if self.loaded else 0.0
        stiffest = A.max(initial=0.0)
        pressed = self.compression(self.start[:n]).max(initial=0.0) > deepest
        if not math.isfinite(energy) or (
            energy == 0 and (pressed or self.start[n : 2 * n].any())
        ):
            _check_range("energy", energy)
        if energy > 0 and len(A):
            deepest = max(deepest, self.contact.reached_by(energy / stiffest, deepest))
        if not deepest:
            return Scales(energy, 0.0, 1.0, 1.0, math.inf)
        stiffening = deepest ** (
            self.k - 1
        )  # F′ = k A δ^{k-1}; the factor k follows in ``time``
        if self.contact.law is not None:  # k is 1
            stiffening = self.contact.stiffness(np.array([at_rest, deepest])).max()
        springs = np.zeros(n)  # of the two contacts of each bead
        springs[: len(A)] = A
        springs[1:] += A[: n - 1]
        time = 1 / np.sqrt((springs / self.masses).max() * self.k * stiffening)
        _check_range("stiffest spring", stiffest * stiffening)
        _check_range("shortest time", time)
        y, v, rounding = deepest, deepest / time, 0.0
        if energy > 0:
            # energy = F′ y² and m v², up to factors of order 1, with the mean mass
            y = np.sqrt(energy / (stiffest * stiffening))
            v = np.sqrt(energy / (self.masses.sum() / n))
            _check_range("displacement", y)
            _check_range("velocity", v)
            rounding = np.finfo(float).eps * at_rest / y
        return Scales(
            energy, float(deepest), float(y), float(v), float(time), float(rounding)
        )


def _check_range(name: str, *values: float) -> None:
    """Raise `SceneError` for values that overflow or are too small for a float's full accuracy."""
    for value in values:
        if not LEAST <= value < math.inf:
            raise SceneError(
                f"the scene's {name} comes out as {value:g}: choose other units"
            )
