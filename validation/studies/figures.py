"""Figures and stated numbers of Porter et al. (2008), computed.

Figure 2: the force over time at three beads of the 1:1 and the 2:1 chain; with it N:1 chains up to
22:1, the range of the paper's numerics. Figure 3a: peak force against speed over the striker's drop
heights, with both moduli of PTFE, and the exponent of V_s ~ F_m^e. Figure 3b, the FWHM from bead to
bead, is drawn by `book/studies/widths.py`.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

from lwa import PhysicalWave, canonical_wave
from lwa.base.progress import Progress
from validation.lattice.run import Run
from validation.lattice.simulate import simulate_many
from validation.pictures import Curve, Panel
from validation.pulses.pulse import Measured, compared, exponent, first_passage
from validation.pulses.train import Train
from validation.report.command import study
from validation.report.result import Report
from validation.report.table import Column, Table, percent
from validation.scenes.materials import DIAMETER, PTFE, PTFE_BEAD
from validation.studies import paper
from validation.studies.paper import HERTZ, chain_cell, chain_runs

RECORDED = {1: (15, 24, 33), 2: (16, 24, 34)}  # N → beads of figure 2; 24 is PTFE
MOST = 22  # the largest N
HEIGHTS = (0.1, 0.2, 0.4, 0.6, 0.8, 1.0, 1.2)  # drop heights of figure 3a, in m
MODULI = (1.46e9, 0.6e9)  # of PTFE, in Pa: dynamic, as in the paper, and nominal static


class Speed(NamedTuple):
    """Speed and peak force of an N:1 chain, and the canonical theory's speed at this force."""

    N: int
    speed: Measured
    force: Measured
    theory: float


@dataclass(frozen=True)
class Scaling:
    """Figure 3a, speed as a function of peak force, for one Young's modulus of PTFE.

    E : the modulus, in Pa. speeds, forces : V_s and F_m = (F_15 + F_34)/2 at each drop height.
    theory : speed of the canonical wave at each F_m.
    """

    E: float
    speeds: tuple[Measured, ...]
    forces: tuple[Measured, ...]
    theory: tuple[float, ...]

    @property
    def exponent(self) -> Measured:
        """Exponent e of V_s ~ F_m^e, by least squares."""
        return exponent(self.forces, self.speeds)


_PARTS = ("value", "error")
_SPEEDS = (
    Column("N", "chain", format="{}:1".format),
    Column("speed", "V_s lattice", "m/s", error=True),
    Column("force", "peak force", "N", error=True),
    Column("theory_value", "V_s theory", "m/s", format=".2f"),
    Column("", "error", format=percent),
)
_SPEEDS_TITLE = """\
N:1 chains; theory: speed of the canonical wave with the lattice's peak force; ±: change in a less
accurate run"""
_SCALINGS = (
    Column("modulus_value", "E of PTFE", "GPa", format=lambda E: f"{E / 1e9:g}"),
    Column("exponent", "exponent of V_s in F_m", error=True),
    Column("", "less 1/6", format="+.0e"),
    Column("speed_value", "V_s", "m/s", format=lambda V: f"{V[0]:.1f} … {V[-1]:.1f}"),
    Column("speed_error_value"),
    Column("force_value", "F_m", "N", format=lambda F: f"{F[0]:.2f} … {F[-1]:.2f}"),
    Column("force_error_value"),
    Column("theory_value", "V_s theory", "m/s", format=lambda V: f"{V[0]:.1f} … {V[-1]:.1f}"),
)
_SCALINGS_TITLE = f"drop heights {HEIGHTS[0]:g} … {HEIGHTS[-1]:g} m; the paper fits 0.1666"


def report(
    records: Mapping[int, Run], speeds: Sequence[Speed], scalings: Sequence[Scaling]
) -> Report:
    """Return tables and panels of the runs of figure 2 (by N), the N:1 chains and figure 3a."""
    first = tuple((*s, s.theory / s.speed.value - 1) for s in speeds)
    rows = []
    for s in scalings:
        parts = [[getattr(x, part) for x in row] for row in (s.speeds, s.forces) for part in _PARTS]
        rows.append((s.E, s.exponent, s.exponent.value - 1 / 6, *parts, s.theory))
    second = Table(_SCALINGS, tuple(rows), "scalings", title=_SCALINGS_TITLE)
    forces = [
        {"N": N, "beads": RECORDED[N], "time_value": run.time, "force_value": run.bead_force}
        for N, run in records.items()
    ]
    panels = [_forces_panel(N, run) for N, run in records.items()]
    return Report(
        "",
        (Table(_SPEEDS, first, "speeds", title=_SPEEDS_TITLE), second),
        panels=(*panels, _scaling_panel(scalings)),
        data={"scaling": second.document()[0], "forces": forces},
    )


