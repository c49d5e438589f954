"""The figures and stated numbers of Porter et al. (2008), computed.

Figure 2: the force over time at three beads of the 1:1 and the 2:1 chain; with it N:1 chains up to
22:1, as far as the paper's numerics go. Figure 3a: peak force against speed over the striker's drop
heights, with both moduli of PTFE, and the exponent of V_s ~ F_m^e. Figure 3b: the FWHM from bead to
bead beside the theory for m1 ≫ m2, for the chain's own masses and for m1 = m2, whose stated errors
against the computed average are 9.2 %, 2.5 % and 22.8 %.

The three lines of figure 3b stand for equal contacts and an equal peak force, and the stated
1.092 / 0.772 = √2 says that they are times. What else the paper's FWHM is it does not say; `widths`
compares every sensible definition with the three stated errors, for the paper's closure and for
the full one.

The compiled engine integrates every chain whole, as it ends in a wall, and twice: the run at the
larger of `TOLERANCES` gives the errors.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import sympy as sp
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline
from scipy.optimize import brentq

from lwa import Dimer, TravelingWave, canonical_wave, homogenize
from validation.lattice.run import Run
from validation.lattice.simulate import COMPILED, simulate
from validation.pulses.pulse import Measured, Pulse, derived, speed
from validation.scenes.materials import DIAMETER, PTFE_BEAD, STEEL_BEAD, Bead
from validation.studies.porter2008.experiment import (
    GRAVITY,
    chain_cell,
    chain_scene,
    pulse_before_wall,
)
from validation.waves.theory import Compacton

Array = NDArray[np.float64]

HERTZ = sp.Rational(3, 2)
TOLERANCES = (1e-9, 1e-7)
"""Of the run that counts and of the one that gives its errors."""

BEADS = 38
VELOCITY = 1.37
"""Of the striker at impact in figures 2 and 3b, in m/s."""

SENSORS = {1: (15, 24, 33), 2: (16, 24, 34)}
"""N → the beads of figure 2; bead 24 is PTFE in both chains, the others are steel."""

MOST = 22
"""The largest N of the paper's numerics."""

HEIGHTS = (0.1, 0.2, 0.4, 0.6, 0.8, 1.0, 1.2)
"""Drop heights of figure 3a, in m."""

MODULI = (1.46e9, 0.6e9)
"""Of PTFE, in Pa: the dynamic one that the paper uses, and the nominal static one."""

FIRST_BEAD = 10
"""From here on the width no longer changes on its way; the average of figure 3b starts here."""

STATED = {"m1 ≫ m2": 0.092, "m2/m1 = 0.27": 0.025, "m1 = m2": 0.228}
"""The paper's errors of its three lines."""


@dataclass(frozen=True, eq=False)
class Forces:
    """Figure 2: the force of each sensor bead (mean of its contacts, N) over time (s)."""

    N: int
    beads: tuple[int, ...]
    time: Array
    force: Array


@dataclass(frozen=True)
class Speed:
    """The leading pulse of an N:1 chain, and the canonical theory's speed at its peak force."""

    N: int
    speed: Measured
    force: Measured
    theory: float


@dataclass(frozen=True)
class Scaling:
    """Figure 3a for one modulus of PTFE: V_s and F_m = (F_15 + F_34)/2 at each drop height."""

    E: float
    speeds: tuple[Measured, ...]
    forces: tuple[Measured, ...]

    @property
    def exponent(self) -> Measured:
        """The fitted e of V_s ~ F_m^e."""

        def fitted(*numbers: float) -> float:
            V, F = np.split(np.log(numbers), 2)
            return float(np.polyfit(F, V, 1)[0])

        return derived(fitted, *self.speeds, *self.forces)


@dataclass(frozen=True)
class Definition:
    """One reading of "the FWHM": its computed average, and the three lines' errors against it.

    quantity : whose force is measured. time : whether the width is one in time, else in sites.
    average : s or sites. errors : closure → line → theory over average, less 1.
    """

    quantity: str
    time: bool
    average: Measured
    errors: Mapping[str, Mapping[str, float]]

    @property
    def reproduced(self) -> tuple[str, ...]:
        """The lines of the paper's closure whose stated error comes out within half a percent."""
        found = self.errors["linear"]
        return tuple(line for line, e in STATED.items() if abs(abs(found[line]) - e) < 0.005)


