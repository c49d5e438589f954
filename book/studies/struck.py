"""Struck chains of unlike links or resonators, and struck packings, beside `lwa.loaded_wave`.

The first bead (with its resonator), or the first layer, has a velocity. There is no load, and
contacts only push. SciPy's DOP853 integrates resonators and packings. The cases:

- ``unlike``: δ^{3/2} with δ³, and with δ, in turn. Equal masses, four decades of the force.
- ``resonators``: δ^{3/2}, and inside each bead a mass m_r on a spring k_r. A free bead and its
  resonator have the frequency ω0 = √(k_r (1/m_r + 1)); a wave of the speed V leaves no tail where
  V = ω0/(2πn) (Kevrekidis, Stefanov and Xu, Lett. Math. Phys. 106, 1067 (2016)).
- ``packings``: beads of diameter 1 in a plane hexagonal packing of δ^{3/2}, struck across its rows
  and along them. Each contact pushes along the line of its two centres, which turns as they move;
  the strip is periodic across the wave, and a share of the striker's velocity is random, so that no
  symmetry keeps the beads on their lines.

Speed and FWHM are those between two sensors, and the mean over the links of a cell.
"""

from __future__ import annotations

import math
from bisect import bisect_left
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import scipy
from numpy.typing import NDArray

from lwa import Lattice, Link, Power, Resonator, hexagonal, loaded_wave
from lwa.base.arrays import Array
from lwa.base.progress import Progress
from lwa.base.words import QuantityName
from lwa.loaded.lattice import DirectionName
from validation.lattice.laws import Contact
from validation.lattice.simulate import simulate
from validation.pictures import Curve, Panel
from validation.pulses.pulse import Pulse, measure
from validation.report.study import Report, option, study
from validation.report.table import Column, Finding, Table, percent
from validation.scenes.checks import one_of
from validation.scenes.scene import Scene

HERTZ = Power("3/2")
FORCES = 0.01, 0.1, 1.0, 10.0, 100.0  # wanted at the peak
# ω0/(2πV) with the theory's V: densest about 1, where a pulse leaves least ringing
TUNINGS = 0.76, 0.91, 0.97, 1.0124, 1.07, 1.25, 2.0, 10.0
LEAST_TUNING = 1.2  # from which on the theory of resonators is promised
STRAINS = 1e-4, 1e-3, 1e-2  # peak strains wanted in packings
# of a packing's strip, and random share of the striker's velocity
COLUMNS, RANDOM = 2, 0.01
STRIKE = 0.616  # peak velocity of a bead in the pulse over that of the striker, Hertz
SENSORS, BEADS = (60, 90), 112
# At a tenth of the tolerance, at 1.6 times the CPU, speeds and widths change by 1e-5 at most.
RTOL = 1e-6
SAMPLES = 6000  # of a motion
BEHIND = 6.0, 11.0  # sites behind the pulse, where a resonator's ringing is measured
Rates = Callable[[Array], Array]
"""Accelerations from displacements."""
Places = NDArray[np.intp]


@study(option("--case", "unlike, resonators, packings or all.", default="all"))
def struck(
    case: str = "all", least: float = 0.0, progress: Progress[Any] = iter
) -> Report:
    """Struck chains of unlike links or resonators, and struck packings (half a minute).

    least: resonators with a smaller ω0/(2πV) are left out; below `LEAST_TUNING` the theory refuses.
    ``rows``: ``case``, ``chain``, ``force_value`` and ``strain_value`` (at the peak),
    ``tuning_value`` (ω0/(2πV) of resonators), ``speed_value``, ``speed_theory_value``,
    ``speed_error_value`` (theory over lattice, less 1, as all errors), ``of`` (of which quantity
    the FWHM is), ``fwhm_value``, ``fwhm_theory_value``, ``fwhm_error_value``, ``decay_value`` (loss
    of the peak per site), ``ringing_value`` (of a resonator behind the pulse, over its peak).

    Raises `lwa.InputError` for another case.
    """
    chosen = CASES if one_of(case, ("all", *CASES), "case") == "all" else (case,)
    blows = [(name, blow) for name in chosen for blow in CASES[name](least)]
    return _report([(blow, blow.cells(name)) for name, blow in progress(blows)])


