"""Damping of the contacts and the drive of the first bead."""

from __future__ import annotations

import cmath
import math
from dataclasses import dataclass
from functools import cache, cached_property
from typing import Any

import numpy as np

from lwa.base.arrays import Array
from validation.scenes.checks import (
    SceneError,
    between,
    each,
    finite,
    one_of,
    one_or_each,
    positive,
)

DAMPINGS = ("contact", "kuwabara_kono", "restitution")


@dataclass(frozen=True)
class Damping:
    """Dissipation in the contacts; a damped contact of a law that opens never pulls.

    Parameters
    ----------
    kind : {"contact", "kuwabara_kono", "restitution"}
        "contact" adds ``γ dδ/dt`` to the force of a closed contact. "kuwabara_kono" adds ``γ
        δ^{k-1} dδ/dt`` (Kuwabara and Kono 1987). "restitution" adds ``c δ^{(k-1)/2} dδ/dt``: two
        beads that collide part with the same share of their speed, whatever the speed
        (`restitution`).
    value : float or sequence of float
        γ, or the share, the coefficient of restitution; one for all contacts, or one for each,
        the wall's last. In a sequence a γ of 0 and a share of 1 stand for no damping.
    """

    kind: str
    value: float | tuple[float, ...]

    def __post_init__(self) -> None:
        one_of(self.kind, DAMPINGS, "damping")
        value = one_or_each(finite)(self.value, self.kind)
        # `between` and `positive` are called for their refusals alone.
        numbers = np.atleast_1d(value).tolist()
        for number in {*numbers}:
            if self.kind == "restitution":
                # At 0.01 the damping ratio ζ is 4.8: hardly any rebound is left.
                wanted = "a coefficient from 0.01 to 1 is wanted"
                between(number, self.kind, 0.01, 1, wanted)
            elif number or isinstance(value, float):
                positive(number, self.kind)
        object.__setattr__(self, "value", value)

    @property
    def undamped(self) -> float:
        """The ``value`` that means no damping: the restitution 1, or ``γ = 0``."""
        return 1.0 if self.kind == "restitution" else 0.0

    def power(self, k: Any) -> Any:
        """Return the exponent of δ in front of the rate dδ/dt, by the kind (see `Damping`).

        k is a number or an array, and the exponent has its shape.
        """
        if self.kind == "contact":
            return 0.0 * k
        return k - 1 if self.kind == "kuwabara_kono" else (k - 1) / 2

    def coefficients(self, k: Any, stiffnesses: Array, masses: Array) -> Array:
        """Return the factors of ``δ^power dδ/dt``, (contacts,).

        Parameters
        ----------
        k : float or array
            Exponent of the contacts, or of each contact.
        stiffnesses, masses : array
            Stiffnesses A and reduced masses of the two beads of each contact.
        """
        value = np.broadcast_to(self.value, stiffnesses.shape)
        # γ is a factor itself, whatever the masses.
        if self.kind != "restitution":
            return value.astype(float)
        ratios = np.array([damping_ratio(share) for share in value.tolist()])
        # c of the damping ratio ζ = c/√(2(k+1) m A), see `restitution`
        return np.asarray(2 * ratios * np.sqrt((k + 1) / 2 * masses * stiffnesses))


def restitution(ratio: float) -> float:
    """Return the coefficient of restitution at a damping ratio ζ.

    Two beads of reduced mass m collide under ``F = A δ^k + c δ^{(k-1)/2} dδ/dt``: ``m d²δ/dt² =
    -F``. In the variable ``s = δ^{(k+1)/2}`` and the time τ with ``dτ = √((k+1)A/(2m)) δ^{(k-1)/2}
    dt`` this is a damped linear oscillator, ``s'' + 2ζ s' + s = 0`` with ``ζ = c/√(2(k+1) m A)``
    (Antypov and Elliott 2011, EPL 94, 50004, for spheres). There s' is proportional to the velocity
    dδ/dt, and ``δ^{(k-1)/2} s''`` to -F. As contacts do not pull, the collision ends where the
    force is zero (Schwager and Pöschel 2007, Granular Matter 9, 465), at ``s'' = 0``.
    """
    if ratio == 1:  # the limit of what follows, which is 0/0
        return math.exp(-2)
    # From s = 0 and s' = 1 on, s = e^{-ζτ} sin(uτ)/u with u = √(1-ζ²), here `turn`. For ζ = cos a,
    # u = sin a, s'' is proportional to sin(uτ - 2a): it vanishes at the end τ = 2a/u. There s' is
    # -e^{-ζτ}, and without its sign the restitution, as it began with 1. For ζ > 1 both a and u are
    # imaginary, and their ratio is real.
    turn = cmath.sqrt(1 - ratio * ratio)
    end = 2 * abs(cmath.acos(ratio) / turn)
    return math.exp(-ratio * end)


@cache  # a long chain has few kinds of contacts
def damping_ratio(share: float) -> float:
    """Return the damping ratio of a coefficient of restitution, the inverse of `restitution`."""
    from scipy.optimize import brentq  # start-up

    # All digits of a small ratio as well: near ζ = 0 the share is 1 - πζ. At ζ = 1000 the share is
    # 2.5e-7, far below the least that is read.
    return float(
        brentq(lambda ratio: restitution(ratio) - share, 0, 1e3, xtol=1e-20, rtol=1e-15)
    )


