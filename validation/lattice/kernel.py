"""The loops of the compiled engine; `validation.lattice.engine` says what they do and why.

Those over all beads hold no branch, and contiguous arrays, so that they vectorise. They are in one
file, as numba's cache does not notice a change in another one.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any, NamedTuple, TypeVar

import numpy as np
from numba import njit
from numpy.typing import NDArray

from lwa.base.arrays import Array

MARGIN = 4  # still beads that the window holds at its front
SHORTEST = 32  # beads below which the vector loops take no less time
BLOCK = 8  # what the window's length is a multiple of: the doubles of the widest vector register
WIDTH = 5  # stages that are added up at a time
_STILL = 1e-13  # of the peak compression: beads that have moved less are still
_NOTHING = 1e-60  # of the greatest compression: open, lest the front decay into denormal numbers
_NEAR = 0.5  # of a contact's greater compression at the ends of a step: a kink is near
_STEADY = 0.5  # of the greater closing speed at the ends of a step
_SLIGHT = 10.0  # times the error that is allowed: what a contact near a kink may bring about
_FAR = 1.0  # steps that it may be away
_EVEN = 0.2  # of the greatest q: the least


class Chain(NamedTuple):
    """Inverse masses; contacts' stiffnesses, rest compressions and loads; their law, and k."""

    inverse: Array
    A: Array
    rest: Array
    load: Array
    law: int
    k: float


class Beads(NamedTuple):
    """y and v, and as they may be after the step that is tried; when beads were left behind.

    force : (stages, padded + 1), by stage that on each bead from behind, less its load.
    sums : (4, padded + 1), of stages: one for all, then the impulses of a step and the errors of
        displacement and velocity that they bring.
    kinks : (padded + 1, 7), of the step: contact, root r and coefficients of q.
    """

    y: Array
    v: Array
    next_y: Array
    next_v: Array
    left: Array
    force: Array
    sums: Array
    kinks: Array


class Samples(NamedTuple):
    """Times; the watched beads, and y, v (W, S) there.

    knots : (3, 4, W), y, v, y'' and y''' at the ends of the last two steps, by turns.
    room : (17, 12), for one bead at a time.
    """

    time: Array
    watched: NDArray[np.int_]
    knots: Array
    y: Array
    v: Array
    room: Array


class Tableau(NamedTuple):
    """kicks, drifts : of a splitting. nodes, rows, ends : of a pair; lower : its lower order.
    points : nodes and weights of ∫ u^k q(u) du from 0 to 1.
    """

    kicks: Array
    drifts: Array
    nodes: Array
    rows: Array
    ends: Array
    lower: int
    points: Array


class Plan(NamedTuple):
    """A scheme, its first step, and what it moves: ``size`` beads, or a window of them.

    y, v : the errors of a step that are allowed. h : the first step. longest : the longest of a
    pair. deepest : the greatest compression. quickest : stiffness over the least mass.
    window : number of beads that are followed behind the front; 0 for the whole chain.
    """

    scheme: Tableau
    y: float
    v: float
    h: float
    longest: float
    end: float
    deepest: float
    quickest: float
    size: int
    window: int


_COUNTS = ("steps", "tries", "evaluations", "front", "lo", "done", "begin", "stop", "kink", "kinks")
_REALS = ("t", "h", "before", "lost")
_PLACE = np.dtype([(name, int) for name in _COUNTS] + [(name, float) for name in _REALS])


def beginning(plan: Plan, front: int) -> Any:
    """The state of an integration at its start: a record that `advance` changes.

    steps, tries, evaluations : their numbers; evaluations times the beads that each one moves.
    front, lo : the first bead that is still, the first one that is followed.
    done : samples that are taken. begin, stop : watched beads that are followed.
    kink : the last step in which a contact opened or closed.
    kinks : those that the last step corrects for.
    t, h, before : the time, the next step, the last step.
    lost : elastic energy of the contacts that the window has cut.
    """
    at = np.zeros(1, _PLACE)[0]
    at["front"], at["h"] = front, plan.h
    return at


