"""A tabulated force as a SymPy function: F, its derivatives and integrals, of a spline."""

from __future__ import annotations

from typing import Any

import mpmath
import sympy as sp
from sympy.core.symbol import Str

from lwa.base.exact import InputError

_NAMES = {-2: "∫√table′", -1: "∫table", 0: "table", 1: "table′", 2: "table″"}
_LATEX = {-2: r"\int\!\sqrt{F'}", -1: "W", 0: "F", 1: "F'", 2: "F''"}

_DIGITS = 35  # of values at a number, as of compressions: differences lose half of them at most


class Tabulated(sp.Function):  # type: ignore[misc]  # SymPy has no types
    """F, F′ or F″ (order 2), ∫ F dδ (-1) or ∫ √F′ dδ (-2) of a `lwa.base.splines.ForceSpline`.

    Arguments are the order, δ and the points as a text, which SymPy's printers of code write as a
    literal: `sympy.lambdify` finds the function itself by its ``_imp_``.
    """

    @classmethod
    def of(cls, delta: sp.Symbol, points: str, order: int = 0) -> Tabulated:
        """Make the function of a compression."""
        made: Tabulated = cls(sp.Integer(order), delta, Str(repr(points)))
        return made

    @classmethod
    def eval(cls, order: sp.Expr, delta: sp.Expr, points: Str) -> sp.Expr | None:
        if delta.is_zero and order < 2:
            return sp.S.Zero
        if not delta.is_number:
            return None
        with mpmath.workdps(_DIGITS):
            place = mpmath.mpf(delta.evalf(_DIGITS))
            value = cls._imp_(order, place, str(points)[1:-1])
        if mpmath.isnan(value):
            last = str(points)[1:-1].split(",")[-1].split()[0]
            raise InputError(f"compression is {float(place):g}: the table ends at {last}")
        return sp.Float(value, _DIGITS)

    @staticmethod
    def _imp_(order: Any, delta: Any, points: str) -> Any:
        from lwa.base.splines import read_spline  # start-up: it loads NumPy

        return read_spline(points)(int(order), delta)

    @property
    def points(self) -> str:
        """The points as `lwa.base.splines.read_spline` reads them."""
        return str(self.args[2])[1:-1]

    def at_order(self, order: int) -> sp.Expr:
        """Return F, one of its derivatives, or an integral, at the same δ.

        Raises `lwa.InputError` beyond F″: the third derivative of the spline jumps at the points.
        """
        if order > 2:
            raise InputError("a table gives F, F′ and F″: higher derivatives are not known")
        return self.func(sp.Integer(order), *self.args[1:])

    def _eval_derivative(self, symbol: sp.Symbol) -> sp.Expr:
        inner = self.args[1].diff(symbol)
        if inner and self.args[0] == -2:
            return sp.sqrt(self.at_order(1)) * inner
        return self.at_order(int(self.args[0]) + 1) * inner if inner else sp.S.Zero

    def _eval_evalf(self, prec: int) -> sp.Expr:
        return self  # numbers are evaluated at once

    def _eval_is_positive(self) -> bool | None:
        return True if self.args[0] < 2 and self.args[1].is_positive else None

    def _eval_is_extended_real(self) -> bool | None:
        return bool(self.args[1].is_extended_real) or None

    def _sympystr(self, printer: Any) -> str:
        return f"{_NAMES[int(self.args[0])]}({printer.doprint(self.args[1])})"

    def _latex(self, printer: Any, exp: str | None = None) -> str:
        name, inside = _LATEX[int(self.args[0])], printer.doprint(self.args[1])
        return f"{name}{f'^{{{exp}}}' if exp else ''}\\left({inside}\\right)"
