"""The experiment and the figures of Porter et al. (2008) on the lattice, beside the theory.

A steel bead strikes a chain in which PTFE and steel beads alternate. The chain has 38 beads,
numbered from 1 (the striker), and ends in a steel wall. As in the paper, sensors sit in beads 15
and 34, the peak force is F_m = (F_15 + F_34)/2, and the speed V_s is the distance of the two beads
over the time between their peaks. The force of a bead is the mean of its two contacts' forces.

Bead 15 is steel and bead 34 PTFE: the shapes of their pulses differ, so that V_s is not the speed
of the pulse. The speed between beads of one kind stands beside V_s.

The amplitude of the theory's wave is set in turn by F_m and by the striker's momentum, as if the
pulse took all of it.

Figure 2: the force over time at three beads of the 1:1 and the 2:1 chain. Figure 3a: peak force
against speed over the striker's drop heights, with both moduli of PTFE, and the exponent of
V_s ~ F_m^e. Figure 3b: the errors of the theory's FWHM; `book/studies/widths.py` draws the figure.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import chain
from typing import Any

import scipy
import sympy as sp

from lwa import (
    Cell,
    CompactWave,
    Dimer,
    PhysicalWave,
    Sphere,
    canonical_wave,
    homogenize,
)
from lwa.base.exact import number
from lwa.base.progress import Progress
from lwa.expansion.physical import GRAVITY
from validation.lattice.cost import RunProgress, silent
from validation.lattice.result import Run
from validation.lattice.simulate import simulate, simulate_many, twice
from validation.pictures import Curve, Panel
from validation.pulses.pulse import Pulse, compared, exponent
from validation.pulses.sensors import Train
from validation.report.command import option, study
from validation.report.result import Report
from validation.report.table import Column, Table, percent
from validation.scenes.chains import DIAMETER, PTFE, PTFE_BEAD, STEEL, STEEL_BEAD
from validation.scenes.checks import between, positive
from validation.scenes.scene import Scene

HERTZ = sp.Rational(3, 2)
BEADS, SENSORS, VELOCITY = (
    38,
    (15, 34),
    1.37,
)  # sensors are numbered from the striker, 1; in m/s
LIKE = (15, 33), (16, 34)  # beads of one kind, both steel and both PTFE
TOLERANCES = (
    1e-10,
    1e-9,
)  # rtol of the run that counts and of the run that gives its errors
SOURCES = ("F_m", "striker")
"""Names of the quantities that set the theory's amplitude."""

RECORDED = {1: (15, 24, 33), 2: (16, 24, 34)}  # N → beads of figure 2; 24 is PTFE
HEIGHTS = (0.1, 0.2, 0.4, 0.6, 0.8, 1.0, 1.2)  # drop heights of figure 3a, in m
MODULI = (1.46e9, 0.6e9)  # of PTFE, in Pa: dynamic, as in the paper, and nominal static
STATED = {"m1 ≫ m2": 0.092, "m2/m1 = 0.27": 0.025, "m1 = m2": 0.228}
"""Lines of figure 3b → errors of the FWHM that the paper states, without a sign."""

FIRST_BEAD = (
    10  # from here on the width no longer changes on its way: the average starts here
)
_UNITS = {
    "speed": "m/s",
    "peak": "N",
    "FWHM": "sites",
}  # by the first word; µs "in time"


_COLUMNS = (
    *(Column("quantity", "quantity"), Column("unit", "unit")),
    Column("lattice", "lattice", error=True),
    *chain.from_iterable(
        (
            Column(f"theory_value.{source}", f"by {source}", format=".5g"),
            Column(f"error_value.{source}", "error", format=percent),
        )
        for source in SOURCES
    ),
)
_NOTE = """\
The force of a bead is the mean of its two contacts'; numbers that name no bead are means over both
sensor beads (odd ones are steel, even ones PTFE) or over their four contacts. The theory's
amplitude is set by F_m or by all of the striker's momentum; error: theory/lattice - 1.
Between steel and PTFE, V_s compares peaks of different shape, and is not the pulse's speed.
±: error of the integration."""


def chain_cell(N: int = 1, ptfe: Sphere = PTFE_BEAD) -> Cell:
    """Unit cell of N steel beads and one of PTFE, in SI units."""
    return Cell.of_spheres([STEEL_BEAD] * N + [ptfe])


