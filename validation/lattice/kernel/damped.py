"""Steps of a chain with damped contacts, by an explicit Runge–Kutta pair of order 8.

The pair (Dormand and Prince's, `scipy.integrate.DOP853`) is written for y'' = f(t, y, y'): stage s
moves a bead by h τ_s v + h² Σ_j a_sj f_j and changes its velocity by h Σ_j b_sj f_j, so that only
the forces f_j of the contacts are stored. Within a step time runs as t + h x^q with q = 1, or with
a greater q in the step after a contact has closed: there its force begins like (x^q)^p with a
broken exponent p, and the motion is smooth in x.

A damped contact is closed while δ > 0 and its force, elastic and damping force together, is
positive. Its force has a kink, or jumps, where it closes or opens. Within a step each contact
remains in the state, ``closed`` or not, of the step's beginning, so that its force is smooth. A
step in which that is wrong for a contact whose force matters is made again with its end there.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from lwa.base.arrays import Array
from validation.lattice.kernel.advance import cut, follow, moving
from validation.lattice.kernel.arrays import Beads, Chain, Plan
from validation.lattice.kernel.compiled import ONE, SOURCES, cached, call, index, part, summed
from validation.lattice.kernel.drive import drive_motion, interval
from validation.lattice.kernel.force import NEGLIGIBLE, power
from validation.lattice.kernel.kinks import Quintic, fitted_compression, quintic

STEP, DENSE = 12, 16  # stages of a step, and with those of its interpolant
WIDTH = 6  # stages that are added up at a time
_SLIGHT = 0.5  # least impulse of a contact that is located, in units of the tolerance
_PLACES = 16  # places in a step at which a contact is looked at for its first change
_TOUCH = 1e-14  # in units of the greatest compression: contacts as near as this touch


class Scheme(NamedTuple):
    """Coefficients of the pair for q = 1, and in a second row for the q after a contact closes.

    times : (2, stages), x^q. drifts : (2, stages), τ. rows : (2, stages, 2, columns), a and b.
    errors : (2, 2, 2, columns), those of the two embedded solutions, of displacement and velocity.
    error_drifts : (2, 2), the coefficients of h v in the displacement's errors. power : q.
    """

    times: Array
    drifts: Array
    rows: Array
    errors: Array
    error_drifts: Array
    power: int


class Steps(NamedTuple):
    """The motion of W watched beads in up to C steps.

    step : (C, 3), time, length, and 0 or 1 for the row of `Scheme`. start : (C, W, 2), displacement
    and velocity. force : (C, W, `DENSE`), of the contacts behind the beads, by stage. watched :
    (W,), increasing numbers of the beads.
    """

    step: Array
    start: Array
    force: Array
    watched: NDArray[np.int_]


def _loop(value: Any, resistance: Any) -> Any:
    """Compile a loop over contacts with the force A value(d, k) + c resistance(d, p) dδ/dt."""

    @part
    def loop(chain: Chain, beads: Beads, f: Array, hi: int, least: float) -> None:
        A, rest, load, k, c, p = chain.A, chain.rest, chain.load, chain.k, chain.c, chain.p
        y, v, closed, changed = beads.next_y, beads.next_v, beads.contacts[0], beads.contacts[1]
        most, heat = beads.contacts[2], beads.contacts[3]
        for i in range(index(hi)):
            x, rate = rest[i] + y[i] - y[i + ONE], v[i] - v[i + ONE]
            d = x if x > least else 0.0
            drag, on = c[i] * resistance(d, p) * rate, closed[i]
            n = A[i] * value(d, k) + drag
            active = 1.0 if (x > 0.0) & (n > 0.0) else 0.0
            f[i + ONE] = (n if on > 0.5 else 0.0) - load[i]
            heat[i] = on * drag * rate
            changed[i] += abs(active - on)
            n = abs(n) if (on > 0.5) | (x > 0.0) else 0.0
            most[i] = n if n > most[i] else most[i]

    return loop


_one = part(lambda d, p: 1.0)
_hertz = part(lambda d, k: d * np.sqrt(d))
_any = part(lambda d, k: d**k)
_hertz_contact = _loop(_hertz, _one)
_hertz_root = _loop(_hertz, part(lambda d, p: np.sqrt(d)))
_hertz_quartic = _loop(_hertz, part(lambda d, p: np.sqrt(np.sqrt(d))))
_linear = _loop(part(lambda d, k: d), _one)
_power_contact = _loop(_any, _one)
_power = _loop(_any, _any)


@part
def _generated(chain: Chain, beads: Beads, f: Array, hi: int) -> None:
    """Compute the forces of contacts of any other law, with a damping force c dδ/dt."""
    y, v = beads.next_y, beads.next_v
    for i in range(hi):
        x, rate, on = chain.rest[i] + y[i] - y[i + 1], v[i] - v[i + 1], beads.contacts[0, i]
        held = chain.A[i] > 0.0 and (chain.pulls or x > 0.0)
        n = (chain.A[i] * call(chain.force, x) if held else 0.0) + chain.c[i] * rate
        active = 1.0 if held and (chain.pulls or n > 0.0) else 0.0
        f[i + 1] = (n if on > 0.5 else 0.0) - chain.load[i]
        beads.contacts[3, i] = on * chain.c[i] * rate * rate
        beads.contacts[1, i] += abs(active - on)
        beads.contacts[2, i] = max(beads.contacts[2, i], abs(n) if on > 0.5 or x > 0.0 else 0.0)


@summed
def _total(row: Array, hi: int) -> float:
    """Return the sum of the first ``hi`` entries."""
    total = 0.0
    for i in range(index(hi)):
        total += row[i]
    return total


@part
def _forces(chain: Chain, beads: Beads, plan: Plan, s: int, hi: int) -> None:
    """Compute forces and powers of stage s at ``next_y`` and ``next_v``."""
    f, least = beads.force[s], NEGLIGIBLE * plan.deepest
    if chain.generated:
        _generated(chain, beads, f, hi)
    elif chain.k == 1.0:
        _linear(chain, beads, f, hi, least)
    elif chain.k == 1.5 and chain.p == 0.0:
        _hertz_contact(chain, beads, f, hi, least)
    elif chain.k == 1.5 and chain.p == 0.5:
        _hertz_root(chain, beads, f, hi, least)
    elif chain.k == 1.5 and chain.p == 0.25:
        _hertz_quartic(chain, beads, f, hi, least)
    elif chain.p == 0.0:
        _power_contact(chain, beads, f, hi, least)
    else:
        _power(chain, beads, f, hi, least)
    beads.power[0, s] = _total(beads.contacts[3], hi)
    beads.power[1, s] = beads.next_v[0] * f[1] if chain.drive.driven else 0.0


@part
def _add_up(beads: Beads, q: Any, rows: Array, a: float, b: float, stages: int, hi: int) -> None:
    """Compute two weighted sums of forces, sums[q] = a Σ rows[0, j] f_j, sums[q + 1] likewise."""
    force, sums = beads.force, beads.sums
    p = q + ONE
    for first in range(0, stages, WIDTH):
        a0, a1, a2 = a * rows[0, first], a * rows[0, first + 1], a * rows[0, first + 2]
        a3, a4, a5 = a * rows[0, first + 3], a * rows[0, first + 4], a * rows[0, first + 5]
        b0, b1, b2 = b * rows[1, first], b * rows[1, first + 1], b * rows[1, first + 2]
        b3, b4, b5 = b * rows[1, first + 3], b * rows[1, first + 4], b * rows[1, first + 5]
        j = index(first)
        j1, j2, j3, j4, j5 = j + ONE, j + index(2), j + index(3), j + index(4), j + index(5)
        for i in range(ONE, index(hi) + ONE):
            f0, f1, f2 = force[j, i], force[j1, i], force[j2, i]
            f3, f4, f5 = force[j3, i], force[j4, i], force[j5, i]
            one = a0 * f0 + a1 * f1 + a2 * f2 + a3 * f3 + a4 * f4 + a5 * f5
            two = b0 * f0 + b1 * f1 + b2 * f2 + b3 * f3 + b4 * f4 + b5 * f5
            sums[q, i] = one if first == 0 else sums[q, i] + one
            sums[p, i] = two if first == 0 else sums[p, i] + two


@part
def _stage(
    chain: Chain, beads: Beads, plan: Plan, now: Any,
    n: int, s: int, h: float, hi: int,
) -> None:  # fmt: skip
    """Move the beads to stage s, and compute the forces there; n : interval of the drive."""
    scheme, w = plan.scheme, now.warped
    _add_up(beads, index(0), scheme.rows[w, s], h * h, h, min(s, DENSE), hi)
    y, v, next_y, next_v = beads.y, beads.v, beads.next_y, beads.next_v
    sums, inverse, drift = beads.sums, chain.inverse, h * scheme.drifts[w, s]
    for i in range(index(hi)):
        next_y[i] = y[i] + drift * v[i] + (sums[0, i] - sums[0, i + ONE]) * inverse[i]
        next_v[i] = v[i] + (sums[1, i] - sums[1, i + ONE]) * inverse[i]
    if chain.drive.driven:
        next_y[0], next_v[0], a = drive_motion(chain.drive, n, now.t + h * scheme.times[w, s])
        beads.given[1] = a if s == STEP else beads.given[1]
    _forces(chain, beads, plan, s, hi)


@summed
def _squares(beads: Beads, inverse: Array, q: Any, drift: float, scale: float, hi: int) -> float:
    """Return the sum of squares of the beads' errors, in units of the tolerances."""
    total, sums, v = 0.0, beads.sums, beads.v
    p = q + ONE
    for i in range(index(hi)):
        a = (sums[q, i] - sums[q, i + ONE]) * inverse[i] * scale + drift * v[i] * (inverse[i] > 0.0)
        b = (sums[p, i] - sums[p, i + ONE]) * inverse[i]
        total += a * a + b * b
    return total


