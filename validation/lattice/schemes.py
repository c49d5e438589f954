"""Coefficients of the compiled integrators.

`RKN86` is the default, an embedded Runge–Kutta–Nyström pair for y'' = f(y) with adaptive steps.
Stage s evaluates f at y + c_s h v + h² Σ a_sj f_j, with Σ_j a_sj = c_s²/2. A step ends at

    y + h v + h² Σ b_j f_j,    v + h Σ b'_j f_j,

and differs from a solution of lower order by h² Σ e_j f_j and h Σ e'_j f_j, its error. The last
stage is at the step's end, and is the first of the next step: its row of a is b.

`BLANES_MOAN` is a symmetric splitting of y'' = F(y)/m, for long runs in which all beads move. A
step of h applies kick 0, drift 0, kick 1, drift 1, …, and a last kick: a kick adds b h F(y)/m to v,
a drift adds a h v to y. It is symplectic and time-reversible, and keeps the momentum to rounding.

Sources: Dormand, El-Mikkawy and Prince 1987, IMA J. Numer. Anal. 7, 423: RKN8(6)9FM. Blanes and
Moan 2002, J. Comput. Appl. Math. 142, 313: SRKN_6^b, of order 4, as printed, to all digits.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction

import numpy as np
from numpy.typing import NDArray

from lwa.base.arrays import Array

Exact = NDArray[np.object_]
"""Arrays of fractions."""


@dataclass(frozen=True, eq=False)
class Pair:
    """Coefficients of an embedded Runge–Kutta–Nyström pair; b is the last row of a.

    order, lower : orders of the two solutions. a : (S, S). speeds : b'. low, low_speeds : b and b'
    of the solution of lower order. All coefficients are fractions.
    """

    order: int
    lower: int
    a: Exact
    speeds: Exact
    low: Exact
    low_speeds: Exact

    @property
    def stages(self) -> int:
        """Number of evaluations of the forces per step."""
        return len(self.a) - 1

    def arrays(self, width: int) -> tuple[Array, Array, Array]:
        """Return the coefficients as float arrays: nodes c, matrix a, and the three rows b', e, e'.

        b' is `speeds`; e = b - `low` and e' = b' - `low_speeds` give the error estimates. The
        columns of the last two arrays are filled with zeros up to a multiple of ``width``.
        """
        ends = np.stack((self.speeds, self.a[-1] - self.low, self.speeds - self.low_speeds))
        zeros = ((0, 0), (0, -len(self.a) % width))
        a, ends = (np.pad(rows.astype(float), zeros) for rows in (self.a, ends))
        return np.sqrt((2 * self.a.sum(axis=1)).astype(float)), a, ends


def _pair(order: int, lower: int, rows: str, *ends: str) -> Pair:
    """Read the rows of a, and b', b and b' of lower order, one a line, without trailing zeros."""
    table = [row.split() for row in ("", *rows.strip().splitlines(), *ends)]
    size = len(table) - len(ends)
    full = np.array([[*map(Fraction, row), *[Fraction(0)] * (size - len(row))] for row in table])
    return Pair(order, lower, full[:size], *full[size:])


RKN86 = _pair(
    8, 6,
    """
    1/800
    1/600 1/300
    9/200 -9/100 9/100
    -66701/197352 28325/32892 -2665/5482 2170/24669
    227015747/304251000 -54897451/30425100 12942349/10141700 -9499/304251 539/9250
    -1131891597/901789000 41964921/12882700 -6663147/3220675 270954/644135 -108/5875 114/1645
    13836959/3667458 -17731450/1833729 1063919505/156478208 -33213845/39119552 13335/28544 -705/14272 1645/57088
    223/7938 0 1175/8064 925/6048 41/448 925/14112 1175/72576 0
    """,  # noqa: E501
    "223/7938 0 5875/36288 4625/21168 41/224 4625/21168 5875/36288 223/7938 0",
    "7987313/109941300 0 1610737/44674560 10023263/33505920 -497221/12409600 10023263/78180480"
    " 1610737/402071040",
    "7987313/109941300 0 1610737/40207104 10023263/23454144 -497221/6204800 10023263/23454144"
    " 1610737/40207104 -4251941/54970650 3/20",
)  # fmt: skip


@dataclass(frozen=True, eq=False)
class Splitting:
    """Coefficients of a splitting: b of the kicks, one more than the a of the drifts."""

    order: int
    kicks: Array
    drifts: Array

    @property
    def stages(self) -> int:
        """Number of evaluations of the forces per step."""
        return len(self.drifts)


def _palindrome(order: int, kicks: list[float], drifts: list[float]) -> Splitting:
    """Complete palindromic coefficients from their first parts, so that both sums are 1."""
    a = [*drifts, 0.5 - sum(drifts)]
    return Splitting(
        order,
        np.array([*kicks, 1 - 2 * sum(kicks), *kicks[::-1]]),
        np.array([*a, *a[::-1]]),
    )


BLANES_MOAN = _palindrome(
    4,
    [0.0829844064174052, 0.396309801498368, -0.0390563049223486],
    [0.245298957184271, 0.604872665711080],
)

SCHEMES: dict[str, Pair | Splitting] = {"RKN86": RKN86, "symplectic": BLANES_MOAN}
