"""Breathers of a loaded chain: time-periodic orbits beside their envelopes.

A = D = 1, and every contact carries the static force F0 = 1. The envelope's equation
(`lwa.envelope`) has a standing wave for each frequency (1 - Δ) ω0, ω0 an edge of a band of the
linear chain: bright, sech(bn), in the gap below the optical band of a dimer; dark, tanh(bn), below
the upper edge of equal beads. On the lattice the orbit of the same frequency is found by Newton's
method from this envelope, in a chain with free ends under the load, mirror symmetric about its
middle bead. At free ends the envelope of a dark breather is 0 as well.

The amplitude is that of the first harmonic: of the middle bead if bright, of the plateau if dark.
The width is 1/b in cells, from the full width at half maximum (bright) or half plateau (dark).
The theory's error is proportional to Δ.

**The chain.** A constant force F0 presses the first bead, and the last one against it or against a
wall, so that every contact has the static compression (F0/A_i)^{1/k}. With u the displacements
from equilibrium and B u the further compressions of the contacts, (B u)_i = u_i - u_{i+1},

    M ü = -Bᵀ [F(δ0 + B u) - F0].

**Orbits.** u(t) = Σ_h a_h cos(hωt), h = 0 … H, for orbits that are at rest at t = 0. The equations
are projected on the same cosines by the trapezoidal rule, which is spectrally accurate, and solved
by Newton's method with a sparse Jacobian (SciPy). Without a wall the mean displacement is held at
0. Newton's method starts from the envelope.

**Stability.** The Floquet multipliers are the eigenvalues of the linearised motion over a period
(SciPy's DOP853). They come in pairs λ, 1/λ; an orbit is linearly stable if all |λ| = 1. (Flach &
Gorbach, Phys. Rep. 467, 1, 2008.)
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
import scipy
from numpy.typing import ArrayLike, NDArray
from scipy.interpolate import CubicSpline

from lwa import Breather, Cell, Power, envelope
from lwa.base.arrays import Array
from lwa.base.exact import InputError
from lwa.base.frozen import Estimate
from lwa.base.progress import Progress
from lwa.command.options import quantities
from validation.pictures import Curve, Panel
from validation.report.study import EXPONENT, Report, option, study
from validation.report.table import Column, Estimates, Finding, Table, percent
from validation.scenes.checks import SceneError, between, integer, numeric

HARMONICS = 5  # H; 8 change amplitude and width by less than their errors
MOST_STEPS = 30  # of Newton's method
CLOSE = 1e-10  # largest force that a solution misses, over the load
SMALL, LARGE = (
    1e-2,
    1e3,
)  # least motion over the start's, and largest over the static compression
TOLERANCE = 1e-10  # rtol of the linearised motion

DETUNINGS = "0.0005,0.001,0.002"
# Widths 1/b in half a chain. Free ends change the amplitude by about 4e^{-2w} of bright, 4e^{-w} of
# dark envelopes: 3e-6 and 1e-5. In a much longer chain a dark one is hardly held in its place.
_WIDE = {"bright": 7.0, "dark": 13.0}
_HALF, _DIP = (
    2 * np.arccosh(2),
    2 * np.arctanh(0.5),
)  # full widths of sech, tanh at half, over 1/b
_BOUND = 4.0  # error of the theory's amplitude over Δ, at most
_FEWER = 0.75  # beads of the chain that gives the errors, over those of the chain that counts


@study(
    option(
        "--masses", "Masses of a cell, one or two.", read=quantities, default="1,1/2"
    ),
    EXPONENT,
    option(
        "--detunings",
        "Detunings 1 - f/f0, f0 the frequency of the band's edge.",
        read=quantities,
        default=DETUNINGS,
    ),
    option(
        "--beads", "Largest number of beads; short breathers take fewer.", default=601
    ),
)
def breather(
    masses: Sequence[Any] = (1, "1/2"),
    k: float = 1.5,
    detunings: Sequence[Any] = tuple(map(float, DETUNINGS.split(","))),
    beads: int = 601,
    progress: Progress[Any] = iter,
) -> Report:
    """Breathers of a loaded chain, their envelopes and their stability (twenty seconds).

    ``rows``: ``detuning_value``, ``frequency_value``, ``amplitude_value`` with its error,
    ``amplitude_theory_value``, ``amplitude_off_value`` (theory/lattice - 1), the same of ``width``,
    ``multiplier_value`` (largest modulus of a Floquet multiplier), ``energy_value``.

    Raises `lwa.InputError` for parameters out of range, among them detunings at which contacts open
    or which want more beads.
    """
    cell = Cell(masses, spacing=1)
    for mass in cell.masses:
        numeric(mass, "mass")
    beads = integer(beads, "beads", 21, 2001)
    if cell.size > 2:
        raise SceneError(
            f"masses are {cell.size}: breathers are found in cells of one or two"
        )
    between(k, "k", 1.1, 5)
    if not detunings:
        raise SceneError("detunings is empty: at least one is wanted")
    edge = envelope(cell, law=Power(k), precompression=1)
    waves = []
    for nu in detunings:
        theory = edge.breather(detuning=nu)
        half = math.ceil(_WIDE[edge.kind] * float(theory.width) * cell.size)
        if beads < 2 * half + 1:
            raise SceneError(
                f"beads is {beads}: at a detuning of {float(nu):g} {2 * half + 1} are wanted"
            )
        waves.append(Standing(cell, k, theory, half))
    return _report(cell, k, [(wave, wave.row()) for wave in progress(waves)])


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

    @cached_property
    def rest(self) -> Array:
        """Static compressions δ0 of the contacts."""
        return np.asarray((self.load / self.stiffnesses) ** (1 / self.k))

    @cached_property
    def strains(self) -> Any:
        """The sparse matrix B, which turns displacements into further compressions."""
        contacts, beads = len(self.stiffnesses), len(self.masses)
        ones = np.ones(contacts)
        return scipy.sparse.diags_array(
            (ones, -ones), offsets=(0, 1), shape=(contacts, beads)
        )

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
        return self.coefficients @ _cosines(
            self.coefficients, self.frequency * np.asarray(t)
        )

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
        end = scipy.integrate.solve_ivp(
            rate, (0, self.period), start, "DOP853", **tolerance
        )
        # The phase of the orbit and, without a wall, the motion of the whole chain give double
        # multipliers 1, which the integration's error ε splits by √ε.
        multipliers = np.linalg.eigvals(
            end.y[:, -1].reshape(2 * n, 2 * n) / unit[:, None]
        )
        return np.asarray(multipliers[np.argsort(-np.abs(multipliers))])


def orbit(
    chain: PressedChain, frequency: float, start: ArrayLike, harmonics: int = HARMONICS
) -> Orbit:
    """Return the orbit with a given frequency, found by Newton's method.

    frequency : ω > 0, in radians per unit of time. harmonics : H, number of harmonics, at least 1.
    start : displacements at t = 0, (N,), for a start with one harmonic, or coefficients (N, H + 1).

    Raises `NoOrbit` if Newton's method does not converge, or converges to the state of rest.
    """
    given = np.asarray(start, float)
    a = np.zeros((len(chain.masses), harmonics + 1))
    if given.ndim == 1:
        a[:, 1] = given
    else:
        a[:, : given.shape[1]] = given[:, : harmonics + 1]
    least, before = SMALL * np.abs(a).max(), math.inf
    for _ in range(MOST_STEPS):
        step, fault = _newton_step(chain, frequency, a)
        # Rounding stops the fall. The step does not measure convergence, as a wide orbit is
        # easily shifted along the chain.
        if fault < CLOSE * chain.load and fault > before / 4:
            return Orbit(chain, frequency, a)
        a, before = a - step, fault
        if not least < np.abs(a).max() < LARGE * chain.rest.max():
            break
    raise NoOrbit(
        f"frequency is {frequency:.8g}: Newton's method finds no orbit from this start"
    )


def continued(begin: Orbit, frequency: float) -> Orbit:
    """Continue an orbit to another frequency; raises `NoOrbit` if Newton's method fails.

    Steps adapt: an orbit that is not found halves the step, down to a hundredth of the first one.
    """
    path = [begin]
    first_step = abs(frequency - begin.frequency) / 4
    step = first_step
    while path[-1].frequency != frequency:
        last = path[-1]
        left = frequency - last.frequency
        omega = frequency
        if abs(left) > step:
            omega = last.frequency + math.copysign(step, left)
        start = last.coefficients
        if len(path) > 1:  # extrapolated from the two orbits before
            older = path[-2]
            share = (omega - last.frequency) / (last.frequency - older.frequency)
            start = start + share * (start - older.coefficients)
        try:
            path.append(orbit(begin.chain, omega, start, start.shape[1] - 1))
            step *= 1.5
        except NoOrbit:
            step /= 2
            if step < first_step / 100:
                raise
    return path[-1]


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
    matrix = (
        scipy.sparse.diags_array(inertia)
        - wide.T @ scipy.sparse.block_diag(blocks) @ wide
    )
    right = fault.ravel()
    if len(chain.stiffnesses) < n:  # no wall: the mean displacement is held
        mean = np.kron(chain.masses, np.eye(1, terms)[0])[None]
        matrix = scipy.sparse.block_array([[matrix, mean.T], [mean, None]])
        right = np.append(right, mean @ a.ravel())
    solved = scipy.sparse.linalg.spsolve(scipy.sparse.csc_array(matrix), right)
    return solved[: n * terms].reshape(n, terms), float(np.abs(fault).max())


@dataclass(frozen=True, eq=False)
class Standing:
    """A breather in a chain of 2·half + 1 beads, around a bead of the largest amplitude.

    theory : the envelope. load : static force. harmonics : of the orbit.
    """

    cell: Cell
    k: float
    theory: Breather
    half: int
    load: float = 1.0
    harmonics: int = HARMONICS

    @property
    def bright(self) -> bool:
        """True if the envelope is a sech; a dark breather's is a tanh."""
        return self.theory.kind == "bright"

    @property
    def place(self) -> int:
        """Position within the cell of the beads with the largest amplitude."""
        return int(np.argmax(np.abs(np.array(self.theory.amplitude, float))))

    @cached_property
    def beads(self) -> tuple[Array, Array]:
        """Number of the cell, and position within the cell, of each bead."""
        return np.divmod(
            np.arange(-self.half, self.half + 1) + self.place, self.cell.size
        )

    @cached_property
    def chain(self) -> PressedChain:
        """The chain under its load."""
        masses, stiffnesses = (
            np.array(values, float)[self.beads[1]]
            for values in (self.cell.masses, self.cell.stiffnesses)
        )
        return PressedChain(masses, stiffnesses[:-1], self.k, self.load)

    @cached_property
    def start(self) -> Array:
        """Displacements of the envelope at t = 0, falling to 0 at the free ends if dark."""
        (n, place), width = self.beads, float(self.theory.width)
        envelope = self.theory.displacements(np.arange(n[0], n[-1] + 1))[
            n - n[0], place
        ]
        if self.bright:
            return np.asarray(envelope)
        ends = (
            self.half + 0.5 - np.abs(np.arange(-self.half, self.half + 1))
        ) / self.cell.size
        return np.asarray(envelope * np.tanh(ends / width))

    @cached_property
    def orbit(self) -> Orbit:
        """The chain's exact periodic orbit with the envelope's frequency."""
        return orbit(
            self.chain, float(self.theory.frequency), self.start, self.harmonics
        )

    @cached_property
    def profile(self) -> tuple[Array, Array]:
        """Cell numbers and |amplitude| of the beads with the largest amplitude in their cell."""
        largest = self.beads[1] == self.place
        return self.beads[0][largest], np.abs(self.orbit.amplitude[largest])

    def numbers(self) -> dict[str, float]:
        """Measured amplitude, and width 1/b in cells, of the orbit."""
        n, size = self.profile
        peak = float(size.max())
        if self.bright:
            shape = CubicSpline(n, size - peak / 2)
            return {
                "amplitude": peak,
                "width": float(np.ptp(shape.roots(extrapolate=False))) / _HALF,
            }
        near = np.abs(n) < len(n) / 4  # the plateaus on both sides of the dip
        shape = CubicSpline(n[near], np.where(n < 0, -size, size)[near])
        ends = [
            float(shape.solve(side * peak / 2, extrapolate=False)[0])
            for side in (-1, 1)
        ]
        return {"amplitude": peak, "width": (ends[1] - ends[0]) / _DIP}

    def row(self) -> dict[str, Any]:
        """Table row of orbit and envelope; errors from a shorter chain and fewer harmonics."""
        theory = {
            "amplitude": abs(float(self.theory.amplitude[self.place])),
            "width": float(self.theory.width),
        }
        rough = replace(
            self, half=int(_FEWER * self.half), harmonics=self.harmonics - 1
        )
        check = rough.numbers()
        cells: dict[str, Any] = {
            "detuning_value": float(self.theory.detuning),
            "frequency_value": float(self.theory.frequency),
            "multiplier_value": float(np.abs(self.orbit.multipliers[0])),
            "energy_value": self.orbit.energy,
        }
        for name, value in self.numbers().items():
            cells[name] = Estimate.against(value, check[name])
            cells[f"{name}_theory_value"] = theory[name]
            cells[f"{name}_off_value"] = theory[name] / value - 1
        return cells


