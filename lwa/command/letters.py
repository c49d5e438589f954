"""The letters of each command's output: no symbol of a caller may be called like one of them.

`lwa.cell.RESERVED` are those that stand in results themselves; these are the ones that a command
prints beside them, on the left of an equals sign or in its text.
"""

from __future__ import annotations

import re
from collections.abc import Iterable

import sympy as sp

from lwa.base.exact import InputError

EQUATION = "u w x t tau τ λ δ F G H"
LETTERS = {
    "derive": EQUATION,
    "wave": "u v x z t tau τ δ F G H p a mu μ eta η sigma σ s xi ξ β π",
    "dispersion": "t tau τ δ kappa κ Omega Ω q",
    "expansion": "t δ F c epsilon ε xi ξ",
}
_NUMBERED = {"derive": "b"}
"""Letters that stand there with an index."""


def demand_own(command: str, values: Iterable[sp.Expr]) -> None:
    """Refuse symbols called like a letter of the command's output.

    >>> demand_own("wave", [sp.Symbol("m1") + sp.Symbol("p")])  # doctest: +ELLIPSIS
    Traceback (most recent call last):
    lwa.base.exact.InputError: 'p' has a meaning of its own in what `lwa wave` prints: ...
    """
    letters = LETTERS[command].split()
    numbered = re.compile(rf"{_NUMBERED[command]}[0-9]+") if command in _NUMBERED else None
    for name in sorted({s.name for value in values for s in value.free_symbols}):
        if name in letters or (numbered and numbered.fullmatch(name)):
            raise InputError(
                f"{name!r} has a meaning of its own in what `lwa {command}` prints: use another "
                "name"
            )
