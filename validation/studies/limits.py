"""The theory's limits on the lattice: equal masses, m1 ≫ m2, and k → 1.

The wave of `lwa` is the leading order in ε = k - 1, so its error against the lattice must vanish
like a known power of ε. Each chain is started from the theory's own wave, which sheds what it is
not and is measured where it has run four, six and eight times its support; the difference between
the last two places is the lattice's own error.

With m1 ≫ m2 the light beads only hand the force on: a chain of spacing 2D, with the same errors.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import sympy as sp

from lwa import Dimer, TravelingWave, homogenize
from lwa.base.progress import Progress
from validation.lattice.run import Run
from validation.lattice.simulate import simulate
from validation.pulses.pulse import (
    Measured,
    compared,
    derived,
    exponent,
    highest_pulse,
    integral,
    speed,
)
from validation.report.command import study
from validation.report.panel import Curve, Panel
from validation.report.result import Report
from validation.report.table import Column, Finding, Table
from validation.report.text import percent
from validation.scenes.chains import carrying
from validation.waves.asymptotics import LAWS, QUANTITIES, theory_values
from validation.waves.theory import Compacton, theory_at

EXPONENTS = (sp.Rational(3, 2), sp.Rational(5, 4), sp.Rational(11, 10))  # Hertz, and on to 1
EQUAL = sp.Integer(1)
LIGHT = sp.Rational(1, 1000)  # ω = m2/m1, so small that its square does not show
LIMIT = (4 * LIGHT, LIGHT, LIGHT / 4)  # from which the lattice is extrapolated to ω → 0 at k = 3/2
AMPLITUDES = (0.01, 1.0, 100.0)  # peak strains B, for the exponent of F_m against V_s


@dataclass(frozen=True)
class Row:
    """One comparison; omega 0: the limit ω → 0, no k: all of `EXPONENTS` enter."""

    quantity: str
    k: sp.Rational | None
    omega: sp.Rational
    theory: sp.Expr
    lattice: Measured
    bound: float

    @property
    def theory_value(self) -> float:
        """The theory's number."""
        return float(sp.N(self.theory, 17))

    @property
    def error(self) -> float:
        """Theory over lattice, less 1."""
        return self.theory_value / self.lattice.value - 1

    @property
    def finding(self) -> Finding:
        """The error, held to the bound with the lattice's own added to it."""
        own = self.lattice.relative_error
        return Finding(self.quantity, self.error, -self.bound, self.bound, error=own)

    @property
    def cells(self) -> tuple[Any, ...]:
        """Of the table."""
        return (self.quantity, self.k, self.omega, self.theory, self.theory_value, self.lattice,
                self.error, self.bound, self.finding.ok)  # fmt: skip


_COLUMNS = (
    Column("quantity", "quantity"),
    Column("k", "k", format=str),
    Column("omega"),
    Column("theory"),
    Column("theory_value", "theory"),
    Column("lattice", "lattice", error=True),
    Column("error_value", "error", format=percent),
    Column("bound_value", "bound", format=lambda bound: percent(bound).lstrip("+")),
    Column("ok", "holds"),
)
_CHAINS = {
    "0": "ω = m2/m1 → 0, extrapolated from runs at small ω",
    "1": "m1 = m2, ω = 1",
    str(LIGHT): f"m1 ≫ m2, ω = {LIGHT}",
}
_NOTE = (
    "Lengths in D, m1 = A = D = 1; force and strain of a contact; error: theory/lattice - 1.\n"
    "±: the lattice's own error, by how much a number still changed over the last stretch.\n"
    "No k: all enter, as k → 1."
)


