"""Coefficients of the compiled integrators.

`RKN86`, an embedded Runge–Kutta–Nyström pair for ``y'' = f(y)``, is the default where forces depend
on displacements alone. `RK853` takes damped contacts, ``y'' = f(y, y')``. It is an explicit
Runge–Kutta pair in Nyström form: stage s evaluates f at ``y + c_s h v + h² Σ (A²)_sj f_j`` and
``v + h Σ A_sj f_j``, A the pair's matrix. The last stage of both pairs is at the step's end, and is
the first stage of the next step.

`BLANES_MOAN` is a symmetric splitting of ``y'' = F(y)/m``, for long runs in which all beads move. A
step of h applies kick 0, drift 0, kick 1, drift 1, …, and a last kick: a kick adds ``b h F(y)/m``
to v, a drift adds ``a h v`` to y. It is symplectic and time-reversible, and keeps the momentum to
rounding.

To add a pair, write its table, with a source, as a text of fractions or decimals, a row a line, and
read it:

1. for ``y'' = f(y)``, `_nystrom`: the rows of a, of which the last are the weights of the
   displacement and whose stage is at the step's end; the weights of the velocity; both weights of
   the less accurate solution;
2. for ``y'' = f(y, y')``, `_explicit`: the rows of a Runge–Kutta matrix, the last of them its
   weights; then the differences to the weights of one or two less accurate solutions;
3. name the power of h to which the estimated error is proportional, 1 + the less accurate order.

The number of stages is the table's, at most `validation.lattice.kernel.arrays.ROOM`.
`validation.lattice.engine` chooses the pair of a scene.

Sources: Dormand, El-Mikkawy and Prince 1987, IMA J. Numer. Anal. 7, 423: RKN8(6)9FM. Hairer,
Nørsett and Wanner, Solving Ordinary Differential Equations I, II.10: the pair of order 8 by Dormand
and Prince with errors of orders 5 and 3, with the digits of SciPy's DOP853. Blanes and Moan 2002,
J. Comput. Appl. Math. 142, 313: ``SRKN_6^b``, of order 4, as printed, to all digits.
"""

from __future__ import annotations

from fractions import Fraction

import numpy as np

from lwa.base.arrays import Array
from validation.lattice.kernel.arrays import ROOM, Pair, Splitting

_ROUNDING = 1e-25  # weights below are rounding, in a table of thirty digits


def _rows(table: str) -> Array:
    """Read exact fractions or decimals, a row a line; zeros fill the rows."""
    rows = []
    for line in table.splitlines():
        rows.append([Fraction(number) for number in line.split()])
    size = max(map(len, rows))
    for row in rows:
        row.extend([Fraction(0)] * (size - len(row)))
    return np.array(rows)


def _pair(
    nodes: Array,
    moments: Array,
    impulses: Array,
    errors: Array,
    thirds: Array,
    order: int,
) -> Pair:
    """Build an embedded pair from exact coefficients: arrays of a row, or a number, for each stage.

    h is the step, x, from 0 to 1, the time in it, f the acceleration as a function of x, c_s the
    place of stage s, and A the matrix of a Runge–Kutta pair:

    - ``nodes``, floats: the places c_s;
    - ``moments``: weights of ``∫ (c_s - x) f dx``, x up to c_s, which times h² moves stage s; the
      matrix a of a Nyström table, or A²; the last row is the step's;
    - ``impulses``: weights of ``∫ f dx``, which times h changes the velocity of stage s; A;
    - ``errors``: weights of the differences of step and less accurate solutions, rows of the
      displacement and of the velocity in turn;
    - ``thirds``: weights of ``∫ (1 - x)²/2 f dx``, the third integral of f; the velocity's weights
      times a, or the last row of A³. The error of f at a contact's kink changes the impulse of a
      neighbouring contact in proportion to this integral of it.

    The compiled loops sum moments, impulses and errors for all beads, several stages at a time:
    these three are padded by zeros (`_padded`). Nodes and thirds they read stage by stage.
    """
    return Pair(
        nodes=nodes,
        moments=_padded(moments),
        impulses=_padded(impulses),
        errors=_padded(errors),
        thirds=thirds.astype(float),
        order=order,
    )


def _padded(exact: Array) -> Array:
    """Return the weights of each row's stages as floats, with zeros up to `ROOM` columns.

    The compiled loops add up `validation.lattice.kernel.arrays.GROUP` stages at a time, and so read
    weights beyond the last stage.
    """
    weights = exact.astype(float)
    # A decimal that was rounded leaves 1e-31 in place of 0.
    weights[np.abs(weights) < _ROUNDING] = 0.0
    missing = ROOM - exact.shape[1]
    return np.pad(weights, ((0, 0), (0, missing)))


