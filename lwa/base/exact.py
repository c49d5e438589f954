"""Exact numbers and symbols from user input.

Numbers are read exactly (a float as the decimal that it prints as: ``0.1`` is 1/10), and names
become positive symbols. Text is never evaluated: it is matched against the grammar of an integer, a
decimal, a fraction or a plain name, and anything else is refused.
"""

from __future__ import annotations

import keyword
import math
import operator
import re
from collections.abc import Callable, Collection, Mapping
from fractions import Fraction
from numbers import Rational, Real
from typing import Any

import sympy as sp

from lwa.base import InputError as InputError
from lwa.base.words import one_of as one_of, shorten as shorten

Quantity = int | float | str | Fraction | sp.Expr
"""Accepted types of an exponent, a mass, a stiffness or a length."""

_NUMBER = re.compile(
    r"[+-]?(?:[0-9]+/[0-9]+|(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]{1,3})?)"
)
_NAME = re.compile(r"[A-Za-zα-ωΑ-Ω][A-Za-zα-ωΑ-Ω0-9_]*")
_NOT_A_NUMBER = {"nan", "inf", "infinity", "none", "null", "true", "false"}
_LONGEST_TEXT = 200  # characters: no number and no name of a chain needs more

DIGITS = 330
"""Digits of a numerator or denominator; the smallest floats are fractions over ``10^324``."""

_FIRST_BEYOND = 2**1024  # the first integer beyond a double

MOST_CANCELLED = 20_000
"""Digits that the terms of an exact number may cancel before it is evaluated in vain: roots take a
tenth of a second then, and sixty numbers of `DIGITS` digits are multiplied exactly."""

_UNLIMITED = 2**63 - 1  # the largest integer that NumPy and files hold

_FACTORED_BITS = 200
"""Most bits of a number in a polynomial that is factored: SymPy takes half a second then, and a
minute for 1e300."""

_FINEST_ROOT = 12
"""Greatest q of powers ``x^{p/q}`` that are rearranged as polynomials in ``x^{1/q}``: the exponent
``(k - 1)/2k`` has a q of 6 at k of 3/2, of 10 at 5/2, and of 394 at 1.97."""

_POWER_BITS = 300
"""Most bits of a number, times the larger part of an exponent, of powers that are written out.

SymPy takes whole powers out of roots, and joins the roots of a product: ``(6/5)^(97/197)`` becomes
a root of ``6^97 · 5^100``. Its search for factors of a number fails with an `OverflowError` beyond
the 1024 bits of a double. The roots of three numbers of this length join to less.
"""


def read_exact(value: Any, name: str) -> sp.Expr:
    """Read a quantity as an exact SymPy expression.

    Parameters
    ----------
    value : Quantity
        A number, an expression, or a text: an integer, a decimal, a fraction or a plain name, which
        becomes a positive symbol. A float stands for the decimal that it prints as.
    name : str
        Name of the quantity in messages.

    Raises
    ------
    InputError
        For NaN, infinities, complex numbers, other text, and numbers beyond the range of a float
        or of more than `DIGITS` digits.

    Examples
    --------
    >>> read_exact(0.1, "k"), read_exact("3/2", "k"), read_exact("m1", "mass")
    (1/10, 3/2, m1)
    """
    if isinstance(value, str):
        expression = _from_text(value.strip(), name)
    elif isinstance(value, sp.Expr):
        # SymPy prints a float to its own digits, so that 0.1 is 1/10 here, too.
        floats = real(value, name).atoms(sp.Float)
        expression = value.xreplace({x: sp.Rational(str(x)) for x in floats})
    else:
        expression = _from_number(value, name)
    for number in expression.atoms(sp.Rational):
        # Longer numbers would fill the memory as coefficients of high orders.
        p = abs(int(number.p))
        q = int(number.q)
        if max(p, q) >= 10**DIGITS or p >= q * _FIRST_BEYOND:
            raise InputError(
                f"{name} is a number beyond 1e±308 or of more than {DIGITS} digits: give a shorter "
                "number"
            )
    return expression