def recorded_chain(
    sensors: Sequence[int],
    velocity: float = VELOCITY,
    N: int = 1,
    ptfe: Sphere = PTFE_BEAD,
) -> Scene:
    """Return the N:1 chain of steel and PTFE, struck by its first bead, until the pulse has run to
    the wall and back.

    sensors : beads, counted from 1; the two contacts of each of them and the contact of the steel
    wall behind the chain are recorded too. velocity : in m/s. N : steel beads in a cell. ptfe : the
    other bead.
    """
    momentum = float(STEEL_BEAD.mass) * velocity
    pulse = of_momentum(canonical_wave(chain_cell(N, ptfe), HERTZ), momentum)
    around = sorted({bead - 1 + side for bead in sensors for side in (-1, 0)})
    return Scene.of_beads(
        [STEEL_BEAD if place % (N + 1) else ptfe for place in range(1, BEADS + 1)],
        wall=STEEL,
        velocities=(velocity,),
        bead_sensors=[bead - 1 for bead in sensors],
        contact_sensors=[*around, BEADS - 1],
        # A pulse with all of the striker's momentum needs two thirds of this time to the wall.
        duration=1.6 * BEADS * DIAMETER / float(pulse.speed),
        samples=60 * BEADS,
    )


@study(
    option("--velocity", default=VELOCITY, says="Velocity of the striker in m/s."),
)
def paper(
    velocity: float = VELOCITY,
    tolerances: tuple[float, float] = TOLERANCES,
    run_progress: RunProgress = silent,
) -> Report:
    """The experiment of Porter et al. (2008): a chain of steel and PTFE beads in turn is struck at
    one end. Speed, peak force and FWHM on the lattice, and by the theory.

    tolerances: of the run and of the less accurate run that gives its errors. Raises `SceneError`
    for a velocity out of range.

    ``velocity_value``, ``beads``, ``sensors``, ``rows``: ``quantity``, ``unit``, ``lattice_value``,
    ``lattice_error_value``, and by the quantity that sets the theory's amplitude (``F_m``,
    ``striker``) ``theory_value`` {…} and ``error_value`` {…}, theory over lattice - 1.
    """
    velocity = between(velocity, "velocity", 1e-6, 1000)
    scene = recorded_chain(sorted({*SENSORS, *chain.from_iterable(LIKE)}), velocity)
    run, check = twice(scene, *tolerances, progress=run_progress)

    def measured(run: Run) -> dict[str, float]:
        return numbers(Train.of(run), Train.of(run, "contact"))

    lattice = compared(measured, run, check, rtol=tolerances[0])
    wave = homogenize(chain_cell(), k=HERTZ).pde.traveling_wave()
    waves = (
        PhysicalWave(wave, lattice["peak bead force F_m"].value, "bead"),
        of_momentum(wave, float(STEEL_BEAD.mass) * velocity),
    )
    theories = [theory_numbers(wave) for wave in waves]
    rows = []
    for name, value in lattice.items():
        unit = "µs" if name.endswith("in time") else _UNITS[name.split()[0]]
        pairs = [(theory[name], theory[name] / value.value - 1) for theory in theories]
        rows.append((name, unit, value, *chain.from_iterable(pairs)))
    return Report(
        f"{BEADS} beads, steel (the striker, {velocity:g} m/s) and PTFE in turn, steel wall; "
        f"sensors in beads {SENSORS[0]} and {SENSORS[1]}",
        (Table(_COLUMNS, tuple(rows), "rows", note=_NOTE),),
        panels=(_panel(run, waves[0]),),
        data={"velocity_value": velocity, "beads": BEADS, "sensors": SENSORS},
    )


def theory_numbers(wave: PhysicalWave) -> dict[str, float]:
    """Return the `numbers` of the theory's wave."""
    V = float(wave.speed)

    def train(peak: float, fwhm: float) -> Train:
        half, times = fwhm / V / 2, {i: i * DIAMETER / V for i in range(1, BEADS + 1)}
        return Train(
            {i: Pulse(t, peak, t - half, t + half) for i, t in times.items()}, DIAMETER
        )

    beads = train(float(wave.bead_force), bead_fwhm(wave.wave))
    contacts = train(float(wave.contact_force), float(wave.fwhm("force")))
    return numbers(beads, contacts)


