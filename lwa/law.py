"""The contact law F(δ) as a value: a power, any smooth expression, or no particular one.

The theory asks of a law only how it changes with the strain p = δ/D,

    φ_n = δ^{n-1} F^{(n)}(δ) / F'(δ),    φ_1 = 1,

which for δ^k are the numbers (k-1) … (k-n+1). A contact pushes with A F(δ), A the stiffness that
the cell gives it: unlike contacts share the strain alike at every strain only under a power.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import mpmath
import sympy as sp
from sympy.core.function import AppliedUndef

from lwa.base.exact import InputError, exact, positive, real, shorten
from lwa.base.frozen import Value
from lwa.cell import RESERVED, Cell, exponent, meant, unmistakable
from lwa.cell import k as symbol_k

DELTA = sp.Symbol("delta", positive=True)
"""δ, the compression of a contact, where the caller names no other symbol."""


TAKEN = {**RESERVED, "A": "the stiffness of a contact", "p0": "the strain ahead of a wave"}
"""Names that stand beside a law in results, and what they mean there."""


LARGE = 32
"""The exponent from which on a power of a sum is not multiplied out."""


class ContactLaw(Value):
    """What all laws have: F, its derivatives, its energy and its symbols."""

    F: sp.Expr
    delta: sp.Symbol

    @property
    def symbols(self) -> tuple[sp.Symbol, ...]:
        """The law's own symbols, by name."""
        return tuple(sorted(self.F.free_symbols - {self.delta}, key=str))

    def slope(self, n: int = 1) -> sp.Expr:
        """F^{(n)}(δ)."""
        return self.F.diff(self.delta, n)

    @cached_property
    def energy(self) -> sp.Expr:
        """W with W′ = F."""
        if self.F.atoms(AppliedUndef):
            s = sp.Dummy("s", positive=True)
            return sp.Integral(self.F.subs(self.delta, s), (s, 0, self.delta))
        parts = sp.Add.make_args(self.F) if _large(self.F) else (self.F,)
        return sp.Add(*(_integral(part, self.delta) for part in parts))

    def phi(self, n: int) -> sp.Expr:
        """φ_n = δ^{n-1} F^{(n)}/F′ as an expression in δ.

        >>> named("exponential", 1).phi(3)
        delta**2
        """
        top, bottom, large = _large_powers(self.delta ** (n - 1) * self.slope(n), self.slope())
        return sp.cancel(sp.powsimp(sp.expand(top) / sp.expand(bottom))).xreplace(large)

    def at(self, delta: sp.Expr, n: int = 0) -> sp.Expr:
        """F^{(n)} at a compression."""
        return self.slope(n).subs(self.delta, delta) if n else self.F.subs(self.delta, delta)


@dataclass(frozen=True)
class Power(ContactLaw):
    """F = δ^k, k > 0 a number or a symbol.

    >>> Power("3/2").phi(3)
    -1/4
    """

    k: sp.Expr
    F: sp.Expr = field(init=False, repr=False)
    delta: sp.Symbol = field(init=False, repr=False)

    def __post_init__(self) -> None:
        k = exponent(self.k)
        for name, value in (("k", k), ("F", DELTA**k), ("delta", DELTA)):
            object.__setattr__(self, name, value)

    @cached_property
    def energy(self) -> sp.Expr:
        return self.delta ** (self.k + 1) / (self.k + 1)

    def phi(self, n: int) -> sp.Expr:
        return sp.Mul(*(self.k - j for j in range(1, n)))

    def replaced(self, new: Mapping[sp.Symbol, sp.Expr]) -> Power:
        """With what `lwa.cell.substitution` gives for its symbols."""
        return Power(self.k.xreplace(new))


