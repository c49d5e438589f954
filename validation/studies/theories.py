"""The ladder of theories: linear, full, canonical, the series in ε, each against the true wave.

The true wave (the truth) is `validation.waves.solver.exact_wave` at mass ratios with a solitary
wave, and elsewhere the steady pulse of a struck chain (`validation.pulses.steady`), with an error.
The theories are compared in the widths of force and strain at a contact and the speed, at peak
contact force 1, m1 = A = D = 1. The cost is the CPU time of deriving and evaluating the theory.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, dataclass
from functools import partial
from statistics import median
from typing import Any

import sympy as sp

from lwa import Cell, InputError, NoSolitaryWave, expand
from lwa.expansion.series import EpsilonSeries
from validation.pictures import Curve, Panel
from validation.pulses.pulse import Measured, MeasureError
from validation.pulses.steady import STRETCH, point
from validation.report.result import Report
from validation.report.table import Column, Table
from validation.waves.solver import exact_wave, measured
from validation.waves.theory import theory_at

_HEADS = {
    "force": "FWHM of a contact's force: theory over truth - 1",
    "strain": "FWHM of a contact's strain: theory over truth - 1",
    "speed": "speed at peak contact force 1: theory over truth - 1",
}
NAMES = tuple(_HEADS)

Prediction = tuple[Sequence[float], Sequence[float] | None]
"""Values and the sizes of their relative errors, in the order of `NAMES`."""


def _closed(closure: str, k: sp.Rational, omega: sp.Rational) -> Prediction:
    wave = theory_at(k, omega, closure).at_force(1)
    return tuple(map(float, (wave.fwhm("force"), wave.fwhm("strain"), wave.speed))), None


def _series(order: int, omega: sp.Rational, **k: sp.Rational) -> list[EpsilonSeries]:
    expansion = expand(Cell((1,) if omega == 1 else (1, omega)), order, **k)
    return [expansion.fwhm("force"), expansion.fwhm("strain"), expansion.c]


def _approximant(n: int, k: sp.Rational, omega: sp.Rational) -> Prediction:
    """Return the Padé approximants [n/n] of the series for equal beads, closed formulas in k."""
    if omega != 1:
        raise NoSolitaryWave("a formula for equal beads")
    return [float(row.pade(k, n, n)) for row in _series(2 * n, omega)], None


def _summed(n: int, k: sp.Rational, omega: sp.Rational) -> Prediction:
    """Return the sums of the series in ε to order n, and the series' own error estimates."""
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


@dataclass(frozen=True)
class Rung:
    """Errors and cost of one theory at one k and ω.

    error_value: theory/truth - 1, by `NAMES`; None without a wave, with the reason in ``missing``.
    estimate_value: the theory's own estimates of |error|; only sums of the series in ε have them.
    seconds: CPU time of derivation and evaluation.
    """

    theory: str
    error_value: Mapping[str, float] | None
    estimate_value: Mapping[str, float] | None
    seconds: float
    missing: str | None = None

    def error(self, name: str) -> float | None:
        """Return theory/truth - 1 of one of `NAMES`; None without a wave."""
        return self.error_value[name] if self.error_value else None


@dataclass(frozen=True)
class Place:
    """Predictions of all theories at one k and ω, beside the lattice's values.

    ``truth`` maps the quantities `NAMES` to values of the lattice; ``kind`` says whether they are
    those of its exact wave or of a struck chain.
    """

    k: sp.Rational
    omega: sp.Rational
    kind: str
    truth: Mapping[str, Measured]
    rungs: tuple[Rung, ...]

    def document(self) -> dict[str, Any]:
        """Return the fields for JSON."""
        return {
            "k": self.k,
            "omega": self.omega,
            "truth": self.kind,
            "truth_value": {name: number.value for name, number in self.truth.items()},
            "truth_error_value": {name: number.error for name, number in self.truth.items()},
            "rows": [asdict(rung) for rung in self.rungs],
        }


_COLUMNS = (
    Column("quantity"),
    Column("k", "k"),
    Column("omega", "m2/m1", format=lambda omega: f"{float(omega):.4g}"),
    Column("truth", "truth", format=".6g", error=True),
    Column("truth", "by", format=lambda kind: kind.split()[0]),
    *(Column(f"error_value.{theory}", theory, format="+.1e") for theory in THEORIES),
)
_NOTE = """\
ε^n: the series in k - 1 summed from n orders; [n/n]: its closed approximants for equal beads.
Truth: the solitary wave or, where there is none, the pulse of a struck chain."""


def ladder(places: Sequence[Place]) -> Report:
    """Return the table of the theories' errors, and a picture of |error| of the force's width.

    JSON: ``theories``, each with ``k``, ``omega``, ``truth``, and ``rows`` of `Rung`.
    """
    times = {
        theory: [p.rungs[i].seconds for p in places if p.rungs[i].error_value]
        for i, theory in enumerate(THEORIES)
    }
    costs = ", ".join(f"{name} {1e3 * median(its):.3g}" for name, its in times.items() if its)
    rows = tuple(
        (name, p.k, p.omega, p.truth[name], p.kind, *(r.error(name) for r in p.rungs))
        for name in NAMES
        for p in places
    )
    equal = [(p.k - 1, p) for p in places if p.omega == 1]
    dimers = [(p.omega, p) for p in places if p.omega != 1 and p.k == HERTZ]
    note = f"{_NOTE}\nMedian cost of derivation and evaluation (ms of CPU): {costs}."
    return Report(
        "Theories against true waves",
        (Table(_COLUMNS, rows, "", "Theories against true waves", note, "quantity", _HEADS),),
        panels=(
            _panel("k - 1", "theories, equal beads", equal),
            _panel("m2/m1", "theories, dimers, k = 3/2", dimers),
        ),
        data={"theories": [p.document() for p in places]},
    )


def _panel(axis: str, title: str, places: Sequence[tuple[sp.Rational, Place]]) -> Panel:
    curves = []
    for i, (name, mark) in enumerate(zip(THEORIES, "osD^v<>Pd", strict=True)):
        errors = ((float(at), place.rungs[i].error("force")) for at, place in places)
        if points := sorted((at, abs(error)) for at, error in errors if error is not None):
            x, y = zip(*points, strict=True)
            curves.append(Curve(name, x, y, f"C{i}{mark}-"))
    return Panel(axis, "|error| of the FWHM of the force", tuple(curves), "xy", title)


def place(k: sp.Rational, omega: sp.Rational, kind: str = SOLITARY) -> Place:
    """Return the comparison of all theories with the truth at one k and ω.

    Raises `MeasureError` where a struck chain's pulse is not steady.
    """
    if kind == SOLITARY:
        wave = measured(exact_wave((1.0,) if omega == 1 else (1.0, float(omega)), float(k)))
        values = [wave[name] for name in ("fwhm force", "fwhm strain", "c")]
    else:
        pulse = point(k, omega, STRETCH)
        if pulse.missing:
            raise MeasureError(pulse.missing)
        values = [pulse.numbers[name] for name in ("width", "strain_width", "speed")]
    truth = dict(zip(NAMES, values, strict=True))
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