def _forces_panel(N: int, run: Run) -> Panel:
    rows = enumerate(zip(RECORDED[N], run.bead_force, strict=True))
    curves = (Curve(f"bead {bead}", 1e6 * run.time, f, f"C{i}-") for i, (bead, f) in rows)
    return Panel("time (µs)", "force of the bead (N)", tuple(curves), title=f"{N}:1 chain")


def _scaling_panel(rows: Sequence[Scaling]) -> Panel:
    curves = []
    for i, row in enumerate(rows):
        label = f"E = {row.E / 1e9:g} GPa: exponent {row.exponent.value:.4f}"
        forces, speeds = ([m.value for m in found] for found in (row.forces, row.speeds))
        curves.append(Curve(label, forces, speeds, f"C{i}{'os'[i]}"))
        curves.append(Curve("theory, $F_m^{1/6}$", forces, row.theory, f"C{i}-"))
    return Panel("peak force $F_m$ (N)", "speed $V_s$ (m/s)", tuple(curves), "xy")


@study()
def figures(progress: Progress[Any] = iter) -> Report:
    """The paper's figures: force records, N:1 chains, force against speed (ten seconds).

    ``speeds``: ``N``, ``speed``, ``force`` and ``theory``, each ``_value``; ``scalings``:
    ``modulus_value``, ``exponent_value`` and lists over the drop heights ``speed_value``,
    ``force_value``, ``theory_value``; ``scaling``: the one with the dynamic modulus; ``forces``:
    ``N``, ``beads``, ``time_value``, ``force_value``.
    """
    parts: list[tuple[Callable[[Any], Any], Any]] = [(forces, N) for N in RECORDED]
    parts += [(chain_speed, N) for N in range(1, MOST + 1)]
    parts += [(scaling, E) for E in MODULI]
    found: dict[Any, dict[Any, Any]] = {}
    for part, argument in progress(parts):
        found.setdefault(part, {})[argument] = part(argument)
    records, speeds, scalings = found.values()
    return report(records, tuple(speeds.values()), tuple(scalings.values()))


def forces(N: int) -> Run:
    """Simulate the N:1 chain of figure 2; return the run, with sensors at beads `RECORDED`."""
    return chain_runs(RECORDED[N], N=N)[0]


def chain_speed(N: int) -> Speed:
    """Measure the speed of the N:1 chain's leading pulse far from the striker.

    The pulse is timed between two steel beads, at least three periods and 18 beads apart, by its
    front at a tenth of the peak: at large N the pulse has several humps, and the highest is not
    always the same.
    """
    period = N + 1
    before, across = (max(3, math.ceil(beads / period)) for beads in (14, 18))
    sensors = (before * period + 1, (before + across) * period + 1)

    def numbers(run: Run) -> dict[str, float]:
        train = Train.of(run)
        first, second = (
            first_passage(run.signal("bead", sensor - 1), pulse.peak / 10)
            for sensor, pulse in zip(sensors, train.pulses.values(), strict=True)
        )
        return {"speed": across * period * DIAMETER / (second - first), "force": train.peak}

    runs = chain_runs(sensors, N=N, beads=max(paper.BEADS, (before + across + 3) * period))
    found = compared(numbers, *runs)
    wave = PhysicalWave(canonical_wave(chain_cell(N), HERTZ), found["force"].value, "bead")
    return Speed(N, found["speed"], found["force"], float(wave.speed))


def scaling(E: float) -> Scaling:
    """Compute figure 3a for a Young's modulus of PTFE, without gravity."""
    ptfe = replace(PTFE_BEAD, material=replace(PTFE, E=E))
    velocities = (math.sqrt(2 * paper.GRAVITY * h) for h in HEIGHTS)
    drops = [paper.recorded_chain(paper.SENSORS, v, ptfe=ptfe) for v in velocities]
    pairs = zip(*(simulate_many(drops, rtol=rtol) for rtol in paper.TOLERANCES), strict=True)
    trains = [tuple(map(Train.of, pair)) for pair in pairs]
    speeds = tuple(Measured(fine.speed, coarse.speed) for fine, coarse in trains)
    forces = tuple(Measured(fine.peak, coarse.peak) for fine, coarse in trains)
    wave = canonical_wave(chain_cell(ptfe=ptfe), HERTZ)
    theory = (float(wave.at_force(force.value, of="bead").speed) for force in forces)
    return Scaling(E, speeds, forces, tuple(theory))