@dataclass(frozen=True)
class Law(ContactLaw):
    """F(δ), a SymPy expression in the symbol ``delta`` with F′ ≠ 0; `general` is one without form.

    Raises `lwa.InputError` for anything else: a text is not evaluated.

    >>> x = sp.Symbol("x", positive=True)
    >>> Law(x + x**2, x).phi(2)
    2*x/(2*x + 1)
    """

    F: sp.Expr
    delta: sp.Symbol = DELTA

    def __post_init__(self) -> None:
        if not isinstance(self.delta, sp.Symbol):
            raise InputError(f"delta is {shorten(self.delta)}: the symbol of δ in F is wanted")
        if not isinstance(self.F, sp.Expr) or self.delta not in self.F.free_symbols:
            raise InputError(
                f"F is {shorten(self.F)}: a SymPy expression in {self.delta} is wanted"
            )
        object.__setattr__(self, "F", meant(exact(self.F, "F"), "law", taken=TAKEN))
        unmistakable((self.delta, *self.symbols))
        if self.slope().is_zero:
            raise InputError(f"F is {shorten(self.F)}: a force that depends on δ is wanted")

    def replaced(self, new: Mapping[sp.Symbol, sp.Expr]) -> Law:
        """With what `lwa.cell.substitution` gives for its symbols."""
        for symbol in self.symbols:
            _uncaptured(new.get(symbol, symbol), str(symbol), self.delta)
        return Law(self.F.xreplace(dict(new)), self.delta)

    def evaluated(self, value: sp.Expr, delta: sp.Expr) -> sp.Expr:
        """An expression in φ_2, φ_3, … at a compression."""
        return value.xreplace({s: self._phi_at(s, delta) for s in value.free_symbols})

    def _phi_at(self, symbol: sp.Symbol, delta: sp.Expr) -> sp.Expr:
        n = symbol.name[3:]
        if not n.isdecimal() or symbol != phi_symbol(int(n)):
            return symbol
        return delta ** (int(n) - 1) * self.at(delta, int(n)) / self.at(delta, 1)

    @property
    def formless(self) -> bool:
        """Whether F is some function that is not given."""
        return bool(self.F.atoms(AppliedUndef))


def general() -> Law:
    """Any law: results hold φ_2, φ_3, … as the symbols phi2, phi3, ….

    >>> general().F
    F(delta)
    """
    return Law(sp.Function("F")(DELTA), DELTA)


def phi_symbol(n: int) -> sp.Symbol:
    """φ_n, as it stands in results."""
    return sp.Symbol(f"phi{n}", real=True)


def _large(*values: sp.Expr) -> set[sp.Expr]:
    """The powers b^e with |e| > `LARGE` in the values."""
    powers: set[sp.Expr] = set().union(*(value.atoms(sp.Pow) for value in values))
    return {power for power in powers if power.exp.is_Rational and abs(power.exp) > LARGE}


def _integral(value: sp.Expr, x: sp.Symbol) -> sp.Expr:
    """∫ value dx; of a large power of a linear base by its own rule, not multiplied out."""
    factor, power = value.as_independent(x, as_Add=False)
    base, e = power.as_base_exp()
    if _large(power) and not base.diff(x).has(x):
        return factor * base ** (e + 1) / (base.diff(x) * (e + 1))
    return sp.integrate(value, x, conds="none")


def _large_powers(*values: sp.Expr) -> tuple[Any, ...]:
    """The values with b^e, |e| > `LARGE`, written as c b^{e - e0}, and the mapping c → b^{e0}.

    The exponents of F′ and of F^{(n)} differ by a few, and c cancels in their ratio; b^e itself
    SymPy would multiply out, in e terms.
    """
    found: dict[sp.Expr, sp.Expr] = {}  # b → b^{e0}
    new: dict[sp.Expr, sp.Expr] = {}
    names: dict[sp.Expr, sp.Expr] = {}
    for power in sorted(_large(*values), key=sp.default_sort_key):
        first = found.setdefault(power.base, power)
        rest = power.exp - first.exp
        if rest.is_Integer and abs(rest) <= LARGE:
            c = names.setdefault(first, sp.Dummy("c", positive=True))
            new[power] = c * power.base**rest
    return *(x.xreplace(new) for x in values), {c: first for first, c in names.items()}


Builder = Callable[..., sp.Expr]

_HERTZ = sp.Rational(3, 2)
_NAMED: Mapping[str, tuple[tuple[str, ...], Builder]] = {
    "hertz2": (("a", "b"), lambda a, b: a * DELTA**_HERTZ + b * DELTA ** (_HERTZ + 1)),
    "exponential": (("a",), lambda a: (sp.exp(a * DELTA) - 1) / a),
    "magnetic": (("n", "d"), lambda n, d: (1 - DELTA / d) ** (-n) - 1),
    "polynomial": (("a", "b"), lambda a, b: DELTA + a * DELTA**2 + b * DELTA**3),
    "lennard-jones": (("d",), lambda d: (1 - DELTA / d) ** -13 - (1 - DELTA / d) ** -7),
}
_OF_EITHER_SIGN = ("polynomial",)
NAMES = ("power", *_NAMED, "general")
"""What `named` knows."""


def demand_one(k: Any, law: ContactLaw) -> None:
    """Refuse an exponent beside a law, of which one says all."""
    if k != symbol_k:
        raise InputError(f"k is {shorten(k)} and law {shorten(law)}: one of them is wanted")