@part
def _error(chain: Chain, beads: Beads, plan: Plan, w: int, h: float, hi: int) -> float:
    """Return the error of a step in units of the tolerance, from both embedded solutions."""
    squares = (0.0, 0.0)
    for m in range(2):
        rows, drift = plan.scheme.errors[w, m], plan.scheme.error_drifts[w, m]
        _add_up(beads, index(2), rows, h * h / plan.y, h / plan.v, STEP, hi)
        total = _squares(beads, chain.inverse, index(2), h * drift / plan.y, 1.0, hi)
        for q in range(2):
            energy = 0.0
            for s in range(STEP):
                energy += rows[1, s] * beads.power[q, s]
            total += (h * energy / plan.energy) ** 2
        squares = (total, squares[0])
    fifth, third = squares
    # Hairer, Nørsett and Wanner, Solving Ordinary Differential Equations I, II.10
    return fifth / math.sqrt(fifth + 0.01 * third) if fifth > 0.0 else 0.0


@part
def _active(chain: Chain, i: int, d: float, rate: float) -> bool:
    """Return True if contact i pushes at a compression d > 0 and a rate dδ/dt."""
    if chain.pulls:
        return True
    if not d > 0.0:
        return False
    if chain.generated:
        return bool(chain.A[i] * call(chain.force, d) + chain.c[i] * rate > 0.0)
    return bool(chain.A[i] * d ** (chain.k - chain.p) + chain.c[i] * rate > 0.0)


