"""Limits of the theory on the lattice: equal masses, m1 ≫ m2, and k → 1.

The theory's wave is the leading order in ``ε = k - 1``, so that its error against the lattice must
vanish as a known power of ε, with a known coefficient. Each chain starts with the theory's wave,
which turns into the lattice's wave and leaves the difference behind. The pulse is measured after
four, six and eight times its support (the places). Its numbers come nearer to their limits by about
the same factor from place to place, so that three places tell how far the last one is off.

With m1 ≫ m2 the light beads only pass the force on: a uniform chain of spacing 2D.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import sympy as sp

from lwa import CompactWave, Dimer, Estimate, PhysicalWave, canonical_wave, homogenize
from lwa.base.progress import Progress
from validation.lattice.result import Run
from validation.lattice.simulate import simulate
from validation.pictures import Curve, Panel
from validation.pulses.pulse import derived, highest_pulse, speed
from validation.pulses.signals import integral
from validation.report.study import Report, study
from validation.report.table import Column, Finding, Table, percent
from validation.scenes.chains import carrying

EXPONENTS = (sp.Rational(3, 2), sp.Rational(5, 4), sp.Rational(11, 10))
EQUAL = sp.Integer(1)
LIGHT = sp.Rational(1, 1000)  # ω = m2/m1; effects of LIGHT² do not show
PLACES = (4, 6, 8)  # supports run
TOLERANCE = 1e-9  # rtol: the pulse sheds more than the integrator loses
# The integrator's error of the numbers over rtol, at most: measured, 3e-4 … 9e-3.
_LOST = 0.01
FORCE_WIDTH = "FWHM of force"
STRAIN_WIDTH = "FWHM of strain"
SUPPORT = "support π/β"  # by the impulse ∫F dx / F_m
SPEED = "speed V_s at B = 1"
QUANTITIES = (FORCE_WIDTH, STRAIN_WIDTH, SUPPORT, SPEED)
"""Lengths in D; force and strain are a contact's."""


@dataclass(frozen=True)
class LeadingPower:
    """Leading power of the theory's error in k - 1, and bounds of a measurement."""

    order: int
    coefficient: sp.Expr  # of ε^order
    constant: float  # |error| ≤ constant · ε^order at each k measured
    order_bound: float  # relative, for the fitted order
    coefficient_bound: float  # relative, for the fitted coefficient


# Powers and coefficients are derived, not fitted. Let v(x) be the strain of the wave with peak 1,
# ε = k - 1 and X = √ε x (D = 1, equal masses). At fixed X, the series of log v in ε is
# -3X² + ε (18/5 X² - 3/10 X⁴) + … for the exact wave of the lattice, and
# -3X² + ε (9/2 X² - 3/2 X⁴) + … for the long-wave theory. The log of the force is k log v. c² is
# 1 - ε/2 + 2ε²/5 for the lattice against 2/(k+1) for the theory. Errors: theory/lattice - 1.
_WIDTH = LeadingPower(1, sp.Rational(3, 20) - sp.log(2) / 15, 0.113, 0.05, 0.01)
LEADING_POWERS = {
    FORCE_WIDTH: _WIDTH,
    STRAIN_WIDTH: _WIDTH,
    SUPPORT: LeadingPower(1, sp.Rational(1, 20), 0.077, 0.2, 0.02),
    SPEED: LeadingPower(2, -sp.Rational(3, 40), 0.075, 0.15, 0.01),
}

_CHAINS = {EQUAL: "m1 = m2, ω = 1", LIGHT: f"m1 ≫ m2, ω = {LIGHT}"}
_COLUMNS = (
    # The name of a number that is fitted to all k goes on behind a colon.
    Column("quantity", "quantity", format=lambda name: name.partition(":")[0]),
    Column("", "at k"),
    Column("k"),
    Column("omega", format=_CHAINS.__getitem__),
    Column("theory"),
    Column("theory_value", "theory", format=".5g"),
    Column("lattice", "lattice", error=True),
    Column(
        "error_value",
        "error",
        # an error of rounding has no sign worth a look
        format=lambda error: percent(error if abs(error) > 1e-9 else 0),
    ),
    Column("bound_value", "bound", format=lambda bound: percent(bound).lstrip("+")),
    Column("ok", "holds"),
)
_NOTE = """\
Lengths in D, m1 = A = D = 1; force and strain of a contact; error: theory/lattice - 1. From all k:
the order n of the error in k - 1, and the limit of error/(k-1)^n as k → 1."""
_ERRORS = "twice what the lattice's number is still expected to change on its way"

Case = tuple[sp.Rational, sp.Rational]  # k and ω of one run
Record = dict[str, Any]
"""A row of the table by the names of its columns."""