def named(name: str, *parameters: Any) -> Power | Law:
    """A law by its name; parameters that are not given are symbols.

    - power: δ^k.
    - hertz2: a δ^{3/2} + b δ^{5/2}, Hertz and its next order.
    - exponential: (e^{aδ} - 1)/a, Toda's.
    - magnetic: (1 - δ/d)^{-n} - 1, a force r^{-n} of poles at the distance r = d - δ, over its
      value at δ = 0 and less it.
    - polynomial: δ + a δ² + b δ³, of Fermi, Pasta, Ulam and Tsingou; a and b of either sign.
    - lennard-jones: (1 - δ/d)^{-13} - (1 - δ/d)^{-7}, d the distance of rest.
    - general: any.

    Raises `lwa.InputError` for other names, too many parameters, and values that cannot be meant.

    >>> named("hertz2", 1, "1/10").F
    delta**(5/2)/10 + delta**(3/2)
    """
    if name == "general":
        _at_most(name, parameters, ())
        return general()
    if name == "power":
        _at_most(name, parameters, ("k",))
        return Power(*(parameters or ("k",)))
    if name not in _NAMED:
        raise InputError(f"law is {shorten(name)}: one of {', '.join(NAMES)} is wanted")
    letters, build = _NAMED[name]
    _at_most(name, parameters, letters)
    read = real if name in _OF_EITHER_SIGN else positive
    given = [*parameters, *letters[len(parameters) :]]
    values = [read(v, f"{name}'s {letter}") for v, letter in zip(given, letters, strict=True)]
    for value, letter in zip(values, letters, strict=True):
        _uncaptured(value, f"{name}'s {letter}", DELTA)
    return Law(build(*values), DELTA)


def _uncaptured(value: sp.Expr, name: str, delta: sp.Symbol) -> None:
    """Refuse a law's parameter that holds the symbol of the compression."""
    meant(value, name, taken={delta.name: "the compression of a contact"})


def _at_most(name: str, parameters: Sequence[Any], letters: tuple[str, ...]) -> None:
    if len(parameters) > len(letters):
        wanted = f"at most {len(letters)} ({', '.join(letters)})" if letters else "none"
        raise InputError(f"law {name} has {len(parameters)} parameters: {wanted} are wanted")


def for_cell(law: Any, cell: Cell) -> Power | Law:
    """The law, refused where the contacts of the cell cannot share it.

    Raises `lwa.InputError` for what is no law, and unlike contacts under a law that is no power:
    their shares of the strain would depend on the strain.
    """
    if not isinstance(law, Power | Law):
        raise InputError(f"law is {shorten(law)}: Power(k), Law(F, delta) or general() is wanted")
    if isinstance(law, Power):
        exponent(law.k, cell)
        return law
    if len(set(cell.stiffnesses)) > 1:
        raise InputError(
            "the contacts differ in stiffness, and their shares of the strain would then depend "
            "on the strain: only a power law allows that"
        )
    own = {s.name for s in cell.symbols}
    for symbol in (law.delta, *law.symbols):
        if symbol.name in own:
            raise InputError(f"{symbol.name} names both the law's and a property of the cell")
    for name in sorted(own | {s.name for s in law.symbols}):
        if name[:3] == "phi" and name[3:].isdecimal():
            raise InputError(f"{name!r} means φ_{name[3:]} of the law here: use another name")
    return law


def compression(cell: Cell, law: Power | Law, force: sp.Expr) -> sp.Expr:
    """The mean compression at which the contacts of a cell push with this force.

    Under a law that is no power it is a number of 35 digits.

    Raises `lwa.InputError` where such a law does not reach the force, or something is a symbol.
    """
    if isinstance(law, Power):
        return (force / cell.stiffness(law.k)) ** (1 / law.k)
    ratio = force / cell.stiffnesses[0]
    if free := ratio.free_symbols | law.F.free_symbols - {law.delta}:
        raise InputError(
            f"{min(map(str, free))!r} has no value: the load under {law.F} needs numbers"
        )
    with mpmath.workdps(40):
        F = sp.lambdify(law.delta, law.F - ratio, "mpmath")
        high = mpmath.mpf(2) ** -20
        low = mpmath.mpf(0)
        while (top := F(high)).imag == 0 and top < 0 and high < 2**40:
            low, high = high, high * mpmath.mpf("1.2")
        if not (top.imag == 0 and top >= 0):
            raise InputError(f"force is {shorten(force)}: the law does not reach it")
        return sp.Float(mpmath.findroot(F, (low, high), solver="anderson"), 35)
