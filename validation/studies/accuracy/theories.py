"""The ladder of theories: linear, full, canonical, the series in ε, each against the true wave.

At a mass ratio whose wave is solitary the true one is `validation.waves.solver.exact_wave`;
elsewhere there is none, and the pulse that a struck chain comes to carry stands for it
(`validation.pulses.steady.point`), with its own error. Compared are the widths of force and strain
at a contact and the speed at peak contact force 1, m1 = A = D = 1. The cost is that of deriving the
theory for this cell and of evaluating it, CPU time.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from functools import partial
from typing import Any

import sympy as sp

from lwa import Cell, NoSolitaryWave, TravelingWave, canonical_wave, expand, homogenize
from validation.pulses.pulse import Measured
from validation.pulses.steady import STRETCH, point
from validation.waves.solver import exact_wave

NAMES = ("force", "strain", "speed")
"""FWHM of the force and of the strain, speed."""

ORDERS = (1, 2, 4, 8)
"""Of the series in ε."""

DEGREES = (1, 2)
"""Of the approximants [n/n] of that series, closed formulas in k for equal beads."""

THEORIES = (
    "linear closure", "full closure", "canonical field",
    *(f"[{n}/{n}]" for n in DEGREES), *(f"ε^{n}" for n in ORDERS),
)  # fmt: skip

UNIFORM = ("1.1", "5/4", "3/2", "2", "3")
"""Exponents, for the chain of equal beads."""

SPECIAL = ("0.3428457811", "0.1547515139", "0.0901277691")
"""Mass ratios at which the Hertz dimer has a solitary wave (by `validation.waves.resonances`)."""

STRUCK = ("0.01", "0.05", "0.2", "0.55", "0.8", "0.9")
"""Mass ratios at which the Hertz dimer has none."""

OTHERS, ALSO = ("5/4", "2"), ("0.05", "0.2", "0.8")
"""Exponents besides, and the mass ratios at which they are tried."""

SOLITARY, STRUCK_CHAIN = "solitary wave", "struck chain"

Progress = Callable[[list[Any]], Any]


@dataclass(frozen=True)
class Rung:
    """One theory at one k and ω.

    errors : theory over truth - 1, by `NAMES`; None where the theory has no wave, see ``missing``.
    estimates : what the theory itself says of the size of these; the series in ε does.
    seconds : CPU time of derivation and evaluation.
    """

    theory: str
    errors: Mapping[str, float] | None
    estimates: Mapping[str, float] | None
    seconds: float
    missing: str | None = None


@dataclass(frozen=True)
class Place:
    """All theories at one k and ω, with the truth that they are measured by.

    kind : `SOLITARY`, or `STRUCK_CHAIN` where there is no such wave.
    truth : by `NAMES`, with the errors of the measurement.
    """

    k: sp.Rational
    omega: sp.Rational
    kind: str
    truth: Mapping[str, Measured]
    rungs: tuple[Rung, ...]


@dataclass(frozen=True)
class Ladder:
    """Theories against truth over (k, ω)."""

    places: tuple[Place, ...]


def ladder(progress: Progress = list) -> Ladder:
    """Climb it: equal beads over `UNIFORM`, the Hertz dimer over `SPECIAL` and `STRUCK`."""
    hertz = sp.Rational(3, 2)
    equal = [(sp.Rational(k), sp.S.One, True) for k in UNIFORM]
    dimers = [(hertz, sp.Rational(w), True) for w in SPECIAL]
    dimers += [(hertz, sp.Rational(w), False) for w in STRUCK]
    dimers += [(sp.Rational(k), sp.Rational(w), False) for k in OTHERS for w in ALSO]
    return Ladder(tuple(place(*at) for at in progress([*equal, *dimers])))


def place(k: sp.Rational, omega: sp.Rational, solitary: bool) -> Place:
    """All theories at one k and ω."""
    truth = _solitary(k, omega) if solitary else _struck(k, omega)
    cell = Cell((1,)) if omega == 1 else Cell((1, omega))
    rungs = tuple(
        _rung(name, compute, truth)
        for name, compute in zip(THEORIES, _theories(cell, k), strict=True)
    )
    return Place(k, omega, SOLITARY if solitary else STRUCK_CHAIN, truth, rungs)


def _solitary(k: sp.Rational, omega: sp.Rational) -> dict[str, Measured]:
    masses = (1.0,) if omega == 1 else (1.0, float(omega))
    wave = exact_wave(masses, float(k))
    size = max(wave.residual, wave.tail, 1e-15)
    values = (wave.fwhm("force"), wave.fwhm("strain"), wave.c)
    return {
        name: Measured(value, value * (1 + size)) for name, value in zip(NAMES, values, strict=True)
    }


def _struck(k: sp.Rational, omega: sp.Rational) -> dict[str, Measured]:
    numbers = point(k, omega, STRETCH).numbers
    names = ("width", "strain_width", "speed")
    return {mine: numbers[its] for mine, its in zip(NAMES, names, strict=True)}


Prediction = tuple[dict[str, float], dict[str, float] | None]
"""Values and error estimates, by `NAMES`."""


def _theories(cell: Cell, k: sp.Rational) -> Iterator[Callable[[], Prediction] | None]:
    """In the order of `THEORIES`; None for closed formulas of another chain."""
    for closure in ("linear", "full"):
        yield partial(_closed, cell, k, closure)
    yield lambda: _compact(canonical_wave(cell, k))
    for degree in DEGREES:
        yield partial(_approximant, k, degree) if cell.size == 1 else None
    for order in ORDERS:
        yield partial(_summed, cell, k, order)


def _closed(cell: Cell, k: sp.Rational, closure: str) -> Prediction:
    return _compact(homogenize(cell, closure=closure, k=k).pde.traveling_wave())


def _compact(wave: TravelingWave) -> Prediction:
    values = (wave.fwhm("force"), wave.fwhm("strain"), wave.speed() * wave.speed_scale)
    ones = {s: 1 for value in values for s in value.free_symbols}  # D = 1, B = 1
    return {name: float(value.subs(ones)) for name, value in zip(NAMES, values, strict=True)}, None


def _approximant(k: sp.Rational, degree: int) -> Prediction:
    """[degree/degree] of the chain of equal beads, a closed formula in k."""
    expansion = expand(Cell((1,)), 2 * degree)
    series = (expansion.fwhm("force"), expansion.fwhm("strain"), expansion.c)
    return {
        name: float(row.pade(k, degree, degree)) for name, row in zip(NAMES, series, strict=True)
    }, None


def _summed(cell: Cell, k: sp.Rational, order: int) -> Prediction:
    expansion = expand(cell, order, k=k)
    series = (expansion.fwhm("force"), expansion.fwhm("strain"), expansion.c)
    sums = {name: row.at() for name, row in zip(NAMES, series, strict=True)}
    values = {name: found.value for name, found in sums.items()}
    return values, {name: abs(found.error / found.value) for name, found in sums.items()}


def _rung(
    theory: str, compute: Callable[[], Prediction] | None, truth: Mapping[str, Measured]
) -> Rung:
    if compute is None:
        return Rung(theory, None, None, 0.0, "a formula for equal beads")
    start = time.process_time()
    try:
        values, estimates = compute()
    except NoSolitaryWave as none:
        return Rung(theory, None, None, time.process_time() - start, str(none))
    seconds = time.process_time() - start
    errors = {name: values[name] / truth[name].value - 1 for name in NAMES}
    return Rung(theory, errors, estimates, seconds)
