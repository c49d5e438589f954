"""The equations of motion of a scene, and its characteristic scales::

    m_i y_i'' = F_{i-1} - F_i + m_i g,    F_i = A_i [δ_i⁰ + y_i - y_{i+1}]_+^k,

where ``F_{-1}`` is the precompression F0, y counts from the equilibrium, ``δ_i⁰`` is the
compression of contact i there (0 without gravity and F0) and the wall stands at ``y_n = 0`` (Porter
et al. 2008, eq. 1, for ``k = 3/2``). A contact that opens carries no tension. Damping makes forces
depend on velocities, and a drive makes the motion of bead 0 depend on time.
"""

from __future__ import annotations

import math
import sys
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import Any

import numpy as np

from lwa.base.arrays import Array
from lwa.base.files import LEAST
from validation.lattice.laws import Contact
from validation.scenes.checks import SceneError
from validation.scenes.scene import Scene


@dataclass(frozen=True)
class Scales:
    """Characteristic scales of a scene.

    Parameters
    ----------
    energy : float
        Energy of the motion above equilibrium: the initial energy, with an estimate of what a drive
        adds, or the response that a run has measured.
    compression : float
        Greatest compression by the energy or the static forces.
    displacement, velocity : float
        Displacement and velocity of a bead with this energy; in equilibrium the static compression,
        and this compression divided by ``time``; 1 without compression.
    time : float
        Shortest ``√(m/spring)`` of a bead between its contacts at the greatest compression;
        infinite without compression.
    rounding : float
        Rounding error of the static compressions divided by the displacement.
    """

    energy: float
    compression: float
    displacement: float
    velocity: float
    time: float
    rounding: float = 0.0


