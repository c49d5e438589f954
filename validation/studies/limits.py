"""Limits of the theory on the lattice: equal masses, m1 ≫ m2, and k → 1.

The theory's wave is the leading order in ε = k - 1, so that its error against the lattice must
vanish as a known power of ε (`validation.waves.theory`). Each chain starts with the theory's
wave, which turns into the lattice's wave and leaves the difference behind. The pulse is measured
after four, six and eight times its support (the places); the difference between the last two places
is the lattice's error.

With m1 ≫ m2 the light beads only pass the force on: a uniform chain of spacing 2D.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import sympy as sp

from lwa import PhysicalWave, TravelingWave
from lwa.base.progress import Progress
from validation.lattice.result import Run
from validation.lattice.simulate import simulate
from validation.pictures import Curve, Panel
from validation.pulses.pulse import Measured, compared, derived, highest_pulse, speed
from validation.pulses.signals import integral
from validation.report.command import study
from validation.report.result import Report
from validation.report.table import Column, Finding, Table, percent
from validation.scenes.chains import carrying
from validation.waves.theory import LEADING_POWERS, QUANTITIES, theory_at, theory_values

EXPONENTS = (sp.Rational(3, 2), sp.Rational(5, 4), sp.Rational(11, 10))
EQUAL, LIGHT = sp.Integer(1), sp.Rational(1, 1000)  # ω = m2/m1; effects of LIGHT² do not show
PLACES = (4, 6, 8)  # supports run
# rtol and atol of chains with one mass and with two. Light beads set the step, far below the needs
# of the pulse at the same tolerance.
TOLERANCES = {1: (1e-9, 1e-9), 2: (1e-7, 1e-6)}


_COLUMNS = (
    Column("quantity"),
    Column("", "quantity"),
    Column("", "k"),
    Column("k"),
    Column("omega"),
    Column("theory"),
    Column("theory_value", "theory", format=".5g"),
    Column("lattice", "lattice", error=True),
    Column("error_value", "error", format=lambda error: percent(error if abs(error) > 1e-9 else 0)),
    Column("bound_value", "bound", format=lambda bound: percent(bound).lstrip("+")),
    Column("ok", "holds"),
)
_CHAINS = {
    "1": "m1 = m2, ω = 1",
    str(LIGHT): f"m1 ≫ m2, ω = {LIGHT}",
}
_NOTE = """\
Lengths in D, m1 = A = D = 1; force and strain of a contact; error:
theory/lattice - 1. From all k: the order n of the error in k - 1, and the limit
of error/(k-1)^n as k → 1. ±: change of the lattice's number over the last
stretch, and the rounding of its seven digits, which JSON does not have."""

Case = tuple[sp.Rational, sp.Rational]  # k and ω of one run
Row = tuple[tuple[Any, ...], Finding]  # cells below `_COLUMNS`, and the error as a finding


@study()
def limits(progress: Progress[Case] = iter) -> Report:
    """Limits of the theory: equal masses, m1 ≫ m2 and k → 1 (a few seconds).

    ``rows``: ``quantity``, ``k`` and ``omega`` (exact; ``k`` null for results from all k),
    ``theory`` (exact), ``theory_value``, ``lattice_value``,
    ``lattice_error_value``, ``error_value`` (theory over lattice - 1), ``bound_value``, ``ok``.
    """
    cases = [(k, omega) for omega in (EQUAL, LIGHT) for k in EXPONENTS]
    waves = {case: theory_at(*case) for case in cases}
    lattice = {case: lattice_wave(waves[case]) for case in progress(cases)}
    rows: list[Row] = []
    for omega in (EQUAL, LIGHT):
        theory = [theory_values(waves[k, omega]) for k in EXPONENTS]
        for quantity in QUANTITIES:
            measured = [lattice[k, omega][quantity] for k in EXPONENTS]
            rows += quantity_rows(quantity, omega, [t[quantity] for t in theory], measured)
    cells, findings = zip(*rows, strict=True)
    return Report(
        "The theory's limits on the lattice",
        (Table(_COLUMNS, cells, "rows", by="omega", heads=_CHAINS, note=_NOTE),),
        findings,
        tuple(_panel(rows, omega) for omega in (EQUAL, LIGHT)),
        width=80,
    )


def _row(
    quantity: str,
    k: sp.Rational | None,
    omega: sp.Rational,
    theory: sp.Expr,
    lattice: Measured,
    bound: float,
) -> Row:
    """Compare theory and lattice in one quantity.

    k : None for a result of all exponents.
    bound : largest expected |theory/lattice - 1|.
    """
    value = float(sp.N(theory, 17))
    error = value / lattice.value - 1
    finding = Finding(quantity, error, -bound, bound, lattice.relative_error)
    name, _, result = quantity.partition(": ")
    kind = ("order" if result.startswith("order") else "→ 1") if k is None else str(k)
    numbers = value, lattice, error, bound, finding.ok
    return (quantity, name, kind, k, omega, theory, *numbers), finding


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


def lattice_wave(wave: TravelingWave, places: Sequence[float] = PLACES) -> dict[str, Measured]:
    """Measure `QUANTITIES` of the pulse that the theory's wave of peak strain 1 becomes.

    places : distances, in supports, at which the pulse is measured: the last one gives the numbers,
    the last but one their errors.
    """
    run = _run(wave, places)
    return compared(lambda place: _numbers(run, wave, place), len(places) - 1, len(places) - 2)


def _run(wave: TravelingWave, supports: Sequence[float]) -> Run:
    """Simulate a chain that starts with the theory's wave, up to the last place."""
    compact = PhysicalWave(wave, 1)  # peak force; A = D = 1
    support, V = float(wave.width), float(compact.speed)
    start = int(support / 2) + 1
    places = [2 * round((start + s * support) / 2) for s in supports]
    cells = (places[-1] + int(support)) // 2 + 2
    bead = np.arange(2 * cells) - start
    scene = carrying(
        [float(m) for m in wave.cell.masses] * cells,
        compact.along(bead[:-1] + 0.5, "strain"),
        compact.along(bead, "velocity"),
        k=float(wave.k),
        contact_sensors=[place + side for place in places for side in (0, 1)],
        duration=(2 * cells - start - support / 4) / V,
    )
    rtol, atol = TOLERANCES[len(set(wave.cell.masses))]
    return simulate(scene, rtol=rtol, atol=atol)


