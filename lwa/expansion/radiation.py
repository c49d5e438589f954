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

`Radiation.relative`, a bound on the relative error of c², was fitted to exact waves of dimers with
tails from 1e-9 to 0.1 and to pulses of struck chains. It is measured, not proved.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache
from typing import TYPE_CHECKING

import sympy as sp

from lwa.base.frozen import Value
from lwa.cell import Cell
from lwa.expansion.observables import Observables, shares_model
from lwa.linear.dispersion import Dispersion

if TYPE_CHECKING:
    from lwa.base.arrays import Array

POINTS = 8001
SPAN = 20.0
"""Half the range of integration in Z = X/√I; F < e^{-100} at its ends."""

PHASES = (0.85, 0.92, 1.0, 1.08, 1.16)
"""Factors of K_0² that move the integral off its zeros."""

POWER = 0.75
"""Exponent of the amplitude in the bound `Radiation.relative`."""


@dataclass(frozen=True)
class Radiation(Value):
    """Parameters of a chain that determine how its wave radiates; letters as in the module.

    contrast : the difference 4I - 1/3 to a chain of equal beads and contacts,
        (m1 - m2)²/(m1 + m2)² for a dimer of equal contacts.
    I : coefficient I in the linear chain's dispersion Ω² = κ² - I κ⁴ + …
    optical : lowest optical Ω² at κ = 0, the Ω_o² of the module.
    lightest : mass of the lightest bead divided by the mean mass.
    quadratic, quartic : coefficients of X² and X⁴ in φ_1.
    """

    contrast: float
    I: float
    optical: float
    lightest: float
    quadratic: float
    quartic: float

    def relative(self, k: float) -> float:
        """Relative error of c², widths, momentum and energy at this k that no order removes.

        A bound for c²; widths near a resonance are off by up to three times as much, which the
        error of their asymptotic series covers (`lwa.expansion.approximants`).
        """
        if self.contrast <= 0:
            return 0.0
        return float(self.contrast * self.amplitude(k) ** POWER)

    def amplitude(self, k: float) -> float:
        """Amplitude R of the tail at this k for the peak force 1, times ``lightest``."""
        import numpy as np  # start-up: `import lwa` does not load it

        epsilon = k - 1
        X = np.linspace(-SPAN, SPAN, POINTS) * np.sqrt(self.I)
        log = -(X**2) / (4 * self.I) + epsilon * (self.quadratic * X**2 + self.quartic * X**4)
        half = np.minimum.accumulate(log[POINTS // 2 :])  # φ_1 may turn log F up far outside
        log = np.concatenate([half[:0:-1], half])
        step = (X[1] - X[0]) / np.sqrt(epsilon)
        F, slope = np.exp(log), np.gradient(log, step)
        wavenumbers = (math.sqrt(factor * max(self.optical - 1, 0.0)) for factor in PHASES)
        return self.lightest * max(
            _tail_integral(K_0 * np.exp(log * epsilon / (2 * k)), F * slope, float(step))
            for K_0 in wavenumbers
        )


def _tail_integral(K: Array, slope: Array, step: float) -> float:
    """|∫ K^{3/2} F' e^{i∫K} dξ| by the trapezoidal rule; the ends, where F' ≈ 0, are left out."""
    import numpy as np  # start-up: `import lwa` does not load it

    phase = np.concatenate([[0.0], np.cumsum((K[1:] + K[:-1]) / 2)]) * step
    return float(abs(np.sum(K**1.5 * slope * np.exp(1j * phase))) * step)


@lru_cache(maxsize=64)
def radiation(cell: Cell, k: sp.Expr) -> Radiation | None:
    """The `Radiation` behind a pulse; None for equal beads and contacts, and for symbols.

    k may be a symbol where contacts are equal; the strain shares of unequal ones depend on k.
    """
    model = shares_model(cell, k)
    values = (*cell.masses, *cell.stiffnesses, model.k)
    if cell.uniform or any(x.free_symbols for x in values):
        return None
    import numpy as np  # start-up: `import lwa` does not load it

    wave = Observables(model, 1)
    trace = [float(t) for t in Dispersion(cell, model.k).trace.values()]
    trace[0] = 0.0  # 2 cos(Pκ) = 2 at κ = 0, where one root is 0
    squares = np.roots(trace[:0:-1]).real
    if not squares.size:  # optical frequencies beyond a double: the pulse excites none
        return None
    phi_1, I = wave.log_force(0)[sp.S.One], float(wave.I)
    return Radiation(
        contrast=(12 * I - 1) / 3,  # a dimer has I = (1 - 3b + 3b²)/3, b = m̂_1, hence (1 - 2b)²
        I=I,
        optical=float(np.min(squares)),
        lightest=cell.size * float(min(cell.fractions)),
        quadratic=float(phi_1.get(2, 0)),
        quartic=float(phi_1.get(4, 0)),
    )
