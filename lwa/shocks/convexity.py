"""The sign of F″ between two strains, which decides what the front between them is.

If F″ keeps its sign between the strains, the front is one shock or one rarefaction.
With an inflection of F between them it is a kink or a compound wave (LeFloch, *Hyperbolic Systems
of Conservation Laws*, 2002, ch. 2), which this theory does not have.
"""

from __future__ import annotations

from itertools import pairwise

import mpmath
import sympy as sp

from lwa.base.calculus import real_function
from lwa.base.exact import InputError
from lwa.loaded.background import Background
from lwa.shocks.edges import SHOCK_DIGITS

_PLACES = 128  # intervals on which F″ that is no polynomial is checked


def demand_one_sign(field: Background, start: sp.Expr, end: sp.Expr) -> None:
    """Raise `lwa.InputError` unless F″ keeps its sign between two strains.

    F″ is checked exactly where it is a polynomial, else at 127 places. Powers pass, and so do laws
    and strains with symbols.
    """
    x = sp.Dummy("x", real=True)
    bend = field.force(x, 2)
    if field.law.homogeneous or (bend + start + end).free_symbols - {x}:
        return
    low, high = sorted((start, end))
    if bend.is_polynomial(x):
        roots = sp.Poly(bend, x).real_roots(multiple=False) if bend.has(x) else []
        found = [root for root, times in roots if times % 2 and low < root < high]
    else:
        curve = real_function(sp.lambdify(x, bend, "mpmath"))
        with mpmath.workdps(SHOCK_DIGITS):
            ends = (mpmath.mpf(sp.N(p, SHOCK_DIGITS)) for p in (low, high))
            places = mpmath.linspace(*ends, _PLACES + 1)[1:-1]
            signs = [mpmath.sign(curve(place)) for place in places]
        found = [
            b for b, (one, other) in zip(places[1:], pairwise(signs), strict=True) if one != other
        ]
    if found:
        raise InputError(
            f"F″ changes its sign at the strain {sp.N(found[0], 5)}, an inflection between "
            f"{sp.N(low, 5)} and {sp.N(high, 5)}: the wave is a kink or a compound one"
        )
