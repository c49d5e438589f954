"""Contact laws F(δ): powers, expressions, and the laws with names.

A law enters the theory through dimensionless functions of the compression δ::

    φ_n = δ^{n-1} F^{(n)}(δ) / F'(δ),    φ_1 = 1.

For ``δ^k`` they are the numbers ``(k-1) … (k-n+1)``. The force of a contact is ``A F(δ)``, A its
stiffness in the cell. Unlike contacts have the same shares at every strain only under a power.

How to add a law of your own: ``Law(F, delta)`` with any SymPy expression F that grows with delta.
To give it a name, on the command line and in files of chains too, add a line to `_NAMED`, the force
as a function of the law's parameters, a line to the docstring of `named`, and one to the table of
``book/laws.md``. The tests of names (tests/lwa/test_law.py) take it from there.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from inspect import signature
from itertools import zip_longest
from typing import TYPE_CHECKING, Any, ClassVar

import mpmath
import sympy as sp
from sympy.core.function import AppliedUndef

from lwa.base import latex
from lwa.base.calculus import growing_root, integral
from lwa.base.exact import (
    InputError,
    demand_numbers,
    integer,
    one_of,
    positive,
    power,
    read_exact,
    real,
    rearranged,
    replaced,
    shorten,
    signed,
)
from lwa.base.frozen import Value
from lwa.cell import Cell, exponent, k as symbol_k, read_cell
from lwa.spheres.hertz import EXPONENT

if TYPE_CHECKING:
    from lwa.base.arrays import Array

DELTA = sp.Symbol("delta", positive=True)
"""δ, the compression of a contact, unless the caller names another symbol."""


@dataclass(frozen=True, repr=False)
class ContactLaw(Value):
    """A contact force F(δ): base of `Power` and `Law`.

    Attributes
    ----------
    F : expression
        The force as a function of `delta`.
    delta : symbol
        The compression δ.
    name, parameters : str, tuple
        Name and parameters, as `named` takes them; "" and () for a law without a name.
    homogeneous : bool
        True if ``F(sδ) = s^k F(δ)``, that is for a power.
    """

    F: sp.Expr
    delta: sp.Symbol = DELTA
    name: str = field(default="", compare=False)
    parameters: tuple[sp.Expr, ...] = field(default=(), compare=False)
    homogeneous: ClassVar[bool] = False

    @property
    def text(self) -> str:
        """Name and parameters as `read_law` reads them, such as "hertz2:1,2"; F without a name."""
        # A law without parameters, such as "general", has no colon.
        parameters = ",".join(map(str, self.parameters))
        return f"{self.name}:{parameters}".rstrip(":") if self.name else str(self.F)

    def latex_rows(self) -> list[str]:
        return latex.rows({f"F({sp.latex(self.delta)})": self.F})

    @property
    def symbols(self) -> tuple[sp.Symbol, ...]:
        """The law's own symbols, by name."""
        return tuple(sorted(self.F.free_symbols - {self.delta}, key=str))

    @property
    def exponent(self) -> sp.Expr:
        """Exponent of a power law, by which unlike contacts share the strain; 1 for other laws."""
        return sp.S.One

    def slope(self, n: int = 1) -> sp.Expr:
        """The n-th derivative ``F^{(n)}(δ)``."""
        return self.F.diff(self.delta, integer(n, "n", 0))

    @cached_property
    def energy(self) -> sp.Expr:
        """The energy W(δ) of a contact, ``W′ = F``."""
        if self.formless:
            s = sp.Dummy("s", positive=True)
            return sp.Integral(self.F.subs(self.delta, s), (s, 0, self.delta))
        return integral(self.F, self.delta)

    def phi(self, n: int) -> sp.Expr:
        """The parameter ``φ_n = δ^{n-1} F^{(n)}/F′`` as an expression in δ."""
        # φ_0 has no meaning.
        order = integer(n, "n", 1) - 1
        value = self.delta**order * self.slope(n) / self.slope()
        return rearranged(sp.cancel, sp.powsimp(value))

    @property
    def pulls(self) -> bool:
        """True if the contact also holds at δ < 0: a law with ``F′(0) > 0`` that is no power."""
        # δ^k is the force of a contact that opens, at k = 1 too.
        known = not (self.homogeneous or self.formless)
        return known and bool(self.slope().subs(self.delta, 0).is_positive)

    def at(self, delta: Any, n: int = 0) -> Any:
        """The force F, or its n-th derivative, at a compression.

        Parameters
        ----------
        delta : number, expression or array
            The compression. The force is 0 where it is negative, unless the law `pulls`.
        n : int
            Number of derivatives.

        Returns
        -------
        expression or ndarray
            An exact expression for a number or an expression, an array of floats for an array.

        Raises
        ------
        InputError
            For text, NaN, infinities and complex numbers.

        Examples
        --------
        >>> Power("3/2").at(4), Power("3/2").at(-1), Power("3/2").at([-1, 4])
        (8, 0, array([0., 8.]))
        """
        n = integer(n, "n", 0)
        # A number of NumPy is an array without axes.
        if isinstance(delta, list | tuple) or getattr(delta, "ndim", 0) > 0:
            from lwa.base.arrays import finite  # here: it loads NumPy

            return self.function(n)(finite(delta, "delta"))
        delta = real(delta, "delta")
        if delta.is_negative and not self.pulls:
            return sp.S.Zero
        return self._put(self.slope(n), delta)

    def _put(self, value: sp.Expr, delta: sp.Expr) -> sp.Expr:
        """An expression in δ at a compression; long numbers are not written out."""
        # SymPy alone can put a value into the derivative of an unknown function.
        if self.formless:
            return value.subs(self.delta, delta)
        return replaced(value, {self.delta: delta})

    def function(self, n: int = 0) -> Callable[[Array], Array]:
        """Compile the n-th derivative of F to a function of arrays, 0 at open contacts.

        Raises
        ------
        InputError
            For a law with symbols, or without an expression.
        """
        import numpy as np  # here: the command starts before NumPy does

        from lwa.base.arrays import function_of

        demand_numbers(self.symbols, "an array of forces needs numbers for the law")
        slope = function_of(self.delta, self.slope(n))
        if self.pulls:
            return slope

        def values(delta: Array) -> Array:
            # `where` evaluates both sides: powers of negative numbers would be NaN with a warning,
            # and derivatives of powers are infinite at 0.
            with np.errstate(divide="ignore"):
                return np.where(delta < 0, 0.0, slope(np.maximum(delta, 0.0)))

        return values

    @property
    def formless(self) -> bool:
        """True if F is a function without an expression, as that of `general`."""
        return bool(self.F.atoms(AppliedUndef))

    def of_strain(self, p: sp.Expr, D: sp.Expr, n: int = 0) -> sp.Expr:
        """The n-th derivative of F at a strain, in the units of ``u_ττ = F′(u_x) u_xx``.

        Parameters
        ----------
        p : expression
            The strain.
        D : expression
            The spacing.
        n : int
            For n 0 the result is ``F(Dp)/D`` (``p^k/k`` for a power), for n -1 the energy W.

        Returns
        -------
        expression
        """
        p, D = real(p, "p"), real(D, "D")
        # Each derivative by p instead of δ = D p brings a factor D, each integral 1/D.
        if n < 0:
            return self._put(self.energy, D * p) / D**2
        return self.at(D * p, n) * D ** (n - 1)

    def check_strain(self, p: sp.Expr, cell: Cell) -> None:
        """Refuse a strain at which F does not grow or before which F has a pole.

        Parameters
        ----------
        p : expression
            The strain. Symbols are accepted.
        cell : Cell
            The cell, whose spacing is 1 if it is a symbol.

        Raises
        ------
        InputError
        """
        # F′ of a power is positive at every strain; that of a law without expression is unknown.
        if self.homogeneous or self.formless:
            return
        D = cell.spacing
        delta = D * real(p, "p")
        if D.is_Symbol:
            delta = delta.subs(D, 1)
        # A base that changes its sign on the way is 0 there, and its negative power a pole.
        for factor in self.F.atoms(sp.Pow):
            start = factor.base.subs(self.delta, 0)
            end = factor.base.subs(self.delta, delta)
            if factor.exp.is_negative and (start * end).is_nonpositive:
                raise InputError(
                    f"the strain is {shorten(p)}: the law has a pole before it"
                )
        slope = self.at(delta, 1)
        if not slope.free_symbols and not slope.is_positive:
            raise InputError(
                f"the strain is {shorten(p)}: F′ is {sp.N(slope, 4)} there, and sound needs F′ > 0"
            )

    def compression(self, cell: Cell, force: sp.Expr) -> sp.Expr:
        """The mean compression of a cell's contacts that push with this force; see `inverse`."""
        # The contacts of a cell act like equal ones of this stiffness.
        return self.inverse(real(force, "force") / cell.stiffness(self.exponent))

    def inverse(self, force: sp.Expr) -> sp.Expr:
        """The compression at which F is this force: exact for a `Power`, else to 35 digits.

        Raises
        ------
        InputError
            For a force beyond the law's reach, and for symbols under a law that is no power.
        """
        # `Power` has a method of its own, which is exact.
        if self.formless:
            raise InputError(
                f"law is {self.text}: the strain under a force needs an expression"
            )
        difference = self.F - real(force, "force")
        unknown = difference.free_symbols - {self.delta}
        demand_numbers(unknown, f"the load under the law {self.text} needs numbers")
        # 15 digits more than the result has, for what the search loses
        with mpmath.workdps(50):
            root = growing_root(difference, self.delta)
            if root is None:
                raise InputError(
                    f"force is {shorten(force)}: the law does not reach it"
                )
            # 35 digits leave 15 of the rise of a wave that is 1e-20 of the load.
            return sp.Float(root, 35)

    def replaced(self, new: Mapping[sp.Symbol, sp.Expr]) -> ContactLaw:
        """The law with the values that `lwa.cell.substitution` gives for its symbols."""
        if self.name:
            return named(self.name, *(x.xreplace(new) for x in self.parameters))
        # A value that holds δ would change the law, not its parameters.
        for symbol in self.symbols:
            _check_parameter(new.get(symbol, symbol), str(symbol), self.delta)
        return Law(self.F.xreplace(new), self.delta)