_Function = TypeVar("_Function", bound=Callable[..., Any])
# Without "reassoc" rounding does not depend on the order of a sum, without "nnan" and "ninf" an
# overflow is seen; in numba's own error model every division by zero would be an exception's way
# out. Nothing is allocated: to count the references to arrays takes longer than the arithmetic.
_OPTIONS: Any = dict(
    fastmath={"nsz", "arcp", "contract"}, error_model="numpy", nogil=True, _nrt=False
)
_compiled: Callable[[_Function], _Function] = njit(cache=True, **_OPTIONS)
# Sums and maxima in the order of the machine's registers, the same in every run.
_summed: Callable[[_Function], _Function] = njit(
    cache=True, **_OPTIONS | {"fastmath": {"nsz", "arcp", "contract", "reassoc"}}
)
# Written out where it is called: to pass the arrays would take as long as the rest.
_part: Callable[[_Function], _Function] = njit(inline="always", **_OPTIONS)
# An index without a sign is never one from the end, which would keep a loop from vectorising.
_index = np.uint64
_ZERO, _ONE, _TWO, _THREE = map(_index, range(4))


@_part
def _press(chain: Chain, y: Array, force: Array, s: Any, lo: int, hi: int, nothing: float) -> None:
    """The forces ahead of the beads lo … hi-1, less their loads, as those of a stage."""
    A, rest, load, law, k = chain.A, chain.rest, chain.load, chain.law, chain.k
    if law == 3:
        for i in range(_index(lo), _index(hi)):
            d = rest[i] + y[i] - y[i + _ONE]
            d = d if d > nothing else 0.0
            force[s, i + _ONE] = A[i] * (d * np.sqrt(d)) - load[i]
    elif law == 1:
        for i in range(_index(lo), _index(hi)):
            d = rest[i] + y[i] - y[i + _ONE]
            d = d if d > nothing else 0.0
            force[s, i + _ONE] = A[i] * d - load[i]
    elif law == 2:
        for i in range(_index(lo), _index(hi)):
            d = rest[i] + y[i] - y[i + _ONE]
            d = d if d > nothing else 0.0
            force[s, i + _ONE] = A[i] * (d * np.sqrt(np.sqrt(d))) - load[i]
    elif law == 4:
        for i in range(_index(lo), _index(hi)):
            d = rest[i] + y[i] - y[i + _ONE]
            d = d if d > nothing else 0.0
            force[s, i + _ONE] = A[i] * (d * d) - load[i]
    elif law == 5:
        for i in range(_index(lo), _index(hi)):
            d = rest[i] + y[i] - y[i + _ONE]
            d = d if d > nothing else 0.0
            force[s, i + _ONE] = A[i] * (d * d * d) - load[i]
    else:
        for i in range(_index(lo), _index(hi)):
            d = rest[i] + y[i] - y[i + _ONE]
            d = d if d > nothing else 0.0
            force[s, i + _ONE] = A[i] * d**k - load[i]


@_compiled
def _split(chain: Chain, beads: Beads, plan: Plan, h: float, lo: int, hi: int) -> None:
    """One step of a splitting, of the beads lo … hi-1."""
    nothing, kicks, drifts = _NOTHING * plan.deepest, plan.scheme.kicks, plan.scheme.drifts
    y, v, force, inverse = beads.y, beads.v, beads.force, chain.inverse
    for s in range(len(drifts)):
        if s > 0:  # the first kick is 0
            _press(chain, y, force, _ZERO, lo, hi, nothing)
        b, a = h * kicks[s], h * drifts[s]
        for i in range(_index(lo), _index(hi)):
            u = v[i] + b * (force[_ZERO, i] - force[_ZERO, i + _ONE]) * inverse[i]
            v[i] = u
            y[i] = y[i] + a * u