def _numbers(run: Run, wave: TravelingWave, place: int) -> dict[str, float]:
    """Return `QUANTITIES` at a place, means over a cell's two contacts.

    The exact strains of the two contacts are mirror images.
    """
    k, beta, support = float(wave.k), float(wave.beta), float(wave.width)
    # The support over ∫F dx / F_m, as ∫ cos^{2k/(k-1)}(βx) dx is Euler's beta function over β.
    unit = support * beta / float(sp.beta(k / (k - 1) + 0.5, 0.5))
    sides = []
    contacts = run.scene.contact_sensors
    for row in (2 * place, 2 * place + 1):  # rows of a cell's contacts; the last cell's are row-2
        here, last = contacts[row], contacts[row - 2]
        force = run.signal("contact", here)
        pulse, before = highest_pulse(force), highest_pulse(run.signal("contact", last))
        strain = highest_pulse(run.signal("contact", here, "compression"))
        V = speed(before, pulse, here - last)
        reach = 0.6 * support / V
        push = integral(force, pulse.arrival - reach, pulse.arrival + reach)
        lengths = pulse.fwhm * V, strain.fwhm * V, unit * push * V / pulse.peak
        sides.append((*lengths, strain.peak, V))
    *lengths, B, V = np.mean(sides, axis=0).tolist()
    # V_s of the theory's units; speeds scale as B^{(k-1)/2}.
    at_one = V / float(wave.time_scale) / B ** (float(wave.k - 1) / 2)
    return dict(zip(QUANTITIES, (*lengths, at_one), strict=True))


def quantity_rows(
    quantity: str, omega: sp.Rational, theory: list[sp.Expr], lattice: list[Measured]
) -> list[Row]:
    """Compare a quantity at each k, and the order and coefficient of its error as ε → 0."""
    law = LEADING_POWERS[quantity]
    epsilon = np.array([float(k - 1) for k in EXPONENTS])
    numbers = np.array([float(sp.N(value, 17)) for value in theory])
    # The coefficient holds at ω = 1 and ω → 0; between them it depends on ω.
    slack = 0.0 if omega == 1 else 20 * float(omega)

    def order(*values: float) -> float:
        return float(np.polyfit(np.log(epsilon), np.log(np.abs(numbers / values - 1)), 1)[0])

    def coefficient(*values: float) -> float:
        return float(np.polyfit(epsilon, (numbers / values - 1) / epsilon**law.order, 2)[-1])

    power, limit = (
        f"{quantity}: order of its error",
        f"{quantity}: error/(k-1)^{law.order} at k → 1",
    )
    orders, coefficients = derived(order, *lattice), derived(coefficient, *lattice)
    bound = law.coefficient_bound + slack
    return [
        *(
            _row(quantity, k, omega, value, measured, law.bound(k))
            for k, value, measured in zip(EXPONENTS, theory, lattice, strict=True)
        ),
        _row(power, None, omega, sp.Integer(law.order), orders, law.order_bound),
        _row(limit, None, omega, law.coefficient, coefficients, bound),
    ]