@part
def _right(chain: Chain, closed: bool, i: int, p: Quintic, h: float, x: float) -> bool:
    """Return True if contact i is in the state ``closed`` at the place x of a step."""
    slope = p[1] + x * (2 * p[2] + x * (3 * p[3] + x * (4 * p[4] + x * 5 * p[5])))
    return _active(chain, i, quintic(p, x), slope / h) == closed


@part
def _first_change(chain: Chain, beads: Beads, i: int, h: float) -> float:
    """Return the place x in a step where contact i first opens or closes; 1 without one."""
    p, _ = fitted_compression(chain, beads, h, STEP, i)
    closed = beads.contacts[0, i] > 0.5
    low = 0.0
    for m in range(1, _PLACES + 1):
        high = m / _PLACES
        if not _right(chain, closed, i, p, h, high):
            for _ in range(50):
                middle = (low + high) / 2
                if _right(chain, closed, i, p, h, middle):
                    low = middle
                else:
                    high = middle
            return high
        low = high
    return 1.0


@part
def _located(chain: Chain, beads: Beads, plan: Plan, h: float, hi: int) -> float:
    """Return the share of the step up to the first change of a contact that matters; 1 without."""
    place = 1.0
    least = _SLIGHT * plan.v / h
    for i in range(hi):
        if beads.contacts[1, i] > 0.5:
            force = beads.contacts[2, i] * max(chain.inverse[i], chain.inverse[i + 1])
            if i == 0 and chain.drive.driven:  # its work, too, is wrong
                force += beads.contacts[2, i] * abs(beads.v[0]) * plan.v / plan.energy
            if force > least:
                x = _first_change(chain, beads, i, h)
                # The state of the contact is wrong from x on, with at most this force.
                if (1.0 - x) * force > least and 1.0 - x > 1e-12:
                    place = min(place, x + 0.5 * least / force)
    return place