@_part
def _add_up(
    sums: Array, q: Any, force: Array, table: Array, row: int, scale: float, stages: int, lo: int,
    hi: int,
) -> None:  # fmt: skip
    """scale Σ_j table[row, j] force[j] over the first stages."""
    sums[q, lo] = 0.0
    for first in range(0, stages, WIDTH):
        a, b = scale * table[row, first], scale * table[row, first + 1]
        c, d = scale * table[row, first + 2], scale * table[row, first + 3]
        e = scale * table[row, first + 4]
        j = _index(first)
        j1, j2, j3, j4 = j + _ONE, j + _index(2), j + _index(3), j + _index(4)
        if first == 0:
            for i in range(_index(lo) + _ONE, _index(hi) + _ONE):
                sums[q, i] = (
                    a * force[j, i] + b * force[j1, i] + c * force[j2, i] + d * force[j3, i]
                    + e * force[j4, i]
                )  # fmt: skip
        else:
            for i in range(_index(lo) + _ONE, _index(hi) + _ONE):
                sums[q, i] += (
                    a * force[j, i] + b * force[j1, i] + c * force[j2, i] + d * force[j3, i]
                    + e * force[j4, i]
                )  # fmt: skip


@_summed
def _square(sums: Array, inverse: Array, lo: int, hi: int) -> float:
    """Σ over the beads of the squares of their errors."""
    total = 0.0
    for i in range(_index(lo), _index(hi)):
        y = (sums[_TWO, i] - sums[_TWO, i + _ONE]) * inverse[i]
        v = (sums[_THREE, i] - sums[_THREE, i + _ONE]) * inverse[i]
        total += y * y + v * v
    return total


@_part
def _attempt(chain: Chain, beads: Beads, plan: Plan, at: Any, h: float, hi: int) -> float:
    """One step of a pair, of the beads lo … hi-1: its greatest error over that which is allowed."""
    lo, nothing, stages = at.lo, _NOTHING * plan.deepest, len(plan.scheme.nodes)
    y, v, next_y, next_v = beads.y, beads.v, beads.next_y, beads.next_v
    inverse, rest, force, sums = chain.inverse, chain.rest, beads.force, beads.sums
    rows, ends, nodes = plan.scheme.rows, plan.scheme.ends, plan.scheme.nodes
    for s in range(1, stages):
        _add_up(sums, _ZERO, force, rows, s, h * h, s, lo, hi)
        ch = nodes[s] * h
        behind = 0.0
        for i in range(_index(lo), _index(hi)):
            ahead = sums[_ZERO, i + _ONE]
            next_y[i] = y[i] + ch * v[i] + (behind - ahead) * inverse[i]
            behind = ahead
        _press(chain, next_y, force, _index(s), lo, hi, nothing)
    _add_up(sums, _ONE, force, ends, 0, h, stages, lo, hi)
    _add_up(sums, _TWO, force, ends, 1, h * h / plan.y, stages, lo, hi)
    _add_up(sums, _THREE, force, ends, 2, h / plan.v, stages, lo, hi)
    for i in range(_index(lo), _index(hi)):
        next_v[i] = v[i] + (sums[_ONE, i] - sums[_ONE, i + _ONE]) * inverse[i]
    at.kinks = 0
    # Kinks within the step or near it, of contacts that move at about one speed and may count.
    least = (_SLIGHT * plan.v / (h * plan.quickest)) ** (1.0 / chain.k)
    near = 0
    for i in range(_index(lo), _index(hi)):
        before = rest[i] + y[i] - y[i + _ONE]
        after = rest[i] + next_y[i] - next_y[i + _ONE]
        most = max(before, after)
        kinked = (most > least) & (min(before, after) < _NEAR * most)
        sums[_ZERO, i + _ONE] = most if kinked else 0.0
        near += 1 if kinked else 0
    if near > 0:
        _kinks(chain, beads, plan, at, h, hi)
    return math.sqrt(_square(sums, inverse, lo, hi))


@_part
def _power(chain: Chain, q: float) -> float:
    q = max(q, 0.0)
    return float(q * np.sqrt(q) if chain.law == 3 else q**chain.k)


