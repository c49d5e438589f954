"""Exact numbers and symbols from user input, and exact arithmetic of large numbers.

Numbers are read exactly (a float as the decimal that it prints as: ``0.1`` is 1/10), and names
become positive symbols. Text is never evaluated: it is matched against the grammar of an integer, a
decimal, a fraction or a plain name, and anything else is refused.
"""

from __future__ import annotations

import keyword
import math
import operator
import re
from collections.abc import Collection
from decimal import Decimal
from fractions import Fraction
from typing import Any

import sympy as sp

from lwa.base.errors import InputError as InputError

Quantity = int | float | str | Fraction | Decimal | sp.Expr
"""Accepted types of an exponent, a mass, a stiffness or a length."""

_NUMBER = re.compile(r"[+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]{1,3})?")
_FRACTION = re.compile(r"[+-]?[0-9]+/[0-9]+")
_NAME = re.compile(r"[A-Za-zα-ωΑ-Ω][A-Za-zα-ωΑ-Ω0-9_]*")
_NOT_A_NUMBER = {"nan", "inf", "infinity", "none", "null", "true", "false"}
_LONGEST = 200
_DIGITS = 1000
_BITS = 3322  # bits of an integer of _DIGITS digits
_ROOTLESS = 1024  # bits of the largest integers within a double
_TOO_LONG = f"at most {_DIGITS} digits are wanted, before the point and behind it"


MOST_CANCELLED = 20_000
"""Digits that the terms of an exact number may cancel before it is evaluated in vain."""


def shorten(value: object) -> str:
    """The ``repr`` of an offending value, cut to one short line for a message."""
    try:
        text = repr(value)
    except ValueError:  # Python writes no integer of more than some thousand digits
        return "a number of thousands of digits"
    return text if len(text) <= 60 else text[:57] + "..."


def exact(value: Any, name: str) -> sp.Expr:
    """Read ``value`` (see `Quantity`) as an exact SymPy expression.

    ``name`` names the value in messages. Texts are integers, decimals, fractions or plain names;
    a name becomes a positive symbol.

    Raises `InputError` for NaN, infinities, complex numbers and other text.

    >>> exact(0.1, "k"), exact("3/2", "k"), exact("m1", "mass")
    (1/10, 3/2, m1)
    """
    if isinstance(value, str):
        return _from_text(value.strip(), name)
    if isinstance(value, bool):
        raise InputError(f"{name} is {value!r}: a number or a symbol is wanted")
    if isinstance(value, sp.Expr):
        return _from_expression(value, name)
    if isinstance(value, Fraction):
        return _writable(sp.Rational(value.numerator, value.denominator), name)
    if hasattr(value, "item"):  # NumPy's scalars, without importing NumPy
        try:
            value = value.item()
        except ValueError:
            raise InputError(f"{name} is {shorten(value)}: one number is wanted") from None
    if isinstance(value, int) and not isinstance(value, bool):
        return _writable(sp.Integer(value), name)
    if isinstance(value, float | Decimal):
        if not (value.is_finite() if isinstance(value, Decimal) else math.isfinite(value)):
            raise InputError(f"{name} is {value}: a finite number is wanted")
        if isinstance(value, Decimal) and abs(value.adjusted()) > _DIGITS:
            raise InputError(f"{name} is {shorten(value)}: {_TOO_LONG}")
        return _writable(sp.Rational(str(value)), name)
    raise InputError(f"{name} is {shorten(value)}: a number or a symbol is wanted")


def integer(value: Any, name: str, low: int) -> int:
    """Read an integer (Python's, NumPy's or SymPy's) of at least ``low``.

    >>> integer(4, "order", 1)
    4
    """
    try:
        number = None if isinstance(value, bool) else operator.index(value)
    except TypeError:
        number = None
    if number is None:
        raise InputError(f"{name} is {shorten(value)}: an integer from {low} on is wanted")
    if number < low:
        raise InputError(f"{name} is {shorten(number)}: it must be {low} or more")
    if number.bit_length() > 63:
        raise InputError(f"{name} is {shorten(number)}: an integer below 2^63 is wanted")
    return number


def positive(value: Any, name: str) -> sp.Expr:
    """Read an exact positive number, or an expression in symbols that may be positive."""
    expression = exact(value, name)
    if expression.is_positive is False or (expression.is_number and not expression.is_positive):
        raise InputError(f"{name} is {expression}: it must be positive")
    return expression


def one_of(value: Any, known: Collection[str], name: str) -> str:
    """Return a word; raise `InputError` unless it is among the known words."""
    if not isinstance(value, str) or value not in known:
        wanted = " or ".join(known) if len(known) == 2 else f"one of {', '.join(known)}"
        raise InputError(f"{name} is {shorten(value)}: {wanted} is wanted")
    return value


