"""Forces of contacts, ``A (F(δ) + r [δ]_+^p dδ/dt)``, and the motion of a driven bead.

A contact is open, without a force, where ``δ ≤ 0``, unless its law pulls there. Damping may not
pull, unless the law attracts where the contact opens: the force is at least 0, or the elastic force
where that is negative.

`part` and `summed` are numba's ``njit`` with options, and `index` makes an index unsigned, so that
a loop vectorises (`validation.lattice.kernel.compiled`).
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from lwa.base.arrays import Array
from validation.lattice.kernel.arrays import TILE, Beads, Chain, Forcing, Plan
from validation.lattice.kernel.compiled import ONE, call, index, part, summed
from validation.scenes.forcing import oscillation

# In units of the greatest compression: less counts as 0, so that no denormals arise.
NEGLIGIBLE = 1e-60

_oscillation = part(oscillation)


@part
def is_quarters(x: float) -> bool:
    """Return True for an exponent that `quarters` knows."""
    return bool(x < 5.0 and 4.0 * x == int(4.0 * x))


@part
def quarters(x: float, d: float) -> float:
    """Return ``d^x`` for a multiple x of 1/4 below 5, as a product that vectorises.

    The binary digits of 4x are the exponents of ``d^{1/4}``, ``d^{1/2}``, d, d² and d⁴; the factor
    of a digit 0 is 1.
    """
    n = int(4.0 * x)
    root = np.sqrt(d)
    a = float(n & 1)
    b = float(n >> 1 & 1)
    c = float(n >> 2 & 1)
    e = float(n >> 3 & 1)
    g = float(n >> 4 & 1)
    low = (1.0 - a + a * np.sqrt(root)) * (1.0 - b + b * root)
    high = (1.0 - e + e * d * d) * (1.0 - g + g * d * d * d * d)
    return float(low * (1.0 - c + c * d) * high)


@part
def power(x: float, d: float) -> float:
    """Return ``d^x``; products and roots take a tenth of the time."""
    if x == 1.5:
        return float(d * np.sqrt(d))
    if x == 0.5:
        return float(np.sqrt(d))
    if x == 0.25:
        return float(np.sqrt(np.sqrt(d)))
    if x == 0.0:
        return 1.0  # where a contact pulls, too, at d < 0
    if is_quarters(x):
        return quarters(x, d)
    return float(d**x)


@part
def elastic(law: Any, d: float) -> float:
    """Return the elastic force F(d) for unit stiffness; 0 for an open contact."""
    if not (d > 0.0 or law.pulls):
        return 0.0
    if law.generated:
        return float(call(law.force, d))
    return power(law.k, d)


@part
def drag(law: Any, d: float) -> float:
    """Return the factor ``d^p`` of ``r dδ/dt`` in the damping force.

    The contact pushes, or its law pulls: such a law has no power, and its factor is 1.
    """
    return power(law.p, d)


@part
def stiffness(law: Any, d: float) -> float:
    """Return ``dF/dd`` for unit stiffness, ``k d^{k-1}`` of a power; 0 for an open contact."""
    if not (d > 0.0 or law.pulls):
        return 0.0
    if law.generated:
        return float(call(law.slope, d))
    return float(law.k * power(law.k - 1.0, d))


@part
def push(law: Any, r: float, d: float, rate: float) -> float:
    """Return the force for unit stiffness at a compression d and a rate dδ/dt.

    r is the damping coefficient over stiffness. Unless the contact sticks, damping may not pull.
    """
    force = elastic(law, d)
    if not r > 0.0 or not (d > 0.0 or law.pulls):
        return force
    total = force + r * drag(law, d) * rate
    if law.sticks:
        return total
    return max(total, min(force, 0.0))


def _loop(value: Any) -> Any:
    """Compile a loop over contacts with the elastic force A value(law, k, d), less the static one.

    The loop takes contacts lo … hi - 1. Contact i presses where its compression is above ``least``,
    which is 0 or nearly, and -∞ if its law pulls; its force goes to ``f[i + 1]``. The acceleration
    of bead i, behind it, goes to ``push[i]`` at once: a second loop would wait for the forces in
    memory, and both loops took a third more time for 16 beads.
    """

    @part
    def loop(
        chain: Chain,
        law: Any,
        y: Array,
        f: Array,
        push: Array,
        lo: int,
        hi: int,
        least: float,
    ) -> None:
        A = chain.A
        rest = chain.rest
        load = chain.load
        inverse = chain.inverse
        k = law.k
        behind = f[index(lo)]
        for i in range(index(lo), index(hi)):
            d = rest[i] + y[i] - y[i + ONE]
            d = d if d > least else 0.0
            ahead = A[i] * value(law, k, d) - load[i]
            f[i + ONE] = ahead
            push[i] = (behind - ahead) * inverse[i]
            behind = ahead

    return loop


def _damped_loop(value: Any, resistance: Any) -> Any:
    """Compile a loop over contacts with the force A (value + r resistance(p, d) dδ/dt).

    Contacts have a force where ``δ > least``: the loop's ``least`` is 0, or nearly, and -∞ if they
    pull. Its ``none`` is the least force with damping: 0, or -∞ if damping may pull. While a
    contact that has stopped pushing expands, its elastic energy turns into heat. The heat is summed
    apart (`_total`): with a sum the loop would take 32 contacts at a time, and fewer one by one.
    """

    @part
    def loop(
        chain: Chain,
        law: Any,
        y: Array,
        v: Array,
        f: Array,
        push: Array,
        heat: Array,
        lo: int,
        hi: int,
        least: float,
        none: float,
    ) -> None:
        """Compute the forces of contacts lo … hi - 1, and the power that each dissipates.

        A contact has a force where δ is above ``least``, which is 0 or nearly, and -∞ if its law
        pulls. ``none`` is the least force with damping: 0, or -∞ if damping may pull.
        """
        A = chain.A
        rest = chain.rest
        load = chain.load
        inverse = chain.inverse
        r = chain.r
        k = law.k
        p = law.p
        behind = f[index(lo)]
        for i in range(index(lo), index(hi)):
            x = rest[i] + y[i] - y[i + ONE]
            rate = v[i] - v[i + ONE]
            # Choices between two numbers in place of branches, so that the loop vectorises.
            d = x if x > least else 0.0
            force = value(law, k, d)
            lowest = force if force < none else none
            total = force + r[i] * resistance(p, d) * rate
            total = total if total > lowest else lowest
            total = total if x > least else 0.0
            ahead = A[i] * total - load[i]
            f[i + ONE] = ahead
            push[i] = (behind - ahead) * inverse[i]
            behind = ahead
            heat[i] = A[i] * (total - force) * rate

    return loop


_hertz = _loop(part(lambda law, k, d: d * np.sqrt(d)))
_quarters = _loop(part(lambda law, k, d: quarters(k, d)))
_other = _loop(part(lambda law, k, d: elastic(law, d)))
# For k = 1 or 3/2 and p = 0, 1/4 or 1/2, a third of the time of other multiples of 1/4.
_damped_hertz = _damped_loop(
    part(lambda law, k, d: d * (np.sqrt(d) if k == 1.5 else 1.0)),
    part(
        lambda p, d: (
            np.sqrt(d) if p == 0.5 else (1.0 if p == 0.0 else np.sqrt(np.sqrt(d)))
        )
    ),
)
_damped_quarters = _damped_loop(part(lambda law, k, d: quarters(k, d)), quarters)
_damped_other = _damped_loop(part(lambda law, k, d: elastic(law, d)), power)


@summed
def _total(values: Array, lo: int, hi: int) -> float:
    """Return the sum of entries lo … hi - 1."""
    total = 0.0
    for i in range(index(lo), index(hi)):
        total += values[i]
    return total


@part
def tile_bounds(tile: int, s: int, hi: int) -> tuple[int, int, int, int]:
    """Return the ranges of beads and of contacts that stage s computes in a tile, up to bead hi.

    All stages of a step go through a tile before the next tile. The contact of a tile's last bead
    waits for the bead ahead, so each stage ends one bead behind the stage before.

    The beads are the first number up to the second, which is left out; the contacts, those behind
    and ahead of these beads, are the third up to the fourth. At the end of the chain no next tile
    takes the last contact.
    """
    lo = max(tile - s, 0)
    up = min(tile + TILE - s, hi)
    return lo, up, max(lo - 1, 0), up if up == hi else up - 1


@part
def contact_forces(
    chain: Chain,
    forcing: Forcing | None,
    beads: Beads,
    plan: Plan,
    y: Array,
    v: Array,
    push: Array,
    s: Any,
    lo: int,
    hi: int,
) -> None:
    """Compute the forces of the contacts ahead of beads lo … hi-1, less the static forces.

    The forces go to row 1 of ``beads.force``, in column i + 1 for the contact ahead of bead i; its
    column lo holds the force behind bead lo. The accelerations of these beads go to ``push``, the
    dissipated power and the power of the drive to ``beads.power``.

    Parameters
    ----------
    chain, forcing, beads, plan : Chain, Forcing or None, Beads, Plan
        The integration.
    y, v : array
        Displacements and velocities.
    push : array
        Room for the accelerations.
    s : int
        Stage of the step.
    lo, hi : int
        Range of the contacts.
    """
    f = beads.force[1]
    start = lo
    while lo < hi:
        law = chain.laws[chain.law[lo]]
        up = min(hi, chain.alike[lo])
        # A contact pushes where δ > least, and with damping by at least none (`_damped_loop`).
        least = -math.inf if law.pulls else NEGLIGIBLE * plan.deepest
        none = -math.inf if law.sticks else 0.0
        fast = is_quarters(law.k) and not law.generated
        if forcing is not None and forcing.damped:
            # Room until the next errors are estimated: here the dissipated power by contact
            heat = beads.errors[0]
            if fast and law.k in (1.0, 1.5) and law.p in (0.0, 0.25, 0.5):
                _damped_hertz(chain, law, y, v, f, push, heat, lo, up, least, none)
            elif fast and is_quarters(law.p):
                _damped_quarters(chain, law, y, v, f, push, heat, lo, up, least, none)
            else:
                _damped_other(chain, law, y, v, f, push, heat, lo, up, least, none)
        elif fast and law.k == 1.5:
            _hertz(chain, law, y, f, push, lo, up, least)
        elif fast:
            _quarters(chain, law, y, f, push, lo, up, least)
        else:
            _other(chain, law, y, f, push, lo, up, least)
        lo = up
    if forcing is not None and forcing.damped:
        # The tiles of a step come in their order: that of the first contact begins the sum.
        before = beads.power[0, s] if start > 0 else 0.0
        beads.power[0, s] = before + _total(beads.errors[0], start, hi)
    if forcing is not None and forcing.driven and start == 0:
        beads.power[1, s] = v[0] * f[1]


@part
def drive_motion(drive: Forcing, middle: float, t: float) -> tuple[float, float, float]:
    """Return displacement, velocity and acceleration of the driven bead at t.

    Parameters
    ----------
    drive : Forcing
        The drive.
    middle : float
        A time inside the interval of the drive's file that holds t; bisection finds the interval.
        At a knot of the file, the end of two intervals, t alone would not tell which one is meant;
        their accelerations differ there. Without a file one interval of zeros holds all times.
    t : float
        The time.
    """
    low = 0
    high = len(drive.times)
    while high - low > 1:
        n = (low + high) // 2
        if drive.times[n] <= middle:
            low = n
        else:
            high = n
    s = t - drive.times[low]
    c = drive.cubics[low]
    y, v, a = _oscillation(t, drive.amplitude, drive.w, drive.ramp)
    y += c[0] + s * (c[1] + s * (c[2] + s * c[3]))
    v += c[1] + s * (2.0 * c[2] + s * 3.0 * c[3])
    a += 2.0 * c[2] + s * 6.0 * c[3]
    return y, v, a