class Motion:
    """The time derivative of a scene's state, and its invariants.

    The state is ``(y_0 … y_{n-1}, v_0 … v_{n-1}, dissipated energy, work of the drive)``, the work
    without that by which the driven bead itself gains speed.

    Parameters
    ----------
    scene : Scene
        The scene.
    response : float, optional
        Greatest energy of the motion, if it is known; by default the initial energy and an estimate
        of the energy that a drive gives.

    Attributes
    ----------
    start : array, (2n + 2,)
        Initial state.
    rest, load : array, (contacts,)
        Static compressions and forces.
    laws : tuple of Contact
        The different laws of the contacts, for unit stiffness.
    law_of : array of int, (contacts,)
        Number of each contact's law.
    damping : array, (contacts,)
        Damping coefficients.
    """

    def __init__(self, scene: Scene, response: float | None = None) -> None:
        self.scene = scene
        self.response = response
        self.size = n = scene.size
        self.masses = np.array(scene.masses)
        self.stiffnesses = np.array(scene.stiffnesses)
        if scene.wall is not None:
            self.stiffnesses = np.append(self.stiffnesses, scene.wall)
        self._read_laws()
        self.rest = self.load = np.zeros(len(self.stiffnesses))
        if scene.gravity or scene.precompression:
            forces = np.array(scene.load) / self.stiffnesses
            # `_check_range` refuses an overflow below. The index `...` means all contacts.
            with np.errstate(over="ignore", invalid="ignore"):
                self.rest = self._each(..., Contact.compressed_by, forces)
                # The load from the rest compressions, so that equilibrium is an exact zero.
                self.load = self.force(self.rest)
            static = {"compression": self.rest, "force": self.load}
            # Called for their refusals alone.
            for name, values in static.items():
                _check_range(f"static {name}", values.min(), values.max())
        # Displacements, velocities, dissipated energy and the drive's work, 0 at the start.
        self.start = np.zeros(2 * n + 2)
        self.start[: len(scene.displacements)] = scene.displacements
        self.start[n : n + len(scene.velocities)] = scene.velocities
        if scene.drive is not None:
            # A drive tells displacement, velocity and acceleration; a state has none of the last.
            self.start[0], self.start[n], _ = scene.drive.at(0.0)

    def _read_laws(self) -> None:
        """Read the laws of the contacts and their damping.

        Contacts with one law share a `Contact`; ``law_of`` says which one. A coefficient of damping
        may depend on the exponent, the stiffness and the reduced mass ``1/(1/m_i + 1/m_{i+1})``.
        """
        scene = self.scene
        damping = scene.damping
        contacts = len(self.stiffnesses)
        # Pairs: an exponent, and a law in place of the power, or None
        laws = scene.contact_laws
        numbers = {law: n for n, law in enumerate(dict.fromkeys(laws))}
        self.law_of = np.array([numbers[law] for law in laws], int)
        self.damping = np.zeros(contacts)
        if damping is not None:
            k = np.array([exponent for exponent, _ in laws])
            # A wall has infinite mass.
            with_wall = np.append(1 / self.masses, 0.0)
            inverse = with_wall[: contacts + 1]
            reduced = 1 / (inverse[:-1] + inverse[1:])
            self.damping = damping.coefficients(k, self.stiffnesses, reduced)
        kinds = []
        for exponent, law in numbers:
            power = None
            if damping is not None:
                power = damping.power(exponent)
            kinds.append(Contact(exponent, law, power))
        self.laws = tuple(kinds)

    def _each(
        self, contacts: Any, evaluate: Callable[..., Array], *rows: Array
    ) -> Array:
        """Evaluate a method of `Contact` for some contacts, law by law.

        contacts : index of the contacts, ``...`` for all.
        rows : arguments of the method, arrays with an entry, or a row, for each of the contacts.
        """
        if len(self.laws) == 1:
            return evaluate(self.laws[0], *rows)
        result = np.empty(rows[0].shape)
        for n, law in enumerate(self.laws):
            own = self.law_of[contacts] == n
            parts = [row[own] for row in rows]
            result[own] = evaluate(law, *parts)
        return result

    def rate(self, v: Array) -> Array:
        """Return the rates dδ_i/dt of the compressions at velocities of shape (n,) or (n, S)."""
        rates = v[:-1] - v[1:]
        if len(self.rest) < len(v):
            return rates
        return np.concatenate((rates, v[-1:]))  # against a wall

    def compression(self, y: Array) -> Array:
        """Return the compressions δ_i at displacements of shape (n,) or (n, S)."""
        change = self.rate(y)
        return (self.rest + change.T).T

    def force(self, compression: Array, contacts: Any = ...) -> Array:
        """Return the elastic forces A_i F(δ_i) of all contacts, or of some.

        The compressions have the shape (contacts,) or (contacts, S), and so have the forces. NumPy
        multiplies along the last axis, which the transposes make that of the contacts.
        """
        forces = self._each(contacts, Contact.force, compression)
        stiffnesses: Array = self.stiffnesses[contacts]
        return (stiffnesses * forces.T).T

    def damped_force(
        self, elastic: Array, compression: Array, rate: Array, contacts: Any = ...
    ) -> Array:
        """Return the total forces of all contacts, or of some, at rates dδ/dt."""
        if self.scene.damping is None:
            return elastic
        rows = elastic, self.damping[contacts], compression, rate
        return self._each(contacts, Contact.damped, *rows)

    def __call__(self, time: float, state: Array) -> Array:
        """Return the time derivative of a state, which ``scipy.integrate`` takes as it is.

        The derivatives of y and v are v and the accelerations; that of the heat is the sum of
        damping force times dδ_i/dt over the contacts; that of the drive's work is its speed times
        the dynamic force of contact 0, which it overcomes.
        """
        n = self.size
        drive = self.scene.drive
        given = work = 0.0
        motions = state[: 2 * n].reshape(2, n)
        # A copy: the state is SciPy's, and a driven bead's entries are set below.
        y, v = motions.copy()
        if drive is not None:
            y[0], v[0], given = drive.at(time)
        compression = self.compression(y)
        rate = self.rate(v)
        elastic = self.force(compression)
        force = self.damped_force(elastic, compression, rate)
        # A contact pushes the bead behind it back, and the bead ahead, or the wall, on. The static
        # forces balance gravity and the precompression.
        push = np.zeros(n)
        push[: len(force)] = self.load - force
        excess = force - self.load
        push[1:] += excess[: n - 1]
        acceleration = push / self.masses
        if drive is not None:
            acceleration[0] = given
            work = -v[0] * push[0]
        resistance = force - elastic
        lost = (resistance * rate).sum()
        return np.concatenate((v, acceleration, (lost, work)))

    def energies(self, state: Array) -> tuple[Array, Array]:
        """Return kinetic energies, (n,), and elastic ones less static forces' work, (contacts,).

        All are 0 in equilibrium. Small ones have all digits.
        """
        change = self.rate(state[: self.size])
        v = state[self.size : 2 * self.size]
        stored = self._each(..., Contact.energy_above, self.rest, change)
        kinetic = self.masses * v * v / 2
        return kinetic, self.stiffnesses * stored

    @cached_property
    def initial_energies(self) -> tuple[Array, Array]:
        """Kinetic energies of the beads and elastic ones of the contacts at the start."""
        return self.energies(self.start)

    @cached_property
    def free_energy(self) -> float:
        """Initial energy of the contacts and of the beads that are not driven."""
        kinetic, stored = self.initial_energies
        free = kinetic[self.scene.drive is not None :]
        return float(free.sum() + stored.sum())

    def _energy_scale(self) -> float:
        """Return the greatest energy of the motion, known or estimated; 0 in equilibrium."""
        if self.response is not None:
            return self.response
        kinetic, stored = self.initial_energies
        # Where contacts attract each other, their energy may be negative.
        elastic = np.abs(stored).sum()
        energy = kinetic.sum() + elastic
        if self.scene.drive is not None:
            # A bead that a drive hits moves about as fast.
            fastest = self.scene.drive.fastest
            energy += self.masses.mean() * fastest * fastest
        return float(energy)

    @cached_property
    @np.errstate(all="ignore")
    def scales(self) -> Scales:
        """Characteristic scales; raises `SceneError` if a scale over- or underflows."""
        n = self.size
        energy = self._energy_scale()
        # The energy of a velocity, or of a contact that is pressed, may underflow.
        pressed = self.compression(self.start[:n]) > self.rest
        moving = self.start[n:] != 0
        if energy != 0 or moving.any() or pressed.any():
            _check_range("energy", energy)
        # Greatest compression, and greatest spring without the factor k of a power.
        deepest = stiffest = 0.0
        # F′ of the contacts, between zeros: nothing lies behind the first bead, or ahead of the
        # last one, or of a wall.
        stiff = np.zeros(len(self.rest) + 2)
        for number, law in enumerate(self.laws):
            own = self.law_of == number
            rest = self.rest[own]
            stiffnesses = self.stiffnesses[own]
            # Scale of the compression: all the energy in the stiffest contact of this law.
            static = float(rest.max())
            largest = float(stiffnesses.max())
            depth = static
            if energy > 0:
                depth = max(depth, law.reached_by(energy / largest, static))
            if not depth:
                continue
            deepest = max(deepest, depth)
            # F′ = k A δ^{k-1}. From δ = 0 the depth is that of the energy A δ^{k+1}, and y, of
            # energy = F′ y² below, is this depth if F′ lacks the factor k. The shortest time is
            # that of the true F′, with k. Other laws have k = 1, and may soften when pressed.
            slope = float(law.stiffness(np.array([static, depth])).max())
            spring = largest * slope / law.k
            stiffest = max(stiffest, spring)
            _check_range("stiffest spring", spring)
            stiff[1:-1][own] = slope * stiffnesses
        if not deepest:
            # Nothing presses: displacement and velocity have any scale, 1, and no time is short.
            return Scales(energy, 0.0, 1.0, 1.0, math.inf)
        # Of the contacts behind and ahead of each bead; a wall has no equation of motion.
        springs = stiff[:-1] + stiff[1:]
        squares = springs[:n] / self.masses  # of angular frequencies
        time = 1 / math.sqrt(squares.max())
        _check_range("shortest time", time)
        y = deepest
        v = deepest / time
        rounding = 0.0
        if energy > 0:
            # energy = F′ y² and m v², up to factors of order 1, with the mean mass
            y = math.sqrt(energy / stiffest)
            v = math.sqrt(energy / self.masses.mean())
            _check_range("displacement", y)
            _check_range("velocity", v)
            # The last digit of the static compression in a float, over the displacement y: the part
            # of the motion that rounding may hide.
            static = float(self.rest.max())
            rounding = sys.float_info.epsilon * static / y
        # Energy, greatest compression, displacement, velocity, shortest time, and rounding
        return Scales(energy, deepest, y, v, time, rounding)


@lru_cache(maxsize=1)
def motion_of(scene: Scene) -> Motion:
    """Return the equations of motion of a scene, which its runs at several tolerances share."""
    return Motion(scene)


def _check_range(name: str, *values: float) -> None:
    """Raise `SceneError` for values that overflow or are too small for a float's full accuracy."""
    for value in values:
        if not LEAST <= value < math.inf:
            raise SceneError(
                f"the scene's {name} comes out as {value:g}: choose other units"
            )
