"""Limits of the theory on the lattice: equal masses, m1 ≫ m2, and k → 1.

The theory's wave is the leading order in ε = k - 1, so that its error against the lattice must
vanish as a known power of ε, with a known coefficient. Each chain starts with the theory's wave,
which turns into the lattice's wave and leaves the difference behind. The pulse is measured after
four, six and eight times its support (the places); the difference between the last two places is
the lattice's error.

With m1 ≫ m2 the light beads only pass the force on: a uniform chain of spacing 2D.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import sympy as sp

from lwa import CompactWave, Dimer, PhysicalWave, canonical_wave, homogenize
from lwa.base.frozen import Estimate
from lwa.base.progress import Progress
from validation.lattice.simulate import simulate
from validation.pictures import Curve, Panel
from validation.pulses.pulse import compared, derived, highest_pulse, speed
from validation.pulses.signals import integral
from validation.report.command import study
from validation.report.result import Report
from validation.report.table import Column, Finding, Table, percent
from validation.scenes.chains import carrying

EXPONENTS = (sp.Rational(3, 2), sp.Rational(5, 4), sp.Rational(11, 10))
EQUAL, LIGHT = (
    sp.Integer(1),
    sp.Rational(1, 1000),
)  # ω = m2/m1; effects of LIGHT² do not show
PLACES = (4, 6, 8)  # supports run
TOLERANCE = 1e-9  # rtol: the pulse sheds more than the integrator loses
QUANTITIES = ("FWHM of force", "FWHM of strain", "support π/β", "speed V_s at B = 1")
"""Lengths in D; force and strain are a contact's; the support is by the impulse ∫F dx / F_m."""


@dataclass(frozen=True)
class LeadingPower:
    """Leading power of the theory's error, coefficient · ε^order, and bounds of a measurement."""

    order: int
    coefficient: sp.Expr
    constant: float  # |error| ≤ constant · ε^order at each k measured
    order_bound: float  # relative, for the fitted order
    coefficient_bound: float  # relative, for the fitted coefficient


# Powers and coefficients are derived, not fitted. Let v(x) be the strain of the wave with peak 1,
# ε = k - 1 and X = √ε x (D = 1, equal masses). At fixed X, the series of log v in ε is
# -3X² + ε (18/5 X² - 3/10 X⁴) + … for the exact wave of the lattice, and
# -3X² + ε (9/2 X² - 3/2 X⁴) + … for the long-wave theory. The log of the force is k log v. c² is
# 1 - ε/2 + 2ε²/5 for the lattice against 2/(k+1) for the theory. Errors: theory/lattice - 1.
_WIDTH = LeadingPower(1, sp.Rational(3, 20) - sp.log(2) / 15, 0.113, 0.05, 0.01)
_SUPPORT = LeadingPower(1, sp.Rational(1, 20), 0.077, 0.2, 0.02)
_SPEED = LeadingPower(2, -sp.Rational(3, 40), 0.075, 0.15, 0.01)
LEADING_POWERS = dict(zip(QUANTITIES, (_WIDTH, _WIDTH, _SUPPORT, _SPEED), strict=True))

_CHAINS = {EQUAL: "m1 = m2, ω = 1", LIGHT: f"m1 ≫ m2, ω = {LIGHT}"}
_COLUMNS = (
    Column("quantity"),
    Column("", "quantity"),
    Column("", "k"),
    Column("k"),
    Column("omega", format=_CHAINS.__getitem__),
    Column("theory"),
    Column("theory_value", "theory", format=".5g"),
    Column("lattice", "lattice", error=True),
    Column(
        "error_value",
        "error",
        format=lambda error: percent(error if abs(error) > 1e-9 else 0),
    ),
    Column("bound_value", "bound", format=lambda bound: percent(bound).lstrip("+")),
    Column("ok", "holds"),
)
_NOTE = """\
Lengths in D, m1 = A = D = 1; force and strain of a contact; error: theory/lattice - 1. From all k:
the order n of the error in k - 1, and the limit of error/(k-1)^n as k → 1. ±: change of the
lattice's number over the last stretch, and the rounding of its seven digits, which JSON does not
have."""

