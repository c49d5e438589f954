"""The theory that the lattice is compared with: traveling waves, and the integrated equation.

`lwa.PhysicalWave` is the wave with a given peak force. This module finds the wave with a given
speed dx/dt or momentum, the width of a bead's force, the mean of its two contact forces, and the
leading powers of the theory's error as k → 1.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
import scipy
import sympy as sp
from numpy.typing import ArrayLike

from lwa import Dimer, PhysicalWave, TravelingWave, canonical_wave, homogenize
from lwa.base.arrays import Array
from lwa.base.exact import number
from lwa.equation.evolution import Evolution
from lwa.wave.closed import CompactWave
from validation.scenes.checks import SceneError, integer, positive

TOLERANCE = 1e-10  # rtol of the integrated equation by default
QUANTITIES = ("FWHM of force", "FWHM of strain", "support π/β", "speed V_s at B = 1")
"""Lengths in D; force and strain are a contact's; the support is by the impulse ∫F dx / F_m."""


def theory_at(k: Any, omega: Any, closure: str = "linear") -> TravelingWave:
    """Return the theory's wave for masses 1 and ω, equal contacts A = 1 and D = 1.

    closure : "linear" (the paper's), "full", or "canonical" (full closure, canonical field).

    >>> theory_at("3/2", 1).width
    sqrt(10)*pi/2
    """
    cell = Dimer(1, omega, spacing=1)
    if closure == "canonical":
        return canonical_wave(cell, k)
    return homogenize(cell, k=k, closure=closure).pde.traveling_wave()


def theory_values(wave: TravelingWave) -> dict[str, sp.Expr]:
    """Return the exact values of `QUANTITIES` for the theory's wave."""
    values = wave.fwhm("force"), wave.fwhm("strain"), wave.width, wave.speed(1)
    return dict(zip(QUANTITIES, values, strict=True))


@dataclass(frozen=True)
class LeadingPower:
    """Leading power of the theory's error, coefficient · ε^order, and bounds of a measurement."""

    order: int
    coefficient: sp.Expr
    constant: float  # |error| ≤ constant · ε^order at each k measured
    order_bound: float  # relative, for the fitted order
    coefficient_bound: float  # relative, for the fitted coefficient

    def bound(self, k: sp.Expr) -> float:
        """Return the bound of |error| at k = 1 + ε."""
        return self.constant * float(k - 1) ** self.order


# Powers and coefficients are derived, not fitted. Let v(x) be the strain of the wave with peak 1,
# ε = k - 1 and X = √ε x (D = 1, equal masses). At fixed X, the series of log v in ε is
# -3X² + ε (18/5 X² - 3/10 X⁴) + … for the exact wave of the lattice, and
# -3X² + ε (9/2 X² - 3/2 X⁴) + … for the long-wave theory. The log of the force is k log v. c² is
# 1 - ε/2 + 2ε²/5 for the lattice against 2/(k+1) for the theory. Errors: theory/lattice - 1.
_WIDTH = LeadingPower(1, sp.Rational(3, 20) - sp.log(2) / 15, 0.113, 0.05, 0.01)
_SUPPORT = LeadingPower(1, sp.Rational(1, 20), 0.077, 0.2, 0.02)
_SPEED = LeadingPower(2, -sp.Rational(3, 40), 0.075, 0.15, 0.01)
LEADING_POWERS = dict(zip(QUANTITIES, (_WIDTH, _WIDTH, _SUPPORT, _SPEED), strict=True))


def of_speed(wave: TravelingWave, speed: float) -> PhysicalWave:
    """Return the theory's wave with a given speed dx/dt; `SceneError` unless it is positive."""
    return _with(wave, "speed", speed, -1)


def of_momentum(wave: TravelingWave, momentum: float) -> PhysicalWave:
    """Return the theory's wave with a given momentum; `SceneError` unless it is positive."""
    return _with(wave, "momentum", momentum, 1)


def _with(wave: TravelingWave, name: str, amount: float, sign: int) -> PhysicalWave:
    """Return the wave at which a quantity, ∝ F^{(k + sign)/(2k)}, has the given amount."""
    unit, exponent = PhysicalWave(wave, sp.S.One), (wave.k + sign) / (2 * wave.k)
    ratio = positive(amount, name) / number(getattr(unit, name))
    return PhysicalWave(wave, math.exp(math.log(ratio) / number(exponent)))


