"""Breathers of a loaded chain: time-periodic orbits beside their envelopes.

A = D = 1, and every contact carries the static force F0 = 1. The envelope's equation
(`lwa.envelope`) has a standing wave for each frequency (1 - Δ) ω0, ω0 an edge of a band of the
linear chain: bright, sech(bn), in the gap below the optical band of a dimer; dark, tanh(bn), below
the upper edge of equal beads. On the lattice the orbit of the same frequency is found by Newton's
method from this envelope (`validation.waves.periodic`), in a chain with free ends under the load,
mirror symmetric about its middle bead. At free ends the envelope of a dark breather is 0 as well.

The amplitude is that of the first harmonic: of the middle bead if bright, of the plateau if dark.
The width is 1/b in cells, from the full width at half maximum (bright) or half plateau (dark).
The theory's error falls as Δ.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
from scipy.interpolate import CubicSpline

from lwa import Breather, Cell, Power, envelope
from lwa.base.arrays import Array
from lwa.base.progress import Progress
from lwa.command.options import quantities
from validation.pictures import Curve, Panel
from validation.pulses.pulse import Measured
from validation.report.command import EXPONENT, option, study
from validation.report.result import Report
from validation.report.table import Column, Finding, Table, percent
from validation.scenes.chains import numeric_cell
from validation.scenes.checks import SceneError, between, integer
from validation.waves.periodic import Orbit, PressedChain, orbit

DETUNINGS = "0.0005,0.001,0.002"
# Widths 1/b in half a chain. Free ends change the amplitude by about 4e^{-2w} of bright, 4e^{-w} of
# dark envelopes: 3e-6 and 1e-5. In a much longer chain a dark one is hardly held in its place.
_WIDE = {"bright": 7.0, "dark": 13.0}
_HALF, _DIP = (
    2 * np.arccosh(2),
    2 * np.arctanh(0.5),
)  # full widths of sech and tanh at half, over 1/b
_BOUND = 4.0  # error of the theory's amplitude over Δ, at most
_FEWER = 0.75  # beads of the chain that gives the errors, over those of the chain that counts


@study(
    option("--masses", callback=quantities, default="1,1/2", says="Masses of a cell, one or two."),
    EXPONENT,
    option(
        "--detunings",
        callback=quantities,
        default=DETUNINGS,
        says="Detunings 1 - f/f0, f0 the frequency of the band's edge.",
    ),
    option("--beads", default=601, says="Largest number of beads; short breathers take fewer."),
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
    cell, beads = numeric_cell(masses), integer(beads, "beads", 21, 2001)
    if cell.size > 2:
        raise SceneError(f"masses are {cell.size}: breathers are found in cells of one or two")
    between(k, "k", 1.1, 5)
    if not detunings:
        raise SceneError("detunings is empty: at least one is wanted")
    edge = envelope(cell, Power(k), precompression=1)
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
    harmonics: int = 5

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
        return np.divmod(np.arange(-self.half, self.half + 1) + self.place, self.cell.size)

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
        envelope = self.theory.displacements(np.arange(n[0], n[-1] + 1))[n - n[0], place]
        if self.bright:
            return np.asarray(envelope)
        ends = (self.half + 0.5 - np.abs(np.arange(-self.half, self.half + 1))) / self.cell.size
        return np.asarray(envelope * np.tanh(ends / width))

    @cached_property
    def orbit(self) -> Orbit:
        """The chain's exact periodic orbit with the envelope's frequency."""
        return orbit(self.chain, float(self.theory.frequency), self.start, self.harmonics)

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
        ends = [float(shape.solve(side * peak / 2, extrapolate=False)[0]) for side in (-1, 1)]
        return {"amplitude": peak, "width": (ends[1] - ends[0]) / _DIP}

    def row(self) -> dict[str, Any]:
        """Table row of orbit and envelope; errors from a shorter chain and fewer harmonics."""
        theory = {
            "amplitude": abs(float(self.theory.amplitude[self.place])),
            "width": float(self.theory.width),
        }
        rough = replace(self, half=int(_FEWER * self.half), harmonics=self.harmonics - 1)
        check = rough.numbers()
        cells: dict[str, Any] = {
            "detuning_value": float(self.theory.detuning),
            "frequency_value": float(self.theory.frequency),
            "multiplier_value": float(np.abs(self.orbit.multipliers[0])),
            "energy_value": self.orbit.energy,
        }
        for name, value in self.numbers().items():
            cells[name] = Measured(value, check[name])
            cells[f"{name}_theory_value"] = theory[name]
            cells[f"{name}_off_value"] = theory[name] / value - 1
        return cells


_COLUMNS = (
    Column("detuning_value", "Δ", format="g"),
    Column("frequency_value", "frequency", format=".6f"),
    Column("amplitude", "amplitude", error=True),
    Column("amplitude_theory_value", "theory", format=".5f"),
    Column("amplitude_off_value", "off", format=percent),
    Column("width", "width", "cells", error=True),
    Column("width_theory_value", "theory", format=".4f"),
    Column("width_off_value", "off", format=percent),
    Column("multiplier_value", "largest |multiplier|", format=".6f"),
    Column("energy_value", "energy", format=".5g"),
)


def _report(cell: Cell, k: float, breathers: Sequence[tuple[Standing, dict[str, Any]]]) -> Report:
    rows = [row for _, row in breathers]
    kind = breathers[0][0].theory.kind
    return Report(
        f"{kind.capitalize()} breathers: masses {', '.join(map(str, cell.masses))}, k = {k:g}, "
        "F0 = A = D = 1",
        (Table(_COLUMNS, tuple(tuple(row[c.key] for c in _COLUMNS) for row in rows), "rows"),),
        tuple(_findings(rows)),
        tuple(_panels(*breathers[-1])),
        (
            "off: theory/lattice - 1. ±: change with fewer beads and harmonics. Double multipliers "
            "1 of the phase and of the whole chain's motion are split by the integration's error.",
        ),
        {"kind": kind},
    )


def _findings(rows: Sequence[dict[str, Any]]) -> Iterator[Finding]:
    """The theory's error is of the order of the detuning."""
    worst = max(abs(row["amplitude_off_value"]) / abs(row["detuning_value"]) for row in rows)
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