@part
def _settle(chain: Chain, beads: Beads, plan: Plan, h: float, hi: int) -> bool:
    """Give every contact its state at the beads' present motion; return True if one closes.

    A contact of negligible force does not count.
    """
    y, v, closing = beads.y, beads.v, False
    for i in range(hi):
        d, rate = chain.rest[i] + y[i] - y[i + 1], v[i] - v[i + 1]
        touching = abs(d) <= _TOUCH * plan.deepest and rate > 0.0
        on = 1.0 if touching or _active(chain, i, d, rate) else 0.0
        if chain.A[i] == 0.0:
            on = 0.0
        if on > beads.contacts[0, i]:
            inverse = max(chain.inverse[i], chain.inverse[i + 1])
            depth, rate = h * max(rate, 0.0), max(rate, 0.0)
            force = chain.A[i] * depth**chain.k + chain.c[i] * depth**chain.p * rate
            if h * force * inverse > _SLIGHT * plan.v:
                closing = True
        beads.contacts[0, i] = on
    return closing


@part
def _stored(chain: Chain, i: int, d: float) -> float:
    """Return the elastic energy of contact i at a compression d > 0, and 0 for d ≤ 0."""
    if not d > 0.0:
        return 0.0
    if chain.generated:
        return float(chain.A[i] * call(chain.energy, d))
    return float(chain.A[i] * power(chain, d) * d / (chain.k + 1.0))


@part
def _accept(chain: Chain, beads: Beads, plan: Plan, now: Any, h: float, hi: int) -> None:
    """Move the beads to the end of a step, and add up its work and dissipated energy."""
    for i in range(hi):
        if beads.contacts[0, i] < 0.5:  # an open contact turns what it still stores into heat
            d = chain.rest[i] + beads.y[i] - beads.y[i + 1]
            now.lost += _stored(chain, i, d)
            now.lost -= _stored(
                chain, i, chain.rest[i] + beads.sums[2, i + 1] - beads.sums[2, i + 2]
            )
    for i in range(index(hi)):
        beads.y[i], beads.v[i] = beads.sums[2, i + ONE], beads.sums[3, i + ONE]
    for s in range(STEP):
        weight = h * plan.scheme.rows[now.warped, STEP, 1, s]
        now.lost += weight * beads.power[0, s]
        now.work += weight * beads.power[1, s]


