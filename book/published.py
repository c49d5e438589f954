"""Numbers beside those that others published; the page on the literature has the sources.

`computed.py` puts them into the page, and ``tests/test_published.py`` holds their differences.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from scipy.integrate import solve_ivp

from lwa import Cell, Material, Sphere, canonical_wave
from lwa.base.arrays import Array
from validation import Damping, Scene, measure, simulate
from validation.pulses.pulse import first_pulse
from validation.pulses.sensors import tracks
from validation.scenes.chains import PTFE_BEAD, STEEL_BEAD

UNSTATED = math.nan  # a published number whose sign, or which itself, is not given


class Beside(NamedTuple):
    """A published number and this project's.

    Attributes
    ----------
    there, here : float
        Their number, and ours.
    digits : int
        Digits of ours behind the point.
    unit : str
        "%" for a difference in parts of their number, "" for one of the numbers.
    """

    there: float
    here: float
    digits: int
    unit: str = ""

    @property
    def off(self) -> float:
        """This project's number less the published one, or the relative difference in percent."""
        if self.unit == "%":
            return 100 * (self.here / self.there - 1)
        return self.here - self.there


Rows = dict[str, Beside]


def rows() -> Rows:
    """All rows but those of the widths, which are a study's."""
    return {
        **paper(),
        **struck_steel(),
        **two_spheres(),
        **column(),
        **decays(),
        **slow_collisions(),
    }


def paper() -> Rows:
    """Exponent of the paper's column, and the extents of its pulses."""
    cell = Cell.of_spheres([STEEL_BEAD, PTFE_BEAD])
    speeds = []
    forces = []
    for blow in (1.4, 2.8, 4.8):
        chain = Scene.of_cell(
            cell, 19, "3/2", velocities=(blow,), duration=1.5e-3, bead_sensors=(14, 33)
        )
        run = simulate(chain, rtol=1e-10)
        near, far = (first_pulse(track.force) for track in tracks(run))
        speeds.append(1 / (far.arrival - near.arrival))
        forces.append((near.peak + far.peak) / 2)
    beta = float(canonical_wave(Cell([1], spacing=1), "3/2").beta)
    return {
        "exponent": Beside(0.1666, slope(forces, speeds), 4),
        "equal": Beside(5, math.pi / beta, 3, "%"),
        "light": Beside(10, 2 * math.pi / beta, 3, "%"),
    }


def slope(x: list[float] | Array, y: list[float] | Array) -> float:
    """The exponent of the power of x that fits y."""
    return float(np.polyfit(np.log(x), np.log(y), 1)[0])


def struck_steel() -> Rows:
    """Sixty steel beads, the first at 1 m/s."""
    R, rho, E, nu = 5e-3, 7780.0, 2.03e11, 0.3
    cell = Cell.of_spheres([Sphere.solid(R, Material(E=E, nu=nu, density=rho))])
    chain = Scene.of_cell(
        cell, 60, "3/2", velocities=(1,), duration=8e-4, samples=16001,
        bead_sensors=(20, 30, 40),
    )  # fmt: skip
    run = simulate(chain, rtol=1e-10)
    first, middle, last = (measure(run.time, v) for v in run.bead_velocity)
    speed = 40 * R / (last.arrival - first.arrival)
    c0 = math.sqrt(6 / (5 * math.pi * rho * 3 * (1 - nu**2) / (4 * E)))
    above = run.time[run.bead_velocity[1] > 0.01 * middle.peak]
    # the first stretch above: oscillations behind the pulse stay below
    end = np.argmax(np.append(np.diff(above) > 2 * run.time[1], True))
    length = (above[end] - above[0]) * speed / (2 * R)
    theory = c0**0.8 * middle.peak**0.2
    fwhm = 2 * math.acos(2**-0.25) * math.sqrt(10) * R  # of cos⁴
    return {
        "velocity": Beside(0.68, middle.peak, 4, "%"),
        "speed": Beside(UNSTATED, 100 * (speed / theory - 1), 2),
        "length": Beside(3.96, length, 3, "%"),
        "fwhm": Beside(-13, 100 * (middle.fwhm * speed / fwhm - 1), 1),
    }


