"""The contact law of a chain, read off its pulses: from peak contact forces F and speeds V.

**One power.** For F = A δ^k, mean mass m̄ and spacing D the lattice's wave has

    V²/D² = R(k) 2/((k+1) m̄) A^{1/k} F^{(k-1)/k},

where R is the squared speed of the lattice's wave divided by that of the long-wave theory. So ln V
is linear in ln F; least squares give k and A, and with k = 3/2 (Hertz) the unknown Young's modulus
E of one material.

**Any law** F(δ) = W'(δ). In the long-wave theory S = m̄ V²/(R D²) is 2 W/δ², δ the peak
compression. Differentiation of S δ² = 2 W with respect to F gives

    dδ/dF = δ² S_F / (2 (F - S δ)),   k = 1/(1 - 2 d ln V/d ln F),

with S_F = dS/dF and the local exponent k. The equation is integrated downwards from the strongest
pulse, where δ = 2 F/((k+1) S), as it is unstable upwards. ln V is a polynomial of ln F, R = R(k).

R comes from the series in k - 1 for equal beads, and otherwise from the steady pulses of struck
chains (`validation.pulses.steady`). Errors are 95 % intervals, for the free law from refits with
resampled noise. Standard deviations of the data, if known, only weight the data; the size of the
noise is estimated from the residuals.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np
import scipy
import sympy as sp
from numpy.polynomial import polynomial

from lwa import Cell, expand
from lwa.base.arrays import Array
from validation.pulses.pulse import Measured
from validation.pulses.steady import STRETCH, point
from validation.scenes.checks import SceneError

_EXPONENTS = ("5/4", "3/2", "2", "5/2", "3", "4")  # at which R is known; R(1) = 1
_ORDER = 8  # of the series of R for equal beads
_DRAWS = 200  # of resampled noise
_STEPS = 60  # of ln F, at which the free law is integrated
_HERTZ = 1.5
_NEAR = 1.2  # times 80 sites, over which the pulse must lead


@lru_cache(maxsize=16)
def speed_ratio(omega: sp.Rational) -> Callable[[Any], Array]:
    """Return R(k) of a chain of masses 1, ω, 1, ω, … as a function of floats 1 ≤ k ≤ 4."""
    nodes, found = [1.0], [1.0]
    for k in map(sp.Rational, _EXPONENTS):
        if omega == 1:
            c2 = expand(Cell((1,), spacing=1), _ORDER).c2.at(k=k).value
        else:
            # Pulses are measured near the blow, where one that is overtaken later still leads.
            read = point(k, omega, STRETCH, farther=_NEAR)
            if read.missing:
                raise SceneError(f"no speed of the lattice's pulse at k = {k}: {read.missing}")
            c2 = read.numbers["speed"].value ** 2
        nodes.append(float(k))
        found.append(c2 * float((k + 1) * (1 + omega) / 4))
    spline = scipy.interpolate.CubicSpline(nodes, found)
    return lambda k: np.asarray(spline(np.clip(k, nodes[0], nodes[-1])))


@dataclass(frozen=True, eq=False)
class Medium:
    """Chain of the measured pulses: mean mass m̄, spacing D and speed ratio R(k)."""

    mass: float
    spacing: float
    ratio: Callable[[Any], Array]

    @classmethod
    def of(cls, cell: Cell) -> Medium:
        """Make the medium of a cell of one or two masses, in numbers."""
        if cell.size > 2:
            raise SceneError(f"the cell has {cell.size} beads: one or two are wanted")
        ratio = speed_ratio(sp.Rational(cell.masses[-1] / cell.masses[0]))
        return cls(float(sum(cell.masses)) / cell.size, float(cell.spacing), ratio)

    def log_stiffness(self, slope: float, constant: float) -> float:
        """Return ln A of the power law with ln V = slope · ln F + constant."""
        k = 1 / (1 - 2 * slope)
        unit = math.log(2 * float(self.ratio(k)) / ((k + 1) * self.mass)) / 2
        return 2 * k * (constant - math.log(self.spacing) - unit)


@dataclass(frozen=True, eq=False)
class PowerFit:
    """Fit of F = A δ^k: k, A, the correlation of k and ln A, and A at k = 3/2 (``hertz``).

    curvature : coefficient of (ln F)² in a parabola through the data ln V; 0 for one power.
    residual : root mean square of the residuals of ln V.
    """

    k: Measured
    A: Measured
    correlation: float
    hertz: Measured
    curvature: Measured
    residual: float

    @property
    def one_power(self) -> bool:
        """True if the curvature is 0 within its error."""
        return abs(self.curvature.value) <= self.curvature.error


def weights(force: Array, speed: Array, force_error: Array, speed_error: Array) -> Array:
    """Return the weights (N,) of pulses, from the standard deviations of their forces and speeds.

    A residual of ln V = slope · ln F + constant has the variance (σ_V/V)² + (slope σ_F/F)², with
    the slope of a first fit without weights. The weights are the inverse standard deviations.
    """
    slope = np.polyfit(np.log(force), np.log(speed), 1)[0]
    return np.asarray(1 / np.hypot(speed_error / speed, slope * force_error / force))


def fit_power(medium: Medium, force: Array, speed: Array, weight: Array | None = None) -> PowerFit:
    """Fit one power F = A δ^k to peak forces and speeds (N,), N ≥ 4, by least squares of ln V.

    weight : (N,), see `weights`; by default all pulses weigh the same.
    """
    x, y = np.log(force), np.log(speed)
    w = np.ones_like(x) if weight is None else weight
    middle = np.average(x, weights=w**2)  # slope and constant are uncorrelated about it
    (slope, constant), covariance = np.polyfit(x - middle, y, 1, w=w, cov=True)
    interval = scipy.stats.t.ppf(0.975, len(x) - 2)

    def read(slope: float, constant: float) -> Array:
        """Return k and ln A."""
        return np.array(
            [1 / (1 - 2 * slope), medium.log_stiffness(slope, constant - slope * middle)]
        )

    value = read(slope, constant)
    step = 1e-6
    jacobian = (
        np.array([read(slope + step, constant), read(slope, constant + step)]) - value
    ).T / step
    spread = jacobian @ covariance @ jacobian.T
    k_error, log_error = interval * np.sqrt(np.diag(spread))
    sixth = (_HERTZ - 1) / (2 * _HERTZ)
    apart = y - sixth * x
    (mean,), variance = np.polyfit(x, apart, 0, w=w, cov=True)
    hertz = medium.log_stiffness(sixth, mean)
    hertz_error = 2 * _HERTZ * interval * math.sqrt(variance[0, 0])
    parabola, noise = np.polyfit(x - middle, y - constant, 2, w=w, cov=True)
    bound = scipy.stats.t.ppf(0.975, len(x) - 3) * math.sqrt(noise[0, 0])
    share = np.linalg.pinv(w[:, np.newaxis] * np.vander(x - middle, 3))[0] * w  # of each ln V
    digits = np.finfo(float).eps * (1 + np.abs(x) + np.abs(y))  # rounding of ln V and ln F
    bound += np.abs(share) @ digits
    return PowerFit(
        Measured(value[0], value[0] + k_error),
        Measured(math.exp(value[1]), math.exp(value[1] + log_error)),
        float(spread[0, 1] / math.sqrt(spread[0, 0] * spread[1, 1])),
        Measured(math.exp(hertz), math.exp(hertz + hertz_error)),
        Measured(parabola[0], parabola[0] + bound),
        float(np.std(y - np.polyval((slope, constant), x - middle))),
    )


def free_law(
    medium: Medium,
    force: Array,
    speed: Array,
    degree: int = 3,
    seed: int = 0,
    weight: Array | None = None,
) -> tuple[Array, Array]:
    """Return the compression at each force, and the error of the force at this compression, (N,).

    degree : degree of the polynomial ln V(ln F). seed : seed of the resampled noise.
    weight : (N,), see `weights`; by default all pulses weigh the same.
    """
    x, y = np.log(force), np.log(speed)
    w = np.ones_like(x) if weight is None else weight
    middle = x.mean()
    best = polynomial.polyfit(x - middle, y, degree, w=w)
    rest = y - polynomial.polyval(x - middle, best)
    noise = math.sqrt(np.sum((w * rest) ** 2) / (len(x) - degree - 1)) / w
    drawn = np.random.default_rng(seed).normal(0, noise[:, None], (len(x), _DRAWS))
    fitted = polynomial.polyfit(x - middle, (y - rest)[:, None] + drawn, degree, w=w)
    rows = np.column_stack((best, fitted))  # (degree + 1, 1 + draws)
    grid = np.linspace(x.max(), x.min(), _STEPS)
    log_delta = _integrated(medium, rows, grid, middle)
    at = scipy.interpolate.CubicSpline(grid[::-1], log_delta[::-1])
    steepness = 1 / at(x, 1)[:, 0]  # d ln F/d ln δ
    spread = np.ptp(np.quantile(at(x), (0.025, 0.975), axis=1), axis=0) / 2
    return np.exp(at(x)[:, 0]), force * np.abs(steepness) * spread


def _integrated(medium: Medium, rows: Array, grid: Array, middle: float) -> Array:
    """Return ln δ on a falling grid of ln F, for each column of coefficients of ln V."""

    def log_S(x: float) -> tuple[Array, Array]:
        """Return ln S and the local exponent k."""
        slope = polynomial.polyval(x - middle, polynomial.polyder(rows))
        k = 1 / (1 - 2 * np.minimum(slope, 0.49))
        log_V = polynomial.polyval(x - middle, rows)
        return 2 * (log_V - math.log(medium.spacing)) + np.log(medium.mass / medium.ratio(k)), k

    def slope(x: float, log_delta: Array) -> Array:
        """Return d ln δ/d ln F."""
        S, step = log_S(x)[0], 1e-4
        change = (log_S(x + step)[0] - log_S(x - step)[0]) / (2 * step)
        share = np.minimum(np.exp(S + log_delta - x), 1 - 1e-6)  # S δ/F = 2/(k+1) of a power
        return np.asarray(change / 2 * share / (1 - share))

    S, k = log_S(grid[0])
    start = math.log(2) + grid[0] - np.log(k + 1) - S
    path = scipy.integrate.solve_ivp(slope, grid[[0, -1]], start, t_eval=grid, rtol=1e-8)
    return np.asarray(path.y.T)
