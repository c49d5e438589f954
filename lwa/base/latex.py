"""LaTeX in the notation and order of the paper: rows, displays, sums and derivatives.

Rows wider than a page are broken at the signs between their terms.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping

import sympy as sp

from lwa.base.exact import evaluated

NUMBER = 24  # symbols of an exact number, a third of a line; digits stand in place of longer ones
DIGITS = 6  # digits of an irrational number behind its formula, as in tables of text
WIDTH = 64
"""Symbols in a line of a display; a page holds about 70 in a row."""


def display(rows: list[str]) -> str:
    """LaTeX of the rows as one display for a notebook."""
    return f"$$\\begin{{aligned}}\n{_aligned(rows)}\n\\end{{aligned}}$$"


def align(rows: list[str]) -> str:
    """LaTeX of the rows as an ``align`` environment for a paper, one equation number a row."""
    body = _aligned(rows, r" \notag")
    return f"\\begin{{align}}\n{body}\n\\end{{align}}"


def _aligned(rows: list[str], unnumbered: str = "") -> str:
    """Lines of rows that align at their first "="; ``unnumbered`` ends lines that go on."""
    lines = (f"{unnumbered} \\\\\n&\\quad ".join(_broken(row)) for row in rows)
    return " \\\\\n".join(line.replace("=", "&=", 1) for line in lines)


def _broken(row: str) -> list[str]:
    """The lines of a row: terms are put on a line as long as they fit.

    A line is broken before a sign between terms. A bracket that grows must close on its own line,
    so that a bracket wider than a page stays in one piece.
    """
    # A page is narrower than the equation of an unlike cell at order 5.
    lines = [""]
    term = ""
    for part in re.split(r"(?<=\S) (?=[+-] )", row):
        term = f"{term} {part}".lstrip()
        opened = re.findall(r"\\left|{", term)
        closed = re.findall(r"\\right|}", term)
        if len(opened) > len(closed):
            continue
        if lines[-1] and width(lines[-1] + term) > WIDTH:
            lines.append("")
        lines[-1] = f"{lines[-1]} {term}".lstrip()
        term = ""
    return lines


def width(text: str) -> int:
    r"""The number of letters, digits, signs and commands in a line.

    >>> width(r"\frac{a^{2} + b}{c} x_{1}")
    8
    """
    return len(re.findall(r"\\[A-Za-z]+|[^\\\s{}^_]", text))


def row(name: str, value: sp.Expr) -> str:
    """The row ``name = value``, with six digits of an irrational number behind its formula.

    >>> row("x", sp.sqrt(2)), row("y", sp.Rational(1, 2))
    ('x = \\\\sqrt{2} \\\\approx 1.41421', 'y = \\\\frac{1}{2}')
    """
    value = _short(value)
    text = _formula(value)
    # Digits stand behind a formula, not behind the digits of a long one.
    if value.is_number and not value.is_Rational and not value.has(sp.Float):
        text += rf" \approx {sp.latex(evaluated(value, DIGITS))}"
    return f"{name} = {text}"


def expression(value: sp.Expr) -> str:
    """LaTeX of a value; a long number without symbols as its digits.

    >>> x, y = sp.symbols("x y")
    >>> expression((x + y) / 2)
    '\\\\frac{x}{2} + \\\\frac{y}{2}'
    """
    return _formula(_short(value))


def _short(value: sp.Expr) -> sp.Expr:
    """The value, or the digits of a number whose formula is long."""
    if not value.free_symbols and width(_formula(value)) > NUMBER:
        return evaluated(value, 15)  # the digits of a float
    return value


def _formula(value: sp.Expr) -> str:
    """LaTeX of a value in closed form."""
    # A power such as a^{1/k} is printed first, as SymPy asks at length whether 1/k is constant.
    powers = {}
    for p in value.atoms(sp.Pow):
        if p.exp.free_symbols and (p.base.is_Symbol or p.base.is_number):
            powers[p] = sp.Symbol(sp.latex(p))
    return str(sp.latex(value.xreplace(powers)))


SPEED = r"\frac{dx}{dt}"


def fwhm(quantity: str) -> str:
    """The name of a full width at half maximum."""
    return rf"\mathrm{{FWHM}}_{{\mathrm{{{quantity}}}}}"


def rows(values: Mapping[str, sp.Expr]) -> list[str]:
    """Return the rows ``name = value``, names in LaTeX, leaving out rows such as ``F = F``."""
    written = {name: row(name, value) for name, value in values.items()}
    return [text for name, text in written.items() if text != f"{name} = {name}"]


def power(base: sp.Expr, n: int) -> str:
    """The factor ``base^n`` in LaTeX; empty where it is 1."""
    value = base**n
    return "" if value == 1 else str(sp.latex(value))


def derivative(n: int, mark: str = "") -> str:
    """The derivative ``∂_x^n u``, such as ``u_{xx}`` and ``u_{4x}``, with a further subscript."""
    order = "x" * n
    if n > _MOST_LETTERS:
        order = f"{n}x"
    return f"u_{{{order}{mark}}}"


_MOST_LETTERS = 3  # u_{xxx} is read at a glance, u_{xxxx} is not


def total(terms: Iterable[tuple[sp.Expr, str]]) -> str:
    """The sum ``Σ coefficient · factor`` in LaTeX, with the signs between the terms.

    >>> total([(-sp.Symbol("G"), "u"), (sp.Integer(1), "v")])
    '- G u + v'
    """
    parts: list[str] = []
    for coefficient, factor in terms:
        # A sum of symbols has a minus sign in front if most of its terms do (SymPy's rule); digits
        # that stand for a long number have the sign of that number.
        coefficient = _short(coefficient)
        sign = "+" if parts else ""
        if coefficient.could_extract_minus_sign():
            sign = "-"
            coefficient = -coefficient
        value = _formula(coefficient)
        if coefficient.is_Add:
            value = rf"\left({value}\right)"
        if value == "1" and factor:
            value = ""
        parts += [sign, value, factor]
    # Factors of 1 leave blanks beside each other.
    return " ".join(" ".join(parts).split()) or "0"
