"""The long-wave equation (1 - I ∂_x²) u_ττ = ∂_x F(u_x), integrated on a periodic interval.

With the strain p = u_x and the velocity v = u_τ,

    p_τ = v_x,    (1 - I ∂_x²) v_τ = ∂_x F(p),

where the operator 1 - I ∂_x² is diagonal in Fourier coefficients (SciPy's FFT). Frequencies are
bounded by c0/√I, so that an explicit method (SciPy's DOP853) needs no small steps. The equation and
its energy ∫ [½ v² + ½ I v_x² + W(p)] dx are those of `lwa.equation.evolution`. A power law has no
tension: F(p) = 0 at p < 0.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
import scipy
import sympy as sp
from numpy.typing import ArrayLike

from lwa.base.arrays import Array
from lwa.equation.evolution import Evolution
from validation.scenes.checks import SceneError, integer, positive

TOLERANCE = 1e-10  # rtol by default


@dataclass(frozen=True, eq=False)
class Continuum:
    """The long-wave equation of a chain on ``points`` equidistant points of a period ``length``.

    Raises `SceneError` for an equation with symbols.
    """

    equation: Evolution
    length: float
    points: int

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
    def _waves(self) -> Array:
        """Wavenumbers of the Fourier coefficients."""
        return np.asarray(2 * np.pi / self.length * np.arange(self.points // 2 + 1))

    @cached_property
    def _laws(self) -> tuple[Any, Any]:
        """The force F and its potential W as functions of arrays."""
        p = sp.Symbol("p", positive=True)
        force, energy = (sp.lambdify(p, self.equation.force(p, n), "numpy") for n in (0, -1))
        return force, energy

    def _pressed(self, p: Array) -> Array:
        return np.maximum(p, 0) if self.equation.law.homogeneous else p

    def evolved(
        self, p: ArrayLike, v: ArrayLike, times: ArrayLike, rtol: float = TOLERANCE
    ) -> tuple[Array, Array]:
        """Return strain and velocity at the times τ, each (times, points), from p, v at τ = 0.

        The times rise from 0 on. Raises `SceneError` if the integration fails.
        """
        n, inertia = self.points, 1 + float(self.equation.I) * self._waves**2
        force, slope = self._laws[0], 1j * self._waves
        if n % 2 == 0:
            slope[-1] = 0  # the sawtooth has no slope at the points

        def rate(tau: float, state: Array) -> Array:
            strain, velocity = state.reshape(2, n)
            pushed = scipy.fft.rfft(force(self._pressed(strain))) * slope / inertia
            moved = scipy.fft.rfft(velocity) * slope
            return np.concatenate((scipy.fft.irfft(moved, n), scipy.fft.irfft(pushed, n)))

        at = np.asarray(times, float)
        start = np.concatenate((np.asarray(p, float), np.asarray(v, float)))
        size = np.abs(start).max()
        found = scipy.integrate.solve_ivp(
            rate, (0.0, float(at[-1])), start, "DOP853", at, rtol=rtol, atol=rtol * size
        )
        if not found.success:
            raise SceneError(f"the integration ends at τ = {found.t[-1]:.6g}: {found.message}")
        strain, velocity = found.y.T.reshape(len(at), 2, n).swapaxes(0, 1)
        return strain, velocity

    def energy(self, p: Array, v: Array) -> Array:
        """Return the energy, (…), of strains and velocities, (…, points)."""
        slope = scipy.fft.irfft(1j * self._waves * scipy.fft.rfft(v), self.points)
        density = v**2 / 2 + float(self.equation.I) * slope**2 / 2
        density = density + self._laws[1](self._pressed(p))
        return np.asarray(density.sum(axis=-1) * self.length / self.points)