def signed(value: Any, name: str) -> sp.Expr:
    """Read an exact real number; a plain name becomes a real symbol of either sign, such as ξ.

    >>> signed("xi", "xi").is_positive is None
    True
    """
    expression = exact(value, name)
    if isinstance(value, str) and expression.is_Symbol:
        return sp.Symbol(expression.name, real=True)
    return expression


def _from_text(text: str, name: str) -> sp.Expr:
    wanted = "an integer, a decimal, a fraction such as 3/2, or a plain name is wanted"
    if len(text) > _LONGEST:
        raise InputError(f"{name} is a text of {len(text)} characters: {wanted}")
    if _FRACTION.fullmatch(text):
        numerator, denominator = text.split("/")
        if int(denominator) == 0:
            raise InputError(f"{name} is {text}: the denominator must not be zero")
        return sp.Rational(int(numerator), int(denominator))
    if _NUMBER.fullmatch(text):
        return sp.Rational(text)
    if not _NAME.fullmatch(text) or text.lower() in _NOT_A_NUMBER:
        raise InputError(f"{name} is {shorten(text)}: {wanted}")
    if keyword.iskeyword(text) or hasattr(sp, text):
        raise InputError(f"{name} is {text!r}, a word with a meaning of its own: choose another")
    return sp.Symbol(text, positive=True)


def _from_expression(value: sp.Expr, name: str) -> sp.Expr:
    if value.has(sp.nan, sp.oo, -sp.oo, sp.zoo) or value.is_real is False:
        raise InputError(f"{name} is {shorten(value)}: a finite real number is wanted")
    floats = {f: sp.Rational(str(f)) for f in value.atoms(sp.Float)}
    for number in value.atoms(sp.Rational):
        _writable(number, name)
    return value.xreplace(floats)


def _writable(number: sp.Rational, name: str) -> sp.Rational:
    """Return the number; raise `InputError` if its powers would be too long for Python to print."""
    if max(int(number.p).bit_length(), int(number.q).bit_length()) > _BITS:
        raise InputError(f"{name} is a number of too many digits: {_TOO_LONG}")
    return number


def demand_numbers(free: Collection[sp.Symbol], why: str) -> None:
    """Raise `InputError` if any symbol is left; ``why`` ends the message."""
    if free:
        raise InputError(f"{min(map(str, free))!r} has no value: {why}")


def number(value: sp.Expr) -> float:
    """The float of an exact number, right to the last digit however much its terms cancel.

    Raises `lwa.InputError` for an expression with symbols.
    """
    if value.free_symbols:
        names = ", ".join(sorted(map(str, value.free_symbols)))
        raise InputError(f"{names}: a curve needs numbers for all symbols; give them by at(…)")
    return float(evaluated(value, 20))


def evaluated(value: sp.Expr, digits: int) -> sp.Expr:
    """Evaluate an exact number to the given digits, even if thousands of digits cancel."""
    return sp.N(value, digits, maxn=MOST_CANCELLED)


class Kept(sp.UnevaluatedExpr):  # type: ignore[misc]  # untyped in SymPy
    """A number that SymPy does not multiply out in a power; it prints and evaluates as usual."""

    def _eval_is_positive(self) -> bool:
        return bool(self.args[0].is_positive)

    def _eval_evalf(self, precision: int) -> sp.Expr:
        return self.args[0]._eval_evalf(precision)


def power(base: sp.Expr, exponent: sp.Expr) -> sp.Expr:
    """The power base^exponent without numbers of more than a thousand digits.

    SymPy takes whole powers out of roots, and would make such a number of 3^(1 + 1/99999). It fails
    on roots of integers beyond a double (`math.log` of python-flint's integers).

    >>> power(sp.Rational(9, 4), sp.Rational(3, 2)), power(sp.Rational(9, 4), sp.Rational(1, 9999))
    (27/8, (9/4)**(1/9999))
    """
    factor, rest = base.as_coeff_Mul()
    if factor in (0, 1) or not factor.is_Rational or not exponent.is_Rational:
        return base**exponent
    p, q = int(exponent.p), int(exponent.q)
    parts = int(factor.p), int(factor.q)
    bits = [part.bit_length() for part in parts]
    if max(bits) > _ROOTLESS and factor > 0 and q > 1 and abs(p) < q:  # exact roots, if any
        roots = [sp.integer_nthroot(part, q) for part in parts]
        whole = all(found for _, found in roots)
        number = sp.Rational(roots[0][0], roots[1][0]) ** p if whole else Kept(factor) ** exponent
        return number * rest**exponent
    if sum(bits) * (abs(p) + q) > _BITS or (max(bits) > _ROOTLESS and q > 1):
        base = Kept(base)
    return base**exponent


def root(value: sp.Expr) -> sp.Expr:
    """The square root, by `power`."""
    return power(value, sp.S.Half)
