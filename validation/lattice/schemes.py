"""Coefficients of the compiled integrators.

`RKN86`, an embedded Runge–Kutta–Nyström pair for y'' = f(y), is the default where forces depend on
displacements alone. `VERNER65` takes damped contacts, y'' = f(y, y'). It is an explicit
Runge–Kutta pair in Nyström form: stage s evaluates f at y + c_s h v + h² Σ (A²)_sj f_j and
v + h Σ A_sj f_j, A the pair's matrix. The last stage of both pairs is at the step's end, and is the
first stage of the next step.

`BLANES_MOAN` is a symmetric splitting of y'' = F(y)/m, for long runs in which all beads move. A
step of h applies kick 0, drift 0, kick 1, drift 1, …, and a last kick: a kick adds b h F(y)/m to v,
a drift adds a h v to y. It is symplectic and time-reversible, and keeps the momentum to rounding.

Sources: Dormand, El-Mikkawy and Prince 1987, IMA J. Numer. Anal. 7, 423: RKN8(6)9FM. Verner 2010,
Numer. Algorithms 53, 383: "most efficient" pair of orders 6 and 5, from the author's tables. Blanes
and Moan 2002, J. Comput. Appl. Math. 142, 313: SRKN_6^b, of order 4, as printed, to all digits.
"""

from __future__ import annotations

from fractions import Fraction

import numpy as np

from lwa.base.arrays import Array
from validation.lattice.kernel.arrays import Pair, Splitting


def _rows(table: str) -> Array:
    """Read exact fractions or decimals, a row a line; zeros fill the rows."""
    rows = [[Fraction(number) for number in row.split()] for row in table.splitlines()]
    size = max(map(len, rows))
    return np.array([row + [Fraction(0)] * (size - len(row)) for row in rows])


def _nystrom(table: str) -> Pair:
    """Read the rows of a, then b', b and b' of lower order; b is the last row of a."""
    rows = _rows(table)
    a, (speeds, low, low_speeds) = rows[:-3], rows[-3:]
    impulses = np.zeros_like(a)
    impulses[-1] = speeds
    errors = np.array((a[-1] - low, speeds - low_speeds))
    nodes = np.sqrt(2 * a.sum(axis=1).astype(float))
    a, impulses, errors, thirds = (
        x.astype(float) for x in (a, impulses, errors, speeds @ a)
    )
    return Pair(nodes, a, impulses, errors, thirds, 6)


def _explicit(table: str) -> Pair:
    """Read the rows of A, the last of them b, then b of lower order."""
    rows = _rows(table)
    a, low = rows[:-1], rows[-1]
    errors = np.array(((a[-1] - low) @ a, a[-1] - low))
    exact = a.sum(axis=1), a @ a, a, errors, a[-1] @ a @ a
    nodes, moments, a, errors, thirds = (x.astype(float) for x in exact)
    return Pair(nodes, moments, a, errors, thirds, 5)


RKN86 = _nystrom(
    """0
    1/800
    1/600 1/300
    9/200 -9/100 9/100
    -66701/197352 28325/32892 -2665/5482 2170/24669
    227015747/304251000 -54897451/30425100 12942349/10141700 -9499/304251 539/9250
    -1131891597/901789000 41964921/12882700 -6663147/3220675 270954/644135 -108/5875 114/1645
    13836959/3667458 -17731450/1833729 1063919505/156478208 -33213845/39119552 13335/28544 -705/14272 1645/57088
    223/7938 0 1175/8064 925/6048 41/448 925/14112 1175/72576 0 0
    223/7938 0 5875/36288 4625/21168 41/224 4625/21168 5875/36288 223/7938 0
    7987313/109941300 0 1610737/44674560 10023263/33505920 -497221/12409600 10023263/78180480 1610737/402071040
    7987313/109941300 0 1610737/40207104 10023263/23454144 -497221/6204800 10023263/23454144 1610737/40207104 -4251941/54970650 3/20"""  # noqa: E501
)

VERNER65 = _explicit(
    """0
    0.06
    0.019239962962962962962962962962 0.07669337037037037037037037037
    0.035975 0 0.107925
    1.318683415233148260919747276431 0 -5.042058063628562225427761634715 4.220674648395413964508014358283
    -41.872591664327514618037577806443 0 159.432562163137491770036566907034 -122.119213565010030920251620338924 5.531743066200053768252631238332
    -54.430156935316504332506420512941 0 207.06725136501846442736571738665 -158.610813784589999182874242436505 6.991816585950242321992597280791 -0.018597231062203233977651717995
    -54.663741787281976802412156480503 0 207.952806255389373451582481669983 -159.288957474499507150895980587142 7.018743740796944434698170760964 -0.018338785905045723064727820051 -0.000511948499788209907787543249
    0.034389578683570360092788201247 0 0 0.258262455563350340465955809858 0.420937118967353715064255151406 4.405396469669310170148836816197 -176.4831190242986576151740942499 172.36413340141507302940225827119
    0.049099676483824897309068549279 0 0 0.225111222951652415340139532053 0.469468225302956203943194852504 0.806579224998886770763416180899 0 -0.607119489177795979767295146525 0.056861139440475692411476031787"""  # noqa: E501
)

_KICKS = 0.0829844064174052, 0.396309801498368, -0.0390563049223486
_DRIFTS = 0.245298957184271, 0.604872665711080
_HALF = [*_DRIFTS, 0.5 - sum(_DRIFTS)]
BLANES_MOAN = Splitting(
    np.array([*_KICKS, 1 - 2 * sum(_KICKS), *_KICKS[::-1]]),
    np.array([*_HALF, *_HALF[::-1]]),
)

SCHEMES: dict[str, Pair | Splitting] = {"RKN86": RKN86, "symplectic": BLANES_MOAN}
