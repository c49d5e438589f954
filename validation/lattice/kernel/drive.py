"""Motion of a driven first bead: cubics between knots, plus an oscillation with a ramp."""

from __future__ import annotations

import math

from validation.lattice.kernel.arrays import Drive
from validation.lattice.kernel.compiled import part


@part
def interval(drive: Drive, t: float) -> int:
    """Return the number of the interval of time that holds t, by bisection."""
    low, high = 0, len(drive.times)
    while high - low > 1:
        middle = (low + high) // 2
        low, high = (middle, high) if drive.times[middle] <= t else (low, middle)
    return low


@part
def drive_motion(drive: Drive, n: int, t: float) -> tuple[float, float, float]:
    """Return displacement, velocity and acceleration of the driven bead at t, in interval n."""
    s, c = t - drive.times[n], drive.cubics[n]
    y = c[0] + s * (c[1] + s * (c[2] + s * c[3]))
    v, a = c[1] + s * (2.0 * c[2] + s * 3.0 * c[3]), 2.0 * c[2] + s * 6.0 * c[3]
    if drive.amplitude != 0.0:
        r, dr, ddr = 1.0, 0.0, 0.0
        if t < drive.ramp:  # x³ (10 - 15 x + 6 x²) has two derivatives that vanish at both ends
            x, pace = t / drive.ramp, 1.0 / drive.ramp
            r, dr = x * x * x * (10 - 15 * x + 6 * x * x), 30 * x * x * (1 - x) * (1 - x) * pace
            ddr = 60 * x * (1 - x) * (1 - 2 * x) * pace * pace
        w, sin, cos = drive.w, math.sin(drive.w * t), math.cos(drive.w * t)
        y += drive.amplitude * r * sin
        v += drive.amplitude * (dr * sin + r * w * cos)
        a += drive.amplitude * (ddr * sin + 2 * dr * w * cos - r * w * w * sin)
    return y, v, a
