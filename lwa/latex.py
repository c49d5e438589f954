"""Derivations as LaTeX, in the notation and order of the paper.

The objects show themselves by these rows in a notebook (`_repr_latex_`); ``--format latex`` prints
the same with all orders.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING

import sympy as sp

if TYPE_CHECKING:
    from lwa.closure.consistency import Closure
    from lwa.pde import PDE
    from lwa.terms import Terms
    from lwa.wave import TravelingWave


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


def ansatz(closure: Closure, most: int | None = None) -> list[str]:
    """w = λ (u + b_1 D u_x + …), λ and the b_n; to D^most or all."""
    shown = range(1, min(len(closure.ansatz), (most or len(closure.ansatz)) + 1))
    if not closure.ansatz:
        return []
    spacing = sp.latex(closure.ring.cell.spacing)
    parts = [f"b_{{{n}}} {spacing}{f'^{{{n}}}' if n > 1 else ''} {derivative(n)}" for n in shown]
    if closure.name == "full" or len(shown) < len(closure.ansatz) - 1:
        parts.append(r"\cdots")
    first = rf"w = \lambda \left(u + {' + '.join(parts)}\right)"
    values = [row(f"b_{{{n}}}", closure.b[n]) for n in shown]
    return [first, row(r"\lambda", closure.ratio), *values]


def equation(pde: PDE, most: int | None = None) -> list[str]:
    """The wave equation, the terms at D^{k+3} with the letters G, H, I; to D^{k+most} or all."""
    letters = pde.third_order
    leading = r"u_{x}^{k-1} u_{xx}" if pde.acoustic else "-u^{k}"
    parts, rows = [leading], []
    left_out = False
    for n, found in pde.coefficients.items():
        if n == 3 and letters:
            parts += [f"{letter} {found.latex(jet)}" for letter, jet in pde.LETTERS.items()]
        elif found and most is not None and n > most:
            left_out = True
        elif found:
            power = n - (1 if pde.acoustic else 0)
            spacing = sp.latex(pde.cell.spacing) + (f"^{{{power}}}" if power > 1 else "")
            parts.append(rf"{spacing} \Bigl({' '.join(_signed(found))}\Bigr)")
    rows.append(rf"u_{{\tau\tau}} = {' + '.join(parts)}" + (r" + \cdots" if left_out else ""))
    rows += [row(letter, value) for letter, value in letters.items()]
    return rows


def _signed(found: Terms) -> Iterator[str]:
    """Coefficients times jets, with the signs between them."""
    for i, jet in enumerate(found):
        coefficient = found[jet]
        minus = coefficient.could_extract_minus_sign()
        value = sp.latex(-coefficient if minus else coefficient)
        if (-coefficient if minus else coefficient).is_Add:
            value = rf"\left({value}\right)"
        sign = "-" if minus else "+" if i else ""
        yield f"{sign} {'' if value == '1' else value} {found.latex(jet)}".strip()


def terms(found: Terms) -> list[str]:
    """The terms of one order, as one row."""
    return [" ".join(_signed(found)) or "0"]


def wave(found: TravelingWave) -> list[str]:
    """The profile with its β and V_s."""
    return [
        r"v = u_{x} = B \cos^{2/(k-1)}(\beta \xi), \quad |\xi| \leq \frac{\pi}{2\beta}",
        row(r"\beta", found.beta),
        row("V_{s}", found.speed()),
    ]


def values(found: Mapping[str, sp.Expr]) -> list[str]:
    """name = value, the names as symbols."""
    return [row(sp.latex(sp.Symbol(name)), value) for name, value in found.items()]


def derivative(n: int) -> str:
    """∂_x^n u."""
    return f"u_{{{'x' * n if n < 4 else f'{n}x'}}}"