@part
def _store(
    chain: Chain, beads: Beads, plan: Plan, steps: Steps,
    now: Any, n: int, h: float, hi: int,
) -> None:  # fmt: skip
    """Compute the interpolant's stages, and store the step at the watched beads."""
    for s in range(STEP + 1, DENSE):
        _stage(chain, beads, plan, now, n, s, h, hi)
    step = steps.step[now.stored]
    step[0], step[1], step[2] = now.t, h, now.warped
    for q in range(len(steps.watched)):
        j = steps.watched[q]
        steps.start[now.stored, q, 0], steps.start[now.stored, q, 1] = beads.y[j], beads.v[j]
        for s in range(DENSE):
            steps.force[now.stored, q, s] = beads.force[s, j]
    now.stored += 1


@part
def _begin(chain: Chain, beads: Beads, plan: Plan, now: Any, hi: int) -> None:
    """Settle the contacts, and compute the forces at the beginning of a step."""
    closing = _settle(chain, beads, plan, now.h, hi)
    now.warped = 1 if closing and plan.scheme.power > 1 else 0
    for i in range(index(hi)):
        beads.next_y[i], beads.next_v[i] = beads.y[i], beads.v[i]
    _forces(chain, beads, plan, 0, hi)


def _built(sources: int) -> Any:
    """Compile `advance_damped`; its cache is for source code with the hash ``sources``."""

    @cached
    def advance_damped(
        chain: Chain, beads: Beads, plan: Plan, steps: Steps,
        now: Any, tries: int,
    ) -> tuple[float, int]:  # fmt: skip
        """Integrate to the end, or for at most ``tries`` tried steps, or until ``steps`` are full.

        Returns the time that is reached, and ``sources``.
        """
        until, watching = now.tries + tries, len(steps.watched) > 0
        if now.tries == 0:
            _begin(chain, beads, plan, now, plan.size)
        while now.t < plan.end and now.tries < until and now.stored < len(steps.step):
            hi = moving(now)
            now.tries += 1
            now.evaluations += STEP * hi
            h, later = cut(plan, now)
            n = interval(chain.drive, now.t + h / 2)
            _, _, beads.given[0] = drive_motion(chain.drive, n, now.t)  # 0 without a drive
            for i in range(index(hi)):
                beads.contacts[1, i], beads.contacts[2, i] = 0.0, 0.0
            for s in range(1, STEP + 1):
                _stage(chain, beads, plan, now, n, s, h, hi)
            error = _error(chain, beads, plan, now.warped, h, hi)
            place = _located(chain, beads, plan, h, hi)
            grow = 0.9 * max(error, 1e-9) ** -0.125
            if not error <= 1.0 or place < 1.0:
                shrink = 1.0 if error <= 1.0 else max(0.1, grow if error < 1e9 else 0.0)
                now.planned = max(now.planned, h) if error <= 1.0 else h * shrink
                now.h = h * min(shrink, place)
                if not error < 1e9:
                    beads.force[1:] = 0.0  # overflows must not last
                continue
            for i in range(index(hi) + ONE):  # the interpolant's stages use `next_y` and `next_v`
                beads.sums[2, i + ONE], beads.sums[3, i + ONE] = beads.next_y[i], beads.next_v[i]
            if watching:
                _store(chain, beads, plan, steps, now, n, h, hi)
            _accept(chain, beads, plan, now, h, hi)
            now.response = max(now.response, now.energy + now.work - now.lost)
            now.steps += 1
            now.t = later
            now.stop += 1 if later == plan.stops[now.stop] else 0
            now.h, now.planned = min(plan.longest, max(h * min(5.0, grow), now.planned)), 0.0
            follow(beads, plan, now)
            _begin(chain, beads, plan, now, hi)
        return now.t, sources

    return advance_damped


advance_damped = _built(SOURCES)
