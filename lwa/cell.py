"""The periodic unit cell of a chain: masses, contact stiffnesses, spacing.

A cell of P particles repeats with the period ``P·D``. Particle i has the mass ``m_i``; contact i
joins particle i to the next particle (the last contact joins the cell to the next cell) and pushes
with the force ``F = A_i δ^k``. Theory and lattice both start from this object.

At leading order in a long wave all contact forces of a cell are equal. Contact i therefore takes
the share ``C_i`` of the strain, and the cell responds like one of P equal contacts of the stiffness
``A_eff``::

    C_i = P A_i^{-1/k} / Σ_j A_j^{-1/k},    A_eff^{-1/k} = (1/P) Σ_j A_j^{-1/k}.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, fields, replace
from functools import cached_property
from typing import Any, Self

import sympy as sp

from lwa.base import latex
from lwa.base.exact import (
    InputError,
    Quantity,
    integer,
    positive,
    power,
    read_exact,
    replaced,
    shorten,
)
from lwa.base.files import items
from lwa.base.frozen import Value
from lwa.spheres.hertz import Sphere, stiffness

D = sp.Symbol("D", positive=True)
"""The spacing of neighbouring particles, unless the caller names another."""

k = sp.Symbol("k", positive=True)
"""The exponent of the contact law ``F = A δ^k``, unless the caller names another."""

EXPONENTS = sp.Rational(1, 100), 1000
"""Least and largest k; beyond them exact numbers such as ``A^{1/k}`` have too many digits."""

MOST_PARTICLES = 1000
"""Most particles of a dimer's cell; beyond them even the simplest theory takes minutes."""


@dataclass(frozen=True, init=False)
class Cell(Value):
    """A periodic cell of P particles.

    Parameters
    ----------
    masses : sequence of positive numbers or symbols
        The masses of the P particles.
    stiffnesses : sequence of positive numbers or symbols, optional
        The ``A_i`` of ``F = A_i δ^k``, one for each contact; all 1 when not given.
    spacing : positive number or symbol
        The distance D of neighbouring particles at rest, the same for all contacts.

    Raises
    ------
    InputError
        When a value is not positive and finite, or the counts differ.
    """

    masses: tuple[sp.Expr, ...]
    stiffnesses: tuple[sp.Expr, ...]
    spacing: sp.Expr

    def __init__(
        self,
        masses: Iterable[Quantity],
        stiffnesses: Iterable[Quantity] = (),
        spacing: Quantity = D,
    ) -> None:
        masses = quantities(masses, "masses", "mass")
        stiffnesses = quantities(stiffnesses, "stiffnesses", "stiffness")
        if not masses:
            raise InputError("a cell needs at least one mass")
        if not stiffnesses:
            stiffnesses = (sp.S.One,) * len(masses)
        if len(stiffnesses) != len(masses):
            raise InputError(
                f"{len(stiffnesses)} stiffnesses for {len(masses)} masses: a periodic cell has as "
                "many contacts as particles",
                stiffnesses=(),  # the call that the message proposes: without them
            )
        self._set(
            masses=masses,
            stiffnesses=stiffnesses,
            spacing=positive(spacing, "spacing"),
        )

    def latex_rows(self) -> list[str]:
        rows = []
        for name, values in (("m", self.masses), ("A", self.stiffnesses)):
            written = ", ".join(map(latex.expression, values))
            rows.append(rf"{name} = \left({written}\right)")
        return [*rows, *latex.rows({"D": self.spacing})]

    @classmethod
    def of_spheres(cls, spheres: Sequence[Sphere]) -> Cell:
        """The cell of spheres in Hertz contact (k 3/2), in the units of the spheres, such as SI.

        The spacing is the mean distance of neighbours' centers, ``Σ 2 R_i / P``. Then widths and
        speeds are those in space, and ``D u_x`` is the mean compression of the contacts.

        Parameters
        ----------
        spheres : sequence of Sphere
            The spheres of one period; the last one touches the first one of the next period.

        Returns
        -------
        Cell
        """
        row = items(spheres, "spheres")
        masses = []
        contacts = []
        length = sp.S.Zero
        # The last sphere touches the first one of the next period.
        for sphere, following in zip(row, row[1:] + row[:1], strict=True):
            contacts.append(stiffness(sphere, following))
            masses.append(sphere.mass)
            length += 2 * sphere.radius
        # Without spheres the cell itself says what it needs.
        return cls(masses, contacts, length / len(row) if row else D)

    @cached_property
    def symbols(self) -> tuple[sp.Symbol, ...]:
        """The symbols of masses, stiffnesses and spacing, by name."""
        values = sp.Tuple(*self.masses, *self.stiffnesses, self.spacing)
        return tuple(sorted(values.free_symbols, key=str))

    @property
    def equal_contacts(self) -> bool:
        """True for equal stiffnesses."""
        return len({*self.stiffnesses}) == 1

    @property
    def uniform(self) -> bool:
        """True for equal masses and equal stiffnesses."""
        return self.equal_contacts and len({*self.masses}) == 1

    def at(self, **values: Any) -> Cell:
        """The cell with numbers (or other symbols) for the named symbols; see `substitution`.

        Examples
        --------
        >>> Cell(["m1", "m1", "m2"]).at(omega="1/3").masses
        (m1, m1, m1/3)
        """
        return self.replaced(substitution(values, self.symbols, self))

    def replaced(self, new: Mapping[sp.Symbol, sp.Expr]) -> Cell:
        """The cell with expressions in place of some of its symbols."""
        masses = [mass.xreplace(new) for mass in self.masses]
        stiffnesses = [A.xreplace(new) for A in self.stiffnesses]
        return Cell(masses, stiffnesses, self.spacing.xreplace(new))

    @property
    def size(self) -> int:
        """The number P of particles in the cell."""
        return len(self.masses)

    @cached_property
    def mass(self) -> sp.Expr:
        """The mass M of the cell."""
        return sp.Add(*self.masses)

    @cached_property
    def fractions(self) -> tuple[sp.Expr, ...]:
        """The mass fractions ``m̂_i = m_i / M``, with the sum 1."""
        return tuple(sp.cancel(m / self.mass) for m in self.masses)

    def compliances(self, k: Any = k) -> tuple[sp.Expr, ...]:
        """The ``A_i^{-1/k}``, strains of the contacts up to a common factor."""
        # All contacts carry one force A_i δ_i^k, so that δ_i goes as A_i^{-1/k}.
        k = exponent(k)
        return tuple(power(A, -1 / k) for A in self.stiffnesses)

    def shares(self, k: Any = k) -> tuple[sp.Expr, ...]:
        """The shares ``C_i``: strain of contact i divided by the mean strain (`lwa.cell`)."""
        compliances = self.compliances(k)
        total = sp.Add(*compliances)
        return tuple(self.size * compliance / total for compliance in compliances)

    def stiffness(self, k: Any = k) -> sp.Expr:
        """The stiffness A_eff of P equal contacts with the same response as the cell."""
        # Equal contacts: no power is taken and undone.
        if self.equal_contacts:
            return self.stiffnesses[0]
        # A_eff^{-1/k} is the mean of the A_i^{-1/k}: compressions add.
        return power(sp.Add(*self.compliances(k)) / self.size, -exponent(k))

    def time_scale(self, k: Any = k) -> sp.Expr:
        """The ratio ``τ/t = √(P k A_eff D^{k+1} / M)`` of the wave equation's time to the chain's.

        The unit of τ makes the leading order ``u_ττ = u_x^{k-1} u_xx``.
        """
        # The force A_eff (D u_x)^k acts on the density M/(P D) of mass:
        # M/(P D) u_tt = k A_eff D^k u_x^{k-1} u_xx.
        k = exponent(k)
        modulus = self.size * k * self.stiffness(k) * power(self.spacing, k + 1)
        return power(modulus / self.mass, sp.S.Half)