_COLUMNS = (
    Column("detuning_value", "Δ", format="g"),
    Column("frequency_value", "frequency", format=".6f"),
    Estimates("amplitude", "amplitude"),
    Column("amplitude_theory_value", "theory", format=".5f"),
    Column("amplitude_off_value", "off", format=percent),
    Estimates("width", "width (cells)"),
    Column("width_theory_value", "theory", format=".4f"),
    Column("width_off_value", "off", format=percent),
    Column("multiplier_value", "largest |multiplier|", format=".6f"),
    Column("energy_value", "energy", format=".5g"),
)


def _report(
    cell: Cell, k: float, breathers: Sequence[tuple[Standing, dict[str, Any]]]
) -> Report:
    rows = [row for _, row in breathers]
    kind = breathers[0][0].theory.kind
    return Report(
        f"{kind.capitalize()} breathers: masses {', '.join(map(str, cell.masses))}, k = {k:g}, "
        "F0 = A = D = 1",
        (Table(_COLUMNS, rows, "rows"),),
        tuple(_findings(rows)),
        tuple(_panels(*breathers[-1])),
        (
            "off: theory/lattice - 1. ±: change with fewer beads and harmonics. Double multipliers "
            "1 of the phase and of the whole chain's motion are split by the integration's error.",
        ),
        {"kind": kind},
    )


