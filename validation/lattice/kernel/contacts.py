"""Damped contacts: their forces, their states, closed or open, and the changes of these.

A damped contact is closed while δ > 0 and its force, elastic and damping force together, is
positive. Its force has a kink, or jumps, where it closes or opens. Within a step a contact remains
closed or open, as it was at the beginning, so that its force is smooth; a step in which this is
wrong for a force that matters must end at the change.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from lwa.base.arrays import Array
from validation.lattice.kernel.arrays import Beads, Chain, Plan
from validation.lattice.kernel.compiled import ONE, call, index, part, summed
from validation.lattice.kernel.force import NEGLIGIBLE, power
from validation.lattice.kernel.kinks import Quintic, fitted_compression, quintic

_SLIGHT = 0.5  # least impulse of a contact whose change matters, in units of the tolerance
# A contact may change and change back between two stages, which are up to 0.27 steps apart. The
# force, if it is a parabola that touches 0 there, has at the stage next to it 0.12 of its value at
# an earlier stage; a gap that closes there would close at the rate at the stage before it.
_WEAK = 0.2  # closed contacts with less, in units of the greatest force, are looked at
_NEAR = 0.3  # open contacts that would close within this share of a step are looked at
_PLACES = 16  # places in a step at which a contact is looked at for its first change
_TOUCH = 1e-14  # in units of the greatest compression: contacts as near as this touch


def _loop(value: Any, resistance: Any) -> Any:
    """Compile a loop over contacts with the force A value(d) + c resistance(d) dδ/dt.

    least : compressions below it are 0. none : bound of compressions and forces of closed contacts,
    0, or -∞ for contacts that pull. reach : time within which a gap may close. The loop returns the
    dissipated power.
    """

    @summed
    def loop(
        chain: Chain,
        beads: Beads,
        f: Array,
        lo: int,
        hi: int,
        least: float,
        none: float,
        reach: float,
    ) -> float:
        A, rest, load, c = chain.A, chain.rest, chain.load, chain.c
        y, v, closed, changed = beads.next_y, beads.next_v, beads.contacts[0], beads.contacts[1]
        most, lost = beads.contacts[2], 0.0
        for i in range(index(lo), index(hi)):
            x, rate = rest[i] + y[i] - y[i + ONE], v[i] - v[i + ONE]
            d = x if x > least else 0.0
            drag, on, past = c[i] * resistance(chain, d) * rate, closed[i], most[i]
            n = A[i] * value(chain, d) + drag
            f[i + ONE] = (n if on > 0.5 else 0.0) - load[i]
            lost += on * drag * rate
            gap = (on < 0.5) & (x <= none)
            pushes = gap | (n > none + on * _WEAK * past)
            active = 1.0 if (x + (1.0 - on) * reach * rate > none) & pushes else 0.0
            changed[i] += abs(active - on)
            n = abs(n) if (on > 0.5) | (x > 0.0) else 0.0
            most[i] = n if n > past else past
        return lost

    return loop


@part
def _fourth_root(chain: Chain, d: float) -> float:
    """Return d^p for the dampings of linear and Hertz contacts, p = 0, 1/4 or 1/2."""
    root = np.sqrt(d)
    other = np.sqrt(root) if chain.p == 0.25 else 1.0
    return root if chain.p == 0.5 else other


# A power takes ten times as long as roots.
_hertz = _loop(part(lambda chain, d: d * (np.sqrt(d) if chain.k == 1.5 else 1.0)), _fourth_root)
_any = _loop(
    part(lambda chain, d: call(chain.force, d) if chain.generated else d**chain.k),
    part(lambda chain, d: 1.0 if chain.p == 0.0 else d**chain.p),
)


@part
def damped_forces(
    chain: Chain, beads: Beads, plan: Plan, s: int, h: float, lo: int, hi: int
) -> None:
    """Compute forces and powers of stage s of a step h at ``next_y`` and ``next_v``."""
    f, least = beads.force[s], NEGLIGIBLE * plan.deepest
    none = 0.0
    if chain.pulls:
        least = none = -math.inf
    if not chain.generated and (chain.k == 1.0 or chain.k == 1.5):
        lost = _hertz(chain, beads, f, lo, hi, least, none, _NEAR * h)
    else:
        lost = _any(chain, beads, f, lo, hi, least, none, _NEAR * h)
    beads.power[0, s] = lost
    beads.power[1, s] = beads.next_v[0] * f[1] if chain.drive.driven else 0.0


@part
def _active(chain: Chain, i: int, d: float, rate: float) -> bool:
    """Return True if contact i pushes at a compression d > 0 and a rate dδ/dt."""
    if chain.pulls:
        return True
    if not d > 0.0:
        return False
    if chain.generated:
        return bool(chain.A[i] * call(chain.force, d) + chain.c[i] * rate > 0.0)
    order = chain.k - chain.p
    return bool(chain.A[i] * (d if order == 1.0 else d**order) + chain.c[i] * rate > 0.0)


@part
def settle(chain: Chain, beads: Beads, plan: Plan, hi: int) -> bool:
    """Give every contact its state at the beads' present motion; return True if one closes."""
    closing = False
    for i in range(hi):
        d, rate = chain.rest[i] + beads.y[i] - beads.y[i + 1], beads.v[i] - beads.v[i + 1]
        touching = abs(d) <= _TOUCH * plan.deepest and rate > 0.0
        closed = chain.A[i] > 0.0 and (touching or _active(chain, i, d, rate))
        closing = closing or (closed and beads.contacts[0, i] == 0.0)
        beads.contacts[0, i] = 1.0 if closed else 0.0
    return closing


