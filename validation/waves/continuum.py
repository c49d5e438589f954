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
