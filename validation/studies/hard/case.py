"""A hard case: a question, what is measured, curves, and the answer that is expected."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace
from functools import wraps
from inspect import getdoc
from typing import Any

from validation.report.panel import Curve, Panel
from validation.report.result import Report
from validation.report.table import Finding, Statement, Table

Parts = Iterator[Finding | Statement | Curve | Table]


def case(answer: str, panel: Panel) -> Callable[[Callable[[], Parts]], Callable[[], Report]]:
    """Make a `Report` of what a function yields: its curves go into the panel, and the first
    paragraph of its docstring is the question."""

    def made(parts: Callable[[], Parts]) -> Callable[[], Report]:
        question = " ".join((getdoc(parts) or "").partition("\n\n")[0].split())

        @wraps(parts)
        def report() -> Report:
            found = tuple(parts())

            def of(kind: Any) -> tuple[Any, ...]:
                return tuple(part for part in found if isinstance(part, kind))

            findings, picture = of(Finding | Statement), replace(panel, curves=of(Curve))
            failed = sum(not finding.ok for finding in findings)
            told = f"{failed} not as expected, which was: {answer}" if failed else answer
            return Report(question, of(Table), findings, (picture,), (told,))

        return report

    return made
