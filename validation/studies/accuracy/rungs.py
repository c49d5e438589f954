"""The ladder of theories as a table, as a document for JSON, and as a picture.

Importing this module teaches `validation.report.text` and `validation.report.figure` what a ladder
is.
"""

from __future__ import annotations

from statistics import median
from typing import TYPE_CHECKING, Any

import sympy as sp

from validation.report.figure import figure
from validation.report.text import document, table, text
from validation.studies.accuracy.theories import NAMES, SOLITARY, THEORIES, Ladder, Place, Rung

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

__all__ = ["Ladder"]

_TITLES = {
    "force": "FWHM of a contact's force",
    "strain": "FWHM of a contact's strain",
    "speed": "speed at peak contact force 1",
}


@text.register(Ladder)
def _(result: Ladder) -> str:
    blocks = []
    for name in NAMES:
        rows = [
            (str(p.k), _ratio(p), _truth(p, name), *(_cell(rung, name) for rung in p.rungs))
            for p in result.places
        ]
        header = ("k", "m2/m1", "truth", *THEORIES)
        blocks.append(f"{_TITLES[name]}: theory over truth - 1\n{table(header, rows)}")
    costs = [f"{name} {1e3 * cost(result, i):.3g}" for i, name in enumerate(THEORIES)]
    blocks.append(
        "ε^n: the series in k - 1 summed from n orders, in brackets its own estimate of the error;"
        "\n[n/n]: its closed approximants for equal beads. Truth: the solitary wave (s) or, where\n"
        "there is none, the pulse of a struck chain (p).\n"
        f"Median cost of derivation and evaluation (ms of CPU): {', '.join(costs)}."
    )
    return "\n\n".join(blocks)


def _ratio(place: Place) -> str:
    return f"{float(place.omega):.4g}"


def _truth(place: Place, name: str) -> str:
    found = place.truth[name]
    digits = f"{found.value:.6g}" if found.relative_error < 1e-6 else f"{found.value:.4g}"
    return f"{digits} {'s' if place.kind == SOLITARY else 'p'}"


def _cell(rung: Rung, name: str) -> str:
    if rung.errors is None:
        return "-"
    estimate = f" ({rung.estimates[name]:.0e})" if rung.estimates else ""
    return f"{rung.errors[name]:+.1e}{estimate}"


def cost(result: Ladder, i: int) -> float:
    return median(place.rungs[i].seconds for place in result.places if place.rungs[i].errors)


@document.register(Ladder)
def _(result: Ladder) -> dict[str, Any]:
    return {"theories": [_document(place) for place in result.places]}


def _document(place: Place) -> dict[str, Any]:
    return {
        "k": str(place.k),
        "omega": str(place.omega),
        "truth": place.kind,
        "truth_value": {name: found.value for name, found in place.truth.items()},
        "truth_error_value": {name: found.error for name, found in place.truth.items()},
        "rows": [
            {
                "theory": rung.theory,
                "error_value": rung.errors and dict(rung.errors),
                "estimate_value": rung.estimates and dict(rung.estimates),
                "seconds": rung.seconds,
                "missing": rung.missing,
            }
            for rung in place.rungs
        ],
    }


@figure.register(Ladder)
def _(result: Ladder) -> Figure:
    """|error| of the force's width against k, and against m2/m1 at k = 3/2."""
    from matplotlib.figure import Figure

    picture = Figure(figsize=(10, 4.5), layout="constrained")
    left, right = picture.subplots(1, 2, sharey=True)
    draw(left, right, result)
    return picture


def draw(left: Axes, right: Axes, result: Ladder) -> None:
    """Draw it on two axes: equal beads, dimers."""
    equal = [p for p in result.places if p.omega == 1]
    hertz = [p for p in result.places if p.omega != 1 and p.k == sp.Rational(3, 2)]
    dimers = sorted(hertz, key=lambda p: float(p.omega))
    for axes, places, label in ((left, equal, "k - 1"), (right, dimers, "m2/m1")):
        for i, name in enumerate(THEORIES):
            points = [
                (float(p.k - 1 if label == "k - 1" else p.omega), abs(errors["force"]))
                for p in places
                if (errors := p.rungs[i].errors) is not None
            ]
            if points:
                axes.loglog(*zip(*points, strict=True), marker="osD^v<>Pd"[i], label=name)
        axes.set(xlabel=label, ylabel="|error| of the FWHM of the force")
    left.set(title="theories, equal beads")
    right.set(title="theories, dimers, k = 3/2")
    left.legend(fontsize="small")