@dataclass(frozen=True)
class Limits:
    """All rows of the comparison."""

    rows: tuple[Row, ...]

    def report(self) -> Report:
        """``rows``: ``quantity``, ``k`` and ``omega`` (exact; ``k`` null where all enter, ``omega``
        0 for the limit), ``theory`` (exact), ``theory_value``, ``lattice_value``,
        ``lattice_error_value``, ``error_value`` (theory over lattice - 1), ``bound_value``, ``ok``.
        """
        rows = tuple(row.cells for row in self.rows)
        return Report(
            "The theory's limits on the lattice",
            (Table(_COLUMNS, rows, "rows", by="omega", heads=_CHAINS, note=_NOTE),),
            tuple(row.finding for row in self.rows),
            tuple(self._panel(omega) for omega in (EQUAL, LIGHT)),
        )

    def _panel(self, omega: sp.Rational) -> Panel:
        """|error| against k - 1, with the leading powers that it must approach."""
        epsilon = np.geomspace(float(EXPONENTS[-1] - 1) / 2, float(EXPONENTS[0] - 1), 2)
        curves = []
        for i, (quantity, law) in enumerate(LAWS.items()):
            rows = [row for row in self.rows if (row.quantity, row.omega) == (quantity, omega)]
            points = [(row.k - 1, abs(row.error), row.lattice.relative_error)
                      for row in rows if row.k is not None]  # fmt: skip
            x, y, error = zip(*points, strict=True)
            power = abs(float(law.coefficient)) * epsilon**law.order
            curves += [Curve.of(quantity, x, y, f"C{i}{'osD^'[i]}", error),
                       Curve.of("", epsilon, power, f"C{i}-")]  # fmt: skip
        title = f"m2/m1 = {omega}; lines: leading order"
        return Panel("k - 1", "|theory/lattice - 1|", tuple(curves), "xy", title)


def lattice_wave(wave: TravelingWave, B: float = 1.0) -> dict[str, Measured]:
    """`QUANTITIES`, speed dx/dt and peak contact force of what the theory's wave becomes.

    Means over the two contacts of a cell, which the exact wave passes as mirror images.
    """
    compacton = Compacton(wave, B)
    start = int(compacton.support / 2) + 1
    places = [2 * round((start + s * compacton.support) / 2) for s in (4, 6, 8)]
    run = _run(compacton, start, places)
    numbers = compared(lambda place: _numbers(run, compacton, place), 2, 1)
    scale, power = float(wave.speed_scale), (compacton.k - 1) / 2
    at_one = derived(lambda V, u: V / scale / u**power, numbers["speed"], numbers["strain"])
    return numbers | {QUANTITIES[-1]: at_one}


def _run(compacton: Compacton, start: int, places: Sequence[int]) -> Run:
    wave = compacton.wave
    cells = (places[-1] + int(compacton.support)) // 2 + 2
    bead = np.arange(2 * cells) - start
    scene = carrying(
        [float(m) for m in wave.cell.masses] * cells,
        compacton.k,
        compacton.compression(bead[:-1] + 0.5),
        compacton.velocity(bead),
        contact_sensors=[place + side for place in places for side in (0, 1)],
        duration=(2 * cells - start - compacton.support / 4) / compacton.speed,
    )
    # Light beads set the step, far below what the pulse needs at the same tolerance.
    rtol, atol = (1e-9, 1e-9) if len(set(wave.cell.masses)) == 1 else (1e-7, 1e-6)
    return simulate(scene, rtol=rtol, atol=atol)


def _numbers(run: Run, compacton: Compacton, place: int) -> dict[str, float]:
    """The lengths among `QUANTITIES`, strain, speed and force at a place: means over a cell."""
    unit_support = compacton.support / compacton.arch_integral(compacton.k * compacton.m)
    width, strain_width, support, _ = QUANTITIES
    sides = []
    contacts = run.scene.contact_sensors
    for row in (2 * place, 2 * place + 1):  # the cell's contacts, next to the last cell's
        here, last = contacts[row], contacts[row - 2]
        force = run.signal("contact", here)
        pulse, before = highest_pulse(force), highest_pulse(run.signal("contact", last))
        strain = highest_pulse(run.signal("contact", here, "compression"))
        V = speed(before, pulse, here - last)
        reach = 0.6 * compacton.support / V
        push = integral(force, pulse.arrival - reach, pulse.arrival + reach)
        sides.append({
            width: pulse.fwhm * V, strain_width: strain.fwhm * V,
            support: unit_support * push * V / pulse.peak,
            "strain": strain.peak, "speed": V, "force": pulse.peak,
        })  # fmt: skip
    first, second = sides
    return {name: (value + second[name]) / 2 for name, value in first.items()}