def _nystrom(table: str, order: int) -> Pair:
    """Read a pair for y'' = f(y)."""
    rows = _rows(table)
    # The last row of a holds the weights of the displacement. Then come those of the velocity, and
    # both of the less accurate solution.
    a = rows[:-3]
    speeds, low, low_speeds = rows[-3:]
    impulses = np.zeros_like(a)
    impulses[-1] = speeds
    errors = np.array((a[-1] - low, speeds - low_speeds))
    sums = a.sum(axis=1).astype(float)  # Σ_j a_sj = c_s²/2
    nodes = np.sqrt(2 * sums)
    return _pair(nodes, a, impulses, errors, speeds @ a, order)


def _explicit(table: str, order: int) -> Pair:
    """Read a pair for y'' = f(y, y')."""
    rows = _rows(table)
    stages = rows.shape[1] + 1
    # Fractions, so that the products below are exact. The last row is the step's end, whose stage
    # has no weight: its column stays 0.
    a = np.zeros((stages, stages), object) + Fraction(0)
    a[:, :-1] = rows[:stages]
    errors = []
    # Differences of the velocity's weights; those of the displacement's follow from them.
    for difference in rows[stages:]:
        full = np.array([*difference, Fraction(0)])
        errors += [full @ a, full]
    nodes = a.sum(axis=1).astype(float)
    # A integrates over time from 0 to each stage, A² twice. The last row of A³ integrates three
    # times up to the step's end: ∫ (1 - x)²/2 f dx.
    thirds = a[-1] @ a @ a
    return _pair(nodes, a @ a, a, np.array(errors), thirds, order)


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
    7987313/109941300 0 1610737/40207104 10023263/23454144 -497221/6204800 10023263/23454144 1610737/40207104 -4251941/54970650 3/20""",  # noqa: E501
    order=7,
)

RK853 = _explicit(
    """0
    0.0526001519587677318785587544488
    0.0197250569845378994544595329183 0.0591751709536136983633785987549
    0.0295875854768068491816892993775 0 0.0887627564304205475450678981324
    0.241365134159266685502369798665 0 -0.884549479328286085344864962717 0.924834003261792003115737966543
    0.037037037037037037037037037037 0 0 0.170828608729473871279604482173 0.125467687566822425016691814123
    0.037109375 0 0 0.170252211019544039314978060272 0.0602165389804559606850219397283 -0.017578125
    0.0370920001185047927108779319836 0 0 0.170383925712239993810214054705 0.107262030446373284651809199168 -0.0153194377486244017527936158236 0.00827378916381402288758473766002
    0.624110958716075717114429577812 0 0 -3.36089262944694129406857109825 -0.868219346841726006818189891453 27.5920996994467083049415600797 20.1540675504778934086186788979 -43.4898841810699588477366255144
    0.477662536438264365890433908527 0 0 -2.48811461997166764192642586468 -0.590290826836842996371446475743 21.2300514481811942347288949897 15.2792336328824235832596922938 -33.2882109689848629194453265587 -0.0203312017085086261358222928593
    -0.93714243008598732571704021658 0 0 5.18637242884406370830023853209 1.09143734899672957818500254654 -8.14978701074692612513997267357 -18.5200656599969598641566180701 22.7394870993505042818970056734 2.49360555267965238987089396762 -3.0467644718982195003823669022
    2.27331014751653820792359768449 0 0 -10.5344954667372501984066689879 -2.00087205822486249909675718444 -17.9589318631187989172765950534 27.9488845294199600508499808837 -2.85899827713502369474065508674 -8.87285693353062954433549289258 12.3605671757943030647266201528 0.643392746015763530355970484046
    0.0542937341165687622380535766363 0 0 0 0 4.45031289275240888144113950566 1.89151789931450038304281599044 -5.8012039600105847814672114227 0.31116436695781989440891606237 -0.152160949662516078556178806805 0.201365400804030348374776537501 0.0447106157277725905176885569043
    0.01312004499419488073250102996 0 0 0 0 -1.225156446376204440720569753 -0.4957589496572501915214079952 1.664377182454986536961530415 -0.350328848749973681688648729 0.3341791187130174790297318841 0.08192320648511571246570742613 -0.02235530786388629525884427845
    -0.1898007540724076157147023288757 0 0 0 0 4.45031289275240888144113950566 1.89151789931450038304281599044 -5.8012039600105847814672114227 -0.422682321323791962932445679177 -0.152160949662516078556178806805 0.201365400804030348374776537501 0.0226517921983608258118062039631""",  # noqa: E501
    order=8,
)

_KICKS = 0.0829844064174052, 0.396309801498368, -0.0390563049223486
_DRIFTS = 0.245298957184271, 0.604872665711080
# Kicks add up to 1, drifts too, and both read the same backwards: the middle kick and the middle
# drifts, which are equal, follow from the others.
_HALF = [*_DRIFTS, 0.5 - sum(_DRIFTS)]
BLANES_MOAN = Splitting(
    np.array([*_KICKS, 1 - 2 * sum(_KICKS), *_KICKS[::-1]]),
    np.array([*_HALF, *_HALF[::-1]]),
)