@dataclass(frozen=True, eq=False)
class Widths:
    """Figure 3b: FWHM (s) of the beads' force by bead number, and definitions of its average."""

    beads: tuple[int, ...]
    times: tuple[Measured, ...]
    lines: Mapping[str, Mapping[str, float]]
    definitions: tuple[Definition, ...]


@dataclass(frozen=True, eq=False)
class Figures:
    """All of them."""

    forces: tuple[Forces, ...]
    speeds: tuple[Speed, ...]
    scaling: tuple[Scaling, ...]
    widths: Widths


def figures(progress: Callable[[Sequence[Any]], Iterable[Any]] = iter) -> Figures:
    """Compute all figures; ``progress`` (such as `tqdm.tqdm`) is shown the runs."""
    runs: list[Callable[[], Any]] = [
        *(lambda N=N: forces(N) for N in SENSORS),
        *(lambda N=N: chain_speed(N) for N in range(1, MOST + 1)),
        *(lambda E=E: scaling(E) for E in MODULI),
        widths,
    ]
    results = [run() for run in progress(runs)]
    return Figures(
        tuple(r for r in results if isinstance(r, Forces)),
        tuple(r for r in results if isinstance(r, Speed)),
        tuple(r for r in results if isinstance(r, Scaling)),
        results[-1],
    )


def _run(
    sensors: Sequence[int],
    velocity: float = VELOCITY,
    N: int = 1,
    ptfe: Bead = PTFE_BEAD,
    beads: int = BEADS,
) -> tuple[Run, Run]:
    """The chain at both of `TOLERANCES`."""
    wave = canonical_wave(chain_cell(N, ptfe), HERTZ)
    duration = 1.6 * beads * DIAMETER / _of_momentum(wave, STEEL_BEAD.mass * velocity)
    scene = chain_scene(velocity, beads, sensors, 0.0, duration, N, ptfe)
    run, check = (simulate(scene, rtol=rtol, method=COMPILED[0]) for rtol in TOLERANCES)
    return run, check


def _of_momentum(wave: TravelingWave, momentum: float) -> float:
    return Compacton.of_momentum(wave, momentum).speed


def forces(N: int) -> Forces:
    """Figure 2 for the N:1 chain."""
    run, _ = _run(SENSORS[N], N=N)
    return Forces(N, SENSORS[N], run.time, run.bead_force)


def chain_speed(N: int) -> Speed:
    """The leading pulse of the N:1 chain over some periods far from the striker, and the theory's.

    It is timed from steel bead to steel bead, over three periods or 18 beads at least, by its
    front: in chains of large N it has several humps, and not the same one stays the highest.
    """
    period = N + 1
    before, across = (max(3, math.ceil(beads / period)) for beads in (14, 18))
    sensors = (before * period + 1, (before + across) * period + 1)
    runs = _run(sensors, N=N, beads=max(BEADS, (before + across + 3) * period))
    found = [_passage(run, (sensors[1] - sensors[0]) * DIAMETER) for run in runs]
    V, force = (Measured(*numbers) for numbers in zip(*found, strict=True))
    theory = Compacton.of_bead_force(canonical_wave(chain_cell(N), HERTZ), force.value)
    return Speed(N, V, force, theory.speed)


def _passage(run: Run, distance: float) -> tuple[float, float]:
    """Speed of the front from one sensor bead to the other, and the mean of their peaks."""
    peaks = [pulse_before_wall(run, f, "bead").peak for f in run.bead_force]
    first, second = (
        _front(run.time, f, peak) for f, peak in zip(run.bead_force, peaks, strict=True)
    )
    return distance / (second - first), float(np.mean(peaks))


def _front(time: Array, force: Array, peak: float) -> float:
    """When the force first passes a tenth of the pulse's peak, by a cubic spline."""
    level = peak / 10
    first = int(np.argmax(force > level))
    spline = CubicSpline(time, force - level)
    return float(brentq(spline, time[first - 1], time[first]))


def scaling(E: float) -> Scaling:
    """Figure 3a for a modulus of PTFE, without gravity in the chain."""
    ptfe = replace(PTFE_BEAD, material=replace(PTFE_BEAD.material, E=E))
    speeds, peaks = [], []
    for height in HEIGHTS:
        runs = _run((15, 34), velocity=math.sqrt(2 * GRAVITY * height), ptfe=ptfe)
        pulses = [[pulse_before_wall(run, f, "bead") for f in run.bead_force] for run in runs]
        speeds.append(Measured(*(speed(a, b, (34 - 15) * DIAMETER) for a, b in pulses)))
        peaks.append(Measured(*(_peak(pair) for pair in pulses)))
    return Scaling(E, tuple(speeds), tuple(peaks))