@dataclass(frozen=True)
class Seen:
    """A measured pulse, in sites and units of the time.

    peak, decay : of the quantity ``of``, "force" or "strain", and its loss per site.
    """

    of: QuantityName
    peak: float
    decay: float
    speed: float
    fwhm: float
    ringing: float | None = None

    @classmethod
    def between(
        cls, of: QuantityName, near: Sequence[Pulse], far: Sequence[Pulse]
    ) -> Seen:
        """Measure pulses of the same links at the two sensors."""
        pairs, sites = list(zip(near, far, strict=True)), SENSORS[1] - SENSORS[0]
        peaks = [float(np.mean([p.peak for p in pulses])) for pulses in (near, far)]
        speed = sites / float(np.mean([b.arrival - a.arrival for a, b in pairs]))
        width = speed * float(np.mean([p.fwhm for p in far]))
        return cls(of, peaks[1], (1 - peaks[1] / peaks[0]) / sites, speed, width)


@dataclass(frozen=True)
class Blow:
    """A lattice, struck so hard that its pulse has about a wanted peak force.

    bounds : largest errors of speed and FWHM that the study promises.
    direction : of the wave in a packing; empty for a chain.
    """

    name: str
    lattice: Lattice
    force: float
    bounds: tuple[float, float] = (math.inf, math.inf)
    direction: str = ""

    def cells(self, case: str) -> dict[str, Any]:
        """Table row: the lattice's pulse beside the theory, which refuses slow resonators."""
        size = float(self.lattice.spacing)
        theory = loaded_wave(_stiff(self.lattice), force=self.force)
        pace, velocity = (
            float(theory.speed) / size,
            float(theory.strain * theory.speed) / STRIKE,
        )
        if self.direction:
            seen = packing(self.direction, velocity, pace)
            force = seen.peak ** float(HERTZ.k) * _force_at_one(self.lattice)
        else:
            seen = chain(self.lattice, velocity, pace)
            force = seen.peak
        row = {"case": case, "chain": self.name, "force": force, "speed": seen.speed}
        row |= {
            "of": seen.of,
            "fwhm": seen.fwhm,
            "decay": seen.decay,
            "ringing": seen.ringing,
        }
        row["strain"] = float(loaded_wave(_stiff(self.lattice), force=force).strain)
        for resonator in self.lattice.resonators:
            row["tuning"] = _resonance(resonator) / (2 * math.pi * seen.speed)
        if row.get("tuning", math.inf) >= LEAST_TUNING:
            theory = loaded_wave(self.lattice, force=force)
            speed, fwhm = float(theory.speed) / size, float(theory.fwhm(seen.of)) / size
            row |= {"speed theory": speed, "fwhm theory": fwhm}
            row |= {
                "speed error": speed / seen.speed - 1,
                "fwhm error": fwhm / seen.fwhm - 1,
            }
        return row


def unlike(_: float) -> Iterator[Blow]:
    """δ^{3/2} with δ³ and with δ in turn."""
    for power in (3, 1):
        lattice = Lattice((1, 1), (Link(0, 1, HERTZ), Link(1, 2, Power(power))))
        for force in FORCES if power == 1 else (1.0,):
            yield Blow(f"δ^3/2, δ^{power}", lattice, force, (0.04, math.inf))


def resonators(least: float) -> Iterator[Blow]:
    """δ^{3/2} with resonators of two masses, tuned to ``least`` or more."""
    for mass in ("3/10", "1"):
        for tuning in TUNINGS[bisect_left(TUNINGS, least) :]:
            yield Blow(f"m_r = {mass}", resonant(mass, tuning), 1.0, (0.015, 0.06))


def packings(_: float) -> Iterator[Blow]:
    """Hexagonal packing of δ^{3/2}, across its rows and along them."""
    directions: dict[DirectionName, tuple[float, float]] = {
        "across": (0.02, 0.06),
        "along": (0.02, 0.15),
    }
    for direction, bounds in directions.items():
        lattice = hexagonal(HERTZ, direction)
        for strain in STRAINS:
            force = (strain * float(lattice.spacing)) ** float(HERTZ.k) * _force_at_one(
                lattice
            )
            small = strain <= 1e-3
            blow = Blow(direction, lattice, force, bounds, direction)
            yield blow if small else replace(blow, bounds=(math.inf, math.inf))


CASES: dict[str, Callable[[float], Iterator[Blow]]] = {
    case.__name__: case for case in (unlike, resonators, packings)
}


def resonant(mass: Any, tuning: float) -> Lattice:
    """Hertz chain with resonators: ω0/(2πV) as given, V by the theory at the peak force 1."""
    resonator = Resonator(0, mass, 1)
    lattice = Lattice((1,), (Link(0, 1, HERTZ),), (resonator,))
    frequency = (
        2 * math.pi * tuning * float(loaded_wave(_stiff(lattice), force=1).speed)
    )
    stiffness = frequency**2 / (1 / float(resonator.mass) + 1)
    return replace(lattice, resonators=(replace(resonator, stiffness=stiffness),))