class Power(ContactLaw):
    """The power law ``F = δ^k``.

    Parameters
    ----------
    k : positive number or symbol
        The exponent, 3/2 for spheres.
    """

    homogeneous: ClassVar[bool] = True

    def __init__(self, k: Any) -> None:
        k = exponent(k)
        super().__init__(DELTA**k, name="power", parameters=(k,))

    def __repr__(self) -> str:
        return f"Power(k={self.k})"

    @property
    def k(self) -> sp.Expr:
        """The exponent."""
        return self.parameters[0]

    exponent = k

    def slope(self, n: int = 1) -> sp.Expr:
        n = integer(n, "n", 0)
        return sp.ff(self.k, n) * self.delta ** (self.k - n)

    def phi(self, n: int) -> sp.Expr:
        return sp.ff(self.k - 1, integer(n, "n", 1) - 1)

    def of_strain(self, p: sp.Expr, D: sp.Expr, n: int = 0) -> sp.Expr:
        # A power's unit of τ takes up the spacing and the factor k of F′ (`Cell.time_scale`). The
        # force that is left, with F′ = p^{k-1}, is that of the spacing 1, divided by k.
        return super().of_strain(p, sp.S.One, n) / self.k

    def inverse(self, force: sp.Expr) -> sp.Expr:
        return power(real(force, "force"), 1 / self.k)


