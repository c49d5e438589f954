"""Transmission of a shaken chain under load, beside Bloch's bands.

Bead 1 of a long chain of cells (A = D = 1, static force F0 = 1 in every contact) moves as
y = a sin(Ωt), a so small that the contacts are springs. In a band of the infinite chain the wave
runs on; in a gap its amplitude falls by e^{-n Im κ} from cell to cell of n beads, κ Bloch's
wavenumber per site. Amplitudes are least squares of sin Ωt and cos Ωt over the last `PERIODS`
periods, before an echo of the wall.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from lwa import Cell, Power
from lwa.base.arrays import Array
from lwa.base.progress import Progress
from lwa.command.options import quantities
from lwa.linear.dispersion import LoadedChain
from validation.lattice.result import Run
from validation.lattice.simulate import simulate_many
from validation.pictures import Curve, Panel
from validation.report.command import EXPONENT, option, study
from validation.report.result import Report
from validation.report.table import Column, Finding, Table
from validation.scenes.chains import numeric_cell
from validation.scenes.checks import integer
from validation.scenes.forcing import Drive
from validation.scenes.scene import Scene

NEAR, FAR = 1, 3  # cells between which the attenuation is measured
PERIODS = 6  # of the drive, over which an amplitude is measured
_SMALL = 1e-6  # amplitude of the drive: contacts are springs to this share
_RAMP = 150.0  # time in which the drive grows, lest it excite other frequencies
_MARGIN = 0.04  # share of a frequency next to an edge, where waves are too slow to settle
_LOWEST = 0.3  # of the upper edge: longer waves would meet their echo
_PASSES = 0.3  # of the amplitude: less is held back
_BOUND = 0.01  # error of the attenuation in a gap, at most


@study(
    option("--masses", callback=quantities, default="1,1/2", says="Masses of a cell."),
    EXPONENT,
    option("--frequencies", default=24, says="Number of frequencies."),
    option("--cells", default=80, says="Number of cells."),
)
def transmission(
    masses: Sequence[Any] = (1, "1/2"),
    k: float = 1.5,
    frequencies: int = 24,
    cells: int = 80,
    progress: Progress[Any] = iter,
) -> Report:
    """Transmission and attenuation of a shaken chain under load (fifteen seconds).

    ``rows``: ``frequency_value`` (Ω), ``transmission_value`` (amplitude in cell 3 over that of the
    drive), ``attenuation_value`` (per cell, -ln of the ratio of amplitudes) and
    ``attenuation_theory_value``. Frequencies next to a band's edge are left out.

    Raises `lwa.InputError` for parameters out of range.
    """
    cell, frequencies = numeric_cell(masses), integer(frequencies, "frequencies", 4, 1000)
    cells = integer(cells, "cells", 40, 1000)
    edges = LoadedChain(cell, Power(str(k)), 1).bands.edges()
    omegas = np.linspace(_LOWEST, 1.2, frequencies) * edges.max()
    clear = np.abs(omegas[:, None] / edges.ravel()[edges.ravel() > 0] - 1).min(axis=1) > _MARGIN
    scenes = [shaken(cell, k, cells, omega) for omega in omegas[clear]]
    runs = simulate_many(scenes, rtol=1e-8, atol=1e-8)
    rows: list[tuple[float, ...]] = []
    for omega in progress(omegas[clear].tolist()):
        near, far = amplitudes(next(runs), omega)
        rows.append((float(omega), far / _SMALL, math.log(near / far) / (FAR - NEAR),
                     attenuation(cell, k, omega)))  # fmt: skip
    return _report(cell, k, edges, rows)


def shaken(cell: Cell, k: float, cells: int, omega: float) -> Scene:
    """Scene of a loaded chain whose first bead is driven at the angular frequency omega."""
    n, size = cells * cell.size, cell.size
    return Scene(
        masses=tuple(map(float, cell.masses)) * cells,
        stiffnesses=((tuple(map(float, cell.stiffnesses))) * cells)[: n - 1],
        wall=float(cell.stiffnesses[-1]),
        k=k,
        precompression=1.0,
        drive=Drive(amplitude=_SMALL, frequency=omega / (2 * math.pi), ramp=_RAMP),
        bead_sensors=(NEAR * size, FAR * size),
        duration=_RAMP + 2 * PERIODS * 2 * math.pi / omega,
        samples=4001,
    )


def amplitudes(run: Run, omega: float) -> list[float]:
    """Amplitudes of the driven frequency at the sensors, over the last periods."""
    late = run.time > run.time[-1] - PERIODS * 2 * math.pi / omega
    waves = np.array([np.sin(omega * run.time[late]), np.cos(omega * run.time[late])]).T
    coefficients = np.linalg.lstsq(waves, run.bead_displacement[:, late].T, rcond=None)[0]
    return [float(x) for x in np.hypot(*coefficients)]


def attenuation(cell: Cell, k: float, omega: float) -> float:
    """Attenuation: fall of ln(amplitude) per cell, n Im κ, from the transfer matrix of a cell."""
    springs = [float(K) for K in LoadedChain(cell, Power(str(k)), 1).spring_constants]
    matrix = np.eye(2)
    for i, m in enumerate(map(float, cell.masses)):
        back, ahead = springs[i - 1], springs[i]
        row = [(back + ahead - m * omega**2) / ahead, -back / ahead]
        matrix = np.array([row, [1.0, 0.0]]) @ matrix
    return float(np.log(np.abs(np.linalg.eigvals(matrix)).max()))


def _report(cell: Cell, k: float, edges: Array, rows: list[tuple[float, ...]]) -> Report:
    omega, passed, measured, theory = np.array(rows).T
    gap = theory > 0.05
    columns = (
        Column("frequency_value", "Ω"),
        Column("transmission_value", "transmission", format=".2e"),
        Column("attenuation_value", "attenuation per cell", format=".5f"),
        Column("attenuation_theory_value", "theory", format=".5f"),
    )
    wrong = float(((passed > _PASSES) == gap).sum())
    worst = float(np.abs(theory / measured - 1)[gap].max(initial=0.0))
    findings = (
        Finding("theory/lattice - 1 in gaps", worst, high=_BOUND, key="attenuation_error"),
        Finding("frequencies on the wrong side of an edge", wrong, high=0, key="misplaced"),
    )
    low, high = passed.min(), passed.max()
    marks = [Curve("", [edge, edge], [low, high], "k:") for edge in edges.ravel() if edge]
    curve = Curve("amplitude in cell 3 over the drive's", omega, passed, "C0o-")
    masses = ", ".join(map(str, cell.masses))
    return Report(
        f"A chain of masses {masses} under load, k = {k:g}, shaken at {len(rows)} frequencies",
        (Table(columns, tuple(rows), "rows"),),
        findings,
        (Panel("Ω", "transmission", (curve, *marks), "y", "dotted: edges of Bloch's bands"),),
        ("Units: m1 = A = F0 = 1.",),
        {"band_edges_value": edges.tolist()},
    )


if __name__ == "__main__":
    transmission.main()
