"""The linear chain: its dispersion relation, the series of its branches, its bands under a load.

A chain with the exponent 1, or a chain of any k linearised about a uniform compression, is a chain
of springs of compliances ``C_i`` (`Cell.shares`). In the theory's units (time τ, wavenumber
``κ = qD``, so that Ω is κ to leading order) its acoustic branch is the series::

    Ω² = κ² (1 - (I/D²) κ² + …),

where I is the coefficient of ``u_x^{k-1} u_xxxx`` in the wave equation. `lwa.linear.bloch` derives
relation and series, `lwa.linear.springs` computes frequencies.
"""

from __future__ import annotations

from contextlib import suppress
from dataclasses import dataclass, replace
from functools import cached_property
from math import comb
from typing import TYPE_CHECKING, Any

import sympy as sp
from flint import fmpq_mpoly

from lwa.algebra.model import Model
from lwa.base import latex
from lwa.base.exact import (
    InputError,
    demand_numbers,
    integer,
    number,
    positive,
    shorten,
)
from lwa.base.frozen import Value
from lwa.cell import Cell, Parametric, exponent, read_cell
from lwa.law import ContactLaw, Power, for_cell
from lwa.linear.bloch import Bloch

if TYPE_CHECKING:
    from lwa.linear.springs import Bands

_KAPPA = sp.Symbol("kappa")

MOST_TERMS = 200_000
"""Terms of the longest series (estimate of `Dispersion._length`); it takes about half a minute."""


@dataclass(frozen=True, repr=False)
class Dispersion(Parametric):
    """The dispersion relation Ω(κ) of the linear chain with a cell's masses and strain shares.

    Ω is the frequency in τ times D and κ the wavenumber times D. In time t the frequency is
    Ω/D · `Cell.time_scale`, times ``p^{(k-1)/2}`` under a mean strain p.

    Parameters
    ----------
    cell : Cell
    k : number or symbol
        Exponent of the contact law, which matters for unequal contacts only; 1 makes the
        stiffnesses spring constants.

    Examples
    --------
    >>> m1, m2 = sp.symbols("m1 m2", positive=True)
    >>> Dispersion(Cell((m1, m2))).acoustic(4)
    {2: 1, 4: -(m1**2 - m1*m2 + m2**2)/(3*(m1 + m2)**2)}
    """

    cell: Cell
    k: sp.Expr = sp.S.One

    def __post_init__(self) -> None:
        read_cell(self.cell)  # for its refusal of anything else
        self._set(k=exponent(self.k))

    def __repr__(self) -> str:
        relation = "Ω² = κ² + …"
        # A cell may have too many symbols for a term at κ⁴.
        with suppress(InputError):
            relation = f"Ω² = κ² + ({shorten(self.acoustic(4)[4])}) κ⁴ + …"
        return f"Dispersion({self.cell!r}, k={self.k}: {relation})"

    def latex_rows(self, order: int = 4) -> list[str]:
        """LaTeX of ``Ω²(κ)`` to ``κ^order``, of the acoustic and of a dimer's optical branch."""
        # The branches of one chain, in the same units
        rows = []
        for branch, series in self.series(order).items():
            terms = []
            for n, coefficient in series.items():
                terms.append((coefficient, latex.power(_KAPPA, n)))
            letter = rf"\Omega_{{\mathrm{{{branch}}}}}^{{2}}"
            rows.append(rf"{letter} = {latex.total(terms)} + \cdots")
        return rows

    def series(self, order: int = 4) -> dict[str, dict[int, sp.Expr]]:
        """Mapping from "acoustic", and for dimers "optical", to the coefficients of ``Ω²(κ)``."""
        series = {"acoustic": self.acoustic(order)}
        if self.cell.size == 2:
            series["optical"] = self.optical(order)
        return series

    def acoustic(self, order: int = 4) -> dict[int, sp.Expr]:
        """The series of the acoustic branch.

        Parameters
        ----------
        order : int
            Highest power of κ.

        Returns
        -------
        dict
            Mapping from the even n, 2 to ``order``, to the coefficient of ``κ^n`` in ``Ω²``.

        Raises
        ------
        InputError
            For more terms than `MOST_TERMS`.
        """
        found = {}
        # A branch of long waves begins at κ².
        series = self._bloch.acoustic(self._length(order))
        for n, coefficient in enumerate(series[1:], start=1):
            found[2 * n] = self._expression(coefficient)
        return found

    def optical(self, order: int = 4) -> dict[int, sp.Expr]:
        """The series of a dimer's optical branch, with n from 0 on; see `acoustic`."""
        # The roots of other cells are not rational.
        if self.cell.size != 2:
            raise InputError(
                f"the optical series needs a cell of 2 masses, not {self.cell.size}"
            )
        # The trace is 2 - 4 Ω² + 4Π Ω⁴, listed by powers of Ω²; its two roots have the sum 1/Π.
        Pi = self._expression(self._bloch.trace(2)[2]) / 4
        acoustic = self.acoustic(order).items()
        return {0: 1 / Pi} | {n: -coefficient for n, coefficient in acoustic}

    @cached_property
    def I(self) -> sp.Expr:
        """The wave equation's coefficient I of ``u_x^{k-1} u_xxxx``, with its factor ``D²``.

        It is that of the acoustic branch ``Ω² = κ² (1 - (I/D²) κ² + …)``.
        """
        fourth = self.acoustic(4)[4]  # the coefficient of κ⁴
        return -fourth * self.cell.spacing**2

    @cached_property
    def _model(self) -> Model:
        """The cell under a power law, with the ring of the coefficients."""
        return Model(self.cell, Power(self.k))

    @cached_property
    def _bloch(self) -> Bloch:
        """Bloch's relation of the cell over the ring of `_model`."""
        return Bloch(self._model)

    def _expression(self, polynomial: fmpq_mpoly) -> sp.Expr:
        """A polynomial of the ring as an expression in the cell's symbols."""
        expression = self._model.expression(list(polynomial.terms()))
        # Compliances enter as 1/A: the result is put over one denominator.
        return sp.together(expression)

    def _length(self, order: Any) -> int:
        """Return the number of powers of κ² up to κ^order; raise `lwa.InputError` for too many.

        The coefficient of ``κ^{2n}`` has the degree 2n - 2 in the masses and in the compliances,
        and comes from about ``n²`` products.
        """
        # Odd powers of κ have no term.
        n = integer(order, "order", 1) // 2
        terms = n * n
        for part in (self._model.masses, self._model.contacts):
            degree = 2 * max(n, 1) - 2
            parameters = len(part.names)
            terms *= comb(degree + parameters, parameters)
        if terms > MOST_TERMS:
            raise InputError(
                f"order is {order}: give numbers for the cell, or a lower order"
            )
        return n

    @cached_property
    def bands(self) -> Bands:
        """The bands in floats, Ω by κ; raises `lwa.InputError` for symbols."""
        # Imported here, as `import lwa` does not load NumPy
        import numpy as np

        from lwa.linear.springs import Bands

        weights = sp.Tuple(*self.cell.fractions, *self.cell.shares(self.k))
        demand_numbers(weights.free_symbols, "bands want numbers")
        floats = np.array(list(map(float, weights)))
        # A float below 1e-308 is 0.
        if not np.all(floats > 0):
            raise InputError(
                "masses or compliances differ by more than the range of a float"
            )
        fractions, shares = np.split(floats, 2)
        return Bands(fractions, shares)


