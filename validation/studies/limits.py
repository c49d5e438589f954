"""The theory's limit k → 1 on the lattice: equal beads.

The theory's wave is the leading order in ``ε = k - 1``, so that its error against the lattice's own
wave, which Newton's method solves to rounding (`validation.waves.solver`), must vanish as a known
power of ε, with a known coefficient.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import sympy as sp

from lwa import Cell, Estimate, homogenize
from lwa.base.exact import number
from validation.pulses.pulse import derived
from validation.report.study import Report, study
from validation.report.table import Column, Estimates, Finding, Table, percent
from validation.waves.solver import exact_wave

# Spheres, and two exponents nearer to 1. At 11/10 the second term of an error is 2 % of the first
# for the widths, 9 % for the speed: three exponents are enough for a fit.
EXPONENTS = (sp.Rational(3, 2), sp.Rational(5, 4), sp.Rational(11, 10))
FORCE_WIDTH = "force FWHM"
STRAIN_WIDTH = "strain FWHM"
SPEED = "speed"
QUANTITIES = (FORCE_WIDTH, STRAIN_WIDTH, SPEED)
"""Widths of a contact's force and strain, and dx/dt, of the wave with peak contact force 1."""


@dataclass(frozen=True)
class LeadingPower:
    """Leading power of the theory's error in k - 1, and bounds of the numbers of the lattice."""

    order: int
    coefficient: sp.Expr  # the error is coefficient · ε^order + …
    constant: float  # |error| ≤ constant · ε^order at each of `EXPONENTS`


# Powers and coefficients are derived, not fitted. Let v(x) be the strain of the wave with peak 1,
# ε = k - 1 and X = √ε x (D = 1, equal masses). At fixed X, the series of log v in ε is
# -3X² + ε (18/5 X² - 3/10 X⁴) + … for the exact wave of the lattice, and
# -3X² + ε (9/2 X² - 3/2 X⁴) + … for the long-wave theory. The log of the force is k log v. c²/k is
# 1 - ε/2 + 2ε²/5 for the lattice against 2/(k+1) for the theory. Errors: theory/lattice - 1.
# The bounds are those errors and the terms behind the leading one: constants are 9 % above the
# coefficient of the widths, as the next term of the force's has the same sign, and the coefficient
# itself for the speed, whose next term has the other one.
_WIDTH = LeadingPower(1, sp.Rational(3, 20) - sp.log(2) / 15, constant=0.113)
LEADING_POWERS = {
    FORCE_WIDTH: _WIDTH,
    STRAIN_WIDTH: _WIDTH,
    SPEED: LeadingPower(2, -sp.Rational(3, 40), constant=0.075),
}
COEFFICIENT_BOUND = 0.01
"""Relative, for a fitted coefficient, which errs by 0.4 %; of another order there is no limit."""

_COLUMNS = (
    Column("quantity", "quantity"),
    Column("k", "k"),
    Column("theory"),
    Column("theory_value", "theory", format=".5g"),
    Estimates("lattice", "lattice"),
    Column("error_value", "error", format=percent),
    Column("bound_value", "bound", format=lambda bound: percent(bound).lstrip("+")),
    Column("ok", "holds"),
)
_NOTE = """\
Peak contact force 1, m = A = D = 1; error: theory/lattice - 1. Limit, from all k: of error/(k-1)^n
as k → 1, n = 1 for the widths and 2 for the speed."""
_ERRORS = "residual of the lattice's wave, and rounding"

Record = dict[str, Any]
"""A row of the table by the names of its columns."""


@study(page="exact", examples=("lwa-validate limits --format csv",))
def limits() -> Report:
    """The theory's limit k → 1: its error against the lattice's own wave of equal beads.

    ``rows``: ``quantity``, ``k`` (exact; null for results from all k), ``theory`` (exact),
    ``theory_value``, ``lattice_value``, ``lattice_error_value``, ``error_value`` (theory over
    lattice - 1), ``bound_value``, ``ok``.
    """
    theory = [theory_numbers(k) for k in EXPONENTS]
    lattice = [lattice_numbers(k) for k in EXPONENTS]
    records: list[Record] = []
    for quantity in QUANTITIES:
        expected = [numbers[quantity] for numbers in theory]
        measured = [numbers[quantity] for numbers in lattice]
        records += compared(quantity, expected, measured)
    return Report(
        "The theory's limit k → 1 on the lattice",
        (Table(_COLUMNS, records, "rows", note=_NOTE, errors=_ERRORS),),
        [*map(finding, records)],
    )


def theory_numbers(k: sp.Expr) -> dict[str, sp.Expr]:
    """Return the theory's `QUANTITIES` at an exponent."""
    wave = homogenize(Cell([1], spacing=1), k=k).pde.traveling_wave()
    return {
        FORCE_WIDTH: wave.fwhm("force"),
        STRAIN_WIDTH: wave.fwhm("strain"),
        SPEED: wave.at_force(1).speed,
    }


def lattice_numbers(k: sp.Expr) -> dict[str, Estimate]:
    """Return `QUANTITIES` of the lattice's wave at an exponent."""
    wave = exact_wave([1], k)
    return {
        FORCE_WIDTH: wave.estimate("fwhm", "force"),
        STRAIN_WIDTH: wave.estimate("fwhm", "strain"),
        SPEED: wave.estimate("c"),
    }


def compared(
    quantity: str, theory: Sequence[sp.Expr], lattice: Sequence[Estimate]
) -> Iterator[Record]:
    """Compare a quantity at each of `EXPONENTS`, and the coefficient of its error as ε → 0."""
    law = LEADING_POWERS[quantity]
    epsilon = np.array([float(k - 1) for k in EXPONENTS])
    numbers = np.array([*map(number, theory)])

    def coefficient(*values: float) -> float:
        """Fit the limit of ``error/ε^order`` as ``ε → 0``."""
        ratios = (numbers / values - 1) / epsilon**law.order
        # A polynomial through all points: its value at ε = 0 is the last coefficient.
        *_, limit = np.polyfit(epsilon, ratios, len(EXPONENTS) - 1)
        return float(limit)

    for k, value, found in zip(EXPONENTS, theory, lattice, strict=True):
        bound = law.constant * float(k - 1) ** law.order
        yield _row(quantity, value, found, bound) | {"k": k}
    fitted = derived(coefficient, *lattice)
    yield _row(f"{quantity} limit", law.coefficient, fitted, COEFFICIENT_BOUND)


def _row(quantity: str, theory: sp.Expr, lattice: Estimate, bound: float) -> Record:
    """The row that compares a number of the lattice with the theory's."""
    value = number(theory)
    row = {
        "quantity": quantity,
        "theory": theory,
        "theory_value": value,
        "lattice": lattice,
        "error_value": value / lattice.value - 1,
        "bound_value": bound,
    }
    return row | {"ok": finding(row).ok}


def finding(record: Record) -> Finding:
    """Return the theory's error in a row as a finding."""
    bound = record["bound_value"]
    error = record["lattice"].relative_error
    return Finding(record["quantity"], record["error_value"], -bound, bound, error)
