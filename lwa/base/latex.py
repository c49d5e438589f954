"""LaTeX in the notation and order of the paper: rows, displays, sums and derivatives.

Derivations write themselves as rows (`latex_rows`); a notebook shows them (`_repr_latex_`), and
``--format latex`` prints the same with all orders.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping

import sympy as sp


def display(rows: list[str]) -> str:
    """Rows as one display for a notebook."""
    return f"$$\\begin{{aligned}}\n{_aligned(rows)}\n\\end{{aligned}}$$"


def align(rows: list[str]) -> str:
    """Rows as an environment of a paper."""
    return f"\\begin{{align}}\n{_aligned(rows)}\n\\end{{align}}"


def _aligned(rows: list[str]) -> str:
    return " \\\\\n".join(row.replace("=", "&=", 1) for row in rows)


def row(name: str, value: sp.Expr) -> str:
    """name = value."""
    return f"{name} = {sp.latex(value)}"


def values(found: Mapping[str, sp.Expr]) -> list[str]:
    """name = value, the names as symbols."""
    return [row(sp.latex(sp.Symbol(name)), value) for name, value in found.items()]


def power(symbol: sp.Expr, n: int) -> str:
    """symbol^n.

    >>> power(sp.Symbol("D"), 2)
    'D^{2}'
    """
    return f"{sp.latex(symbol)}^{{{n}}}" if n > 1 else str(sp.latex(symbol))


def derivative(n: int) -> str:
    """∂_x^n u.

    >>> derivative(2), derivative(4)
    ('u_{xx}', 'u_{4x}')
    """
    return f"u_{{{'x' * n if n < 4 else f'{n}x'}}}"


def total(terms: Iterable[tuple[sp.Expr, str]]) -> str:
    """Σ coefficient · factor, with the signs between the terms.

    >>> total([(-sp.Symbol("G"), "u"), (sp.Integer(1), "v")])
    '- G u + v'
    """
    written = []
    for i, (coefficient, factor) in enumerate(terms):
        minus = coefficient.could_extract_minus_sign()
        size = -coefficient if minus else coefficient
        value = rf"\left({sp.latex(size)}\right)" if size.is_Add else sp.latex(size)
        sign = "-" if minus else "+" if i else ""
        written.append(f"{sign} {'' if value == '1' else value} {factor}".strip())
    return " ".join(" ".join(written).split()) or "0"
