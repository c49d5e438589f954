"""A symmetric splitting of y'' = F(y)/m, with its coefficients.

A step of h applies kick 0, drift 0, kick 1, drift 1, …: a kick adds b h F(y)/m to v, a drift adds
a h v to y. It is symplectic and time-reversible, and keeps the momentum to rounding.

Source: Blanes and Moan 2002, J. Comput. Appl. Math. 142, 313, SRKN_14^a, as printed, to all digits.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lwa.base.arrays import Array


@dataclass(frozen=True, eq=False)
class Splitting:
    """Coefficients of a splitting: b of the kicks, a of the drifts; the first kick is 0."""

    order: int
    kicks: Array
    drifts: Array

    @property
    def stages(self) -> int:
        """Number of evaluations of the forces per step."""
        return len(self.kicks) - 1


def _mirrored(order: int, kicks: list[float], drifts: list[float]) -> Splitting:
    """Complete palindromic coefficients from their first halves.

    The coefficients in the middle, which are not given, make both sums 1.
    """
    b = [*kicks, 0.5 - sum(kicks)]
    a = [*drifts, 1 - 2 * sum(drifts)]
    return Splitting(order, np.array([0.0, *b, *b[::-1]]), np.array([*a, *drifts[::-1]]))


# fmt: off
SRKN14 = _mirrored(6,
    [0.09171915262446165, 0.183983170005006, -0.05653436583288827, 0.004914688774712854,
     0.143761127168358, 0.328567693746804],
    [0.0378593198406116, 0.102635633102435, -0.0258678882665587, 0.314241403071447,
     -0.130144459517415, 0.106417700369543, -0.00879424312851058])
# fmt: on