class Parametric(Value):
    """Base of results of a chain, for whose symbols values can be given.

    The fields hold cells, contact laws, expressions, and results that are of this kind themselves.
    """

    def at(self, **values: Any) -> Self:
        """Substitute numbers (or other symbols) for the named symbols, and for ``ω = m2/m1``.

        Parameters
        ----------
        **values
            Values by the names of symbols; see `lwa.cell.substitution`.

        Raises
        ------
        InputError
            For a name that does not occur, and a value that the result cannot have.
        NoSolitaryWave
            For values without a wave.

        Examples
        --------
        >>> from lwa import Dimer, canonical_wave, homogenize
        >>> homogenize(Dimer("m1", "m2")).at(k="3/2", omega=1).pde.I
        D**2/12
        >>> canonical_wave(Cell(["m1", "m2"]), "k").at(k="3/2", omega=1).beta
        sqrt(10)/(5*D)
        """
        parts = self._parts()
        symbols = set()
        for part in parts:
            # Expressions have free symbols, cells and laws symbols; words and numbers have none.
            own = getattr(part, "symbols", ())
            symbols |= {*getattr(part, "free_symbols", own)}
        cell = next(part for part in parts if isinstance(part, Cell))
        return self.replaced(substitution(values, symbols, cell))

    def _parts(self) -> list[Any]:
        """Values of all fields; a field that is a result gives the values of its own fields."""
        parts: list[Any] = []
        for field in fields(self):
            part = getattr(self, field.name)
            parts += part._parts() if isinstance(part, Parametric) else [part]
        return parts

    def replaced(self, new: Mapping[sp.Symbol, sp.Expr]) -> Self:
        """The result with expressions in place of some of its symbols."""
        changed = {}
        for field in fields(self):
            part = getattr(self, field.name)
            if isinstance(part, sp.Expr):
                changed[field.name] = replaced(part, new)
            elif hasattr(part, "replaced"):
                changed[field.name] = part.replaced(new)
        return replace(self, **changed)