@_part
def _quintic(c0: float, c1: float, c2: float, c3: float, c4: float, c5: float, x: float) -> float:
    return c0 + x * (c1 + x * (c2 + x * (c3 + x * (c4 + x * c5))))


@_summed
def _ramp(chain: Chain, points: Array, kink: Array, z: float) -> tuple[float, float]:
    """∫∫ and ∫ of p_+^k, from its root r to z, for p = (z - r) q(z)."""
    root, q0, q1, q2, q3, q4 = kink[1], kink[2], kink[3], kink[4], kink[5], kink[6]
    side = z - root
    once = twice = 0.0
    if side * q0 > 0.0:
        for m in range(points.shape[1]):
            part = points[0, m]
            q = _quintic(q0, q1, q2, q3, q4, 0.0, root + side * part)
            f = points[1, m] * _power(chain, side * q)
            once += f
            twice += f * (1.0 - part)
    return side * side * twice, side * once


@_summed
def _pair_sums(
    chain: Chain, scheme: Tableau, c0: float, c1: float, c2: float, c3: float, c4: float, c5: float
) -> tuple[float, float, float, float]:  # fmt: skip
    """What the pair makes of ∫ and ∫∫ of p_+^k over a step, and its errors of both."""
    nodes, last = scheme.nodes, len(scheme.nodes) - 1
    once = twice = error = error_once = 0.0
    for s in range(last + 1):
        f = _power(chain, _quintic(c0, c1, c2, c3, c4, c5, nodes[s]))
        once += scheme.ends[0, s] * f
        twice += scheme.rows[last, s] * f
        error += scheme.ends[1, s] * f
        error_once += scheme.ends[2, s] * f
    return twice, once, error, error_once


@_part
def _correct(chain: Chain, beads: Beads, plan: Plan, at: Any, h: float, i: int) -> None:
    """Contact i opens or closes in a step or near it: take the pair's error in its impulse off.

    Its compression is about the quintic p with δ, δ' and δ'' of both ends, with one root r. On the
    closed side p is (x - r) q(x), and ∫ |x - r|^k q^k dx is a Gauss–Jacobi sum. The pair integrates
    what is left of the force, which is smoother.
    """
    y, v, inverse, force, scheme = beads.y, beads.v, chain.inverse, beads.force, plan.scheme
    c0 = chain.rest[i] + y[i] - y[i + 1]
    end = chain.rest[i] + beads.next_y[i] - beads.next_y[i + 1]
    c1 = h * (v[i] - v[i + 1])
    c2 = h * h * _relative(force[0], inverse, i) / 2
    r0 = end - c0 - c1 - c2
    r1 = h * (beads.next_v[i] - beads.next_v[i + 1]) - c1 - 2 * c2
    r2 = h * h * _relative(force[len(scheme.nodes) - 1], inverse, i) - 2 * c2
    c3, c4, c5 = 10 * r0 - 4 * r1 + r2 / 2, -15 * r0 + 7 * r1 - r2, 6 * r0 - 3 * r1 + r2 / 2
    rising = end > c0
    low, high, x = 0.0, 1.0, c0 / (c0 - end)
    if c0 * end >= 0.0:
        low, high = (-_FAR, 0.0) if rising else (1.0, 1.0 + _FAR)
        if _quintic(c0, c1, c2, c3, c4, c5, low if rising else high) >= 0.0:
            return
    for _ in range(30):  # Newton's method, or else the middle
        p = _quintic(c0, c1, c2, c3, c4, c5, x)
        slope = c1 + x * (2 * c2 + x * (3 * c3 + x * (4 * c4 + x * 5 * c5)))
        low, high = (low, x) if (p > 0.0) == rising else (x, high)
        guess = x - p / slope
        guess = guess if low < guess < high else (low + high) / 2
        x, moved = guess, abs(guess - x)
        if moved < 1e-9:  # its square is left
            break
    q3 = c4 + x * c5
    q2 = c3 + x * q3
    q1 = c2 + x * q2
    q0 = c1 + x * q1
    sign = 1.0 if rising else -1.0
    start, finish = sign * q0, sign * (q0 + q1 + q2 + q3 + c5)
    root = sign * (q0 + x * (q1 + x * (q2 + x * (q3 + x * c5))))
    if min(start, finish, root) < _EVEN * max(start, finish, root):
        return
    kink = beads.kinks[at.kinks]
    kink[0], kink[1], kink[2], kink[3], kink[4], kink[5], kink[6] = i, x, q0, q1, q2, q3, c5
    twice, once = _ramp(chain, scheme.points, kink, 1.0)
    start_twice, start_once = _ramp(chain, scheme.points, kink, 0.0)
    pair_twice, pair_once, error, error_once = _pair_sums(chain, scheme, c0, c1, c2, c3, c4, c5)
    impulse = chain.A[i] * h * (once - start_once - pair_once)
    moment = chain.A[i] * h * h * (twice - start_twice - start_once - pair_twice)
    # What is taken off moves the contact by e ~ u^{k+2} from the root on, so that p is not quite
    # its compression: where ∫ k A p^{k-1} e counts, the pair's own estimate is the better judge.
    most = max(c0, end)
    stiff = chain.k * chain.A[i] * _power(chain, most) / most
    apart = (inverse[i] + inverse[i + 1]) * abs(moment)
    if h * stiff * apart * max(inverse[i], inverse[i + 1]) > (2.0 * chain.k + 2.0) * plan.v:
        return
    at.kinks += 1
    beads.next_v[i] -= impulse * inverse[i]
    beads.next_v[i + 1] += impulse * inverse[i + 1]
    beads.next_y[i] -= moment * inverse[i]
    beads.next_y[i + 1] += moment * inverse[i + 1]
    beads.sums[2, i + 1] -= chain.A[i] * h * h * error / plan.y
    beads.sums[3, i + 1] -= chain.A[i] * h * error_once / plan.v


