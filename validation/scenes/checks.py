"""Checked input of scenes: numbers, sequences, contact laws; messages name the faulty value."""

from __future__ import annotations

import math
from collections.abc import Iterable
from functools import cache
from typing import Any

import sympy as sp

from lwa.base import Refusal, files
from lwa.base.exact import InputError, one_of as one_of, shorten
from lwa.base.files import Reader
from lwa.cell import exponent
from lwa.law import ContactLaw

SceneError = InputError
"""Invalid input of a scene, under the name that `validation` exports."""

finite = files.finite
integer = files.integer
items = files.items
positive = files.positive


MISSING = math.nan
"""The exponent of a scene that gives a law."""

# Functions whose form changes at a compression. A contact that pulls also has compressions δ < 0,
# but SymPy derives the energy for δ > 0. At δ < 0 force and energy of a Piecewise both go on with
# its first case; force and energy of these functions would not agree.
_OTHER_CASES = sp.Max, sp.Min, sp.Abs, sp.sign, sp.Heaviside, sp.floor, sp.ceiling


class Failure(Refusal):
    """A computation with valid input that could not go on; the message says where and why."""


def between(value: Any, name: str, low: float, high: float, wanted: str = "") -> float:
    """Return a finite number from ``low`` to ``high``; `SceneError` for another value.

    The message names the value by ``name`` and ends with ``wanted``, by default with the limits.
    """
    number = finite(value, name)
    # NaN is refused by `finite`.
    if not low <= number <= high:
        wanted = wanted or f"it lies between {low:g} and {high:g}"
        digits = repr(number).removesuffix(".0")  # all of them: 1.0000001 is not 1
        raise SceneError(f"{name} is {digits}: {wanted}")
    return number


def each(reader: Reader) -> Reader:
    """Return a reader of sequences that reads every item by ``reader``, as ``name[0]`` …"""
    return lambda values, name: tuple(
        reader(value, f"{name}[{i}]") for i, value in enumerate(items(values, name))
    )


def one_or_each(reader: Reader) -> Reader:
    """Return a reader of one value for all contacts, or of a sequence with one for each contact.

    A sequence of equal values is read as one value: contacts that are alike are the same chain
    however they were written.
    """

    def read(value: Any, name: str) -> Any:
        if isinstance(value, str) or not isinstance(value, Iterable):
            return reader(value, name)
        return alike(each(reader)(value, name))

    return read


def alike(values: tuple[Any, ...]) -> Any:
    """Return the value of a tuple of equal values, any other tuple as it is."""
    return values[0] if len(set(values)) == 1 else values


def check_count(value: Any, name: str, contacts: int) -> None:
    """Raise `SceneError` for a tuple of another length; one value for all contacts passes."""
    if isinstance(value, tuple) and len(value) != contacts:
        raise SceneError(
            f"{name} has {len(value)} entries: one for all contacts is wanted, or one for each "
            f"of the {contacts} (the wall's is the last)"
        )


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
    # Without a last case, of the condition True, F would be undefined beyond the other cases.
    open_ends = (
        cases for cases in law.F.atoms(sp.Piecewise) if cases.args[-1][1] != sp.true
    )
    if law.F.has(*_OTHER_CASES) or any(open_ends):
        cases = "a force by cases is a Piecewise whose last condition is True"
        raise SceneError(f"law is {shorten(law.text)}: {cases}")
    return law


def contact_law(k: float, law: ContactLaw | None) -> tuple[float, ContactLaw | None]:
    """Check exponent and law of a contact, and return both; the law is None for a power.

    The user gives one of them. A scene that is copied gives both, if its law is no power: such a
    law is kept beside the exponent 1.
    """
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
        raise SceneError(f"{name} is {value}: a number is wanted in place of symbols")
    return float(value)
