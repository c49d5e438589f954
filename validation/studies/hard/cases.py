"""Hard cases: where theory, closed forms or integration are pushed to their limits, measured.

Numbers are held to bounds that follow from a law, a closed form or another method.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass, replace

from lwa.base.progress import Progress
from validation.report.command import option, study
from validation.report.result import Report
from validation.report.table import Column, Finding, Table
from validation.scenes.checks import one_of
from validation.studies.hard import exponents, floats, loads, motion, ratios

CASES: Mapping[str, Callable[[], Report]] = {
    "near-linear": exponents.near_linear,
    "vanishing-terms": exponents.vanishing_terms,
    "hard-spheres": exponents.hard_spheres,
    "mass-ratios": ratios.mass_ratios,
    "resonance": ratios.resonance,
    "contact-loss": motion.contact_loss,
    "long-run": motion.long_run,
    "light-bead": motion.light_bead,
    "ulps": floats.closed_forms,
    "no-compact-wave": ratios.no_compact_wave,
    "under-load": loads.under_load,
}
"""The cases by their names."""

_COLUMNS = tuple(map(Column, ("case", "quantity", "measured_value", "error_value", "least_value",
                              "most_value", "ok")))  # fmt: skip


@dataclass(frozen=True)
class Hard:
    """The outcomes of the cases that were run, by name."""

    outcomes: Mapping[str, Report]

    @property
    def ok(self) -> bool:
        """Whether every outcome is as it must be."""
        return all(outcome.ok for outcome in self.outcomes.values())

    def report(self) -> Report:
        """``cases``, each with ``case`` (its name), ``question``, ``outcome``, its chief numbers by
        their keys (such as ``energy_drift_value``), ``findings``, ``statements``, ``ok`` and
        ``panel``. CSV holds the findings of all."""
        failed = sum(not outcome.ok for outcome in self.outcomes.values())
        rows, cases, parts = [], [], []
        for name, outcome in self.outcomes.items():
            rows += [(name, *finding.document().values())
                     for finding in outcome.findings if isinstance(finding, Finding)]  # fmt: skip
            (panel,), (answer,) = outcome.panels, outcome.notes
            told = {"case": name, "question": outcome.title, "outcome": answer}
            cases.append(told | outcome.document() | {"panel": panel.document()})
            title = f"{name}\n{outcome.title}"
            parts.append(replace(outcome, title=title, panels=(replace(panel, title=name),)))
        count = f"{len(cases)} case{'s' * (len(cases) > 1)}"
        title = f"{count}: {f'{failed} fail' if failed else 'all hold'}"
        return Report(title, (Table(_COLUMNS, tuple(rows)),), data={"cases": cases},
                      parts=tuple(parts))  # fmt: skip


@study(
    option("--case", "names", multiple=True, metavar="NAME",
           says=f"Only this case, may be given again: {', '.join(CASES)}."),
)  # fmt: skip
def hard(names: Collection[str] = (), progress: Progress[str] = iter) -> Hard:
    """Extreme k, ω and loads, lost contacts, long runs, float64 against 50 digits. Half a minute.

    Runs the cases of these names, all by default; raises `SceneError` for a name that is not one of
    `CASES`.
    """
    wanted = {one_of(name, CASES, "case") for name in names} or set(CASES)
    chosen = [name for name in CASES if name in wanted]
    return Hard({name: CASES[name]() for name in progress(chosen)})