def numbers(beads: Train, contacts: Train) -> dict[str, float]:
    """Return speeds, peak forces and FWHM at the two beads `SENSORS`, in `_UNITS`.

    Numbers whose names hold no bead are means over both beads or over their four contacts.
    """
    both = beads.only(SENSORS)
    around = contacts.only([bead + side for bead in SENSORS for side in (-1, 0)])
    sites = both.speed / DIAMETER
    return {
        "speed V_s": both.speed,
        **{f"peak bead force F_{bead}": both.only([bead]).peak for bead in SENSORS},
        "peak bead force F_m": both.peak,
        "peak contact force": around.peak,
        **{f"FWHM of F_{bead}": both.only([bead]).fwhm * sites for bead in SENSORS},
        "FWHM of bead force": both.fwhm * sites,
        "FWHM of bead force in time": 1e6 * both.fwhm,
        "FWHM of contact force": around.fwhm * sites,
        "FWHM of contact force in time": 1e6 * around.fwhm,
        **{f"speed from bead {a} to {b}": beads.only((a, b)).speed for a, b in LIKE},
    }


def of_momentum(wave: CompactWave, momentum: float) -> PhysicalWave:
    """Return the theory's wave with a given momentum; `SceneError` unless it is positive."""
    ratio = positive(momentum, "momentum") / number(
        PhysicalWave(wave, sp.S.One).momentum
    )
    # The momentum is proportional to F^{(k + 1)/(2k)}.
    return PhysicalWave(
        wave, math.exp(math.log(ratio) * number(2 * wave.k / (wave.k + 1)))
    )


def bead_fwhm(wave: CompactWave) -> float:
    """Return the FWHM of a bead's force, a length that does not depend on the amplitude."""
    k, D = number(wave.k), number(wave.D)
    beta = (k - 1) / (2 * D * math.sqrt(number(wave.coefficient_sum)))

    def force(x: float) -> float:
        """Return a bead's force: cos^p(β(x ± D/2)) summed, p = 2k/(k-1), each 0 off its arch."""
        sides = (beta * (x + side) for side in (-D / 2, D / 2))
        return math.fsum(
            math.cos(y) ** (2 * k / (k - 1)) for y in sides if abs(y) < math.pi / 2
        )

    half, end = force(0.0) / 2, (math.pi / beta + D) / 2
    return 2 * float(
        scipy.optimize.brentq(lambda x: force(x) - half, 0, end, xtol=1e-14 * end)
    )


def _panel(run: Run, theory: PhysicalWave) -> Panel:
    """Return a panel of the forces at two beads, and the theory's wave with each peak."""
    curves = []
    for i, (bead, pulse) in enumerate(Train.of(run).only(SENSORS).pulses.items()):
        (force,) = run.bead_force[[j == bead - 1 for j in run.scene.bead_sensors]]
        wave = theory.curve(run.time - pulse.arrival)
        curves.append(Curve(f"bead {bead}, lattice", 1e6 * run.time, force, f"C{i}-"))
        curves.append(
            Curve(f"bead {bead}, theory by F_m", 1e6 * run.time, wave, f"C{i}--")
        )
    return Panel("time (µs)", "force, mean of the bead's contacts (N)", tuple(curves))


_DROPS = (
    Column("modulus_value", "E of PTFE (GPa)", format=lambda E: f"{E / 1e9:g}"),
    Column("height_value", "drop height", "m"),
    Column("speed", "V_s", "m/s", error=True),
    Column("force", "F_m", "N", error=True),
    Column("theory_value", "V_s theory", "m/s", format=".5g"),
)
_WIDTHS = (
    Column("line", "FWHM for"),
    Column(
        "stated_error_value", "the paper's error", format=lambda e: f"{100 * e:.1f} %"
    ),
    Column("error_value", "here", format=percent),
)
_WIDTH_NOTE = """\
FWHM in time of the contacts' forces from bead 10 on, at an equal peak force: theory/lattice - 1.
No definition of the FWHM meets 2.5 % together with the others (book/studies/widths.py)."""


