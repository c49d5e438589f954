"""The ladder of theories: linear, full, canonical, the series in ε, each against the true wave.

The true wave (the truth) is `validation.waves.solver.exact_wave` at mass ratios with a solitary
wave, and elsewhere the steady pulse of a struck chain (`validation.pulses.steady`), with an error.
The theories are compared in the widths of force and strain at a contact and the speed, at peak
contact force 1, m1 = A = D = 1. The cost is the CPU time of deriving and evaluating the theory.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from itertools import chain, product
from statistics import median
from typing import Any

import sympy as sp

from lwa import Cell, InputError, NoSolitaryWave, expand
from lwa.expansion.series import EpsilonSeries
from validation.pictures import Curve, Panel
from validation.pulses.pulse import MeasureError
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
QUANTITIES = tuple(_HEADS)

Prediction = tuple[Sequence[float], Sequence[float] | None]
"""Values of `QUANTITIES`, and the theory's own estimates of their relative errors."""


def _closed(closure: str, k: sp.Rational, omega: sp.Rational) -> Prediction:
    """Return `QUANTITIES` by the closed form of a closure."""
    wave = theory_at(k, omega, closure).at_force(1)
    return [float(x) for x in (wave.fwhm("force"), wave.fwhm("strain"), wave.speed)], None


def _series(order: int, omega: sp.Rational, **k: sp.Rational) -> list[EpsilonSeries]:
    """Return force and strain FWHM and speed (`QUANTITIES`) as series in ε = k - 1."""
    expansion = expand(Cell((1,) if omega == 1 else (1, omega)), order, **k)
    return [expansion.fwhm("force"), expansion.fwhm("strain"), expansion.c]


def _approximant(n: int, k: sp.Rational, omega: sp.Rational) -> Prediction:
    """Return the Padé approximants [n/n] of the series for equal beads, closed formulas in k."""
    if omega != 1:
        raise NoSolitaryWave("a formula for equal beads")
    # [n/n] has 2n + 1 coefficients, as many as a series to order 2n
    return [float(row.pade(k, n, n)) for row in _series(2 * n, omega)], None


def _summed(n: int, k: sp.Rational, omega: sp.Rational) -> Prediction:
    """Return the sums of the series in ε to order n, and their estimated errors."""
    sums = [row.at() for row in _series(n, omega, k=k)]
    return [x.value for x in sums], [abs(x.error / x.value) for x in sums]


THEORIES: Mapping[str, Callable[[sp.Rational, sp.Rational], Prediction]] = {
    **{f"{closure} closure": partial(_closed, closure) for closure in ("linear", "full")},
    "canonical field": partial(_closed, "canonical"),
    **{f"[{n}/{n}]": partial(_approximant, n) for n in (1, 2)},
    **{f"ε^{n}": partial(_summed, n) for n in (1, 2, 4, 8)},
}
"""Closures, closed approximants of the series in ε for equal beads, and sums of the series."""

SOLITARY, STRUCK_CHAIN = "solitary wave", "struck chain"
HERTZ = sp.Rational(3, 2)


Place = Mapping[str, Any]
"""Predictions of all theories at one k and ω, beside the lattice's values, as in JSON.

``k``, ``omega``; ``truth``, `SOLITARY` or `STRUCK_CHAIN`, the origin of the lattice's `QUANTITIES`,
``truth_value`` and ``truth_error_value``; ``rows``, for each theory ``theory``, its name;
``error_value``, theory/truth - 1 by `QUANTITIES`, or None and the reason ``missing``;
``estimate_value`` of |error| by the theory itself, where it has one; ``seconds``, CPU time of
derivation and evaluation.
"""


_COLUMNS = (
    Column("quantity"),
    Column("k", "k"),
    Column("omega", "m2/m1", format=lambda omega: f"{float(omega):.4g}"),
    Column("truth_value", "truth", format=".6g"),
    Column("truth_error_value", "±", format=".0e"),
    Column("truth", "by", format=lambda kind: kind.split()[0]),
    *(Column(f"error_value.{theory}", theory, format="+.1e") for theory in THEORIES),
)
_NOTE = """\
ε^n: the series in k - 1 summed from n orders; [n/n]: its closed approximants for equal beads.
Truth: the solitary wave or, where there is none, the pulse of a struck chain."""


