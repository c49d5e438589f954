"""Radiation by a wave of unlike beads: an error of its series that no order in ε removes.

Light beads rattle under the pulse. A rattle that stands in the pulse's frame has the wavenumber K,

    K² = K_0² F^{(k-1)/k},    K_0² = Ω_o² - 1,

with Ω_o² the lowest optical Ω² at κ = 0 (1/ν for a dimer). Contacts are stiffer where they are
pressed, so that K falls towards the pulse's ends. The slaved motion, of size F', excites a rattle

    R = |∫ K^{3/2} F' e^{i∫K} dξ|,

exponentially small in 1/ε where K_0 is large. R is computed with F = exp(φ_0 + ε φ_1), as the
largest value for some K_0 nearby, since the integral vanishes at the mass ratios without a tail.

`Radiation.relative`, a bound on the relative error of c² and the widths, was fitted to exact waves
of dimers with tails from 1e-9 to 0.1 and to pulses of struck chains. It is measured, not proved.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import TYPE_CHECKING

import sympy as sp
from flint import fmpq_mpoly

from lwa.algebra.model import Model
from lwa.base.frozen import Value
from lwa.cell import Cell
from lwa.expansion.pulse import by_degree
from lwa.expansion.recursion import Recursion
from lwa.law import Power
from lwa.linear.bloch import Bloch

if TYPE_CHECKING:
    from lwa.base.arrays import Array

POINTS = 8001
SPAN = 20.0
"""Half the range of integration in Z = X/√I; F < e^{-100} at its ends."""

PHASES = (0.85, 0.92, 1.0, 1.08, 1.16)
"""Factors of K_0² that move the integral off its zeros."""

FACTOR, POWER = 1.0, 0.75
"""Parameters of the bound FACTOR · contrast · R^POWER."""


@dataclass(frozen=True)
class Radiation(Value):
    """The numbers of a chain on which its radiation depends.

    contrast : 0 for equal beads and contacts, (1 - 2b)² for a dimer of equal contacts.
    I : of Ω² = κ² - I κ⁴ + …
    optical : the lowest optical Ω² at κ = 0.
    lightest : the lightest bead's mass over the mean mass.
    quadratic, quartic : φ_1 = quadratic X² + quartic X⁴ + odd terms.
    """

    contrast: float
    I: float
    optical: float
    lightest: float
    quadratic: float
    quartic: float

    def relative(self, k: float) -> float:
        """Bound on the relative error of c², widths, momentum and energy at this k."""
        if self.contrast <= 0:
            return 0.0
        return float(FACTOR * self.contrast * self.amplitude(k) ** POWER)

    def amplitude(self, k: float) -> float:
        """The rattle R at this k, over the pulse's peak force."""
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
            _rattle(K_0 * np.exp(log * epsilon / (2 * k)), F * slope, float(step))
            for K_0 in wavenumbers
        )


def _rattle(K: Array, slope: Array, step: float) -> float:
    """The rattle |∫ K^{3/2} F' e^{i∫K} dξ| by the trapezoidal rule; F' has decayed."""
    import numpy as np  # start-up: `import lwa` does not load it

    phase = np.concatenate([[0.0], np.cumsum((K[1:] + K[:-1]) / 2)]) * step
    return float(abs(np.sum(K**1.5 * slope * np.exp(1j * phase))) * step)


@lru_cache(maxsize=64)
def radiation(cell: Cell, k: sp.Expr) -> Radiation | None:
    """The radiation of a chain in numbers; None for equal beads and contacts, and for symbols.

    k may be a symbol where contacts are equal; others share the strain by it.
    """
    alike = len({*cell.stiffnesses}) == 1
    if alike and len({*cell.masses}) == 1:
        return None
    model = Model(cell, Power(sp.S.One if alike else k))
    if any(x.free_symbols for x in (*cell.masses, *cell.stiffnesses, model.k)):
        return None
    if not all(float(x) for x in (*cell.fractions, *cell.shares(model.k))):
        return None  # a mass or a compliance that underflows
    import numpy as np  # start-up: `import lwa` does not load it

    values = _values(model)
    trace = [_float(t, values) for t in Bloch(model).trace(cell.size)]
    trace[0] = 0.0  # 2 cos(Pκ) = 2 at κ = 0, where one root is 0
    squares = np.roots(trace[:0:-1]).real
    if not squares.size:  # optical frequencies beyond a double: the pulse excites none
        return None
    wave = Recursion(model, 2)
    I = _float(wave.I, (1.0, *values))
    first = by_degree(wave.fields.log_force[0][2])
    quadratic, quartic = (_float(first.get(d, wave.zero), (1.0, *values)) for d in (2, 4))
    return Radiation(
        contrast=(12 * I - 1) / 3,  # a dimer has I = (1 - 3b + 3b²)/3, hence (1 - 2b)²
        I=I,
        optical=float(np.min(squares)),
        lightest=cell.size * min(_float(mu, (1.0, *values)) for mu in wave.mu),
        quadratic=quadratic / I**4,
        quartic=quartic / I**5,
    )


def _values(model: Model) -> tuple[float, ...]:
    """Values of the generators of the coefficient ring."""
    values = [] if model.k.is_Rational else [model.k]
    for part in (model.ring.masses, model.ring.contacts):
        if part.names:
            values += [part.total * w / part.sum for w in part.distinct[:-1]]
    return tuple(float(sp.N(value)) for value in values)


def _float(polynomial: fmpq_mpoly, values: Sequence[float]) -> float:
    return math.fsum(
        float(c) * math.prod(v ** int(e) for v, e in zip(values, exponents, strict=True))
        for exponents, c in polynomial.terms()
    )