@part
def _slope(p: Quintic, x: float) -> float:
    """Return the derivative at x of the quintic with coefficients p."""
    return p[1] + x * (2 * p[2] + x * (3 * p[3] + x * (4 * p[4] + x * 5 * p[5])))


@part
def _right(chain: Chain, closed: bool, i: int, p: Quintic, h: float, x: float) -> bool:
    """Return True if contact i is in the state ``closed`` at the place x of a step."""
    return _active(chain, i, quintic(p, x), _slope(p, x) / h) == closed


@part
def _place(
    chain: Chain, beads: Beads, i: int, h: float, last: int, end: float, width: float
) -> float:
    """Return the place x < end in a step where contact i first opens or closes; 1 without one.

    width : greatest error of x.
    """
    p, _ = fitted_compression(chain, beads, h, last, i)
    closed = beads.contacts[0, i] > 0.5
    low = 0.0
    while low < end:
        high = low + 1.0 / _PLACES
        if not _right(chain, closed, i, p, h, high):
            while high - low > width:
                middle = (low + high) / 2
                if _right(chain, closed, i, p, h, middle):
                    low = middle
                else:
                    high = middle
            return high
        low = high
    return 1.0


@part
def _unseen(chain: Chain, beads: Beads, i: int, h: float, last: int) -> float:
    """Return the greatest force in a step of contact i, which is open at all stages."""
    p, _ = fitted_compression(chain, beads, h, last, i)
    most = 0.0
    for m in range(1, _PLACES):
        x = m / _PLACES
        d = quintic(p, x)
        if d > 0.0:
            elastic = call(chain.force, d) if chain.generated else power(chain, d)
            drag = d**chain.p * _slope(p, x) / h
            most = max(most, abs(chain.A[i] * elastic + chain.c[i] * drag))
    return most


@part
def first_change(chain: Chain, beads: Beads, plan: Plan, h: float, last: int, hi: int) -> float:
    """Return the share of the step up to the first change of a contact that matters; 1 without.

    h : the step. last : the stage at its end.
    """
    place = 1.0
    least = _SLIGHT * plan.v / h
    for i in range(hi):
        if beads.contacts[1, i] > 0.5:
            most = beads.contacts[2, i]
            if most == 0.0:  # a gap
                most = _unseen(chain, beads, i, h, last)
            force = most * max(chain.inverse[i], chain.inverse[i + 1])
            if i == 0 and chain.drive.driven:  # its work, too, is wrong
                force += most * abs(beads.v[0]) * plan.v / plan.energy
            if force > least:
                x = _place(chain, beads, i, h, last, place, max(0.1 * least / force, 1e-15))
                # The state of the contact is wrong from x on, with at most this force.
                if (1.0 - x) * force > least and 1.0 - x > 1e-12:
                    place = min(place, x + 0.5 * least / force)
    return place


@part
def stored(chain: Chain, i: int, d: float) -> float:
    """Return the elastic energy of contact i at a compression d > 0, and 0 for d ≤ 0."""
    if not d > 0.0:
        return 0.0
    if chain.generated:
        return float(chain.A[i] * call(chain.energy, d))
    return float(chain.A[i] * power(chain, d) * d / (chain.k + 1.0))
