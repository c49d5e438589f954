"""Range of validity of a profile F = exp Σ a_d ξ^d with a truncated series in the exponent.

The profile falls from its peak; further out the truncated polynomial may rise again.
"""

from __future__ import annotations

import math
from collections.abc import Mapping

import sympy as sp

POINTS = 401
"""Places at which a profile is evaluated."""

DEEP = 40.0
"""Fall of log F from the peak beyond which a profile is taken as zero."""


def descent(
    whole: Mapping[int, float], last: Mapping[int, float]
) -> tuple[tuple[sp.Expr, sp.Expr], float, float]:
    """Interval around the peak in which exp Σ a ξ^d falls, and two checks of the series.

    whole, last : d → a_d of the series, and of its last order alone.

    Returns the ends of the interval, rounded inwards; the higher of the two values at the ends over
    the peak; and the largest change of the profile by the last order, over the peak. Both ratios
    are infinite where the series has no peak.
    """
    import numpy as np  # start-up: `import lwa` does not load it
    from numpy.polynomial import Polynomial  # likewise

    log, more = (Polynomial([a.get(d, 0.0) for d in range(max(whole) + 1)]) for a in (whole, last))
    roots = log.deriv().roots()
    turns = np.sort(roots.real[np.abs(roots.imag) <= 1e-9 * np.abs(roots)])
    peak = min(turns, key=abs)
    left, right = turns[turns < peak].max(initial=-np.inf), turns[turns > peak].min(initial=np.inf)
    ends = (-_inwards(-float(left)), _inwards(float(right)))
    if not log.deriv(2)(peak) < 0:
        return ends, math.inf, math.inf
    fallen = max(
        (float(np.exp(log(x) - log(peak))) for x in (left, right) if np.isfinite(x)), default=0.0
    )
    width = math.sqrt(2 * DEEP / -log.deriv(2)(peak))
    xi = np.linspace(max(left, peak - width), min(right, peak + width), POINTS)
    force = np.exp(log(xi) - log(peak))
    return ends, fallen, float(np.max(force * np.minimum(np.abs(more(xi)), 1.0)))


def _inwards(end: float) -> sp.Expr:
    return sp.Rational(math.floor(1000 * end), 1000) if math.isfinite(end) else sp.oo
