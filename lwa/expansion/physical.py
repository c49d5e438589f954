"""Waves of the lattice in the cell's units: at a given force, from a striker.

A power law has no scale of its own: the speed scales as F^{(k-1)/(2k)} with the peak force F of the
first contact, and widths in sites do not depend on F.

The wave of a chain of equal beads has the momentum P and the energy E of a particle of mass
m_eff = P²/(2E), and collides nearly like such a quasi-particle. An elastic collision with a striker
of mass m_s and velocity v gives it the velocity w = 2 m_s v/(m_s + m_eff), hence E = ½ m_eff w²,
and E ∝ F^{(k+1)/k} gives the peak force F. This is a rule; its errors are bounds of measured errors
(cf. Job et al., Granular Matter 10, 13 (2007)).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import sympy as sp

from lwa.base import latex
from lwa.base.exact import InputError, positive, shorten
from lwa.base.frozen import Estimate, Value, known_extent
from lwa.cell import Cell, exponent
from lwa.expansion.expand import Expansion, expand
from lwa.expansion.series import EpsilonSeries
from lwa.expansion.sums import Resummed
from lwa.spheres.beads import GRAVITY as GRAVITY

ORDER = 10
"""Order in k - 1 of the sums for strikes."""


@dataclass(frozen=True)
class ExpandedWave(Value):
    """The wave of an expansion whose first contact has the peak force F, in the cell's units.

    Raises `lwa.InputError` unless k, the cell with its spacing, and F > 0 are numbers, and where a
    series has no sum.

    >>> from lwa import Cell, expand
    >>> wave = ExpandedWave(expand(Cell([1], spacing=2), 16, k="3/2"), 64)
    >>> round(wave.speed.value, 6), round(wave.fwhm("force").value, 6)
    (3.622063, 2.823857)
    """

    expansion: Expansion
    F: sp.Expr

    def __post_init__(self) -> None:
        object.__setattr__(self, "F", positive(self.F, "force"))
        for name, value in (
            ("force", self.F),
            ("spacing", self.expansion.cell.spacing),
        ):
            if not value.is_number:
                raise InputError(f"{name} is {shorten(value)}: a number is wanted")

    @property
    def speed(self) -> Resummed:
        """Speed dx/dt."""
        speed = self._at_force(self.expansion.c, (self.expansion.k - 1) / 2)
        return speed * float(self.expansion.cell.spacing)

    def fwhm(self, quantity: str = "strain", extent: str = "length") -> Resummed:
        """Full width at half maximum of "strain", "force" or "velocity", a "length" or a "time"."""
        known_extent(extent)
        width = self.expansion.fwhm(quantity).at() * float(self.expansion.cell.spacing)
        return width if extent == "length" else width / self.speed

    @property
    def momentum(self) -> Resummed:
        """Momentum Σ m v of the chain."""
        return self._at_force(self.expansion.momentum, (self.expansion.k + 1) / 2)

    @property
    def energy(self) -> Resummed:
        """Kinetic and elastic energy."""
        return self._at_force(self.expansion.energy, self.expansion.k + 1)

    def latex_rows(self) -> list[str]:
        """LaTeX of peak force, speed and width of the force, without units."""
        return _rows(latex.expression(self.F), self)

    def _at_force(self, series: EpsilonSeries, power: sp.Expr) -> Resummed:
        """Sum a quantity that scales as the compression to this power, at the peak force F."""
        return series.at() * float(self.F ** (power / self.expansion.k))


def _rows(force: str, wave: ExpandedWave | Strike) -> list[str]:
    try:
        speed, width = wave.speed.latex(), wave.fwhm("force", "length").latex()
    except InputError:
        speed = width = r"\text{no sum}"
    names = ("F", latex.SPEED, r"\mathrm{FWHM}_{\mathrm{force}}")
    return [
        f"{name} = {x}" for name, x in zip(names, (force, speed, width), strict=True)
    ]


@dataclass(frozen=True)
class Strike(Value):
    """The leading pulse of a chain of equal beads struck by a mass, in the units of the cell.

    chain : the expansion of the chain's wave, all numbers.
    mass, velocity : mass and velocity of the striker; its contact is like those of the chain.

    The error of the force bounds the differences to struck chains at k = 5/4 … 5/2 and m_s of ½ to
    8 beads, and is NaN at other exponents. A contact of the striker half or twice as stiff changes
    the force by up to 2 %.

    >>> strike = pulse_of_strike(Cell([1], spacing=1), mass=1, velocity=1)
    >>> round(strike.force.value, 4), abs(0.63955 - strike.force.value) < strike.force.error < 0.014
    (0.6353, True)
    """

    chain: Expansion
    mass: sp.Expr
    velocity: sp.Expr

    @cached_property
    def _effective_mass(self) -> float:
        return self.chain.effective_mass.at().value

    @cached_property
    def wave(self) -> ExpandedWave:
        """The chain's wave of the same peak force; its errors leave out that of the rule."""
        k, m = self.chain.k, self._effective_mass
        w = 2 * float(self.mass * self.velocity) / (float(self.mass) + m)
        unit = self.chain.energy.at().value
        power = float(k / (k + 1))  # w² may be beyond a double where F is not
        return ExpandedWave(self.chain, (m / (2 * unit)) ** power * w ** (2 * power))

    @property
    def force(self) -> Estimate:
        """Peak force of a contact."""
        value, log = (
            float(self.wave.F),
            math.log(float(self.mass) / self._effective_mass),
        )
        # Measured: b ln²(m_s/m_eff), b = 3 % for strikers heavier than m_eff and 13 % for lighter
        # ones, and 0.7 % from m_eff to 2 beads.
        measured = sp.Rational(5, 4) <= self.chain.k <= sp.Rational(5, 2)
        error = (
            max(0.007, (0.03 if log > 0 else 0.13) * log**2) if measured else math.nan
        )
        return Estimate(value, value * error)

    @property
    def speed(self) -> Resummed:
        """Speed dx/dt of the pulse."""
        return self.wave.speed.widened(self._share)

    def fwhm(self, quantity: str = "force", extent: str = "time") -> Resummed:
        """Full width at half maximum; arguments as in `lwa.ExpandedWave.fwhm`."""
        width = self.wave.fwhm(quantity, extent)
        return width if extent == "length" else width.widened(self._share)

    def latex_rows(self) -> list[str]:
        """LaTeX of peak force, speed and width of the force, without units."""
        return _rows(self.force.latex(), self)

    @property
    def _share(self) -> float:
        """Relative error of F^{±(k-1)/(2k)} by that of the force."""
        force = self.force
        return (
            float((self.chain.k - 1) / (2 * self.chain.k)) * force.error / force.value
        )

    @property
    def train(self) -> bool:
        """True if m_s > 2 m: over a few per cent of the energy go into further pulses."""
        return bool(self.mass > 2 * self.chain.cell.masses[0])


