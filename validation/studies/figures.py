"""Figures and stated numbers of Porter et al. (2008), computed.

Figure 2: the force over time at three beads of the 1:1 and the 2:1 chain. Figure 3a: peak force
against speed over the striker's drop heights, with both moduli of PTFE, and the exponent of
V_s ~ F_m^e. Figure 3b, the FWHM from bead to bead, is drawn by `book/studies/widths.py`.
"""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

from lwa import canonical_wave
from lwa.base.progress import Progress
from lwa.expansion.physical import GRAVITY
from validation.lattice.result import Run
from validation.lattice.simulate import simulate, simulate_many
from validation.pictures import Curve, Panel
from validation.pulses.pulse import compared, exponent
from validation.pulses.sensors import Train
from validation.report.command import study
from validation.report.result import Report
from validation.report.table import Column, Table
from validation.scenes.chains import PTFE, PTFE_BEAD
from validation.studies.paper import HERTZ, SENSORS, TOLERANCES, chain_cell, recorded_chain

RECORDED = {1: (15, 24, 33), 2: (16, 24, 34)}  # N → beads of figure 2; 24 is PTFE
HEIGHTS = (0.1, 0.2, 0.4, 0.6, 0.8, 1.0, 1.2)  # drop heights of figure 3a, in m
MODULI = (1.46e9, 0.6e9)  # of PTFE, in Pa: dynamic, as in the paper, and nominal static


_COLUMNS = (
    Column("modulus_value", "E of PTFE (GPa)", format=lambda E: f"{E / 1e9:g}"),
    Column("height_value", "drop height", "m"),
    Column("speed", "V_s", "m/s", error=True),
    Column("force", "F_m", "N", error=True),
    Column("theory_value", "V_s theory", "m/s", format=".5g"),
)


@study()
def figures(progress: Progress[Any] = iter) -> Report:
    """The paper's figures: force records, and speed as a function of force (a few seconds).

    ``rows``: ``modulus_value`` of PTFE, ``height_value`` of the striker's drop, ``speed_value`` V_s
    and ``force_value`` F_m = (F_15 + F_34)/2 with errors, ``theory_value``, speed of the canonical
    wave at F_m; ``scaling``: ``exponent_value`` of V_s ~ F_m^e by least squares, with its error, at
    the first modulus; ``forces``: ``N``, ``beads``, ``time_value``, ``force_value``.
    """
    records = {N: forces(N) for N in progress([*RECORDED])}
    rows = [row for E in progress(MODULI) for row in scaling(E)]
    curves, exponents = [], []
    for i, E in enumerate(MODULI):
        _, _, V, F, theory = zip(*(row for row in rows if row[0] == E), strict=True)
        exponents.append(exponent(F, V))
        force, speed = ([number.value for number in numbers] for numbers in (F, V))
        curves.append(Curve(f"E = {E / 1e9:g} GPa", force, speed, f"C{i}{'os'[i]}"))
        curves.append(Curve("theory, $F_m^{1/6}$", force, theory, f"C{i}-"))
    fitted = " and ".join(map(str, exponents))
    return Report(
        "Figures 2 and 3a of Porter et al. (2008)",
        (Table(_COLUMNS, tuple(rows), "rows"),),
        panels=(
            *(_forces_panel(N, run) for N, run in records.items()),
            Panel("peak force $F_m$ (N)", "speed $V_s$ (m/s)", tuple(curves), "xy"),
        ),
        notes=(
            f"V_s ~ F_m^e: e = {fitted}; the paper fits 0.1666.",
            "Not reproduced: the paper's 2.5 % error of the FWHM, which no definition of the FWHM "
            "meets together with its 9.2 and 22.8 % (book/studies/widths.py).",
        ),
        data={
            "scaling": {
                "exponent_value": exponents[0].value,
                "exponent_error_value": exponents[0].error,
            },
            "forces": [
                {"N": N, "beads": RECORDED[N], "time_value": r.time, "force_value": r.bead_force}
                for N, r in records.items()
            ],
        },
    )


def _forces_panel(N: int, run: Run) -> Panel:
    """Return the panel of force against time, figure 2."""
    rows = enumerate(zip(RECORDED[N], run.bead_force, strict=True))
    curves = (Curve(f"bead {bead}", 1e6 * run.time, f, f"C{i}-") for i, (bead, f) in rows)
    return Panel("time (µs)", "force of the bead (N)", tuple(curves), title=f"{N}:1 chain")


def forces(N: int) -> Run:
    """Simulate the N:1 chain of figure 2; return the run, with sensors at beads `RECORDED`."""
    rtol = TOLERANCES[0]
    return simulate(recorded_chain(RECORDED[N], N=N), rtol=rtol, atol=rtol)


def scaling(E: float, tolerances: tuple[float, float] = TOLERANCES) -> list[tuple[Any, ...]]:
    """Return the rows of figure 3a, below `_COLUMNS`, for a Young's modulus of PTFE."""
    ptfe = replace(PTFE_BEAD, material=replace(PTFE, E=E))
    # A striker dropped from the height h has the velocity √(2gh).
    drops = [recorded_chain(SENSORS, math.sqrt(2 * float(GRAVITY) * h), ptfe=ptfe) for h in HEIGHTS]
    fine, coarse = ([*map(Train.of, simulate_many(drops, rtol=rtol))] for rtol in tolerances)
    wave, rows = canonical_wave(chain_cell(ptfe=ptfe), HERTZ), []
    for height, train, less in zip(HEIGHTS, fine, coarse, strict=True):
        numbers = compared(lambda x: {"V": x.speed, "F": x.peak}, train, less, tolerances[0])
        theory = float(wave.at_force(numbers["F"].value, of="bead").speed)
        rows.append((E, height, numbers["V"], numbers["F"], theory))
    return rows