def ladder(places: Sequence[Place]) -> Report:
    """Return the table of the theories' errors, and a picture of |error| of the force's width.

    JSON: ``theories``, the places.
    """
    seconds: dict[str, list[float]] = {}
    for row in chain.from_iterable(place["rows"] for place in places):
        if row["error_value"]:
            seconds.setdefault(row["theory"], []).append(row["seconds"])
    costs = ", ".join(f"{name} {1e3 * median(s):.3g}" for name, s in seconds.items())
    rows = []
    for name, p in product(QUANTITIES, places):
        truth = p["truth_value"][name], p["truth_error_value"][name], p["truth"]
        off = [row["error_value"] and row["error_value"][name] for row in p["rows"]]
        rows.append((name, p["k"], p["omega"], *truth, *off))
    note = f"{_NOTE}\nMedian cost of derivation and evaluation (ms of CPU): {costs}."
    title = "Theories against true waves"
    equal = [(p["k"] - 1, p) for p in places if p["omega"] == 1]
    dimers = [(p["omega"], p) for p in places if p["omega"] != 1 and p["k"] == HERTZ]
    return Report(
        "",
        (Table(_COLUMNS, tuple(rows), "", title, note, by="quantity", heads=_HEADS),),
        panels=(
            _panel("k - 1", "theories, equal beads", equal),
            _panel("m2/m1", "theories, dimers, k = 3/2", dimers),
        ),
        data={"theories": places},
    )


def _panel(axis: str, title: str, places: Sequence[tuple[sp.Rational, Place]]) -> Panel:
    """Return the panel of |error| of the force's width, as a function of k - 1 or ω."""
    curves = []
    for i, (theory, mark) in enumerate(zip(THEORIES, "osD^v<>Pd", strict=True)):
        errors = ((x, p["rows"][i]["error_value"]) for x, p in places)
        if points := sorted((x, abs(error["force"])) for x, error in errors if error):
            x, y = zip(*points, strict=True)
            curves.append(Curve(theory, x, y, f"C{i}{mark}-"))
    return Panel(axis, "|error| of the FWHM of the force", tuple(curves), "xy", title)


def place(k: sp.Rational, omega: sp.Rational, kind: str = SOLITARY) -> Place:
    """Compare all theories with the lattice's solitary wave or struck pulse at one k and ω.

    Raises `MeasureError` where the struck chain's pulse is not steady.
    """
    if kind == SOLITARY:
        wave = measured(exact_wave((1.0,) if omega == 1 else (1.0, float(omega)), float(k)))
        truth = [wave[name] for name in ("fwhm force", "fwhm strain", "c")]
    else:
        pulse = point(k, omega, STRETCH)
        if pulse.missing:
            raise MeasureError(pulse.missing)
        truth = [pulse.numbers[name] for name in ("width", "strain_width", "speed")]
    rows = []
    for theory, predict in THEORIES.items():
        row = dict.fromkeys(("error_value", "estimate_value", "missing"))
        start = time.process_time()
        try:
            numbers, shares = predict(k, omega)
            off = (x / true.value - 1 for x, true in zip(numbers, truth, strict=True))
            row["error_value"] = dict(zip(QUANTITIES, off, strict=True))
            row["estimate_value"] = shares and dict(zip(QUANTITIES, shares, strict=True))
        except (InputError, NoSolitaryWave) as reason:
            row["missing"] = str(reason)
        rows.append({"theory": theory, **row, "seconds": time.process_time() - start})
    return {
        "k": k,
        "omega": omega,
        "truth": kind,
        "truth_value": {q: x.value for q, x in zip(QUANTITIES, truth, strict=True)},
        "truth_error_value": {q: x.error for q, x in zip(QUANTITIES, truth, strict=True)},
        "rows": rows,
    }