@dataclass(frozen=True, repr=False)
class Law(ContactLaw):
    """A law F(δ) given by an expression. Laws of one F are equal, whatever their names.

    Parameters
    ----------
    F : SymPy expression
        The force.
    delta : symbol
        The symbol of the compression in F.
    name, parameters : str, tuple
        Name and parameters, as `named` takes them.

    Raises
    ------
    InputError
        For a force that does not depend on δ, and for text.

    Examples
    --------
    >>> x = sp.Symbol("x", positive=True)
    >>> Law(x + x**2, x).phi(2)
    2*x/(2*x + 1)
    """

    def __repr__(self) -> str:
        if self.name:
            return f"named({', '.join(map(repr, (self.name, *self.parameters)))})"
        return f"Law(F={self.F}, delta={self.delta})"

    def __post_init__(self) -> None:
        if not isinstance(self.delta, sp.Symbol):
            raise InputError(
                f"delta is {shorten(self.delta)}: the symbol of δ in F is wanted"
            )
        if not isinstance(self.F, sp.Expr) or self.F.diff(self.delta).is_zero:
            fault = f"a SymPy expression that depends on {self.delta} is wanted"
            raise InputError(f"F is {shorten(self.F)}: {fault}")
        # Floats are taken for the decimals that they print.
        self._set(F=read_exact(self.F, "F"))


def general() -> Law:
    """A law without an expression: results hold φ_2, φ_3, … as the symbols phi2, phi3, ….

    >>> general().F
    F(delta)
    """
    return Law(sp.Function("F")(DELTA), name="general")


# Mapping from a name to the force, or the law itself, as a function of the law's parameters.
_NAMED: Mapping[str, Callable[..., Any]] = {
    "power": Power,
    "hertz": lambda: Power(EXPONENT),
    "hertz2": lambda a, b: a * DELTA**EXPONENT + b * DELTA ** (EXPONENT + 1),
    "exponential": lambda a: (sp.exp(a * DELTA) - 1) / a,
    "magnetic": lambda n, d: (1 - DELTA / d) ** (-n) - 1,
    "polynomial": lambda a, b: DELTA + a * DELTA**2 + b * DELTA**3,
    "lennard-jones": lambda d: (1 - DELTA / d) ** -13 - (1 - DELTA / d) ** -7,
    "general": general,
}
NAMES = tuple(_NAMED)
"""The names of laws."""