Case = tuple[sp.Rational, sp.Rational]  # k and ω of one run
Row = tuple[
    tuple[Any, ...], Finding
]  # cells below `_COLUMNS`, and the error as a finding


@study()
def limits(progress: Progress[Case] = iter) -> Report:
    """Limits of the theory: equal masses, m1 ≫ m2 and k → 1 (a few seconds).

    ``rows``: ``quantity``, ``k`` and ``omega`` (exact; ``k`` null for results from all k),
    ``theory`` (exact), ``theory_value``, ``lattice_value``, ``lattice_error_value``,
    ``error_value`` (theory over lattice - 1), ``bound_value``, ``ok``.
    """
    cases = [(k, omega) for omega in (EQUAL, LIGHT) for k in EXPONENTS]
    waves = {case: theory_at(*case) for case in cases}
    lattice = {case: lattice_wave(waves[case]) for case in progress(cases)}
    rows: list[Row] = []
    for omega in (EQUAL, LIGHT):
        alike = [waves[k, omega] for k in EXPONENTS]
        theory = zip(
            *((w.fwhm("force"), w.fwhm("strain"), w.width, w.speed(1)) for w in alike),
            strict=True,
        )
        for quantity, values in zip(QUANTITIES, theory, strict=True):
            measured = [lattice[k, omega][quantity] for k in EXPONENTS]
            rows += quantity_rows(quantity, omega, values, measured)
    cells, findings = zip(*rows, strict=True)
    return Report(
        "The theory's limits on the lattice",
        (Table(_COLUMNS, cells, "rows", by="omega", note=_NOTE),),
        findings,
        tuple(_panel(rows, omega) for omega in (EQUAL, LIGHT)),
    )


def theory_at(k: Any, omega: Any, closure: Any = "linear") -> CompactWave:
    """Return the theory's wave for masses 1 and ω, equal contacts A = 1 and D = 1.

    closure : "linear" (the paper's), "full", or "canonical" (full closure, canonical field).

    >>> theory_at("3/2", 1).width
    sqrt(10)*pi/2
    """
    cell = Dimer(1, omega, spacing=1)
    if closure == "canonical":
        return canonical_wave(cell, k)
    return homogenize(cell, k=k, closure=closure, field="first").pde.traveling_wave()


def _panel(rows: Sequence[Row], omega: sp.Rational) -> Panel:
    """Return the panel of |error| as a function of k - 1, beside its leading power."""
    epsilon = np.geomspace(float(EXPONENTS[-1] - 1) / 2, float(EXPONENTS[0] - 1), 2)
    curves = []
    for i, (quantity, law) in enumerate(LEADING_POWERS.items()):
        points = [
            (k - 1, abs(finding.value), finding.error)
            for (name, _, _, k, ratio, *_), finding in rows
            if (name, ratio) == (quantity, omega) and k is not None
        ]
        x, y, error = zip(*points, strict=True)
        power = abs(float(law.coefficient)) * epsilon**law.order
        curves.append(Curve(quantity, x, y, f"C{i}{'osD^'[i]}", error))
        # Dashes, as two quantities share their leading order.
        curves.append(Curve("", epsilon, power, f"C{i}{('-', '--', '-.', ':')[i]}"))
    title = f"m2/m1 = {omega}; lines: leading order"
    return Panel("k - 1", "|theory/lattice - 1|", tuple(curves), "xy", title)