@study()
def figures(progress: Progress[Any] = iter) -> Report:
    """The paper's figures: force records, and speed as a function of force (a few seconds).

    ``rows``: ``modulus_value`` of PTFE, ``height_value`` of the striker's drop, ``speed_value`` V_s
    and ``force_value`` F_m = (F_15 + F_34)/2 with errors, ``theory_value``, speed of the canonical
    wave at F_m; ``scaling``: ``exponent_value`` of V_s ~ F_m^e by least squares, with its error, at
    the first modulus; ``widths``: ``line``, ``stated_error_value`` and ``error_value`` of the FWHM;
    ``forces``: ``N``, ``beads``, ``time_value``, ``force_value``.
    """
    records = {N: forces(N) for N in progress([*RECORDED])}
    rows = [row for E in progress(MODULI) for row in scaling(E)]
    panels, curves, exponents = [], [], []
    for N, run in records.items():
        beads = zip(RECORDED[N], run.bead_force, strict=True)
        force = tuple(Curve(f"bead {bead}", 1e6 * run.time, row) for bead, row in beads)
        panels.append(
            Panel("time (µs)", "force of the bead (N)", force, title=f"{N}:1 chain")
        )
    for i, E in enumerate(MODULI):
        _, _, V, F, theory = zip(*(row for row in rows if row[0] == E), strict=True)
        exponents.append(exponent(F, V))
        peaks, speeds = ([number.value for number in numbers] for numbers in (F, V))
        curves.append(Curve(f"E = {E / 1e9:g} GPa", peaks, speeds, f"C{i}{'os'[i]}"))
        curves.append(Curve("theory, $F_m^{1/6}$", peaks, theory, f"C{i}-"))
    fitted = " and ".join(map(str, exponents))
    return Report(
        "Figures 2 and 3 of Porter et al. (2008)",
        (
            Table(_DROPS, tuple(rows), "rows"),
            Table(_WIDTHS, tuple(stated_errors()), "widths", note=_WIDTH_NOTE),
        ),
        panels=(
            *panels,
            Panel("peak force $F_m$ (N)", "speed $V_s$ (m/s)", tuple(curves), "xy"),
        ),
        notes=(f"V_s ~ F_m^e: e = {fitted}; the paper fits 0.1666.",),
        data={
            "scaling": {
                "exponent_value": exponents[0].value,
                "exponent_error_value": exponents[0].error,
            },
            "forces": [
                {
                    "N": N,
                    "beads": RECORDED[N],
                    "time_value": r.time,
                    "force_value": r.bead_force,
                }
                for N, r in records.items()
            ],
        },
    )


def forces(N: int) -> Run:
    """Simulate the N:1 chain of figure 2; return the run, with sensors at beads `RECORDED`."""
    return simulate(recorded_chain(RECORDED[N], N=N), rtol=TOLERANCES[0])


def cells_of_lines() -> tuple[Cell, ...]:
    """Return the unit cells of the lines `STATED`: the chain's contacts, and three masses m2."""
    cell = chain_cell()
    heavy, light = cell.masses
    contacts: dict[str, Any] = {
        "stiffnesses": cell.stiffnesses,
        "spacing": cell.spacing,
    }
    # the first for m2 → 0, exact to 12 digits
    return tuple(Dimer(heavy, m2, **contacts) for m2 in (heavy / 10**12, light, heavy))


def stated_errors() -> Iterator[tuple[str, float, float]]:
    """Yield lines of figure 3b, the paper's error of the FWHM, and the error on the lattice.

    The FWHM is a time, of the contacts' force from bead `FIRST_BEAD` on, at an equal peak force.
    """
    run = simulate(recorded_chain(range(FIRST_BEAD, BEADS - 2)), rtol=TOLERANCES[0])
    contacts = Train.of(run, "contact").only(range(FIRST_BEAD, BEADS - 2))
    for (line, stated), cell in zip(STATED.items(), cells_of_lines(), strict=True):
        wave = homogenize(cell, k=HERTZ).pde.traveling_wave().at_force(contacts.peak)
        yield line, stated, float(wave.fwhm("force", "time")) / contacts.fwhm - 1


def scaling(
    E: float, tolerances: tuple[float, float] = TOLERANCES
) -> list[tuple[Any, ...]]:
    """Return the rows of figure 3a, below `_DROPS`, for a Young's modulus of PTFE."""
    ptfe = replace(PTFE_BEAD, material=replace(PTFE, E=E))
    # A striker dropped from the height h has the velocity √(2gh).
    drops = [
        recorded_chain(SENSORS, math.sqrt(2 * float(GRAVITY) * h), ptfe=ptfe)
        for h in HEIGHTS
    ]
    fine, coarse = (
        [*map(Train.of, simulate_many(drops, rtol=rtol))] for rtol in tolerances
    )
    wave, rows = canonical_wave(chain_cell(ptfe=ptfe), HERTZ), []
    for height, train, less in zip(HEIGHTS, fine, coarse, strict=True):
        numbers = compared(
            lambda x: {"V": x.speed, "F": x.peak}, train, less, tolerances[0]
        )
        theory = float(wave.at_force(numbers["F"].value, of="bead").speed)
        rows.append((E, height, numbers["V"], numbers["F"], theory))
    return rows