def _stiff(lattice: Lattice) -> Lattice:
    """The lattice with stiff resonators; the theory's speed and strain know their mass only."""
    stiff = tuple(
        replace(resonator, stiffness=10**6) for resonator in lattice.resonators
    )
    return replace(lattice, resonators=stiff)


def _resonance(resonator: Resonator) -> float:
    """ω0 of a resonator in a bead of mass 1."""
    return math.sqrt(float(resonator.stiffness) * (1 / float(resonator.mass) + 1))


def _force_at_one(lattice: Lattice) -> float:
    """Static force of a lattice of Hertz links at the mean compression 1 of a layer."""
    compression = float(lattice.equilibrium(1).strain) * float(lattice.spacing)
    return float(compression ** -float(HERTZ.k))


def chain(lattice: Lattice, velocity: float, pace: float) -> Seen:
    """Strike the first bead of a chain, with its resonator, and measure the pulse's force."""
    size = len(lattice.masses)
    laws = [_law(link) for link in lattice.links]
    duration = (SENSORS[1] + 16) / pace
    if lattice.resonators:
        (resonator,) = lattice.resonators
        time, u = resonating(resonator, laws[0], velocity, duration)
    else:
        # The engine of scenes knows contacts of several laws, but no resonators.
        contacts = np.arange(BEADS - 1) % size
        scene = Scene(
            masses=np.resize([float(m) for m in lattice.masses], BEADS),
            stiffnesses=[float(lattice.links[i].factor) for i in contacts],
            k=[float(lattice.links[i].law.exponent) for i in contacts],
            velocities=(velocity,),
            duration=duration,
            samples=SAMPLES,
            bead_sensors=range(BEADS),
        )
        run = simulate(scene, rtol=RTOL)
        time, u = run.time, run.bead_displacement
    places = [[link.i + n - n % size for link in lattice.links] for n in SENSORS]
    pulses = [
        [measure(time, law(u[i] - u[i + 1])) for i, law in zip(at, laws, strict=True)]
        for at in places
    ]
    seen = Seen.between("force", pulses[0], pulses[1])
    if not lattice.resonators:
        return seen
    relative = u[BEADS + SENSORS[0]] - u[SENSORS[0]]
    after = (time - pulses[0][0].arrival) * seen.speed
    late = relative[(after > BEHIND[0]) & (after < BEHIND[1])]
    return replace(seen, ringing=float(np.ptp(late) / 2 / np.abs(relative).max()))


def resonating(
    resonator: Resonator,
    law: Callable[[Array], Array],
    velocity: float,
    duration: float,
) -> tuple[Array, Array]:
    """Motion of equal beads with a resonator in each: displacements of beads, then resonators."""
    mass, stiffness = float(resonator.mass), float(resonator.stiffness)

    def rates(u: Array) -> Array:
        force = np.zeros(BEADS + 1)  # of the contact before each bead
        force[1:-1] = law(u[: BEADS - 1] - u[1:BEADS])
        pull = stiffness * (u[BEADS:] - u[:BEADS])
        return np.concatenate([force[:-1] - force[1:] + pull, -pull / mass])

    start = np.zeros(2 * BEADS)
    start[::BEADS] = velocity
    return integrated(rates, start, duration)


def packing(direction: str, velocity: float, pace: float) -> Seen:
    """Strike the first layer of a hexagonal packing, and measure its mean compression."""
    layer, i, j, gap = hexagons(direction)
    n, beads = layer.max() + 1, len(layer)
    force = Contact(float(HERTZ.k)).force

    def rates(u: Array) -> Array:
        moved = u.reshape(2, beads)
        change = moved[:, j] - moved[:, i]
        now = gap + change
        length = np.hypot(*now)
        # 1 - length without cancellation, as the gap at rest has the length 1
        compression = -((2 * gap + change) * change).sum(axis=0) / (1 + length)
        push = force(compression) * now / length
        return np.concatenate(
            [np.bincount(j, p, beads) - np.bincount(i, p, beads) for p in push]
        )

    start, first = np.zeros((2, beads)), layer == 0
    start[0, first] = velocity
    start[:, first] += (
        RANDOM * velocity * np.random.default_rng(1).standard_normal((2, COLUMNS))
    )
    time, u = integrated(rates, start.ravel(), (SENSORS[1] + 16) / pace)
    mean = np.array([u[:beads][layer == at].mean(axis=0) for at in range(n)])
    pulses = [[measure(time, mean[at] - mean[at + 1])] for at in SENSORS]
    return Seen.between("strain", pulses[0], pulses[1])