def pulse_of_strike(
    chain: Cell, mass: Any, velocity: Any = None, *, drop: Any = None, k: Any = "3/2"
) -> Strike:
    """The pulse that a striker sends into a chain of equal beads.

    Parameters
    ----------
    chain : the cell, with numbers for mass, stiffness and spacing.
    mass : mass of the striker, in the units of the cell.
    velocity, drop : speed v of the striker, or the height h in m of its free fall, v = √(2 g h).
    k : exponent of the contact law.

    Raises `lwa.InputError` for other chains, and for values that are no positive numbers.
    """
    if not isinstance(chain, Cell) or not chain.uniform:
        raise InputError(
            f"chain is {shorten(chain)}: a Cell of equal beads and contacts is wanted"
        )
    if (velocity is None) == (drop is None):
        raise InputError("velocity or drop: one of the two is wanted")
    if velocity is None:
        velocity = sp.sqrt(2 * GRAVITY * positive(drop, "drop"))
    mass, velocity, k = (
        positive(mass, "mass"),
        positive(velocity, "velocity"),
        exponent(k),
    )
    for name, value in (("mass", mass), ("velocity", velocity), ("k", k)):
        if value.free_symbols:
            raise InputError(f"{name} is {shorten(value)}: a number is wanted")
    return Strike(expand(chain, ORDER, k=k), mass, velocity)
