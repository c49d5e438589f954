"""LaTeX in the notation and order of the paper: rows, displays, sums and derivatives.

Rows wider than a page are broken at the signs between their terms.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping

import sympy as sp

from lwa.base.exact import evaluated

NUMBER = 24  # symbols of an exact number beyond which its digits stand in its place
WIDTH = 64
"""Symbols in a line of a display, of a fraction in both parts; a page holds about 70 in a row."""


def display(rows: list[str]) -> str:
    """LaTeX of the rows as one display for a notebook."""
    return f"$$\\begin{{aligned}}\n{_aligned(rows)}\n\\end{{aligned}}$$"


def align(rows: list[str]) -> str:
    """LaTeX of the rows as an ``align`` environment for a paper, one equation number a row."""
    body = _aligned(rows, r" \notag")
    return f"\\begin{{align}}\n{body}\n\\end{{align}}"


def _aligned(rows: list[str], unnumbered: str = "") -> str:
    lines = (f"{unnumbered} \\\\\n&\\quad ".join(_broken(row)) for row in rows)
    return " \\\\\n".join(line.replace("=", "&=", 1) for line in lines)


def _broken(row: str) -> list[str]:
    """The lines of a row: terms are put on a line as long as they fit."""
    lines = [""]
    for term in _terms(row):
        if lines[-1] and width(lines[-1] + term) > WIDTH:
            lines.append("")
        lines[-1] += f" {term}" if lines[-1] else term
    return lines


def _terms(row: str) -> Iterator[str]:
    """The parts of a row from one sign to the next, outside of braces and of \\left … \\right."""
    depth, start = 0, 0
    for token in re.finditer(r"\\left|\\right|[{}]|(?<=\S) (?=[+-] )", row):
        if token[0] == " ":
            if depth == 0:
                yield row[start : token.start()]
                start = token.end()
        else:
            depth += 1 if token[0] in ("\\left", "{") else -1
    yield row[start:]


def width(text: str) -> int:
    r"""The number of letters, digits, signs and commands in a line.

    >>> width(r"\frac{a^{2} + b}{c} x_{1}")
    8
    """
    return len(re.findall(r"\\[A-Za-z]+|[^\\\s{}^_]", text))


def row(name: str, value: sp.Expr) -> str:
    """The row ``name = value``."""
    return f"{name} = {expression(value)}"


def expression(value: sp.Expr) -> str:
    """LaTeX of a value; a long number without symbols as its digits.

    >>> x, y = sp.symbols("x y")
    >>> expression((x + y) / 2)
    '\\\\frac{x}{2} + \\\\frac{y}{2}'
    """
    # A power such as a^{1/k} is printed first, as SymPy asks at length whether 1/k is constant.
    symbolic = (
        p for p in value.atoms(sp.Pow) if p.base.is_Symbol and p.exp.free_symbols
    )
    powers = {p: sp.Symbol(sp.latex(p)) for p in symbolic}
    plain = str(sp.latex(value.xreplace(powers)))
    if not value.free_symbols and width(plain) > NUMBER:
        return str(sp.latex(evaluated(value, 15)))
    return plain


SPEED = r"\frac{dx}{dt}"


def rows(values: Mapping[str, sp.Expr]) -> list[str]:
    """Return the rows ``name = value``, names in LaTeX, leaving out rows such as F = F."""
    written = {name: row(name, value) for name, value in values.items()}
    return [text for name, text in written.items() if text != f"{name} = {name}"]


def power(symbol: sp.Expr, n: int) -> str:
    """The power symbol^n in LaTeX."""
    return f"{sp.latex(symbol)}^{{{n}}}" if n > 1 else str(sp.latex(symbol))


def derivative(n: int, mark: str = "") -> str:
    """The derivative ∂_x^n u in LaTeX, such as u_{xx} and u_{4x}, with a further subscript."""
    return f"u_{{{'x' * n if n < 4 else f'{n}x'}{mark}}}"


def total(terms: Iterable[tuple[sp.Expr, str]]) -> str:
    """The sum Σ coefficient · factor in LaTeX, with the signs between the terms.

    >>> total([(-sp.Symbol("G"), "u"), (sp.Integer(1), "v")])
    '- G u + v'
    """
    written = []
    for i, (coefficient, factor) in enumerate(terms):
        minus = coefficient.could_extract_minus_sign()
        size = -coefficient if minus else coefficient
        value = rf"\left({expression(size)}\right)" if size.is_Add else expression(size)
        sign = "-" if minus else "+" if i else ""
        written.append(
            f"{sign} {'' if value == '1' and factor else value} {factor}".strip()
        )
    return " ".join(" ".join(written).split()) or "0"