def hexagons(direction: str) -> tuple[Places, Places, Places, Array]:
    """Layers of a strip's beads (N,), contacts i, j (L,), and gaps between centres (2, L)."""
    layer, column = (x.ravel() for x in np.indices((BEADS, COLUMNS)))
    thin, wide = (0.5, math.sqrt(3)) if direction == "along" else (math.sqrt(0.75), 1.0)
    places = np.array([layer * thin, (column + layer % 2 / 2) * wide])
    contacts = []
    for shift in (-COLUMNS * wide, 0.0, COLUMNS * wide):
        gap = (
            places[:, None, :]
            - places[:, :, None]
            + np.array([0, shift])[:, None, None]
        )
        ahead = (gap[0] > 0.1) | ((gap[0] == 0) & (gap[1] > 0))  # each pair once
        near = np.argwhere(ahead & (np.abs(np.hypot(*gap) - 1) < 1e-9))
        contacts += [(a, b, *gap[:, a, b]) for a, b in near]
    i, j, x, y = np.array(contacts).T
    return layer, i.astype(np.intp), j.astype(np.intp), np.array([x, y])


def integrated(rates: Rates, velocity: Array, duration: float) -> tuple[Array, Array]:
    """Sample times (S,) and displacements (N, S) of beads at rest but for their velocities (N,)."""
    size, time = len(velocity), np.linspace(0, duration, SAMPLES)

    def motion(t: float, y: Array) -> Array:
        return np.concatenate([y[size:], rates(y[:size])])

    start = np.concatenate([np.zeros(size), velocity])
    atol = RTOL * 0.01 * np.abs(velocity).max()
    run = scipy.integrate.solve_ivp(
        motion, (0, duration), start, "DOP853", time, rtol=RTOL, atol=atol
    )
    return time, run.y[:size]


def _law(link: Link) -> Callable[[Array], Array]:
    """Force of a link of a power, which only pushes."""
    force, factor = Contact(float(link.law.exponent)).force, float(link.factor)
    return lambda compression: factor * force(compression)


_COLUMNS = {
    "case": Column("case"),
    "chain": Column("chain", "chain"),
    "force": Column("force_value"),
    "strain": Column("strain_value", "strain", format=".3g"),
    "tuning": Column("tuning_value", "ω0/(2πV)", format=".3f"),
    "speed": Column("speed_value", "V (sites)", format=".6f"),
    "speed theory": Column("speed_theory_value"),
    "speed error": Column("speed_error_value", "off", format=percent),
    "of": Column("of", "FWHM of"),
    "fwhm": Column("fwhm_value", "sites", format=".4f"),
    "fwhm theory": Column("fwhm_theory_value"),
    "fwhm error": Column("fwhm_error_value", "off", format=percent),
    "decay": Column("decay_value"),
    "ringing": Column("ringing_value", "ringing", format=".1e"),
}


def _report(blows: Sequence[tuple[Blow, dict[str, Any]]]) -> Report:
    findings = []
    for blow, row in blows:
        for name, bound in zip(("speed", "fwhm"), blow.bounds, strict=True):
            at = f"{blow.name}, F = {row['force']:.3g}"
            if math.isfinite(bound) and f"{name} error" in row:
                findings.append(
                    Finding(f"{at}: {name}, error", row[f"{name} error"], -bound, bound)
                )
    rows = [row for _, row in blows]
    table = [{c.name: row.get(name) for name, c in _COLUMNS.items()} for row in rows]
    return Report(
        "Struck lattices without load, beside the relation that knows the static energy and I",
        (Table([*_COLUMNS.values()], table, "rows", by="case"),),
        tuple(findings),
        tuple(_panels(rows)),
        (
            "off: theory over lattice, less 1. Speeds and widths in sites, or layers of a packing.",
        ),
    )


def _panels(rows: Sequence[dict[str, Any]]) -> Iterator[Panel]:
    """Panels of the speed and the FWHM: theory over lattice."""
    for name, label in (("speed", "V"), ("fwhm", "FWHM")):
        known, curves = [row for row in rows if f"{name} theory" in row], []
        for chain_name in dict.fromkeys(row["chain"] for row in known):
            those = [row for row in known if row["chain"] == chain_name]
            x, y = ([row[key] for row in those] for key in (name, f"{name} theory"))
            curves.append(Curve(chain_name, x, y, "o"))
        ends = [end([row[name] for row in known]) for end in (min, max)]
        curves.append(Curve("", ends, ends, "k:"))
        yield Panel(
            f"{label} on the lattice", f"{label} by the theory", tuple(curves), "xy"
        )


if __name__ == "__main__":
    struck.main()