def two_spheres() -> Rows:
    """Hertz's collision, and restitution under a viscous force of Kuwabara and Kono."""
    ball = Sphere.solid("0.01", Material(E="1e8", nu="0.3", density="2500"))
    m = float(ball.mass)
    A = float(Cell.of_spheres([ball]).stiffnesses[0])
    rate = 5e-5
    hertz = Scene(
        masses=(m, m), stiffnesses=(A,), k=1.5, velocities=(1,), duration=1e-3,
        contact_sensors=(0,), samples=20001,
    )  # fmt: skip
    run = simulate(hertz, rtol=1e-11)
    closed = run.time[run.contact_force[0] > 0][-1]
    deepest = run.compression.max()
    overlap = (15 * m / 2 / (16 * 1e8 / 1.82 * math.sqrt(5e-3))) ** 0.4
    viscous = Damping("kuwabara_kono", 1.5 * rate * A)
    unit = (m**2 / 4 / (5e-3 * (1e8 / 1.82) ** 2)) ** 0.2  # (m*²/(R* E*² v))^{1/5}
    return {
        "duration": Beside(0.832, 1e3 * closed, 3, "%"),
        "factor": Beside(2.87, closed / unit, 2),
        "constant": Beside(2.94, closed / deepest, 2),
        "overlap": Beside(UNSTATED, 100 * (deepest / overlap - 1), 3),
        "slow_pulls": Beside(0.809, rebound(m, A, 0.1, rate), 4, "%"),
        "fast_pulls": Beside(0.661, rebound(m, A, 3, rate), 4, "%"),
        "slow_pushes": Beside(0.809, restitution(m, A, 0.1, viscous), 4, "%"),
        "fast_pushes": Beside(0.661, restitution(m, A, 3, viscous), 4, "%"),
    }


def restitution(m: float, A: float, v: float, damping: Damping) -> float:
    """Restitution of two spheres whose contact never pulls."""
    blow = Scene(
        masses=(m, m), stiffnesses=(A,), k=1.5, velocities=(v,), duration=5e-3 * v**-0.2,
        damping=damping,
    )  # fmt: skip
    run = simulate(blow, rtol=1e-11)
    return float(run.velocities[1] - run.velocities[0]) / v


def rebound(m: float, A: float, v: float, rate: float) -> float:
    """Restitution under A (δ^{3/2} + (3/2) rate √δ dδ/dt) if the contact pulls until δ = 0."""

    def motion(t: float, state: Array) -> tuple[float, float]:
        delta = max(state[0], 0.0)
        speed = state[1]
        force = A * (delta**1.5 + 1.5 * rate * math.sqrt(delta) * speed)
        return speed, -2 / m * force

    def over(t: float, state: Array) -> float:
        return float(state[0]) if t else 1.0

    over.terminal = True
    over.direction = -1
    end = solve_ivp(
        motion, (0, 1), (0.0, v), "DOP853", events=over, rtol=1e-11, atol=1e-14
    )
    return float(-end.y[1, -1] / v)


def column(beads: int = 800) -> Rows:
    """Slopes of speed, velocity and displacement of a weak blow's front against the depth."""
    at = np.unique(np.geomspace(beads / 8, beads * 0.8, 8).astype(int))
    duration = 1.05 * np.sum(np.arange(1, beads + 1) ** (-1 / 6)) / math.sqrt(1.5) + 6
    weighed = Scene(
        masses=(1.0,) * beads, stiffnesses=(1.0,) * (beads - 1), wall=1.0, k=1.5, gravity=1.0,
        velocities=(1e-4,), duration=duration, bead_sensors=tuple(at.tolist()), samples=12001,
    )  # fmt: skip
    run = simulate(weighed, rtol=1e-9)
    moved = (run.bead_displacement - run.bead_displacement[:, :1]).max(axis=1)
    speed = np.diff(at) / np.diff(run.time[np.argmax(run.bead_velocity, axis=1)])
    velocity = run.bead_velocity.max(axis=1)
    return {
        "column_speed": Beside(1 / 6, slope((at[1:] + at[:-1]) / 2, speed), 3),
        "column_velocity": Beside(-1 / 4, slope(at, velocity), 3),
        "column_displacement": Beside(-1 / 12, slope(at, moved), 3),
    }


def decays() -> Rows:
    """Loss of force per twenty beads, in percent, at two mass ratios."""
    return {
        "loss_alike": Beside(UNSTATED, loss(0.98), 2),
        "loss_unlike": Beside(UNSTATED, loss(0.55), 1),
    }


def loss(ratio: float) -> float:
    """Loss of force between the contacts 20 and 40 of a struck dimer, in percent."""
    chain = Scene(
        masses=(1.0, ratio) * 50, stiffnesses=(1.0,) * 99, k=1.5, velocities=(1.0,),
        duration=60, contact_sensors=(20, 21, 40, 41),
    )  # fmt: skip
    run = simulate(chain, rtol=1e-9)
    peaks = [first_pulse(track.force).peak for track in tracks(run)]
    return 100 * (1 - sum(peaks[2:]) / sum(peaks[:2]))


def slow_collisions() -> Rows:
    """Exponent of 1 - e_r against the speed of slow collisions."""
    damping = Damping("kuwabara_kono", 0.05)
    speeds = [1e-6, 1e-5]
    lost = []
    for v in speeds:
        pair = Scene(
            masses=(1.0, 1.0), stiffnesses=(1.0,), k=1.5, velocities=(v,),
            duration=6 * v**-0.2, damping=damping,
        )  # fmt: skip
        run = simulate(pair, rtol=1e-11)
        lost.append(1 - (run.velocities[1] - run.velocities[0]) / v)
    return {"slow": Beside(1 / 5, slope(speeds, lost), 3)}