def _from_number(value: Any, name: str) -> sp.Rational:
    """Read a number of Python or NumPy."""
    # True is an integer of Python; numbers of one element, and masked ones, are arrays.
    if isinstance(value, bool) or not isinstance(value, Real):
        raise InputError(f"{name} is {shorten(value)}: a number or a symbol is wanted")
    if isinstance(value, Rational):
        return sp.Rational(value)
    if not math.isfinite(value):
        raise InputError(f"{name} is {value}: a finite number is wanted")
    return sp.Rational(str(value))


def _from_text(text: str, name: str) -> sp.Expr:
    """Read a number, or a name as a positive symbol."""
    short = len(text) <= _LONGEST_TEXT
    if short and _NUMBER.fullmatch(text):
        # Fraction reads this grammar and decimals exactly; SymPy's reader would evaluate text.
        try:
            return sp.Rational(Fraction(text))
        except ZeroDivisionError:
            raise InputError(
                f"{name} is {text}: the denominator must not be zero"
            ) from None
    named = short and _NAME.fullmatch(text)
    if not named or text.lower() in _NOT_A_NUMBER:
        raise InputError(
            f"{name} is {shorten(text)}: an integer, a decimal, a fraction such as 3/2, or a plain "
            "name is wanted"
        )
    # Printed results are read again by SymPy, and source code has the names as variables.
    if keyword.iskeyword(text) or hasattr(sp, text):
        raise InputError(
            f"{name} is {text!r}, a word with a meaning of its own: choose another"
        )
    return sp.Symbol(text, positive=True)


def real(value: Any, name: str) -> sp.Expr:
    """Return an expression that may be real as it is, or read a number exactly; refuse a text."""
    if isinstance(value, str):
        raise InputError(
            f"{name} is {shorten(value)}: a number or an expression is wanted"
        )
    if not isinstance(value, sp.Expr):
        return read_exact(value, name)
    # is_real is None for an expression whose symbols may be anything.
    if value.is_real is False or value.has(sp.nan, sp.oo, -sp.oo, sp.zoo):
        raise InputError(f"{name} is {shorten(value)}: a finite real number is wanted")
    return value


def signed(value: Any, name: str) -> sp.Expr:
    """Read an exact real number; a plain name becomes a real symbol of either sign, such as ξ."""
    expression = read_exact(value, name)
    if isinstance(value, str) and expression.is_Symbol:
        return sp.Symbol(expression.name, real=True)
    return expression


def positive(value: Any, name: str) -> sp.Expr:
    """Read an exact positive number, or an expression in symbols that may be positive."""
    expression = read_exact(value, name)
    # The sign of an expression in symbols may be unknown, None; that of a number must be known.
    sign = expression.is_positive
    if sign is False or (expression.is_number and not sign):
        raise InputError(f"{name} is {shorten(expression)}: it must be positive")
    return expression


def not_negative(value: Any, name: str) -> sp.Expr:
    """Read an exact positive number, or an expression as `positive` does, or zero."""
    # A load of zero is no load, and as valid as a missing one.
    number = read_exact(value, name)
    if number.is_zero:
        return number
    return positive(number, name)


def integer(value: Any, name: str, low: int, high: int = _UNLIMITED) -> int:
    """Read an integer (Python's, NumPy's or SymPy's) from ``low`` to ``high``."""
    try:
        number = operator.index(value)
    except TypeError:
        number = low - 1  # refused below
    if isinstance(value, bool) or not low <= number <= high:
        wanted = f"from {low} to {high}"
        if high == _UNLIMITED:
            wanted = f"from {low} on"
        raise InputError(f"{name} is {shorten(value)}: an integer {wanted} is wanted")
    return number


def demand_numbers(free: Collection[sp.Symbol], why: str) -> None:
    """Raise `InputError` if any symbol is left; ``why`` ends the message."""
    if free:
        raise InputError(f"{min(map(str, free))!r} has no value: {why}")


def number(value: sp.Expr) -> float:
    """The float of an exact number; see `evaluated`.

    Raises `lwa.InputError` for an expression with symbols, and for other than real numbers.
    """
    demand_numbers(
        value.free_symbols, "a curve needs numbers for all symbols; give them by at(…)"
    )
    result = evaluated(value, 20)  # four digits more than a float has
    if not result.is_Float and not result.is_Rational:
        raise InputError(f"{shorten(value)} is no real number")
    return float(result)


def evaluated(value: sp.Expr, digits: int) -> sp.Expr:
    """Evaluate an exact number to the given digits; terms may cancel `MOST_CANCELLED` digits."""
    return sp.N(value, digits, maxn=MOST_CANCELLED)


