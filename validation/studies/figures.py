"""Figures and stated numbers of Porter et al. (2008), computed.

Figure 2: the force over time at three beads of the 1:1 and the 2:1 chain. Figure 3a: peak force
against speed over the striker's drop heights, with both moduli of PTFE, and the exponent of
V_s ~ F_m^e. Figure 3b, the FWHM from bead to bead, is drawn by `book/studies/widths.py`.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import Any, NamedTuple

from lwa import canonical_wave
from lwa.base.progress import Progress
from lwa.expansion.physical import GRAVITY
from validation.lattice.result import Run
from validation.lattice.simulate import simulate, simulate_many
from validation.pictures import Curve, Panel
from validation.pulses.pulse import Measured, compared, exponent
from validation.pulses.sensors import Train
from validation.report.command import study
from validation.report.result import Report
from validation.report.table import Column, Table
from validation.scenes.chains import PTFE, PTFE_BEAD
from validation.studies.paper import HERTZ, SENSORS, TOLERANCES, chain_cell, recorded_chain

RECORDED = {1: (15, 24, 33), 2: (16, 24, 34)}  # N → beads of figure 2; 24 is PTFE
HEIGHTS = (0.1, 0.2, 0.4, 0.6, 0.8, 1.0, 1.2)  # drop heights of figure 3a, in m
MODULI = (1.46e9, 0.6e9)  # of PTFE, in Pa: dynamic, as in the paper, and nominal static


class Scaling(NamedTuple):
    """Figure 3a, speed as a function of peak force, for one Young's modulus of PTFE.

    E : the modulus, in Pa. exponent : e of V_s ~ F_m^e, by least squares. speed, force : V_s and
    F_m = (F_15 + F_34)/2 at each drop height, with their errors. theory : speed of the canonical
    wave at each F_m.
    """

    E: float
    exponent: Measured
    speed: list[float]
    speed_error: list[float]
    force: list[float]
    force_error: list[float]
    theory: list[float]


def _ends(values: Sequence[float]) -> str:
    return f"{values[0]:.5g} … {values[-1]:.5g}"


_SCALINGS = (
    Column("modulus_value", "E of PTFE", "GPa", format=lambda E: f"{E / 1e9:g}"),
    Column("exponent", "exponent of V_s in F_m", error=True),
    Column("speed_value", "V_s", "m/s", format=_ends),
    Column("speed_error_value"),
    Column("force_value", "F_m", "N", format=_ends),
    Column("force_error_value"),
    Column("theory_value", "V_s theory", "m/s", format=_ends),
)
_SCALINGS_TITLE = (
    f"V_s ~ F_m^e over drop heights {HEIGHTS[0]:g} … {HEIGHTS[-1]:g} m; the paper fits e = 0.1666"
)


@study()
def figures(progress: Progress[Any] = iter) -> Report:
    """The paper's figures: force records, and speed as a function of force (a few seconds).

    ``scalings``: ``modulus_value``, ``exponent_value`` and lists over the drop heights
    ``speed_value``, ``force_value``, each with its error, and ``theory_value``; ``scaling``: the
    first of them; ``forces``: ``N``, ``beads``, ``time_value``, ``force_value``.
    """
    records = {N: forces(N) for N in progress([*RECORDED])}
    scalings = tuple(scaling(E) for E in progress(MODULI))
    table = Table(_SCALINGS, scalings, "scalings", title=_SCALINGS_TITLE)
    data = [
        {"N": N, "beads": RECORDED[N], "time_value": run.time, "force_value": run.bead_force}
        for N, run in records.items()
    ]
    return Report(
        "Figures 2 and 3a of Porter et al. (2008)",
        (table,),
        panels=(*(_forces_panel(N, run) for N, run in records.items()), _scaling_panel(scalings)),
        notes=(
            "Not reproduced: the paper's 2.5 % error of the FWHM, which no definition of the FWHM "
            "meets together with its 9.2 and 22.8 % (book/studies/widths.py).",
        ),
        data={"scaling": table.document()[0], "forces": data},
    )


def _forces_panel(N: int, run: Run) -> Panel:
    """Return the panel of force against time, figure 2."""
    rows = enumerate(zip(RECORDED[N], run.bead_force, strict=True))
    curves = (Curve(f"bead {bead}", 1e6 * run.time, f, f"C{i}-") for i, (bead, f) in rows)
    return Panel("time (µs)", "force of the bead (N)", tuple(curves), title=f"{N}:1 chain")


def _scaling_panel(scalings: Sequence[Scaling]) -> Panel:
    """Return the panel of speed against peak force, figure 3a."""
    curves = []
    for i, row in enumerate(scalings):
        label = f"E = {row.E / 1e9:g} GPa: exponent {row.exponent.value:.4f}"
        curves.append(Curve(label, row.force, row.speed, f"C{i}{'os'[i]}"))
        curves.append(Curve("theory, $F_m^{1/6}$", row.force, row.theory, f"C{i}-"))
    return Panel("peak force $F_m$ (N)", "speed $V_s$ (m/s)", tuple(curves), "xy")


def forces(N: int) -> Run:
    """Simulate the N:1 chain of figure 2; return the run, with sensors at beads `RECORDED`."""
    rtol = TOLERANCES[0]
    return simulate(recorded_chain(RECORDED[N], N=N), rtol=rtol, atol=rtol)


def scaling(E: float, tolerances: tuple[float, float] = TOLERANCES) -> Scaling:
    """Compute figure 3a for a Young's modulus of PTFE."""
    ptfe = replace(PTFE_BEAD, material=replace(PTFE, E=E))
    # A striker dropped from the height h has the velocity √(2gh).
    drops = [recorded_chain(SENSORS, math.sqrt(2 * float(GRAVITY) * h), ptfe=ptfe) for h in HEIGHTS]
    fine, coarse = ([*map(Train.of, simulate_many(drops, rtol=rtol))] for rtol in tolerances)
    pairs = [
        compared(lambda train: {"V_s": train.speed, "F_m": train.peak}, *pair, tolerances[0])
        for pair in zip(fine, coarse, strict=True)
    ]
    V, F = ([pair[name] for pair in pairs] for name in ("V_s", "F_m"))
    (speed, speed_error), (force, force_error) = (
        ([number.value for number in row], [number.error for number in row]) for row in (V, F)
    )
    wave = canonical_wave(chain_cell(ptfe=ptfe), HERTZ)
    theory = [float(wave.at_force(peak, of="bead").speed) for peak in force]
    return Scaling(E, exponent(F, V), speed, speed_error, force, force_error, theory)