@dataclass(frozen=True, repr=False)
class LoadedChain(Value):
    """The linear chain about a static load, the same force F0 in all contacts.

    Frequencies and speeds are in the units of the cell, 1/s and m/s in SI. About the load contact i
    is a spring of the constant ``A_i F′(δ_i)``, where ``A_i F(δ_i) = F0``; under a power it is
    ``k A_i^{1/k} F0^{(k-1)/k}``.

    Parameters
    ----------
    cell : Cell
    law : ContactLaw
    precompression : positive number or symbol
        The force F0.

    Raises
    ------
    InputError
        Unless the load is positive, and for unlike contacts under a law that is no power.
    """

    cell: Cell
    law: ContactLaw
    precompression: sp.Expr

    def __post_init__(self) -> None:
        # Called for its refusal of unlike contacts under a law that is no power
        for_cell(self.law, self.cell)
        self._set(precompression=positive(self.precompression, "precompression"))

    def __repr__(self) -> str:
        return (
            f"LoadedChain({self.cell!r}, {self.law!r}, precompression={self.precompression}: "
            f"sound_speed={shorten(self.sound_speed)})"
        )

    def latex_rows(self) -> list[str]:
        values = {"F_{0}": self.precompression}
        for i, K in enumerate(self.spring_constants, start=1):
            values[f"K_{{{i}}}"] = K
        return latex.rows(values | {"c_{0}": self.sound_speed})

    @cached_property
    def spring_constants(self) -> tuple[sp.Expr, ...]:
        """The spring constants ``A_i F′(δ_i)``."""
        constants = []
        for A in self.cell.stiffnesses:
            delta = self.law.inverse(self.precompression / A)
            slope = self.law.at(delta, 1)
            constants.append(sp.powsimp(A * slope))
        return tuple(constants)

    @cached_property
    def springs(self) -> Dispersion:
        """The dispersion of the chain of these springs, Ω(κ) in the theory's units."""
        # `Dispersion` has k = 1 unless told: stiffnesses are spring constants.
        return Dispersion(replace(self.cell, stiffnesses=self.spring_constants))

    @cached_property
    def sound_speed(self) -> sp.Expr:
        """The speed dω/dq of long waves."""
        # They have Ω = κ, which is dx/dτ = 1: dx/dt is τ/t.
        return self.springs.cell.time_scale(1)

    @cached_property
    def bands(self) -> Bands:
        """The bands in floats, in the units of the cell; raises `lwa.InputError` for symbols."""
        D = self.cell.spacing
        rate = self.sound_speed / D  # ω/Ω, in 1/s for a cell in SI
        # A symbol is the unit of length.
        length = sp.S.One if D.is_Symbol else D
        return replace(self.springs.bands, rate=number(rate), length=number(length))
