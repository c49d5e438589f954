"""Forces of all contacts, A (F(δ) + r [δ]_+^p dδ/dt) ≥ 0, and a driven bead's motion."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from lwa.base.arrays import Array
from validation.lattice.kernel.arrays import TILE, Beads, Chain, Drive, Law, Plan
from validation.lattice.kernel.compiled import ONE, call, index, part, summed

NEGLIGIBLE = (
    1e-60  # in units of the greatest compression: less is 0, so that no denormals arise
)


def _loop(value: Any) -> Any:
    """Compile a loop over contacts with the force A value(d, k), d ≥ 0 the compression."""

    @part
    def loop(chain: Chain, y: Array, f: Array, lo: int, hi: int, least: float) -> None:
        A, rest, load, k = chain.A, chain.rest, chain.load, chain.law.k
        for i in range(index(lo), index(hi)):
            d = rest[i] + y[i] - y[i + ONE]
            d = d if d > least else 0.0
            f[i + ONE] = A[i] * value(d, k) - load[i]

    return loop


def _damped_loop(value: Any, resistance: Any) -> Any:
    """Compile a loop over contacts with the force A (value(law, d) + r resistance(d, p) dδ/dt).

    least, none : contacts push where δ > least and F > none; both are -∞ for contacts that pull.
    The loop returns the dissipated power. While a contact that has stopped pushing expands, its
    elastic energy turns into heat.
    """

    @summed
    def loop(
        chain: Chain,
        y: Array,
        v: Array,
        f: Array,
        lo: int,
        hi: int,
        least: float,
        none: float,
    ) -> float:
        A, rest, load, r, law, lost = (
            chain.A,
            chain.rest,
            chain.load,
            chain.r,
            chain.law,
            0.0,
        )
        for i in range(index(lo), index(hi)):
            x, rate = rest[i] + y[i] - y[i + ONE], v[i] - v[i + ONE]
            d = x if x > least else 0.0
            elastic = value(law, d)
            force = elastic + r[i] * resistance(d, law.p) * rate
            force = force if (force > none) & (x > least) else 0.0
            f[i + ONE] = A[i] * force - load[i]
            lost += A[i] * (force - elastic) * rate
        return lost

    return loop


@part
def _of_quarters(d: float, k: float) -> float:
    """Return d^k for a multiple k of 1/4, 1 ≤ k < 5, as a product that vectorises.

    k - 1 = a/4 + b/2 + c + 2 e with binary digits a, b, c and e, and the factor of a digit 0 is 1.
    """
    n, root = int(4.0 * (k - 1.0)), np.sqrt(d)
    a, b, c, e = float(n & 1), float(n >> 1 & 1), float(n >> 2 & 1), float(n >> 3 & 1)
    low = (1.0 - a + a * np.sqrt(root)) * (1.0 - b + b * root)
    return float(d * low * (1.0 - c + c * d) * (1.0 - e + e * d * d))


# d^k itself takes ten times as long as products and roots.
_hertz = _loop(part(lambda d, k: d * np.sqrt(d)))
_quarters = _loop(_of_quarters)
_power = _loop(part(lambda d, k: d**k))
_damped_hertz = _damped_loop(
    part(lambda law, d: d * (np.sqrt(d) if law.k == 1.5 else 1.0)),
    part(
        lambda d, p: (
            np.sqrt(d) if p == 0.5 else (1.0 if p == 0.0 else np.sqrt(np.sqrt(d)))
        )
    ),
)
_damped = _damped_loop(
    part(lambda law, d: call(law.force, d) if law.generated else d**law.k),
    part(lambda d, p: 1.0 if p == 0.0 else d**p),
)


@part
def tile_bounds(tile: int, s: int, hi: int) -> tuple[int, int, int, int]:
    """Return the ranges of beads and of contacts that stage s computes in a tile, up to bead hi.

    All stages of a step go through a tile before the next tile. The contact of a tile's last bead
    waits for the bead ahead, so each stage ends one bead behind the stage before.
    """
    lo, up = max(tile - s, 0), min(tile + TILE - s, hi)
    return lo, up, max(lo - 1, 0), up if up == hi else up - 1


@part
def contact_forces(
    chain: Chain, beads: Beads, plan: Plan, y: Array, v: Array, s: Any, lo: int, hi: int
) -> None:
    """Compute the forces of the contacts ahead of beads lo … hi-1, less the static forces.

    y, v : displacements and velocities. The forces go to row s (stage) of ``beads.force``, in
    column i + 1 for the contact ahead of bead i; the dissipated power and the power of the drive go
    to ``beads.power``.
    """
    f, least, law, k = beads.force[s], NEGLIGIBLE * plan.deepest, chain.law, chain.law.k
    if chain.damped:
        none = 0.0
        if law.pulls:
            least = none = -math.inf
        simple = (k == 1.5 and law.p in (0.0, 0.25, 0.5)) or (k == 1.0 and law.p == 0.0)
        if simple and not law.generated:
            lost = _damped_hertz(chain, y, v, f, lo, hi, least, none)
        else:
            lost = _damped(chain, y, v, f, lo, hi, least, none)
        beads.power[0, s] = lost + (beads.power[0, s] if lo > 0 else 0.0)
    elif law.generated:
        for i in range(index(lo), index(hi)):
            d = chain.rest[i] + y[i] - y[i + ONE]
            closed = chain.A[i] > 0.0 and (law.pulls or d > 0.0)
            f[i + ONE] = (
                chain.A[i] * call(law.force, d) if closed else 0.0
            ) - chain.load[i]
    elif k == 1.5:
        _hertz(chain, y, f, lo, hi, least)
    elif k < 5.0 and 4.0 * k == int(4.0 * k):
        _quarters(chain, y, f, lo, hi, least)
    else:
        _power(chain, y, f, lo, hi, least)
    if chain.drive.driven and lo == 0:
        beads.power[1, s] = v[0] * f[1]


@part
def stiffness(law: Law, d: float) -> float:
    """Return F′(d) of a contact of unit stiffness, k [d]_+^{k-1} for a power law."""
    if law.generated:
        return float(call(law.slope, d) if law.pulls or d > 0.0 else 0.0)
    if not d > 0.0:
        return 0.0
    return float(law.k * (np.sqrt(d) if law.k == 1.5 else d ** (law.k - 1.0)))


@part
def drive_motion(drive: Drive, middle: float, t: float) -> tuple[float, float, float]:
    """Return displacement, velocity and acceleration of the driven bead at t.

    middle : a time inside of the interval of the drive's file that holds t, by bisection.
    """
    low, high = 0, len(drive.times)
    while high - low > 1:
        n = (low + high) // 2
        low, high = (n, high) if drive.times[n] <= middle else (low, n)
    s, c = t - drive.times[low], drive.cubics[low]
    y = c[0] + s * (c[1] + s * (c[2] + s * c[3]))
    v, a = c[1] + s * (2.0 * c[2] + s * 3.0 * c[3]), 2.0 * c[2] + s * 6.0 * c[3]
    if drive.amplitude != 0.0:
        r, dr, ddr = 1.0, 0.0, 0.0
        if (
            t < drive.ramp
        ):  # x³ (10 - 15 x + 6 x²) has two derivatives that vanish at both ends
            x, pace = t / drive.ramp, 1.0 / drive.ramp
            r, dr = (
                x * x * x * (10 - 15 * x + 6 * x * x),
                30 * x * x * (1 - x) * (1 - x) * pace,
            )
            ddr = 60 * x * (1 - x) * (1 - 2 * x) * pace * pace
        w, sin, cos = drive.w, math.sin(drive.w * t), math.cos(drive.w * t)
        y += drive.amplitude * r * sin
        v += drive.amplitude * (dr * sin + r * w * cos)
        a += drive.amplitude * (ddr * sin + 2 * dr * w * cos - r * w * w * sin)
    return y, v, a
