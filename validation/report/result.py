"""What a hard case turned out to be: numbers held to bounds, statements, and a picture's curves."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from validation.pulses.pulse import Measured

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Finding:
    """One measured number.

    low, high : what it must lie between, its error included; a number without either is only told.
    error : of the value; None where the number is itself an error, or exact.
    key : by which a program finds it in the case's document; none for the many of a loop.

    >>> Finding("order", 2.4, 2.0, 3.0, error=0.1).ok
    True
    >>> Finding("order", 2.4, 2.0, 2.45, error=0.1).ok
    False
    """

    quantity: str
    value: float
    low: float = -math.inf
    high: float = math.inf
    error: float | None = None
    key: str = ""

    @classmethod
    def of(
        cls, quantity: str, measured: Measured, low: float, high: float, key: str = ""
    ) -> Finding:
        """A number that was measured twice."""
        return cls(quantity, measured.value, low, high, measured.error, key)

    @property
    def ok(self) -> bool:
        """Whether it lies where it must; a NaN never does."""
        error = self.error or 0.0
        return bool(self.low <= self.value - error and self.value + error <= self.high)


@dataclass(frozen=True)
class Statement:
    """What holds or does not, such as that something is refused, in the words of the refusal."""

    quantity: str
    says: str
    ok: bool


@dataclass(frozen=True, eq=False)
class Curve:
    """A row of points; ``line`` False draws the points alone."""

    label: str
    x: Array
    y: Array
    line: bool = True

    @classmethod
    def of(cls, label: str, x: ArrayLike, y: ArrayLike, line: bool = True) -> Curve:
        """From any sequences of numbers."""
        return cls(label, np.asarray(x, float), np.asarray(y, float), line)


@dataclass(frozen=True)
class Panel:
    """The picture of a case; ``scale`` names the logarithmic axes: "", "x", "y" or "xy"."""

    x: str
    y: str
    curves: tuple[Curve, ...]
    scale: str = ""


@dataclass(frozen=True)
class Grid:
    """Many findings as one table for people: a header and its rows."""

    header: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]


@dataclass(frozen=True)
class Outcome:
    """What is asked of a case, what was found, and what follows.

    answer : what follows when the findings are as they must be.
    grid : in place of the list of findings, where they fill a table.
    """

    question: str
    findings: Sequence[Finding | Statement]
    answer: str
    panel: Panel
    grid: Grid | None = None

    @property
    def ok(self) -> bool:
        """Whether all findings are as they must be."""
        return all(finding.ok for finding in self.findings)