def oscillation(
    t: Any, amplitude: float, w: float, ramp: float
) -> tuple[Any, Any, Any]:
    """Return ``amplitude r(t) sin(wt)`` and its first and second derivative at times of any shape.

    The factor r grows from 0 to 1 within ``ramp``; it is 1 for a ramp of 0. The engine compiles
    this function.
    """
    s, pace = 1.0, 0.0
    if ramp > 0.0:
        s, pace = np.minimum(t / ramp, 1.0), 1 / ramp
    # s³ (10 - 15 s + 6 s²) has two derivatives that vanish at both ends
    r = s * s * s * (10 - 15 * s + 6 * s * s)
    dr = 30 * s * s * (1 - s) * (1 - s) * pace
    ddr = 60 * s * (1 - s) * (1 - 2 * s) * pace * pace
    sin, cos = np.sin(w * t), np.cos(w * t)
    v = dr * sin + r * w * cos
    a = ddr * sin + 2 * dr * w * cos - r * w * w * sin
    return amplitude * r * sin, amplitude * v, amplitude * a


@dataclass(frozen=True, kw_only=True)
class Drive:
    """Prescribed motion of the first bead, of exactly one of three kinds.

    Parameters
    ----------
    velocity : float, optional
        Constant velocity of a piston.
    amplitude, frequency : float, optional
        Amplitude and frequency of the motion ``amplitude sin(2π frequency t)``.
    ramp : float, optional
        Time within which the oscillation grows smoothly to its full size.
    time, displacement : sequence of float, optional
        Rows of equal length from time 0 to the duration or beyond, joined by a cubic spline.
    """

    velocity: float | None = None
    amplitude: float | None = None
    frequency: float | None = None
    ramp: float = 0.0
    time: tuple[float, ...] = ()
    displacement: tuple[float, ...] = ()

    def __post_init__(self) -> None:
        for name in ("time", "displacement"):
            given = getattr(self, name)
            row = each(finite)(given, f"drive.{name}")
            object.__setattr__(self, name, row)
        # A piston may stand still: 0 is a velocity.
        constant = self.velocity is not None
        harmonic = self.amplitude is not None or self.frequency is not None
        recorded = bool(self.time or self.displacement)
        if constant + harmonic + recorded != 1:
            wanted = (
                "velocity, amplitude and frequency, or time and displacement are wanted"
            )
            raise SceneError(f"drive has not one motion: {wanted}")
        ramp = between(self.ramp, "drive.ramp", 0, math.inf, "it must not be negative")
        if ramp and not harmonic:
            wrong = "it belongs to amplitude and frequency"
            raise SceneError(f"drive.ramp is {ramp:g}: {wrong}")
        # Read for their refusals alone.
        if constant:
            finite(self.velocity, "drive.velocity")
        if harmonic:
            # An oscillation needs both numbers: neither has a default.
            finite(self.amplitude, "drive.amplitude")
            positive(self.frequency, "drive.frequency")
        if recorded:
            self._check_record()

    def _check_record(self) -> None:
        """Refuse times and displacements through which no spline goes."""
        times, places = len(self.time), len(self.displacement)
        # A cubic spline without conditions at its ends takes four points.
        if times != places or times < 4:
            wanted = "equally many, four or more, are wanted"
            raise SceneError(
                f"drive has {times} times and {places} displacements: {wanted}"
            )
        if self.time[0] != 0 or min(np.diff(self.time)) <= 0:
            raise SceneError("drive.time must begin with 0 and increase")
        try:
            # Called for a refusal alone: the spline is made here.
            with np.errstate(all="ignore"):
                self.at(0.0)
        except ValueError:  # SciPy's, of slopes that overflow
            raise SceneError(
                "drive.displacement changes too fast for floats: choose other units"
            ) from None

    @cached_property
    def _spline(self) -> Any:
        """The displacement of a file as a cubic spline of time."""
        from scipy.interpolate import CubicSpline  # start-up

        return CubicSpline(self.time, self.displacement)

    @property
    def oscillation(self) -> tuple[float, float]:
        """Amplitude and angular frequency 2π · frequency of a harmonic drive."""
        return self.amplitude or 0.0, 2 * math.pi * (self.frequency or 0.0)

    def at(self, t: Any) -> tuple[Any, Any, Any]:
        """Return displacement, velocity and acceleration of the bead at times t of any shape."""
        if self.velocity is not None:
            return self.velocity * t, self.velocity + 0 * t, 0 * t
        if self.time:
            return tuple(self._spline(t, order) for order in range(3))
        return oscillation(t, *self.oscillation, self.ramp)

    @property
    def cubics(self) -> tuple[Array, Array]:
        """Beginnings of the intervals, and coefficients (intervals, 4) of cubics in each of them.

        The cubics are the motion except the oscillation.
        """
        if self.time:
            # SciPy's array (4, intervals) has the highest power first.
            rising = self._spline.c[::-1].T
            return self._spline.x[:-1], np.ascontiguousarray(rising)
        return np.zeros(1), np.array([[0.0, self.velocity or 0.0, 0.0, 0.0]])

    @property
    def fastest(self) -> float:
        """Approximate greatest speed of the bead."""
        if self.velocity is not None:
            return abs(self.velocity)
        if self.time:
            velocities = self._spline(self.time, 1)
            return float(np.abs(velocities).max())
        amplitude, w = self.oscillation
        return abs(amplitude) * w

    @property
    def longest_step(self) -> float:
        """Longest step in time that resolves the drive; infinite at a constant velocity."""
        # An eighth of a period. Extrema and inflections of a sine take turns a quarter of a period
        # apart: a step holds one of them at most.
        if self.frequency is not None:
            return 1 / (8 * self.frequency)
        # Between two times of a file the motion is a cubic, with one inflection at most.
        longest = np.diff(self.time).max(initial=0.0)
        return float(longest) or math.inf
