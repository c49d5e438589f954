"""Time-periodic orbits of a chain under constant load, and their stability.

A constant force F0 presses the first bead, and the last one against it or against a wall, so that
every contact has the static compression (F0/A_i)^{1/k}. With u the displacements from equilibrium
and B u the further compressions of the contacts, (B u)_i = u_i - u_{i+1},

    M ü = -Bᵀ [F(δ0 + B u) - F0].

**Orbits.** u(t) = Σ_h a_h cos(hωt), h = 0 … H, for orbits that are at rest at t = 0. The equations
are projected on the same cosines by the trapezoidal rule, which is spectrally accurate, and solved
by Newton's method with a sparse Jacobian (SciPy). Without a wall the mean displacement is held at
0. Newton's method starts from a near motion, such as an envelope (`lwa.envelopes`).

**Stability.** The Floquet multipliers are the eigenvalues of the linearised motion over a period
(SciPy's DOP853). They come in pairs λ, 1/λ; an orbit is linearly stable if all |λ| = 1. (Flach &
Gorbach, Phys. Rep. 467, 1, 2008.)
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
import scipy
from numpy.typing import ArrayLike, NDArray

from lwa.base.arrays import Array
from lwa.base.exact import InputError
from validation.scenes.checks import SceneError, integer, positive
from validation.waves import newton

HARMONICS = 5  # H
MOST_STEPS = 30  # of Newton's method
CLOSE = 1e-10  # largest force that a solution misses, over the load
SMALL, LARGE = 1e-2, 1e3  # least motion over the start's, and largest over the static compression
TOLERANCE = 1e-10  # rtol of the linearised motion


class NoOrbit(InputError):
    """Failure of Newton's method to find an orbit; the message names the frequency."""


@dataclass(frozen=True, eq=False)
class PressedChain:
    """A chain of contacts F = A δ^k under a constant load.

    masses : (N,). stiffnesses : A of the N - 1 contacts, and of the contact with a wall behind the
        last bead if there is one; without it the load presses the last bead, too. load : F0.
    """

    masses: Array
    stiffnesses: Array
    k: float
    load: float

    def __post_init__(self) -> None:
        for name in ("masses", "stiffnesses"):
            values = [positive(x, name) for x in getattr(self, name)]
            object.__setattr__(self, name, np.array(values))
        beads, contacts = len(self.masses), len(self.stiffnesses)
        if beads - contacts not in (0, 1):
            wanted = "one between two beads, and one more for a wall, are wanted"
            raise SceneError(f"stiffnesses are {contacts} of {beads} beads: {wanted}")
        positive(self.load, "load")

    @cached_property
    def rest(self) -> Array:
        """Static compressions δ0 of the contacts."""
        return np.asarray((self.load / self.stiffnesses) ** (1 / self.k))

    @cached_property
    def strains(self) -> Any:
        """The sparse matrix B, which turns displacements into further compressions."""
        contacts, beads = len(self.stiffnesses), len(self.masses)
        ones = np.ones(contacts)
        return scipy.sparse.diags_array((ones, -ones), offsets=(0, 1), shape=(contacts, beads))

    def forces(self, u: Array) -> Array:
        """Return F - F0 of the contacts at displacements u, (N,) or (N, times)."""
        return self.load * _power_less_one(self._shares(u), self.k)

    def slopes(self, u: Array) -> Array:
        """Return F′ of the contacts at displacements u, (N,) or (N, times)."""
        slope = self.k * self.load * (1 + self._shares(u)) ** (self.k - 1)
        return np.asarray((slope.T / self.rest).T)

    def energy(self, u: Array) -> float:
        """Return the elastic energy less the work of the loads at displacements u, (N,)."""
        stored = _power_less_one(self._shares(u), self.k + 1) / (self.k + 1)
        return float(self.load * (self.rest @ stored - np.sum(self.strains @ u)))

    def _shares(self, u: Array) -> Array:
        """Return the further compressions divided by the static ones; -1 for open contacts."""
        return np.asarray(np.maximum(((self.strains @ u).T / self.rest).T, -1))


@np.errstate(divide="ignore")  # an open contact
def _power_less_one(share: Array, exponent: float) -> Array:
    """Return (1 + share)^exponent - 1 without cancellation."""
    return np.asarray(np.expm1(exponent * np.log1p(share)))


@dataclass(frozen=True, eq=False)
class Orbit:
    """A time-periodic motion u(t) = Σ_h a_h cos(hωt) of a chain."""

    chain: PressedChain
    frequency: float  # ω, in radians per unit of time
    coefficients: Array  # a, (N, H + 1)

    @property
    def period(self) -> float:
        """Period 2π/ω of the orbit."""
        return 2 * math.pi / self.frequency

    @property
    def amplitude(self) -> Array:
        """Amplitude of the first harmonic of each bead, with its sign."""
        return np.asarray(self.coefficients[:, 1])

    @property
    def energy(self) -> float:
        """Energy above the state of rest."""
        return self.chain.energy(self.displacements(0.0))

    @property
    def residual(self) -> float:
        """Largest force by which the orbit violates the equations of motion, divided by F0."""
        # Between the times at which the equations were solved.
        phase = np.linspace(0, np.pi, 8 * self.coefficients.shape[1] + 3)
        fault = _fault(self.chain, self.frequency, self.coefficients, phase)
        return float(np.abs(fault).max()) / self.chain.load

    def displacements(self, t: ArrayLike) -> Array:
        """Return the displacements of the beads at times t, (N, *shape of t)."""
        return self.coefficients @ _cosines(self.coefficients, self.frequency * np.asarray(t))

    @cached_property
    def multipliers(self) -> NDArray[np.complex128]:
        """Floquet multipliers, the largest first."""
        chain, n = self.chain, len(self.chain.masses)
        B, inverse = chain.strains, 1 / chain.masses[:, None]

        def rate(t: float, state: Array) -> Array:
            x, v = state.reshape(2, n, 2 * n)
            push = B.T @ (chain.slopes(self.displacements(t))[:, None] * (B @ x))
            return np.concatenate((v, -inverse * push)).ravel()

        # Velocities in units of displacement times ω: all entries have one scale.
        unit = np.append(np.ones(n), np.full(n, self.frequency))
        start, tolerance = np.diag(unit).ravel(), dict(rtol=TOLERANCE, atol=TOLERANCE)
        end = scipy.integrate.solve_ivp(rate, (0, self.period), start, "DOP853", **tolerance)
        # The phase of the orbit and, without a wall, the motion of the whole chain give double
        # multipliers 1, which the integration's error ε splits by √ε.
        multipliers = np.linalg.eigvals(end.y[:, -1].reshape(2 * n, 2 * n) / unit[:, None])
        return np.asarray(multipliers[np.argsort(-np.abs(multipliers))])