def Dimer(
    m1: Any, m2: Any, N: int = 1, *, stiffnesses: Sequence[Any] = (), spacing: Any = D
) -> Cell:
    """The paper's N:1 dimer.

    Parameters
    ----------
    m1, m2 : positive numbers or symbols
        Masses of the particles; u is the field of the first one, of mass m1.
    N : int
        Number of particles m1 before the one particle m2.
    stiffnesses, spacing
        Stiffnesses and spacing, as of a `Cell`.

    Returns
    -------
    Cell

    Examples
    --------
    >>> Dimer("m1", "m2", N=2).masses
    (m1, m1, m2)
    """
    masses = (m1,) * integer(N, "N", 1, MOST_PARTICLES) + (m2,)
    return Cell(masses, stiffnesses, spacing)


def read_cell(value: Any) -> Cell:
    """Return a cell; raise `lwa.InputError` for anything else."""
    if not isinstance(value, Cell):
        raise InputError(
            f"cell is {shorten(value)}: a Cell such as Dimer(m1, m2) is wanted"
        )
    return value


def exponent(value: Any) -> sp.Expr:
    """Read the exponent k of ``F = A δ^k`` exactly.

    Parameters
    ----------
    value : number or symbol

    Returns
    -------
    expression

    Raises
    ------
    InputError
        For numbers outside of `EXPONENTS`.
    """
    least, largest = EXPONENTS
    result = read_exact(value, "k")
    # A symbol may stand for any number.
    if result.is_number and not least <= result <= largest:
        raise InputError(
            f"k is {shorten(result)}: exponents from {least} to {largest} are taken"
        )
    return result


def by_name(symbols: Collection[sp.Symbol]) -> dict[str, sp.Symbol]:
    """Symbols by their names; raises `lwa.InputError` for a name of two symbols."""
    known = {}
    # SymPy tells symbols of one name and different assumptions apart; a caller's keyword cannot.
    for symbol in sorted(symbols, key=str):
        if symbol.name in known:
            raise InputError(
                f"{symbol.name!r} names two symbols, with different assumptions: choose another"
            )
        known[symbol.name] = symbol
    return known


def substitution(
    values: Mapping[str, Any], symbols: Collection[sp.Symbol], cell: Cell
) -> dict[sp.Symbol, sp.Expr]:
    """Map symbols of a cell and of its results to the values given for their names.

    Parameters
    ----------
    values : mapping
        Values by the names of symbols. Unless a symbol has this name, ``omega`` is the ratio m2/m1
        of the cell's two masses.
    symbols : collection of symbols
        The symbols. Values of those that are none of the cell's may have either sign.
    cell : Cell

    Returns
    -------
    dict
        Mapping from symbols to expressions.

    Raises
    ------
    InputError
        For a name that does not occur or that two symbols have, and a value of the cell that is
        not positive.
    """
    known = by_name(symbols)
    # The values, by symbol
    new = {}
    for name, value in values.items():
        if name in known:
            # Masses, stiffnesses and lengths are positive; a law's parameters need not be.
            read = positive if known[name] in cell.symbols else read_exact
            new[known[name]] = read(value, name)
        elif name != "omega":
            names = ", ".join(known) or "there are none"
            raise InputError(f"{shorten(name)} is not among the symbols: {names}")
    if "omega" in values and "omega" not in known:
        mass, value = _by_ratio(cell, positive(values["omega"], "omega"), new)
        new[mass] = value
    return new


def _by_ratio(
    cell: Cell, omega: sp.Expr, known: Mapping[sp.Symbol, sp.Expr]
) -> tuple[sp.Symbol, sp.Expr]:
    """Return the mass symbol that a given m2/m1 determines, and its value; others are ``known``."""
    masses = tuple(dict.fromkeys(cell.masses))
    if len(masses) != 2:
        raise InputError(
            f"omega is m2/m1 of a cell with two masses; this one has {len(masses)}"
        )
    # m2 becomes ω m1 or, where m2 is no free symbol, m1 becomes m2/ω.
    m1, m2 = masses
    choices = (
        (m2, m1, omega),
        (m1, m2, 1 / omega),
    )
    for mass, other, ratio in choices:
        if mass.is_Symbol and mass not in known and mass not in other.free_symbols:
            return mass, ratio * other.xreplace(known)
    raise InputError(
        "omega is m2/m1: one of the masses must be a symbol without another value"
    )


def quantities(values: Any, name: str, singular: str) -> tuple[sp.Expr, ...]:
    """Read a sequence of positive numbers or symbols.

    Parameters
    ----------
    values : iterable
    name, singular : str
        Names of the sequence and of one of its values in messages.
    """
    numbered = enumerate(items(values, name), start=1)
    return tuple(positive(x, f"{singular} {i}") for i, x in numbered)