def lattice_wave(
    wave: CompactWave, places: Sequence[float] = PLACES
) -> dict[str, Estimate]:
    """Measure `QUANTITIES` of the pulse that the theory's wave of peak strain 1 becomes.

    places : distances, in supports, at which the pulse is measured: the last one gives the numbers,
    the last but one their errors.
    """
    compact = PhysicalWave(wave, 1)  # peak force; A = D = 1
    k, support, V = float(wave.k), float(wave.width), float(compact.speed)
    masses, start = [float(m) for m in wave.cell.masses], int(support / 2) + 1
    size = len(masses)  # the exact strains of a cell's two contacts are mirror images
    sensors = [size * round((start + place * support) / size) for place in places]
    beads = size * ((sensors[-1] + int(support)) // size + 4)
    x = np.arange(beads) - start
    scene = carrying(
        masses * (beads // size),
        compact.along(x[:-1] + 0.5, "strain"),
        compact.along(x, "velocity"),
        k=k,
        contact_sensors=[
            sensor + side for sensor in sensors for side in range(2 * size)
        ],
        duration=(beads - start - support / 4) / V,
    )
    run = simulate(scene, rtol=TOLERANCE)
    # The support over ∫F dx / F_m, as ∫ cos^{2k/(k-1)}(βx) dx is Euler's beta function over β.
    unit = support * float(wave.beta / sp.beta(k / (k - 1) + 0.5, 0.5))

    def numbers(sensor: int) -> dict[str, float]:
        contacts = []
        for last in range(sensor, sensor + size):
            force = run.signal("contact", last + size)
            pulse, before = (
                highest_pulse(force),
                highest_pulse(run.signal("contact", last)),
            )
            strain = highest_pulse(run.signal("contact", last + size, "compression"))
            V = speed(before, pulse, size)
            reach = 0.6 * support / V
            push = integral(force, pulse.arrival - reach, pulse.arrival + reach)
            lengths = pulse.fwhm * V, strain.fwhm * V, unit * push * V / pulse.peak
            contacts.append((*lengths, strain.peak, V))
        *means, B, V = np.mean(contacts, axis=0).tolist()
        # V_s of the theory's units; speeds scale as B^{(k-1)/2}.
        at_one = V / float(wave.time_scale) / B ** ((k - 1) / 2)
        return dict(zip(QUANTITIES, (*means, at_one), strict=True))

    return compared(numbers, sensors[-1], sensors[-2])


def quantity_rows(
    quantity: str,
    omega: sp.Rational,
    theory: Sequence[sp.Expr],
    lattice: Sequence[Estimate],
) -> list[Row]:
    """Compare a quantity at each k, and the order and coefficient of its error as ε → 0."""
    law = LEADING_POWERS[quantity]
    epsilon = np.array([float(k - 1) for k in EXPONENTS])
    numbers = np.array([float(sp.N(value, 17)) for value in theory])
    # The coefficient holds at ω = 1 and ω → 0; between them it depends on ω.
    slack = 0.0 if omega == 1 else 20 * float(omega)

    def order(*values: float) -> float:
        return float(
            np.polyfit(np.log(epsilon), np.log(np.abs(numbers / values - 1)), 1)[0]
        )

    def coefficient(*values: float) -> float:
        return float(
            np.polyfit(epsilon, (numbers / values - 1) / epsilon**law.order, 2)[-1]
        )

    compared_numbers: list[tuple[str, str, Any, sp.Expr, Estimate, float]] = [
        (quantity, str(k), k, value, measured, law.constant * float(k - 1) ** law.order)
        for k, value, measured in zip(EXPONENTS, theory, lattice, strict=True)
    ]
    orders, coefficients = derived(order, *lattice), derived(coefficient, *lattice)
    name, limit = (
        f"{quantity}: order of its error",
        f"{quantity}: error/(k-1)^{law.order} at k → 1",
    )
    compared_numbers += [
        (name, "order", None, sp.Integer(law.order), orders, law.order_bound),
        (
            limit,
            "→ 1",
            None,
            law.coefficient,
            coefficients,
            law.coefficient_bound + slack,
        ),
    ]
    rows = []
    for name, kind, k, expected, number, bound in compared_numbers:
        value = float(sp.N(expected, 17))
        error = value / number.value - 1
        finding = Finding(name, error, -bound, bound, number.relative_error)
        cells = (
            quantity,
            kind,
            k,
            omega,
            expected,
            value,
            number,
            error,
            bound,
            finding.ok,
        )
        rows.append(((name, *cells), finding))
    return rows
