"""Names that the output of a command uses itself, and that no symbol of a caller may have.

`lwa.cell.RESERVED` holds the names that occur in results. This module adds the names that a command
prints to the left of an equals sign or elsewhere in its text.
"""

from __future__ import annotations

import re
from collections.abc import Iterable

import sympy as sp

from lwa.base.exact import InputError

EQUATION = "u w x t tau τ λ delta δ A F G H"
NAMES = {
    "derive": EQUATION,
    "wave": "u v x z t tau τ delta δ A F G H p a mu μ eta η sigma σ s xi ξ beta β π",
    "wave under load": "u v x t tau τ delta δ A F F0 I p0 xi ξ c0 alpha α gamma γ L",
    "envelope": "A F T U X i n t u Psi Ψ kappa κ omega ω chi χ Delta Δ a b delta δ",
    "shock": "A F x t delta δ c s v_p",
    "dispersion": "t tau τ delta δ A kappa κ Omega Ω q",
    "expansion": "t delta δ A F c epsilon ε xi ξ",
}
_NUMBERED = {"derive": "b"}
"""Names that a command prints with a number behind them, such as b1."""


def demand_free(output: str, values: Iterable[sp.Expr], own: str = "") -> None:
    """Refuse symbols with a name that an output, a key of `NAMES`, has for something else.

    own: the name that the command prints for these values, such as A for stiffnesses.

    >>> demand_free("wave", [sp.Symbol("m1") + sp.Symbol("p")])  # doctest: +ELLIPSIS
    Traceback (most recent call last):
    lwa.base.errors.InputError: 'p' has a meaning of its own in the output of `lwa wave`: ...
    """
    names = NAMES[output].split()
    numbered = re.compile(rf"{_NUMBERED[output]}[0-9]+") if output in _NUMBERED else None
    for name in sorted({s.name for value in values for s in value.free_symbols} - {own}):
        if name in names or (numbered and numbered.fullmatch(name)):
            raise InputError(
                f"{name!r} has a meaning of its own in the output of `lwa {output.split()[0]}`: "
                "use another name"
            )