def _lines(closure: str) -> dict[str, TravelingWave]:
    """The waves of the three lines: the chain's contacts, and masses m1, m2 of `STATED`."""
    cell = chain_cell()
    heavy, light = cell.masses

    def wave(m2: sp.Expr) -> TravelingWave:
        own = Dimer(heavy, m2, stiffnesses=cell.stiffnesses, spacing=cell.spacing)
        if closure == "canonical":
            return canonical_wave(own, HERTZ)
        return homogenize(own, k=HERTZ).pde.traveling_wave()

    masses = (heavy / 10**12, light, heavy)  # the first for m2 → 0, exact to 12 digits
    return dict(zip(STATED, map(wave, masses), strict=True))


def widths() -> Widths:
    """Figure 3b: the FWHM down the 1:1 chain, and what its average means."""
    beads = tuple(range(4, BEADS - 2))
    train, less = (_Train(run, beads) for run in _run(beads))
    waves = {closure: _lines(closure) for closure in ("linear", "canonical")}
    mean_force = _peak([train.pulses[b] for b in (15, 34)])
    readings = {  # quantity → the pulses' name there, the theory's, and the theory's peak
        "contact force": ("contacts", "force", _peak(train.contacts)),
        "bead force": ("late", "bead force", mean_force),
        "bead force, contact's theory": ("late", "force", mean_force),
        "steel beads' force, contact's theory": ("steel", "force", mean_force),
        "PTFE beads' force, contact's theory": ("ptfe", "force", mean_force),
    }
    definitions = []
    for quantity, (found, theory, force) in readings.items():
        for in_time in (True, False):
            average = Measured(*(one.average(found, in_time) for one in (train, less)))
            errors = {
                closure: {
                    line: _width(wave, theory, force, in_time) / average.value - 1
                    for line, wave in lines.items()
                }
                for closure, lines in waves.items()
            }
            definitions.append(Definition(quantity, in_time, average, errors))
    lines = {
        closure: {line: _width(wave, "force", mean_force, True) for line, wave in found.items()}
        for closure, found in waves.items()
    }
    times = tuple(Measured(train.pulses[b].fwhm, less.pulses[b].fwhm) for b in beads)
    return Widths(beads, times, lines, tuple(definitions))


class _Train:
    """The pulse at one bead after another of a run, and at the contacts between them."""

    def __init__(self, run: Run, beads: Sequence[int]) -> None:
        self.pulses = {
            b: pulse_before_wall(run, f, f"bead {b}")
            for b, f in zip(beads, run.bead_force, strict=True)
        }
        self.contacts = [
            pulse_before_wall(run, force, f"contact {i + 1}")
            for i, force in zip(run.scene.contact_sensors[:-1], run.contact_force[:-1], strict=True)
            if i + 1 >= FIRST_BEAD
        ]
        measured = [b for b in beads if b >= FIRST_BEAD]
        self.steel = [self.pulses[b] for b in measured if b % 2]
        self.ptfe = [self.pulses[b] for b in measured if not b % 2]
        self.late = self.steel + self.ptfe

    def average(self, name: str, in_time: bool) -> float:
        """The mean FWHM of the pulses of that name, in s or sites."""
        V = speed(self.steel[0], self.steel[-1], 2 * (len(self.steel) - 1) * DIAMETER)
        average = float(np.mean([pulse.fwhm for pulse in getattr(self, name)]))
        return average if in_time else average * V / DIAMETER


def _peak(pulses: Sequence[Pulse]) -> float:
    return float(np.mean([pulse.peak for pulse in pulses]))


def _width(wave: TravelingWave, quantity: str, force: float, in_time: bool) -> float:
    """The theory's FWHM of a quantity whose peak is ``force``, in s or sites."""
    if quantity == "bead force":
        compacton = Compacton.of_bead_force(wave, force)
    else:
        unit = Compacton(wave, 1.0)
        compacton = Compacton(wave, (force / float(unit.contact_force(0.0))) ** (1 / unit.k))
    return compacton.fwhm(quantity) / (compacton.speed if in_time else compacton.spacing)