Case = tuple[sp.Rational, sp.Rational, float]  # k, ω and B of one run


@study()
def limits(progress: Progress[Case] = iter) -> Limits:
    """Equal masses, m1 ≫ m2 and k → 1: widths, speed, amplitude, held to bounds. A few seconds."""
    cases: dict[Case, None] = dict.fromkeys(
        [(k, omega, 1.0) for omega in (EQUAL, LIGHT) for k in EXPONENTS]
        + [(k, EQUAL, B) for k in EXPONENTS for B in AMPLITUDES]
        + [(EXPONENTS[0], omega, 1.0) for omega in LIMIT]
    )
    waves = {(k, omega): theory_at(k, omega) for k, omega, _ in cases}
    lattice = {case: lattice_wave(waves[case[:2]], case[2]) for case in progress(list(cases))}
    rows: list[Row] = []
    for omega in (EQUAL, LIGHT):
        theory = [theory_values(waves[k, omega]) for k in EXPONENTS]
        for quantity in QUANTITIES:
            found = [lattice[k, omega, 1.0][quantity] for k in EXPONENTS]
            rows += _quantity_rows(quantity, omega, [t[quantity] for t in theory], found)
    rows += _limit_rows([lattice[EXPONENTS[0], omega, 1.0] for omega in LIMIT])
    for k in EXPONENTS:
        rows.append(_exponent_row(k, waves[k, EQUAL], [lattice[k, EQUAL, B] for B in AMPLITUDES]))
    return Limits(tuple(rows))


def _quantity_rows(
    quantity: str, omega: sp.Rational, theory: list[sp.Expr], lattice: list[Measured]
) -> list[Row]:
    """One quantity at each k, and how its error vanishes with ε."""
    law = LAWS[quantity]
    epsilon = np.array([float(k - 1) for k in EXPONENTS])
    rows = [Row(quantity, k, omega, t, f, law.bound(k))
            for k, t, f in zip(EXPONENTS, theory, lattice, strict=True)]  # fmt: skip
    # The coefficient is that of ω = 1 and of ω → 0; between, it depends on ω.
    slack = 0.0 if omega == 1 else 20 * float(omega)
    numbers = np.array([row.theory_value for row in rows])

    def order(*found: float) -> float:
        return float(np.polyfit(np.log(epsilon), np.log(np.abs(numbers / found - 1)), 1)[0])

    def coefficient(*found: float) -> float:
        return float(np.polyfit(epsilon, (numbers / found - 1) / epsilon**law.order, 2)[-1])

    return [
        *rows,
        Row(f"{quantity}: order of its error", None, omega, sp.Integer(law.order),
            derived(order, *lattice), law.order_bound),
        Row(f"{quantity}: error/(k-1)^{law.order} at k → 1", None, omega, law.coefficient,
            derived(coefficient, *lattice), law.coefficient_bound + slack),
    ]  # fmt: skip


def _limit_rows(waves: list[dict[str, Measured]]) -> Iterator[Row]:
    """ω → 0 at the first k: the lattice extrapolated, linearly in ω."""
    k = EXPONENTS[0]
    symbols = homogenize(Dimer("m1", "m2", spacing=1), k=k).pde.traveling_wave()
    m1, m2 = symbols.cell.masses
    for quantity, theory in theory_values(symbols).items():
        coarse, middle, fine = (wave[quantity].value for wave in waves)
        limit = Measured((4 * fine - middle) / 3, (4 * middle - coarse) / 3)
        there = sp.simplify(theory.subs({m1: 1, m2: 0}))
        yield Row(quantity, k, sp.Integer(0), there, limit, LAWS[quantity].bound(k))


def _exponent_row(k: sp.Rational, wave: TravelingWave, waves: list[dict[str, Measured]]) -> Row:
    """The power of V_s to which F_m is proportional, fitted to runs of different amplitude."""
    speeds, forces = ([wave[name] for wave in waves] for name in ("speed", "force"))
    # The lattice scales exactly, so only the integration's error is allowed for.
    found = exponent(speeds, forces)
    return Row("exponent of F_m in V_s", k, EQUAL, wave.force_exponent, found, 1e-5)
