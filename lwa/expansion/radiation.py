"""Radiation by the wave of a chain of unlike beads: the error that no order in ε removes.

Light beads rattle under the pulse and leave an oscillating tail. Let ξ be the position in the frame
of the pulse, F(ξ) its contact force with the peak 1, F' = dF/dξ, and Ω_o² the lowest optical Ω² at
κ = 0 (1/Π for a dimer, `lwa.linear.bloch`). An oscillation that stands in this frame has the
wavenumber K,

    K² = K_0² F^{(k-1)/k},    K_0² = Ω_o² - 1,

which falls towards the pulse's ends, as contacts are stiffer where they are pressed. The pulse
excites the oscillation in proportion to F'; the amplitude of the tail scales as

    R = |∫ K^{3/2} F' e^{i∫K} dξ|,

exponentially small in 1/ε where K_0 is large. R is computed with log F = φ_0 + ε φ_1, the first two
terms in X = √ε ξ (`lwa.Expansion.log_force`, φ_0 = -X²/(4I)), and is the largest value for a few
K_0 nearby, since the integral vanishes at the mass ratios without a tail.

`radiated`, a bound on the relative error of c², was fitted to exact waves of dimers with tails from
1e-9 to 0.1 and to pulses of struck chains. It is measured, not proved.
"""

from __future__ import annotations

import math
from functools import lru_cache
from typing import NamedTuple

import numpy as np
import sympy as sp

from lwa.base.arrays import Array
from lwa.cell import Cell
from lwa.expansion.observables import Observables, shares_model
from lwa.expansion.recursion import Recursion
from lwa.linear.dispersion import Dispersion

POINTS = 8001
SPAN = 20.0
"""Half the range of integration in Z = X/√I; F < e^{-100} at its ends."""

PHASES = (0.85, 0.92, 1.0, 1.08, 1.16)
"""Factors of K_0² that move the integral off its zeros."""

POWER = 0.75
"""Exponent of the amplitude in the bound `radiated`."""


class Parameters(NamedTuple):
    """Numbers of a chain on which its radiation depends; letters as in the module.

    I : coefficient I in the linear chain's dispersion Ω² = κ² - I κ⁴ + …
    optical : lowest optical Ω² at κ = 0, the Ω_o² of the module; infinite beyond a double.
    quadratic, quartic : coefficients of X² and X⁴ in φ_1.
    """

    I: float
    optical: float
    quadratic: float
    quartic: float


@lru_cache(maxsize=64)
def parameters(cell: Cell, k: sp.Expr) -> Parameters:
    """Return the parameters of a chain; all values are numbers, but for k under equal contacts."""
    model = shares_model(cell, k)
    wave = Observables(Recursion(model, 1))
    trace = [float(t) for t in Dispersion(cell, model.k).trace.values()]
    # 2 cos(Pκ) = 2 = t_0 at κ = 0, where one root is 0: the others are those of Σ t_m Ω^{2m-2}
    optical = min(np.roots(trace[:0:-1]).real, default=math.inf)
    phi_1 = wave.log_force(0)[sp.S.One]
    slopes = (float(phi_1.get(d, 0)) for d in (2, 4))
    return Parameters(float(wave.I), float(optical), *slopes)


def radiated(cell: Cell, k: sp.Expr) -> float:
    """Relative error of c², widths, momentum and energy at k that no order removes; all numbers.

    A bound for c²; widths near a resonance are off by up to three times as much, which the error of
    their asymptotic series covers (`lwa.expansion.sums`). 0 for equal beads and contacts.
    """
    # The difference to equal beads and contacts: (m1 - m2)²/(m1 + m2)² for a dimer, which has
    # I = (1 - 3b + 3b²)/3, b = m̂_1, hence (1 - 2b)².
    contrast = 0.0 if cell.uniform else 4 * parameters(cell, k).I - 1 / 3
    return contrast * amplitude(cell, k) ** POWER if contrast > 0 else 0.0


def amplitude(cell: Cell, k: sp.Expr) -> float:
    """Amplitude R of the tail for the peak force 1, times the lightest mass over the mean mass."""
    chain, epsilon = parameters(cell, k), float(k - 1)
    if math.isinf(chain.optical):
        return 0.0
    X = np.linspace(-SPAN, SPAN, POINTS) * np.sqrt(chain.I)
    log = -(X**2) / (4 * chain.I) + epsilon * (
        chain.quadratic * X**2 + chain.quartic * X**4
    )
    half = np.minimum.accumulate(
        log[POINTS // 2 :]
    )  # φ_1 may turn log F up far outside
    log = np.concatenate([half[:0:-1], half])
    step = float(X[1] - X[0]) / math.sqrt(epsilon)
    F, slope = np.exp(log), np.gradient(log, step)
    largest = max(
        _tail_integral(K_0 * np.exp(log * epsilon / (2 * float(k))), F * slope, step)
        for K_0 in (
            math.sqrt(factor * max(chain.optical - 1, 0.0)) for factor in PHASES
        )
    )
    return cell.size * float(min(cell.fractions)) * largest


def _tail_integral(K: Array, slope: Array, step: float) -> float:
    """|∫ K^{3/2} F' e^{i∫K} dξ| by the trapezoidal rule; the ends, where F' ≈ 0, are left out."""
    phase = np.concatenate([[0.0], np.cumsum((K[1:] + K[:-1]) / 2)]) * step
    return float(abs(np.sum(K**1.5 * slope * np.exp(1j * phase))) * step)
