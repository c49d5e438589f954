"""Contact laws of a scene: an exponent, or a law of `lwa.law` that can be evaluated."""

from __future__ import annotations

import math
from functools import cache
from typing import Any

import sympy as sp

from lwa.base.exact import shorten
from lwa.cell import exponent
from lwa.law import ContactLaw
from validation.scenes.checks import SceneError, finite

MISSING = math.nan
"""The exponent of a scene that gives a law."""

# SymPy integrates F for δ > 0. Where a contact that pulls has δ < 0, a Piecewise goes on with its
# first case, as the energy does, and these functions do not.
_OTHER_CASES = sp.Max, sp.Min, sp.Abs, sp.sign, sp.Heaviside, sp.floor, sp.ceiling


def read_exponent(value: Any, name: str) -> float:
    """Read the exponent of a power law."""
    if isinstance(value, str | sp.Expr):
        return numeric(exponent(value), name)
    return finite(value, name)


def read_contact_law(value: Any, name: str) -> ContactLaw | None:
    """Read a contact law whose force can be evaluated; None stands for a power."""
    if value is None:
        return None
    if not isinstance(value, ContactLaw):
        raise SceneError(f"{name} is {shorten(value)}: a law of lwa.law is wanted")
    return _evaluable(value)


@cache  # a long chain has few laws
def _evaluable(law: ContactLaw) -> ContactLaw:
    """Return a law, or raise `SceneError` for a law with symbols or with cases left open."""
    if law.symbols or law.formless:
        raise SceneError(
            f"law is {law.text}: the lattice needs numbers in place of symbols"
        )
    open_ends = (
        cases for cases in law.F.atoms(sp.Piecewise) if cases.args[-1][1] != sp.true
    )
    if law.F.has(*_OTHER_CASES) or any(open_ends):
        cases = "a force by cases is a Piecewise whose last condition is True"
        raise SceneError(f"law is {shorten(law.text)}: {cases}")
    return law


def contact_law(k: float, law: ContactLaw | None) -> tuple[float, ContactLaw | None]:
    """Return exponent and law of a contact, None for a power, whose exponent may be given twice."""
    if law is None:
        if k is MISSING:
            raise SceneError("k is missing: an exponent or a law is wanted")
    elif k is not MISSING and k != 1:
        raise SceneError(f"k is {k:g} and law {law.text}: one of them is wanted")
    else:
        k = float(law.exponent)
        if law.homogeneous:
            law = None
    if k < 1:
        raise SceneError(f"k is {k}: the contact law A δ^k is simulated for k ≥ 1")
    return k, law


def numeric(value: sp.Expr, name: str) -> float:
    """Return an exact number as a float; `SceneError` for an expression with symbols."""
    if not value.is_number:
        raise SceneError(
            f"{name} is {value}: the lattice needs numbers in place of symbols"
        )
    return float(value)
