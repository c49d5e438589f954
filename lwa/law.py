"""Contact laws: powers, expressions, and the laws with names.

`lwa.force` says what the theory asks of a law.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, ClassVar

import sympy as sp

from lwa.base.exact import (
    InputError,
    one_of,
    positive,
    power,
    read_exact,
    shorten,
    signed,
)
from lwa.cell import RESERVED, Cell, check_distinct, check_names, exponent
from lwa.cell import k as symbol_k
from lwa.force import ContactLaw

DELTA = sp.Symbol("delta", positive=True)
"""δ, the compression of a contact, unless the caller names another symbol."""


TAKEN = {**RESERVED, "A": "the stiffness of a contact", "p0": "the strain ahead of a wave"}
"""Names that results use beside a law, and their meaning there."""


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
        # p^k/k derived n times: (k-1) … (k-n+1) p^{k-n}; n = -1: p^{k+1}/(k (k+1))
        up, down = (sp.Mul(*(self.k - j for j in r)) for r in (range(1, n), range(n, 1)))
        return up / down * p ** (self.k - n)

    def weight(self, p: sp.Expr, D: sp.Expr, a: sp.Expr, b: sp.Expr) -> sp.Expr:
        return p ** (a + b * self.k)  # p F′ = p^k

    def evaluated(self, value: sp.Expr, delta: sp.Expr) -> sp.Expr:
        return value

    def check_contacts(self, cell: Cell) -> None:
        exponent(self.k, cell)

    def compressions(self, cell: Cell, force: sp.Expr) -> tuple[sp.Expr, ...]:
        return tuple(power(force / A, 1 / self.k) for A in cell.stiffnesses)

    def compression(self, cell: Cell, force: sp.Expr) -> sp.Expr:
        return power(force / cell.stiffness(self.k), 1 / self.k)

    def replaced(self, new: Mapping[sp.Symbol, sp.Expr]) -> Power:
        return Power(self.k.xreplace(new))


@dataclass(frozen=True, repr=False)
class Law(ContactLaw):
    """A law F(δ) given by a SymPy expression and its symbol ``delta`` of the compression.

    name, parameters : those of `named`; laws of one F are equal, whatever their names.

    Raises `lwa.InputError` if F′ = 0, and for text, which is not evaluated.

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
            raise InputError(f"delta is {shorten(self.delta)}: the symbol of δ in F is wanted")
        if not isinstance(self.F, sp.Expr) or self.delta not in self.F.free_symbols:
            raise InputError(
                f"F is {shorten(self.F)}: a SymPy expression in {self.delta} is wanted"
            )
        object.__setattr__(self, "F", check_names(read_exact(self.F, "F"), "law", taken=TAKEN))
        check_distinct((self.delta, *self.symbols))
        if self.slope().is_zero:
            raise InputError(f"F is {shorten(self.F)}: a force that depends on δ is wanted")

    def replaced(self, new: Mapping[sp.Symbol, sp.Expr]) -> ContactLaw:
        if self.name:
            return named(self.name, *(x.xreplace(dict(new)) for x in self.parameters))
        for symbol in self.symbols:
            _check_parameter(new.get(symbol, symbol), str(symbol), self.delta)
        return Law(self.F.xreplace(dict(new)), self.delta)


def general() -> Law:
    """A law without an expression: results hold φ_2, φ_3, … as the symbols phi2, phi3, ….

    >>> general().F
    F(delta)
    """
    return Law(sp.Function("F")(DELTA), name="general")


def refuse_two_laws(k: Any, law: ContactLaw) -> None:
    """Raise `lwa.InputError` for an exponent beside a law, which already determines the force."""
    if k != symbol_k:
        raise InputError(f"k is {shorten(k)} and law {law.text}: one of them is wanted")


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
_OF_EITHER_SIGN = ("polynomial",)
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
        raise InputError(f"law {name} has {len(parameters)} parameters: {wanted} are wanted")
    read = signed if name in _OF_EITHER_SIGN else positive
    given = [*parameters, *letters[len(parameters) :]]
    places = [f"{name}'s {letter}" for letter in letters]
    values = [
        _check_parameter(read(value, place), place, DELTA)
        for value, place in zip(given, places, strict=True)
    ]
    force = build(*values)
    if isinstance(force, ContactLaw):
        return force
    return Law(force, name=name, parameters=tuple(values))


def read_law(value: Any, name: str) -> ContactLaw:
    """Read a law from its name and parameters, such as "hertz2:1,2"; ``name`` is for messages."""
    if not isinstance(value, str):
        raise InputError(f"{name} is {shorten(value)}: a text such as 'hertz2:1,2' is wanted")
    title, colon, parameters = value.partition(":")
    return named(title.strip(), *(parameters.split(",") if colon else ()))


def _check_parameter(value: sp.Expr, name: str, delta: sp.Symbol) -> sp.Expr:
    """Return a law's parameter; raise `lwa.InputError` if it holds the compression's symbol."""
    return check_names(value, name, taken={delta.name: "the compression of a contact"})