def brief(value: sp.Expr) -> str:
    """Six digits of an exact number, or the short text of an expression, for a ``repr``.

    >>> brief(sp.pi / 7), brief(sp.Symbol("x") / 3)
    ('0.448799', 'x/3')
    """
    if value.free_symbols:
        return shorten(value)
    return f"{number(value):.6g}"


# SymPy's own powers fail: a decimal k of many digits, and masses of 1e-300 and 1e300, end in an
# OverflowError, and a law with a long exponent fills the memory.
class Unmultiplied(sp.UnevaluatedExpr):  # type: ignore[misc]  # untyped in SymPy
    """A number that SymPy does not multiply out in a power; it prints and evaluates as usual."""

    def _eval_is_positive(self) -> bool:
        return bool(self.args[0].is_positive)

    def _eval_evalf(self, precision: int) -> sp.Expr:
        return self.args[0]._eval_evalf(precision)


def power(base: sp.Expr, exponent: sp.Expr) -> sp.Expr:
    """The power ``base^exponent``, left as a power if its number or its exponent is long.

    >>> power(sp.Rational(9, 4), sp.Rational(3, 2)), power(sp.Rational(9, 4), sp.Rational(1, 9999))
    (27/8, (9/4)**(1/9999))
    """
    number, rest = base.as_independent(sp.Symbol, as_Add=False)
    if number not in (0, 1) and exponent.is_Rational:
        factor = number.as_coeff_Mul()[0]
        if not factor.is_Rational:  # a float has no root that is written out
            return base**exponent
        # SymPy multiplies out by the larger part of the exponent: x^{p/q} has x^p in a root.
        bits = int(factor.p).bit_length() + int(factor.q).bit_length()
        # SymPy joins the root of a surd and the exponent: (2^{1/2})^{p/q} becomes 2^{p/(2q)}. So
        # powers of surds are written out up to a p or q of about `_FINEST_ROOT` alone.
        if not number.is_Rational:
            bits += _POWER_BITS // _FINEST_ROOT
        if bits * max(abs(int(exponent.p)), int(exponent.q)) > _POWER_BITS:
            base = Unmultiplied(number) * rest
    return base**exponent


def replaced(value: sp.Expr, new: Mapping[sp.Symbol, sp.Expr]) -> sp.Expr:
    """Substitute for symbols, with powers by `power`: SymPy writes long numbers out.

    >>> x = sp.Symbol("x", positive=True)
    >>> replaced(x**2 + x**sp.Rational(1, 9999), {x: sp.Rational(9, 4)})
    (9/4)**(1/9999) + 81/16
    """
    if value.free_symbols.isdisjoint(new):
        return value
    if value.is_Symbol:
        return new[value]
    parts = [replaced(part, new) for part in value.args]
    return power(*parts) if value.is_Pow else value.func(*parts)


def factored(value: sp.Expr) -> sp.Expr:
    """The expression in lowest terms, factored if its numbers are short; see `rearranged`."""
    for number in value.atoms(sp.Rational):
        if max(int(abs(number.p)), int(number.q)).bit_length() > _FACTORED_BITS:
            return rearranged(sp.cancel, value)
    return rearranged(sp.factor, value)


def rearranged(method: Callable[[sp.Expr], Any], value: sp.Expr) -> sp.Expr:
    """Apply SymPy's `factor` or `cancel`; a power ``x^{p/q}`` of large q is taken for a symbol.

    SymPy takes ``x^{p/q}`` for the power p of ``x^{1/q}``. Polynomials of such a degree fill the
    memory where an exponent comes from a decimal such as 1.2345.

    >>> x = sp.Symbol("x", positive=True)
    >>> [rearranged(sp.factor, x ** sp.Rational(2, q) - 1) for q in (5, 13)]
    [(x**(1/5) - 1)*(x**(1/5) + 1), x**(2/13) - 1]
    """
    letters = {}
    for part in value.atoms(sp.Pow):
        if part.exp.is_Rational and part.exp.q > _FINEST_ROOT:
            letters[part] = sp.Dummy(positive=True)
    back = {letter: part for part, letter in letters.items()}
    return method(value.xreplace(letters)).xreplace(back)