@study(page="exact", examples=("lwa-validate limits --plot limits.svg",))
def limits(progress: Progress[Case] = iter) -> Report:
    """Limits of the theory: equal masses, m1 ≫ m2 and k → 1 (a few seconds).

    ``rows``: ``quantity``, ``k`` and ``omega`` (exact; ``k`` null for results from all k),
    ``theory`` (exact), ``theory_value``, ``lattice_value``, ``lattice_error_value``,
    ``error_value`` (theory over lattice - 1), ``bound_value``, ``ok``.
    """
    cases = [(k, omega) for omega in (EQUAL, LIGHT) for k in EXPONENTS]
    waves = {case: theory_at(*case) for case in cases}
    lattice = {case: lattice_wave(waves[case]) for case in progress(cases)}
    records: list[Record] = []
    for omega in (EQUAL, LIGHT):
        theory = [theory_numbers(waves[k, omega]) for k in EXPONENTS]
        found = [lattice[k, omega] for k in EXPONENTS]
        for quantity in QUANTITIES:
            expected = [numbers[quantity] for numbers in theory]
            measured = [numbers[quantity] for numbers in found]
            records += compared(quantity, omega, expected, measured)
    return Report(
        "The theory's limits on the lattice",
        (Table.of(_COLUMNS, records, "rows", by="omega", note=_NOTE, errors=_ERRORS),),
        tuple(map(finding, records)),
        tuple(_panel(records, omega) for omega in (EQUAL, LIGHT)),
    )


def theory_at(k: Any, omega: Any, closure: Any = "linear") -> CompactWave:
    """Return the theory's wave for masses 1 and ω, equal contacts of stiffness 1, and spacing 1.

    Parameters
    ----------
    k, omega : number or str
        Exponent and mass ratio.
    closure : {"linear", "full", "canonical"}
        The paper's, the full one, or the full one with the canonical field.

    >>> theory_at("3/2", 1).width
    sqrt(10)*pi/2
    """
    cell = Dimer(1, omega, spacing=1)
    if closure == "canonical":
        return canonical_wave(cell, k)
    return homogenize(cell, k=k, closure=closure).pde.traveling_wave()


def theory_numbers(wave: CompactWave) -> dict[str, sp.Expr]:
    """Return the theory's `QUANTITIES`."""
    return {
        FORCE_WIDTH: wave.fwhm("force"),
        STRAIN_WIDTH: wave.fwhm("strain"),
        SUPPORT: wave.width,
        SPEED: wave.speed(1),
    }