def named(name: str, *parameters: Any) -> ContactLaw:
    """Make a law by its name.

    - power: ``δ^k``.
    - hertz: ``δ^{3/2}``, a power, of spheres.
    - hertz2: ``a δ^{3/2} + b δ^{5/2}``, Hertz and its next order.
    - exponential: ``(e^{aδ} - 1)/a``, Toda's.
    - magnetic: ``(1 - δ/d)^{-n} - 1``, poles at the distance d - δ that repel with its power -n.
    - polynomial: ``δ + a δ² + b δ³``, of Fermi, Pasta, Ulam and Tsingou; a and b of either sign.
    - lennard-jones: ``(1 - δ/d)^{-13} - (1 - δ/d)^{-7}``, d the distance of rest.
    - general: a law without an expression (`general`).

    Parameters
    ----------
    name : str
        One of these names.
    *parameters : numbers or symbols
        In the order of the formula (magnetic: n, d); those that are not given are symbols.

    Returns
    -------
    ContactLaw

    Raises
    ------
    InputError
        For other names, too many parameters, and bad values.

    Examples
    --------
    >>> named("hertz2", 1, "1/10").F
    delta**(5/2)/10 + delta**(3/2)
    """
    build = _NAMED[one_of(name, NAMES, "law")]
    letters = list(signature(build).parameters)
    if len(parameters) > len(letters):
        wanted = ", ".join(letters) or "none"
        raise InputError(
            f"law is {name} with {len(parameters)} parameters: {wanted} are wanted"
        )
    # Only the corrections of a polynomial may soften a contact.
    read = signed if name == "polynomial" else positive
    values = []
    for letter, given in zip_longest(letters, parameters):
        place = f"law is {name}, whose {letter}"
        value = read(letter if given is None else given, place)
        values.append(_check_parameter(value, place, DELTA))
    force = build(*values)
    # "power", "hertz" and "general" build the law itself.
    if isinstance(force, ContactLaw):
        return force
    return Law(force, DELTA, name, tuple(values))


def read_law(value: Any, name: str) -> ContactLaw:
    """Read a law from its name and parameters.

    Parameters
    ----------
    value : str
        Name and parameters, such as "hertz2:1,2" or "power".
    name : str
        Name of the value in messages.

    Returns
    -------
    ContactLaw

    Raises
    ------
    InputError
        For anything else; nothing is evaluated.
    """
    if not isinstance(value, str):
        raise InputError(
            f"{name} is {shorten(value)}: a text such as 'hertz2:1,2' is wanted"
        )
    # Without a colon all parameters are symbols.
    title, colon, parameters = value.partition(":")
    return named(title.strip(), *(parameters.split(",") if colon else ()))


def _check_parameter(value: sp.Expr, name: str, delta: sp.Symbol) -> sp.Expr:
    """Return a law's parameter; raise `lwa.InputError` if it holds the compression's symbol."""
    if delta.name in {s.name for s in value.free_symbols}:
        raise InputError(
            f"{name} is {delta.name!r}: the name means the compression of a contact"
        )
    return value


def phi_symbol(n: int) -> sp.Symbol:
    """The symbol of φ_n in results."""
    return sp.Symbol(f"phi{n}", real=True)


def for_cell(law: Any, cell: Cell, k: Any = symbol_k) -> ContactLaw:
    """Return the law of a cell's contacts.

    Parameters
    ----------
    law : ContactLaw or None
    cell : Cell
    k : number or symbol
        Exponent of the power that stands for None.

    Returns
    -------
    ContactLaw

    Raises
    ------
    InputError
        For anything but a law or None, for a law besides an exponent, and for unlike contacts under
        a law that is no power.
    """
    # `k != symbol_k` alone would be an array if k is one.
    if law is not None and (not isinstance(k, sp.Symbol) or k != symbol_k):
        raise InputError(
            f"k is {shorten(k)} and law {shorten(law)}: one of them is wanted"
        )
    if law is None:
        law = Power(k)
    if not isinstance(law, ContactLaw):
        raise InputError(
            f"law is {shorten(law)}: Power(k), Law(F, delta) or general() is wanted"
        )
    if not (read_cell(cell).equal_contacts or law.homogeneous):
        raise InputError(
            "the contacts differ in stiffness, and their shares of the strain would then depend on "
            "the strain: only a power law allows that",
            stiffnesses=(),
        )
    return law


def power_exponent(law: ContactLaw | None, cell: Cell, k: Any, why: str) -> sp.Expr:
    """Return the exponent of the power law of a cell's contacts.

    Parameters
    ----------
    law : ContactLaw or None
    cell : Cell
    k : number or symbol
        Exponent of the power that stands for None.
    why : str
        End of the message that refuses other laws.

    Returns
    -------
    expression

    Raises
    ------
    InputError
        For a law that is no power, and as `for_cell`.
    """
    contact = for_cell(law, cell, k)
    if not contact.homogeneous:
        raise InputError(f"law is {contact.text}: {why}")
    return contact.exponent