def bead_fwhm(wave: CompactWave) -> float:
    """Return the FWHM of a bead's force, a length that does not depend on the amplitude."""
    k, D = number(wave.k), number(wave.D)
    beta = (k - 1) / (2 * D * math.sqrt(number(wave.coefficient_sum)))

    def force(x: float) -> float:
        """Return a bead's force: cos^p(β(x ± D/2)) summed, p = 2k/(k-1), each 0 off its arch."""
        sides = (beta * (x + side) for side in (-D / 2, D / 2))
        return math.fsum(math.cos(y) ** (2 * k / (k - 1)) for y in sides if abs(y) < math.pi / 2)

    half, end = force(0.0) / 2, (math.pi / beta + D) / 2
    return 2 * float(scipy.optimize.brentq(lambda x: force(x) - half, 0, end, xtol=1e-14 * end))


@dataclass(frozen=True, eq=False)
class Continuum:
    """The long-wave equation (1 - I ∂_x²) u_ττ = ∂_x F(u_x) of a chain on a periodic interval.

    It is p_τ = v_x, (1 - I ∂_x²) v_τ = ∂_x F(p) in the strain p = u_x and the velocity v = u_τ, and
    its energy ∫ [½ v² + ½ I v_x² + W(p)] dx (`lwa.equation.evolution`). A power law has no tension:
    F(p) = 0 at p < 0. Raises `SceneError` for an equation with symbols.
    """

    equation: Evolution
    length: float  # the period
    points: int  # equidistant

    def __post_init__(self) -> None:
        positive(self.length, "length")
        integer(self.points, "points", 16, 2**20)
        cell, law = self.equation.cell, self.equation.law
        if names := sorted(map(str, {*cell.symbols, *law.symbols})):
            raise SceneError(f"{names[0]!r} has no value: numbers are wanted")

    @cached_property
    def x(self) -> Array:
        """Grid points, from -length/2 on."""
        return np.asarray(self.length * (np.arange(self.points) / self.points - 0.5))

    @cached_property
    def _wavenumbers(self) -> Array:
        return np.asarray(2 * np.pi / self.length * np.arange(self.points // 2 + 1))

    def _of_strain(self, p: Array, n: int) -> Array:
        """The force F(p) for n = 0, its potential W(p) for n = -1."""
        return np.asarray(self._laws[n](np.maximum(p, 0) if self.equation.law.homogeneous else p))

    @cached_property
    def _laws(self) -> dict[int, Any]:
        p = sp.Symbol("p", positive=True)
        return {n: sp.lambdify(p, self.equation.force(p, n), "numpy") for n in (0, -1)}

    def evolved(
        self, p: ArrayLike, v: ArrayLike, times: ArrayLike, rtol: float = TOLERANCE
    ) -> tuple[Array, Array]:
        """Return strain and velocity at the times τ, each (times, points), from p, v at τ = 0.

        The times rise from 0 on. Raises `SceneError` if the integration fails.
        """
        # The operator 1 - I ∂_x² is diagonal in Fourier coefficients. Frequencies are bounded by
        # c0/√I, so that an explicit method needs no small steps.
        n, inertia = self.points, 1 + float(self.equation.I) * self._wavenumbers**2
        slope = 1j * self._wavenumbers
        if n % 2 == 0:
            slope[-1] = 0  # the shortest wave, ±1 in turn, has no slope at the points

        def rate(tau: float, state: Array) -> Array:
            strain, velocity = state.reshape(2, n)
            acceleration = scipy.fft.rfft(self._of_strain(strain, 0)) * slope / inertia
            stretching = scipy.fft.rfft(velocity) * slope
            return np.ravel(scipy.fft.irfft((stretching, acceleration), n))

        at, start = np.asarray(times, float), np.concatenate((p, v), dtype=float)
        tolerances = {"rtol": rtol, "atol": rtol * np.abs(start).max()}
        path = scipy.integrate.solve_ivp(rate, (0.0, at[-1]), start, "DOP853", at, **tolerances)
        if not path.success:
            raise SceneError(f"the integration ends at τ = {path.t[-1]:.6g}: {path.message}")
        strain, velocity = path.y.T.reshape(len(at), 2, n).swapaxes(0, 1)
        return strain, velocity

    def energy(self, p: Array, v: Array) -> Array:
        """Return the energy, (…), of strains and velocities, (…, points)."""
        slope = scipy.fft.irfft(1j * self._wavenumbers * scipy.fft.rfft(v), self.points)
        density = (v**2 + float(self.equation.I) * slope**2) / 2 + self._of_strain(p, -1)
        return np.asarray(density.sum(axis=-1) * self.length / self.points)