def lattice_wave(
    wave: CompactWave, places: Sequence[float] = PLACES
) -> dict[str, Estimate]:
    """Measure `QUANTITIES` of the pulse that the theory's wave of peak strain 1 becomes.

    Parameters
    ----------
    wave : CompactWave
        The wave with which the chain starts.
    places : sequence of float
        Three distances, in supports, at equal steps, at which the pulse is measured.
    """
    compact = PhysicalWave(wave, 1)  # peak force; A = D = 1
    support = float(wave.width)
    V = float(compact.speed)
    masses = [float(m) for m in wave.cell.masses]
    size = len(masses)
    start = int(support / 2) + 1
    # The exact strains of a cell's two contacts are mirror images: both are recorded.
    sensors = [size * round((start + place * support) / size) for place in places]
    beads = size * ((sensors[-1] + int(support)) // size + 4)
    x = np.arange(beads) - start
    scene = carrying(
        masses * (beads // size),
        compact.along(x[:-1] + 0.5, "strain"),
        compact.along(x, "velocity"),
        k=float(wave.k),
        # two cells at each place, for the speed from one to the next
        contact_sensors=[first + side for first in sensors for side in range(2 * size)],
        duration=(beads - start - support / 4) / V,
    )
    run = simulate(scene, rtol=TOLERANCE)
    numbers = [pulse_numbers(run, wave, sensor) for sensor in sensors]
    return {name: settled(*(row[name] for row in numbers)) for name in QUANTITIES}


def pulse_numbers(run: Run, wave: CompactWave, sensor: int) -> dict[str, float]:
    """Measure `QUANTITIES` at the cell behind a sensor: means over the cell's contacts."""
    k = float(wave.k)
    support = float(wave.width)
    size = wave.cell.size
    # The support over ∫F dx / F_m, as ∫ cos^{2k/(k-1)}(βx) dx is Euler's beta function over β.
    unit = support * float(wave.beta / sp.beta(k / (k - 1) + 0.5, 0.5))
    contacts = []
    for last in range(sensor, sensor + size):
        force = run.signal("contact", last + size)
        pulse = highest_pulse(force)
        strain = highest_pulse(run.signal("contact", last + size, "compression"))
        V = speed(highest_pulse(run.signal("contact", last)), pulse, size)
        reach = 0.6 * support / V  # a fifth more than the pulse
        push = integral(force, pulse.arrival - reach, pulse.arrival + reach)
        width = unit * push * V / pulse.peak
        contacts.append((pulse.fwhm * V, strain.fwhm * V, width, strain.peak, V))
    force_width, strain_width, width, B, V = np.mean(contacts, axis=0).tolist()
    return {
        FORCE_WIDTH: force_width,
        STRAIN_WIDTH: strain_width,
        SUPPORT: width,
        # V_s of the theory's units; speeds scale as B^{(k-1)/2}.
        SPEED: V / float(wave.time_scale) / B ** ((k - 1) / 2),
    }


def settled(first: float, second: float, third: float) -> Estimate:
    """Return the third of three numbers on their way to a limit, with twice the way that is left.

    Steps fall by a factor r: the rest of the way is the last step times ``r + r² + …``.
    """
    step = abs(third - second)
    r = step / abs(second - first)
    return Estimate(third, 2 * step * r / (1 - r) + _LOST * TOLERANCE * abs(third))


def compared(
    quantity: str,
    omega: sp.Rational,
    theory: Sequence[sp.Expr],
    lattice: Sequence[Estimate],
) -> Iterator[Record]:
    """Compare a quantity at each of `EXPONENTS`, and its error's order and coefficient as ε → 0."""
    law = LEADING_POWERS[quantity]
    epsilon = np.array([float(k - 1) for k in EXPONENTS])
    numbers = np.array([float(sp.N(value, 17)) for value in theory])

    def order(*values: float) -> float:
        logs = np.log(np.abs(numbers / values - 1))
        return float(np.polyfit(np.log(epsilon), logs, 1)[0])

    def coefficient(*values: float) -> float:
        return float(
            np.polyfit(epsilon, (numbers / values - 1) / epsilon**law.order, 2)[-1]
        )

    for k, value, number in zip(EXPONENTS, theory, lattice, strict=True):
        bound = law.constant * float(k - 1) ** law.order
        yield _row(quantity, str(k), omega, value, number, bound) | {"k": k}
    name = f"{quantity}: order of its error"
    fitted = derived(order, *lattice)
    expected = sp.Integer(law.order)
    yield _row(name, "order", omega, expected, fitted, law.order_bound)
    name = f"{quantity}: error/(k-1)^{law.order} at k → 1"
    fitted = derived(coefficient, *lattice)
    # The coefficient holds at ω = 1 and ω → 0; between them it depends on ω.
    slack = 0.0 if omega == 1 else 20 * float(omega)
    bound = law.coefficient_bound + slack
    yield _row(name, "→ 1", omega, law.coefficient, fitted, bound)


def _row(
    quantity: str,
    at: str,
    omega: sp.Rational,
    theory: sp.Expr,
    number: Estimate,
    bound: float,
) -> Record:
    """The row that compares a number with the theory's."""
    value = float(sp.N(theory, 17))
    row = {
        "quantity": quantity,
        "at k": at,
        "omega": omega,
        "theory": theory,
        "theory_value": value,
        "lattice": number,
        "error_value": value / number.value - 1,
        "bound_value": bound,
    }
    return row | {"ok": finding(row).ok}


def finding(record: Record) -> Finding:
    """Return the theory's error in a row as a finding."""
    bound = record["bound_value"]
    error = record["lattice"].relative_error
    return Finding(record["quantity"], record["error_value"], -bound, bound, error)


def _panel(records: Sequence[Record], omega: sp.Rational) -> Panel:
    """Return the panel of the errors as functions of k - 1, beside their leading powers."""
    epsilon = np.geomspace(float(EXPONENTS[-1] - 1) / 2, float(EXPONENTS[0] - 1), 2)
    curves = []
    for i, (quantity, law) in enumerate(LEADING_POWERS.items()):
        x = []
        y = []
        error = []
        for row in records:
            if row["quantity"] == quantity and row["omega"] == omega:
                x.append(float(row["k"] - 1))
                y.append(abs(row["error_value"]))
                error.append(row["lattice"].relative_error)
        curves.append(Curve(quantity, x, y, f"C{i}{'osD^'[i]}", error))
        power = abs(float(law.coefficient)) * epsilon**law.order
        # Dashes, as two quantities share their leading order.
        curves.append(Curve("", epsilon, power, f"C{i}{('-', '--', '-.', ':')[i]}"))
    title = f"m2/m1 = {omega}; lines: leading order"
    return Panel("k - 1", "|theory/lattice - 1|", tuple(curves), "xy", title)