def _findings(rows: Sequence[dict[str, Any]]) -> Iterator[Finding]:
    """Findings on the theory's error, which is of the order of the detuning."""
    worst = max(
        abs(row["amplitude_off_value"]) / abs(row["detuning_value"]) for row in rows
    )
    yield Finding("amplitude: |theory/lattice - 1| over Δ, at most", worst, high=_BOUND)


def _panels(wave: Standing, row: dict[str, Any]) -> Iterator[Panel]:
    """The profile of the largest detuning with its envelope, and the multipliers."""
    n, size = wave.profile
    cells = np.linspace(n[0], n[-1], 1001)
    shape = cells / row["width_theory_value"]
    line = 1 / np.cosh(shape) if wave.bright else np.abs(np.tanh(shape))
    yield Panel(
        "cell",
        "amplitude of every bead that moves most",
        (
            Curve("lattice", n, size, "C0o"),
            Curve("envelope", cells, row["amplitude_theory_value"] * line, "C1-"),
        ),
        title=f"Δ = {row['detuning_value']:g}",
    )
    phase = np.linspace(0, 2 * np.pi, 361)
    multipliers = wave.orbit.multipliers
    yield Panel(
        "Re λ",
        "Im λ",
        (
            Curve("unit circle", np.cos(phase), np.sin(phase), "C7-"),
            Curve("multipliers", multipliers.real, multipliers.imag, "C3."),
        ),
    )


if __name__ == "__main__":
    breather.main()