@_part
def _kinks(chain: Chain, beads: Beads, plan: Plan, at: Any, h: float, hi: int) -> None:
    """Correct for the kinks of contacts whose greater compression is in the first sum."""
    y, v, next_y, next_v = beads.y, beads.v, beads.next_y, beads.next_v
    inverse, rest = chain.inverse, chain.rest
    for i in range(at.lo, hi):
        most = beads.sums[0, i + 1]
        if most > 0.0:
            within = (rest[i] + y[i] - y[i + 1]) * (rest[i] + next_y[i] - next_y[i + 1]) < 0.0
            if within:
                at.kink = at.steps + 1
            speed, later = v[i] - v[i + 1], next_v[i] - next_v[i + 1]
            steady = min(speed / later, later / speed) > _STEADY
            kick = h * chain.A[i] * _power(chain, most) * max(inverse[i], inverse[i + 1])
            counts = kick > _SLIGHT * plan.v and plan.scheme.points.shape[1] > 0
            if counts and (within or steady):
                _correct(chain, beads, plan, at, h, i)


@_part
def _relative(force: Array, inverse: Array, i: int) -> float:
    """The acceleration of bead i less that of the next."""
    near, far = (force[i] - force[i + 1]) * inverse[i], (force[i + 1] - force[i + 2])
    return float(near - far * inverse[i + 1])


@_part
def _accepted(chain: Chain, beads: Beads, plan: Plan, at: Any, h: float, hi: int) -> bool:
    """Try a step of a pair, choose the next one by its error, and tell whether it is made."""
    error = _attempt(chain, beads, plan, at, h, hi)
    if not error <= 1.0:
        shrink = 0.9 * error ** (-1.0 / (plan.scheme.lower + 1)) if error < 1e9 else 0.0
        at.h = h * max(0.1, shrink)
        if not error < 1e9:
            beads.force[1:] = 0.0  # overflows must not last
        return False
    for i in range(_index(at.lo), _index(hi)):
        beads.y[i], beads.v[i] = beads.next_y[i], beads.next_v[i]
    _press(chain, beads.y, beads.force, _ZERO, at.lo, hi, _NOTHING * plan.deepest)
    grow = 0.9 * max(error, 1e-9) ** (-1.0 / (plan.scheme.lower + 1))
    at.h = min(plan.longest, h * min(5.0, grow))
    return True