def orbit(
    chain: PressedChain, frequency: float, start: ArrayLike, harmonics: int = HARMONICS
) -> Orbit:
    """Return the orbit with a given frequency, found by Newton's method.

    frequency : ω, in radians per unit of time. harmonics : H, number of harmonics.
    start : displacements at t = 0, (N,), for a start with one harmonic, or coefficients (N, H + 1).

    Raises `NoOrbit` if Newton's method does not converge, or converges to the state of rest.
    """
    omega, H = positive(frequency, "frequency"), integer(harmonics, "harmonics", 1, 100)
    given = np.asarray(start, float)
    a = np.zeros((len(chain.masses), H + 1))
    if given.ndim == 1:
        a[:, 1] = given
    else:
        a[:, : given.shape[1]] = given[:, : H + 1]
    least, before = SMALL * np.abs(a).max(), math.inf
    for _ in range(MOST_STEPS):
        step, fault = _newton_step(chain, omega, a)
        # Rounding stops the fall. The step does not measure convergence, as a wide orbit is
        # easily shifted along the chain.
        if fault < CLOSE * chain.load and fault > before / 4:
            return Orbit(chain, omega, a)
        a, before = a - step, fault
        if not least < np.abs(a).max() < LARGE * chain.rest.max():
            break
    raise NoOrbit(f"frequency is {omega:.8g}: Newton's method finds no orbit from this start")


def continued(begin: Orbit, frequency: float) -> Orbit:
    """Continue an orbit to another frequency; raises `NoOrbit` if Newton's method fails."""

    def at(omega: float, path: Sequence[tuple[float, Orbit]]) -> Orbit:
        (omega1, older), (omega2, last) = path[0], path[-1]
        start = last.coefficients  # extrapolated from the two orbits before
        if len(path) > 1:
            share = (omega - omega2) / (omega2 - omega1)
            start = start + share * (start - older.coefficients)
        return orbit(begin.chain, omega, start, start.shape[1] - 1)

    end = positive(frequency, "frequency")
    return newton.continued(begin, begin.frequency, end, abs(end - begin.frequency) / 4, at)


def _cosines(a: Array, phase: Array) -> Array:
    """Return cos(hφ) for h = 0 … H and phases φ, (H + 1, *shape of φ)."""
    return np.cos(np.multiply.outer(np.arange(a.shape[1]), phase))


def _fault(chain: PressedChain, omega: float, a: Array, phase: Array) -> Array:
    """Return the force M ü + Bᵀ [F - F0] by which the equations of motion fail, (N, phases)."""
    cosines = _cosines(a, phase)
    acceleration = -(a * (omega * np.arange(a.shape[1])) ** 2) @ cosines
    forces = chain.strains.T @ chain.forces(a @ cosines)
    return np.asarray(chain.masses[:, None] * acceleration + forces)


def _newton_step(chain: PressedChain, omega: float, a: Array) -> tuple[Array, float]:
    """Return Newton's step at the coefficients a, (N, H + 1), and the largest residual."""
    n, terms = a.shape
    times = 2 * terms  # of half a period: twice as many as are needed
    phase = np.pi / times * np.arange(times + 1)
    cosines = _cosines(a, phase)
    project = cosines * (2 / times)
    project[0] /= 2
    project[:, [0, -1]] /= 2  # the trapezoidal rule
    fault = -_fault(chain, omega, a, phase) @ project.T
    blocks = np.einsum("ht,ct,gt->chg", project, chain.slopes(a @ cosines), cosines)
    wide = scipy.sparse.kron(chain.strains, scipy.sparse.eye_array(terms))
    inertia = omega**2 * np.outer(chain.masses, np.arange(terms) ** 2).ravel()
    matrix = scipy.sparse.diags_array(inertia) - wide.T @ scipy.sparse.block_diag(blocks) @ wide
    right = fault.ravel()
    if len(chain.stiffnesses) < n:  # no wall: the mean displacement is held
        mean = np.kron(chain.masses, np.eye(1, terms)[0])[None]
        matrix = scipy.sparse.block_array([[matrix, mean.T], [mean, None]])
        right = np.append(right, mean @ a.ravel())
    solved = scipy.sparse.linalg.spsolve(scipy.sparse.csc_array(matrix), right)
    return solved[: n * terms].reshape(n, terms), float(np.abs(fault).max())
