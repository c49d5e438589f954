"""Contact laws F(δ): powers, expressions, and the laws with names.

A law enters the theory through dimensionless functions of the compression δ,

    φ_n = δ^{n-1} F^{(n)}(δ) / F'(δ),    φ_1 = 1,

which for δ^k are the numbers (k-1) … (k-n+1). The force of a contact is A F(δ), A its stiffness in
the cell. The shares of unlike contacts in the strain are the same at every strain only for a power.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from itertools import zip_longest
from typing import Any, ClassVar

import mpmath
import sympy as sp
from sympy.core.function import AppliedUndef

from lwa.base import latex
from lwa.base.calculus import growing_root, integral, ratio
from lwa.base.exact import (
    InputError,
    demand_numbers,
    integer,
    one_of,
    positive,
    power,
    read_exact,
    real,
    shorten,
    signed,
)
from lwa.base.frozen import Value
from lwa.cell import Cell, exponent, read_cell, substitution
from lwa.cell import k as symbol_k

DELTA = sp.Symbol("delta", positive=True)
"""δ, the compression of a contact, unless the caller names another symbol."""


class ContactLaw(Value):
    """A contact force F(δ): base of `Power` and `Law`; ``homogeneous`` if F(sδ) = s^k F(δ).

    name, parameters : those of `named`; "" and () for a law without a name.
    """

    F: sp.Expr
    delta: sp.Symbol
    name: str
    parameters: tuple[sp.Expr, ...]
    homogeneous: ClassVar[bool] = False

    @property
    def text(self) -> str:
        """Name and parameters as `read_law` reads them, such as "hertz2:1,2"; F without a name."""
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
        """The k of A_i^{-1/k} by which unlike contacts share the strain; 1 where all are alike."""
        return sp.S.One

    def slope(self, n: int = 1) -> sp.Expr:
        """The n-th derivative F^{(n)}(δ)."""
        return self.F.diff(self.delta, integer(n, "n", 0))

    @cached_property
    def energy(self) -> sp.Expr:
        """The energy W(δ) of a contact, W′ = F."""
        if self.formless:
            s = sp.Dummy("s", positive=True)
            return sp.Integral(self.F.subs(self.delta, s), (s, 0, self.delta))
        return integral(self.F, self.delta)

    def phi(self, n: int) -> sp.Expr:
        """The parameter φ_n = δ^{n-1} F^{(n)}/F′ as an expression in δ."""
        return ratio(
            self.delta ** (integer(n, "n", 1) - 1) * self.slope(n), self.slope()
        )

    @property
    def pulls(self) -> bool:
        """True if the contact also holds where δ < 0: laws with F′(0) > 0 that are no power."""
        known = not (self.homogeneous or self.formless)
        return known and bool(self.slope().subs(self.delta, 0).is_positive)

    def at(self, delta: Any, n: int = 0) -> Any:
        """The force F, or its n-th derivative, at a compression: a number, an expression, an array.

        The force is 0 where δ < 0, unless the law `pulls`. Raises `lwa.InputError` for text, NaN,
        infinities and complex numbers.

        >>> Power("3/2").at(4), Power("3/2").at(-1), Power("3/2").at([-1, 4])
        (8, 0, array([0., 8.]))
        """
        value = self.slope(n)
        if not isinstance(delta, list | tuple) and getattr(delta, "ndim", 0) == 0:
            delta = real(delta, "delta")
            closed = self.pulls or not delta.is_negative
            return value.subs(self.delta, delta) if closed else sp.S.Zero

        import numpy as np  # here: the command starts before NumPy does

        from lwa.base.arrays import finite, function_of

        demand_numbers(self.symbols, "an array of forces needs numbers for the law")
        compressions = finite(delta, "delta")
        pushed = compressions if self.pulls else np.maximum(compressions, 0.0)
        with np.errstate(divide="ignore"):  # derivatives of powers at 0
            forces = function_of(self.delta, value)(pushed)
        return np.where(compressions < pushed, 0.0, forces)

    @property
    def formless(self) -> bool:
        """True if F is a function without an expression, as that of `general`."""
        return bool(self.F.atoms(AppliedUndef))

    def of_strain(self, p: sp.Expr, D: sp.Expr, n: int = 0) -> sp.Expr:
        """The n-th derivative of F at the strain p, in the units of u_ττ = F′(u_x) u_xx.

        For n = 0 this is F(Dp)/D (p^k/k for a power), for n = -1 the energy W.
        """
        p, D = real(p, "p"), real(D, "D")
        # Each derivative by p instead of δ = D p brings a factor D, each integral 1/D.
        if n < 0:
            return self.energy.subs(self.delta, D * p) / D**2
        return self.at(D * p, n) * D ** (n - 1)

    def check_strain(self, p: sp.Expr, cell: Cell, sound: bool = False) -> None:
        """Raise `lwa.InputError` unless F is real up to the strain p and grows there, F′ > 0.

        Symbols are accepted, a spacing as 1; F′(0) = 0 is accepted unless ``sound`` is wanted.
        """
        D = cell.spacing
        delta = (D * real(p, "p")).xreplace({D: sp.S.One} if D.is_Symbol else {})
        if self.homogeneous or self.formless or (delta.is_zero and not sound):
            return
        for factor in self.F.atoms(sp.Pow):
            start, end = (factor.base.subs(self.delta, x) for x in (0, delta))
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
        """The mean compression of a cell's contacts that push with this force, to 35 digits.

        Raises `lwa.InputError` for a force beyond the law's reach, and for symbols.
        """
        if self.formless:
            raise InputError(
                f"law is {self.text}: the strain under a force needs an expression"
            )
        needed = (
            real(force, "force") / cell.stiffnesses[0]
        )  # F(δ) of a contact of unit stiffness
        free = needed.free_symbols | self.F.free_symbols - {self.delta}
        demand_numbers(free, f"the load under the law {self.text} needs numbers")
        with mpmath.workdps(50):
            root = growing_root(self.F - needed, self.delta)
            if root is None:
                raise InputError(
                    f"force is {shorten(force)}: the law does not reach it"
                )
            # 35 digits leave 15 of the rise of a wave that is 1e-20 of the load.
            return sp.Float(root, 35)

    def replaced(self, new: Mapping[sp.Symbol, sp.Expr]) -> ContactLaw:
        """The law with the values that `lwa.cell.substitution` gives for its symbols."""
        raise NotImplementedError


@dataclass(frozen=True)
class Power(ContactLaw):
    """The power law F = δ^k, k > 0 a number or a symbol."""

    k: sp.Expr
    F: sp.Expr = field(init=False, repr=False)
    delta: sp.Symbol = field(init=False, repr=False, default=DELTA)
    name: str = field(init=False, repr=False, default="power")
    parameters: tuple[sp.Expr, ...] = field(init=False, repr=False)
    homogeneous: ClassVar[bool] = True

    def __post_init__(self) -> None:
        k = exponent(self.k)
        for name, value in (("k", k), ("F", DELTA**k), ("parameters", (k,))):
            object.__setattr__(self, name, value)

    @property
    def exponent(self) -> sp.Expr:
        return self.k

    @cached_property
    def energy(self) -> sp.Expr:
        return self.delta ** (self.k + 1) / (self.k + 1)

    def phi(self, n: int) -> sp.Expr:
        return sp.Mul(*(self.k - j for j in range(1, n)))

    def of_strain(self, p: sp.Expr, D: sp.Expr, n: int = 0) -> sp.Expr:
        p = real(p, "p")
        # p^k/k derived n times: (k-1) … (k-n+1) p^{k-n}; n = -1: p^{k+1}/(k (k+1))
        up, down = (
            sp.Mul(*(self.k - j for j in r)) for r in (range(1, n), range(n, 1))
        )
        return up / down * p ** (self.k - n)

    def compression(self, cell: Cell, force: sp.Expr) -> sp.Expr:
        return power(real(force, "force") / cell.stiffness(self.k), 1 / self.k)

    def replaced(self, new: Mapping[sp.Symbol, sp.Expr]) -> Power:
        return Power(self.k.xreplace(new))


@dataclass(frozen=True, repr=False)
class Law(ContactLaw):
    """A law F(δ) given by a SymPy expression and its symbol ``delta`` of the compression.

    Laws of one F are equal, whatever their names. Raises `lwa.InputError` if F′ = 0, and for text.

    >>> x = sp.Symbol("x", positive=True)
    >>> Law(x + x**2, x).phi(2)
    2*x/(2*x + 1)
    """

    F: sp.Expr
    delta: sp.Symbol = DELTA
    name: str = field(default="", compare=False)
    parameters: tuple[sp.Expr, ...] = field(default=(), compare=False)

    def __repr__(self) -> str:
        if self.name:
            return f"named({', '.join(map(repr, (self.name, *self.parameters)))})"
        return f"Law(F={self.F}, delta={self.delta})"

    def __post_init__(self) -> None:
        if not isinstance(self.delta, sp.Symbol):
            raise InputError(
                f"delta is {shorten(self.delta)}: the symbol of δ in F is wanted"
            )
        if not isinstance(self.F, sp.Expr) or self.delta not in self.F.free_symbols:
            fault = f"a SymPy expression in {self.delta} is wanted"
            raise InputError(f"F is {shorten(self.F)}: {fault}")
        object.__setattr__(self, "F", read_exact(self.F, "F"))
        if self.slope().is_zero:
            raise InputError(
                f"F is {shorten(self.F)}: a force that depends on δ is wanted"
            )

    def replaced(self, new: Mapping[sp.Symbol, sp.Expr]) -> ContactLaw:
        if self.name:
            return named(self.name, *(x.xreplace(new) for x in self.parameters))
        for symbol in self.symbols:
            _check_parameter(new.get(symbol, symbol), str(symbol), self.delta)
        return Law(self.F.xreplace(new), self.delta)


def general() -> Law:
    """A law without an expression: results hold φ_2, φ_3, … as the symbols phi2, phi3, ….

    >>> general().F
    F(delta)
    """
    return Law(sp.Function("F")(DELTA), name="general")


_HERTZ = sp.Rational(3, 2)
# Names → letters of the parameters, and the force (or the law itself) as a function of them.
_NAMED: Mapping[str, tuple[str, Callable[..., Any]]] = {
    "power": ("k", Power),
    "hertz2": ("a b", lambda a, b: a * DELTA**_HERTZ + b * DELTA ** (_HERTZ + 1)),
    "exponential": ("a", lambda a: (sp.exp(a * DELTA) - 1) / a),
    "magnetic": ("n d", lambda n, d: (1 - DELTA / d) ** (-n) - 1),
    "polynomial": ("a b", lambda a, b: DELTA + a * DELTA**2 + b * DELTA**3),
    "lennard-jones": ("d", lambda d: (1 - DELTA / d) ** -13 - (1 - DELTA / d) ** -7),
    "general": ("", general),
}
NAMES = tuple(_NAMED)
"""The names of laws."""


def named(name: str, *parameters: Any) -> ContactLaw:
    """Make a law by its name; parameters that are not given are symbols.

    - power: δ^k.
    - hertz2: a δ^{3/2} + b δ^{5/2}, Hertz and its next order.
    - exponential: (e^{aδ} - 1)/a, Toda's.
    - magnetic: (1 - δ/d)^{-n} - 1, poles at the distance d - δ that repel with its power -n.
    - polynomial: δ + a δ² + b δ³, of Fermi, Pasta, Ulam and Tsingou; a and b of either sign.
    - lennard-jones: (1 - δ/d)^{-13} - (1 - δ/d)^{-7}, d the distance of rest.
    - general: a law without an expression (`general`).

    Raises `lwa.InputError` for other names, too many parameters, and bad values.

    >>> named("hertz2", 1, "1/10").F
    delta**(5/2)/10 + delta**(3/2)
    """
    text, build = _NAMED[one_of(name, NAMES, "law")]
    letters = text.split()
    if len(parameters) > len(letters):
        wanted = f"at most {len(letters)} ({', '.join(letters)})" if letters else "none"
        raise InputError(
            f"law {name} has {len(parameters)} parameters: {wanted} are wanted"
        )
    read = signed if name == "polynomial" else positive
    values = []
    for letter, value in zip_longest(letters, parameters):
        place = f"{name}'s {letter}"
        values.append(
            _check_parameter(
                read(letter if value is None else value, place), place, DELTA
            )
        )
    force = build(*values)
    if isinstance(force, ContactLaw):
        return force
    return Law(force, DELTA, name, tuple(values))


def read_law(value: Any, name: str) -> ContactLaw:
    """Read a law from its name and parameters, such as "hertz2:1,2"; ``name`` is for messages."""
    if not isinstance(value, str):
        raise InputError(
            f"{name} is {shorten(value)}: a text such as 'hertz2:1,2' is wanted"
        )
    title, colon, parameters = value.partition(":")
    return named(title.strip(), *(parameters.split(",") if colon else ()))


def _check_parameter(value: sp.Expr, name: str, delta: sp.Symbol) -> sp.Expr:
    """Return a law's parameter; raise `lwa.InputError` if it holds the compression's symbol."""
    if delta.name in {s.name for s in value.free_symbols}:
        raise InputError(
            f"{name} {delta.name!r}: the name means the compression of a contact"
        )
    return value


def phi_symbol(n: int) -> sp.Symbol:
    """The symbol of φ_n in results."""
    return sp.Symbol(f"phi{n}", real=True)


def for_cell(law: Any, cell: Cell, k: Any = symbol_k) -> ContactLaw:
    """Return the law of a cell's contacts; the power k without a law.

    Raises `lwa.InputError` for anything but a law or None, for a law besides an exponent, and for
    unlike contacts under a law that is no power.
    """
    if law is not None and (
        not isinstance(k, sp.Symbol) or k != symbol_k
    ):  # k may be an array
        raise InputError(
            f"k is {shorten(k)} and law {shorten(law)}: one of them is wanted"
        )
    law = Power(k) if law is None else law
    if not isinstance(law, ContactLaw):
        raise InputError(
            f"law is {shorten(law)}: Power(k), Law(F, delta) or general() is wanted"
        )
    if len(set(read_cell(cell).stiffnesses)) > 1 and not law.homogeneous:
        raise InputError(
            "the contacts differ in stiffness, and their shares of the strain would then depend on "
            "the strain: only a power law allows that"
        )
    return law


def substituted(
    values: Mapping[str, Any], cell: Cell, law: ContactLaw, *expressions: sp.Expr
) -> tuple[Any, ...]:
    """Substitute values in a cell, a law and expressions, as `lwa.cell.substitution`."""
    others = set().union(*(x.free_symbols for x in expressions)) - {
        *cell.symbols,
        *law.symbols,
    }
    new = substitution(values, cell, more=(*law.symbols, *sorted(others, key=str)))
    return (
        cell.replaced(new),
        law.replaced(new),
        *(x.xreplace(new) for x in expressions),
    )
