"""The ladder of theories: linear, full, canonical, the series in ε, each against the true wave.

At a mass ratio whose wave is solitary the true one is `validation.waves.solver.exact_wave`;
elsewhere the pulse that a struck chain comes to carry (`validation.pulses.steady`) stands for it,
with its own error. Compared are the widths of force and strain at a contact and the speed at peak
contact force 1, m1 = A = D = 1. The cost is the CPU time of deriving and evaluating the theory.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from statistics import median
from typing import Any

import sympy as sp

from lwa import Cell, InputError, NoSolitaryWave, expand
from lwa.expansion.series import EpsilonSeries
from validation.pulses.pulse import Measured
from validation.pulses.steady import STRETCH, point
from validation.report.panel import Curve, Panel
from validation.report.result import Report
from validation.report.table import Column, Table
from validation.waves.solver import exact_wave, measured
from validation.waves.theory import Compacton, theory_at

_HEADS = {
    "force": "FWHM of a contact's force: theory over truth - 1",
    "strain": "FWHM of a contact's strain: theory over truth - 1",
    "speed": "speed at peak contact force 1: theory over truth - 1",
}
NAMES = tuple(_HEADS)

Prediction = tuple[Sequence[float], Sequence[float] | None]
"""Values and the sizes of their relative errors, in the order of `NAMES`."""


def _closed(closure: str, k: sp.Rational, omega: sp.Rational) -> Prediction:
    wave = Compacton(theory_at(k, omega, closure), 1.0)
    return (wave.fwhm("force"), wave.fwhm("strain"), wave.speed), None


def _series(order: int, omega: sp.Rational, **k: sp.Rational) -> list[EpsilonSeries]:
    expansion = expand(Cell((1,) if omega == 1 else (1, omega)), order, **k)
    return [expansion.fwhm("force"), expansion.fwhm("strain"), expansion.c]


def _approximant(n: int, k: sp.Rational, omega: sp.Rational) -> Prediction:
    """[n/n] of the series of equal beads, a closed formula in k."""
    if omega != 1:
        raise NoSolitaryWave("a formula for equal beads")
    return [float(row.pade(k, n, n)) for row in _series(2 * n, omega)], None


def _summed(n: int, k: sp.Rational, omega: sp.Rational) -> Prediction:
    """n orders of the series in ε."""
    sums = [row.at() for row in _series(n, omega, k=k)]
    return [found.value for found in sums], [abs(found.error / found.value) for found in sums]


_PREDICTIONS: Mapping[str, Callable[[sp.Rational, sp.Rational], Prediction]] = {
    **{f"{closure} closure": partial(_closed, closure) for closure in ("linear", "full")},
    "canonical field": partial(_closed, "canonical"),
    **{f"[{n}/{n}]": partial(_approximant, n) for n in (1, 2)},
    **{f"ε^{n}": partial(_summed, n) for n in (1, 2, 4, 8)},
}
THEORIES = tuple(_PREDICTIONS)
"""Closures, closed approximants of the series in ε for equal beads, and sums of the series."""

SOLITARY, STRUCK_CHAIN = "solitary wave", "struck chain"
HERTZ = sp.Rational(3, 2)

# k, ω, and what is the truth there; the ratios of solitary waves of the Hertz dimer are by
# `validation.waves.resonances`.
CASES = tuple(
    (sp.Rational(k), sp.Rational(omega), kind)
    for exponents, ratios, kind in (
        (("1.1", "5/4", "3/2", "2", "3"), ("1",), SOLITARY),
        (("3/2",), ("0.3428457811", "0.1547515139", "0.0901277691"), SOLITARY),
        (("3/2",), ("0.01", "0.05", "0.2", "0.55", "0.8", "0.9"), STRUCK_CHAIN),
        (("5/4", "2"), ("0.05", "0.2", "0.8"), STRUCK_CHAIN),
    )
    for k in exponents
    for omega in ratios
)


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
    """All theories at one k and ω, with the truth by `NAMES`.

    kind : of the truth: `SOLITARY`, or `STRUCK_CHAIN` where there is no such wave.
    """

    k: sp.Rational
    omega: sp.Rational
    kind: str
    truth: Mapping[str, Measured]
    rungs: tuple[Rung, ...]

    def document(self) -> dict[str, Any]:
        """For JSON."""
        return {
            "k": self.k, "omega": self.omega, "truth": self.kind,
            "truth_value": {name: found.value for name, found in self.truth.items()},
            "truth_error_value": {name: found.error for name, found in self.truth.items()},
            "rows": [
                {"theory": r.theory, "error_value": r.errors, "estimate_value": r.estimates,
                 "seconds": r.seconds, "missing": r.missing} for r in self.rungs
            ],
        }  # fmt: skip


@dataclass(frozen=True)
class Ladder:
    """Theories against truth over (k, ω)."""

    places: tuple[Place, ...]

    def cost(self, theory: str) -> float:
        """The median of its seconds, where it has a wave."""
        rungs = (place.rungs[THEORIES.index(theory)] for place in self.places)
        return median(rung.seconds for rung in rungs if rung.errors)

    def report(self) -> Report:
        """``theories``: ``k``, ``omega``, ``truth`` (its kind), ``truth_value``,
        ``truth_error_value``, and ``rows``, as of `Rung`; in the picture |error| of the force's
        width over k and over m2/m1."""
        found = {rung.theory for p in self.places for rung in p.rungs if rung.errors}
        told = (f"{name} {1e3 * self.cost(name):.3g}" for name in THEORIES if name in found)
        note = (
            "ε^n: the series in k - 1 summed from n orders, in brackets its own estimate of the "
            "error;\n[n/n]: its closed approximants for equal beads. Truth: by the solitary wave "
            "or, where\nthere is none, the pulse of a struck chain.\n"
            f"Median cost of derivation and evaluation (ms of CPU): {', '.join(told)}."
        )
        rows = tuple((name, p.k, p.omega, p.truth[name], p.kind,
                      *(cell for rung in p.rungs for cell in _cells(rung, name)))
                     for name in NAMES for p in self.places)  # fmt: skip
        equal = [(p.k - 1, p) for p in self.places if p.omega == 1]
        dimers = [(p.omega, p) for p in self.places if p.omega != 1 and p.k == HERTZ]
        return Report(
            "Theories against true waves",
            (Table(_COLUMNS, rows, by="quantity", heads=_HEADS, note=note),),
            panels=(_panel("k - 1", "theories, equal beads", equal),
                    _panel("m2/m1", "theories, dimers, k = 3/2", dimers)),
            data={"theories": [p.document() for p in self.places]},
        )  # fmt: skip


_COLUMNS = (
    Column("quantity"),
    Column("k", "k"),
    Column("omega", "m2/m1", format=lambda omega: f"{float(omega):.4g}"),
    Column("truth", "truth", format=".6g", error=True),
    Column("truth", "by", format=lambda kind: kind.split()[0]),
    *(column for name in THEORIES for column in
      (Column(f"error_value.{name}"), Column(f"estimate_value.{name}"), Column("", name))),
)  # fmt: skip


def _cells(rung: Rung, name: str) -> tuple[float | None, float | None, str | None]:
    """Error, estimate, and both for people."""
    if rung.errors is None:
        return None, None, None
    error, estimate = rung.errors[name], rung.estimates[name] if rung.estimates else None
    told = "" if estimate is None else f" ({estimate:.0e})"
    return error, estimate, f"{error:+.1e}{told}"


def _panel(axis: str, title: str, places: Sequence[tuple[sp.Rational, Place]]) -> Panel:
    curves = []
    for i, (name, mark) in enumerate(zip(THEORIES, "osD^v<>Pd", strict=True)):
        points = sorted((float(at), abs(errors["force"])) for at, place in places
                        if (errors := place.rungs[i].errors))  # fmt: skip
        if points:
            x, y = zip(*points, strict=True)
            curves.append(Curve.of(name, x, y, f"C{i}{mark}-"))
    return Panel(axis, "|error| of the FWHM of the force", tuple(curves), "xy", title)


def place(k: sp.Rational, omega: sp.Rational, kind: str = SOLITARY) -> Place:
    """All theories at one k and ω."""
    numbers: Mapping[str, Measured]
    if kind == SOLITARY:
        numbers = measured(exact_wave((1.0,) if omega == 1 else (1.0, float(omega)), float(k)))
        names = "fwhm force", "fwhm strain", "c"
    else:
        numbers = point(k, omega, STRETCH).numbers
        names = "width", "strain_width", "speed"
    truth = {mine: numbers[its] for mine, its in zip(NAMES, names, strict=True)}
    return Place(k, omega, kind, truth, tuple(_rung(name, k, omega, truth) for name in THEORIES))


def _rung(theory: str, k: sp.Rational, omega: sp.Rational, truth: Mapping[str, Measured]) -> Rung:
    start = time.process_time()
    try:
        values, estimates = _PREDICTIONS[theory](k, omega)
    except (InputError, NoSolitaryWave) as none:
        return Rung(theory, None, None, time.process_time() - start, str(none))
    seconds = time.process_time() - start
    errors = {name: v / truth[name].value - 1 for name, v in zip(NAMES, values, strict=True)}
    sizes = None if estimates is None else dict(zip(NAMES, estimates, strict=True))
    return Rung(theory, errors, sizes, seconds)