@_part
def _bond(chain: Chain, beads: Beads, i: int, lo: int) -> tuple[float, float]:
    """The force of contact i, less its load, and its rate; 0 where it is cut."""
    d = chain.rest[i] + beads.y[i] - beads.y[i + 1]
    if i < lo or d <= 0.0:
        return (0.0 if i < lo else -chain.load[i]), 0.0
    root = np.sqrt(d) if chain.law == 3 else d ** (chain.k - 1.0)
    stiff = chain.A[i] * root
    return stiff * d - chain.load[i], chain.k * stiff * (beads.v[i] - beads.v[i + 1])


@_part
def _knot(chain: Chain, beads: Beads, seen: Samples, at: Any, turn: int) -> None:
    """y and its first three derivatives at the watched beads."""
    knot = seen.knots[turn]
    for q in range(at.begin, at.stop):
        j = seen.watched[q]
        back, back_rate = _bond(chain, beads, j - 1, at.lo) if j > 0 else (0.0, 0.0)
        force, rate = _bond(chain, beads, j, at.lo)
        knot[0, q], knot[1, q] = beads.y[j], beads.v[j]
        knot[2, q] = (back - force) * chain.inverse[j]
        knot[3, q] = (back_rate - rate) * chain.inverse[j]


@_part
def _bend(chain: Chain, plan: Plan, kink: Array, j: int, h: float, z: float) -> tuple[float, float]:
    """What a kink adds to the displacement and velocity of bead j."""
    unit = chain.A[int(kink[0])] * chain.inverse[j] * h * (1.0 if kink[0] < j else -1.0)
    twice, once = _ramp(chain, plan.scheme.points, kink, z)
    return unit * h * twice, unit * once


@_part
def _smooth(chain: Chain, beads: Beads, plan: Plan, at: Any, knots: Array, j: int, h: float) -> int:
    """Take what kinks add off the knots of bead j at the ends of the step; their number."""
    count = 0
    for n in range(at.kinks):
        kink = beads.kinks[n]
        i = int(kink[0])
        if i != j and i + 1 != j:
            continue
        count += 1
        unit = chain.A[i] * chain.inverse[j] * (1.0 if i < j else -1.0)
        for end in range(2):
            knot = knots[(at.steps - 1 + end) % 3]
            y, v = _bend(chain, plan, kink, j, h, end)
            q = kink[2] + end * (kink[3] + kink[4] + kink[5] + kink[6])
            rise = kink[3] + end * (2 * kink[4] + 3 * kink[5] + 4 * kink[6])
            p, slope = (end - kink[1]) * q, q + (end - kink[1]) * rise
            knot[0] -= y
            knot[1] -= v
            if p > 0.0:
                force = unit * _power(chain, p)
                knot[2] -= force
                knot[3] -= chain.k * force / p * slope / h
    return count


