"""Hard cases: where theory, closed forms or integration are pushed to their limits, measured.

A case is a function that returns its `Outcome`: numbers held to bounds that follow from a law, a
closed form or another method, and what follows from them. k: `hard_exponents`; ω: `hard_ratios`;
integration: `hard_motion`; float64: `ulps`.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Iterable, Mapping
from dataclasses import dataclass

import numpy as np

from lwa.exact import shorten
from validation.report.result import Curve, Finding, Grid, Outcome, Panel
from validation.scenes.checks import SceneError
from validation.studies.hard import exponents, motion, ratios
from validation.studies.hard.floats import (
    ALLOWED,
    CLOSURES,
    EXPONENTS,
    FORMS,
    PRINTED,
    Loss,
    losses,
)


def closed_forms() -> Outcome:
    """Every closed form in float64 against 50 digits, and the paper's printed form beside it."""
    found = {(loss.name, loss.source): loss for loss in losses()}
    ours = [loss for loss in found.values() if loss.source != PRINTED]
    theirs = found["β", PRINTED]
    findings = [
        Finding("largest loss of all in ulps", max(loss.worst for loss in ours), 0, ALLOWED,
                key="loss_ulps"),
        Finding("points at which one of them has no number", sum(loss.missing for loss in ours),
                0, 0, key="missing"),
        Finding("β as printed: largest loss in ulps", theirs.worst, ALLOWED,
                key="printed_loss_ulps"),
        Finding("β as printed: points without a number", theirs.missing, 1, key="printed_missing"),
    ]  # fmt: skip
    for loss in found.values():
        name = f"{loss.name}, {loss.source}"
        # The route through p is only told; the expression for k = 3/2 is as good as ours.
        told = loss.source == PRINTED and loss.name in FORMS
        most, none = (math.inf, math.inf) if told else (ALLOWED, 0.0)
        findings += [
            Finding(f"{name}: largest loss in ulps", loss.worst, high=most),
            Finding(f"{name}: median loss in ulps", loss.median),
            Finding(f"{name}: points of {loss.points} without a number", loss.missing, high=none),
        ]
    return Outcome(
        "k = 1 + 1e-6 … 20, ω = 1e-6 … 1e6: how many ulps does float64 lose against 50 digits?",
        findings,
        f"Less than {ALLOWED:g}, in every closed form and closure, and there is always a number. "
        "The paper's route through the root p loses all digits where G+H+I nearly vanishes and "
        "gives no number where p is complex; its expression of β at k = 3/2 is sound.",
        Panel(
            "k - 1", "largest loss of β, in ulps",
            (Curve.of("lwa", EXPONENTS - 1, _by_exponent(found["β", "paper's closure"])),
             Curve.of(PRINTED, EXPONENTS - 1, _by_exponent(theirs))),
            "xy",
        ),
        _grid(found),
    )  # fmt: skip


def _grid(found: Mapping[tuple[str, str], Loss]) -> Grid:
    """A row for each form: the largest loss in each closure, and the printed form's losses."""
    rows = []
    for name in dict.fromkeys(form for form, _ in found):
        row = [name]
        for closure in CLOSURES:
            loss = found.get((name, closure))
            row.append("-" if loss is None else f"{loss.worst:.2f}")
        theirs = found.get((name, PRINTED))
        row += (
            ["-"] * 4
            if theirs is None
            else [
                f"{theirs.worst:.2g}",
                "k = {:.7g}, ω = {:.3g}".format(*theirs.where),
                f"{theirs.median:.2g}",
                f"{theirs.missing} of {theirs.points}",
            ]
        )
        rows.append(tuple(row))
    header = ("largest loss, ulps", *CLOSURES, PRINTED, "at", "median", "no number")
    return Grid(header, tuple(rows))


def _by_exponent(loss: Loss) -> list[float]:
    return [float(np.max(row, where=np.isfinite(row), initial=0.0)) for row in loss.ulps]


CASES: Mapping[str, Callable[[], Outcome]] = {
    "near-linear": exponents.near_linear,
    "vanishing-terms": exponents.vanishing_terms,
    "hard-spheres": exponents.hard_spheres,
    "mass-ratios": ratios.mass_ratios,
    "resonance": ratios.resonance,
    "contact-loss": motion.contact_loss,
    "long-run": motion.long_run,
    "light-bead": motion.light_bead,
    "ulps": closed_forms,
    "no-compact-wave": ratios.no_compact_wave,
}
"""The cases by their names."""


@dataclass(frozen=True)
class Hard:
    """The outcomes of the cases that were run, by name."""

    outcomes: Mapping[str, Outcome]

    @property
    def ok(self) -> bool:
        """Whether every outcome is as it must be."""
        return all(outcome.ok for outcome in self.outcomes.values())


def hard(
    names: Collection[str] = (), progress: Callable[[list[str]], Iterable[str]] = iter
) -> Hard:
    """Run the cases of these names, all by default; ``progress`` shows how far (as `tqdm.tqdm`).

    Raises `SceneError` for a name that is not one of `CASES`.
    """
    for name in names:
        if name not in CASES:
            raise SceneError(f"case is {shorten(name)}: one of {', '.join(CASES)} is wanted")
    wanted = [name for name in CASES if name in names or not names]
    return Hard({name: CASES[name]() for name in progress(wanted)})