@_part
def _sample(
    chain: Chain, beads: Beads, plan: Plan, seen: Samples, at: Any, h: float, due: int
) -> None:
    """The samples within a step: Hermite's polynomial of the knots of two steps, in Newton's form.

    Its order is 12; 8, in one step, where a contact opens or closes in them, and in the first.
    What the kinks of a bead's own contacts add is not interpolated.
    """
    x, d, knots, inverse = seen.room[0], seen.room[1], seen.room[2:5], seen.room[5:]
    x[:4], x[4:8], x[8:] = 0.0, 1.0, -at.before / h
    for j in range(1, 12):
        for i in range(j, 12):
            inverse[j, i] = 1.0 / (x[i] - x[i - j]) if x[i] != x[i - j] else 0.0
    new, old, older = at.steps % 3, (at.steps - 1) % 3, (at.steps - 2) % 3
    for q in range(at.begin, at.stop):
        bead = seen.watched[q]
        for turn in range(3):
            for j in range(4):
                knots[turn, j] = seen.knots[turn, j, q]
        kinks = _smooth(chain, beads, plan, at, knots, bead, h)
        size = 12 if at.steps - at.kink > 1 and kinks == 0 else 8
        for i in range(size):
            d[i] = knots[old if i < 4 else new if i < 8 else older, 0]
        scale = 1.0
        for j in range(1, size):
            scale *= h / j
            for i in range(size - 1, j - 1, -1):
                if inverse[j, i] == 0.0:
                    d[i] = scale * knots[old if i < 4 else new if i < 8 else older, j]
                else:
                    d[i] = (d[i] - d[i - 1]) * inverse[j, i]
        for s in range(at.done, due):
            z = (seen.time[s] - at.t) / h
            p, slope = d[size - 1], 0.0
            for i in range(size - 2, -1, -1):
                slope = p + (z - x[i]) * slope
                p = d[i] + (z - x[i]) * p
            y, v = p, slope / h
            for n in range(at.kinks if kinks > 0 else 0):
                if beads.kinks[n, 0] == bead or beads.kinks[n, 0] + 1 == bead:
                    more, faster = _bend(chain, plan, beads.kinks[n], bead, h, z)
                    y, v = y + more, v + faster
            seen.y[q, s], seen.v[q, s] = y, v
    at.done = due


@_part
def _follow(chain: Chain, beads: Beads, plan: Plan, at: Any) -> None:
    """Move the front with the first bead that is still, and the rear of a window behind it."""
    while at.front < plan.size and abs(beads.y[at.front - MARGIN]) > _STILL * plan.deepest:
        at.front += 1
    while plan.window > 0 and at.front - at.lo > plan.window:
        lo = at.lo
        force, _ = _bond(chain, beads, lo, lo)
        at.lost += force * max(beads.y[lo] - beads.y[lo + 1], 0.0) / (chain.k + 1)
        beads.left[lo] = at.t
        at.lo = lo + 1
        for s in range(len(beads.force)):
            beads.force[s, lo + 1] = 0.0


@_compiled
def advance(chain: Chain, beads: Beads, plan: Plan, seen: Samples, at: Any, tries: int) -> float:
    """Integrate on from where the beads are, to the end or by so many tries; the time there.

    Beads that are left behind stay as they were then.
    """
    until, time, watched = at.tries + tries, seen.time, seen.watched
    stages = max(len(plan.scheme.nodes), len(plan.scheme.drifts)) - 1
    if at.tries == 0:
        _press(chain, beads.y, beads.force, _ZERO, 0, plan.size, 0.0)
        at.stop = len(watched)
        for turn in range(3):
            _knot(chain, beads, seen, at, turn)
        at.stop = 0
    while at.t < plan.end and at.tries < until:
        hi = at.lo + max(SHORTEST, -(-(at.front - at.lo) // BLOCK) * BLOCK)
        while at.stop < len(watched) and watched[at.stop] < hi:
            at.stop += 1
        while at.begin < at.stop and watched[at.begin] < at.lo:
            at.begin += 1
        at.tries += 1
        at.evaluations += stages * (hi - at.lo)
        h, pair = at.h, len(plan.scheme.nodes) > 0
        later = at.t + h if pair else (at.steps + 1) * h
        if later > plan.end - 1e-9 * h:
            later, h = plan.end, plan.end - at.t
        if not pair:
            _split(chain, beads, plan, h, at.lo, hi)
        elif not _accepted(chain, beads, plan, at, h, hi):
            continue
        at.steps += 1
        due = at.done
        while due < len(time) and time[due] <= later:
            due += 1
        _knot(chain, beads, seen, at, at.steps % 3)
        if due > at.done:
            _sample(chain, beads, plan, seen, at, h, due)
        at.t, at.before = later, h
        _follow(chain, beads, plan, at)
    return float(at.t)
