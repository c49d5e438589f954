"""The pulse that a striker sends into a chain of equal beads.

The wave of equal beads has the momentum P and the energy E of a particle of the mass ``m_eff =
P²/(2E)``, and collides nearly like such a quasi-particle. An elastic collision of a striker of mass
m_s and velocity v with a particle of mass M gives it the velocity ``w = 2 m_s v/(m_s + M)`` and the
energy ½ M w². As E grows as ``F^{(k+1)/k}``, the peak force F follows:

- m_s up to the mass m of a bead: M is m, and a share η of the energy is the pulse's (0.9936 for
  spheres behind their equal), so that ``F = F_eq [2 m_s v/(m_s + m)]^{2k/(k+1)}``.
- m_s above m: M is m_eff. A heavy striker drives the chain like a wall, and its leading bead
  reaches twice the velocity (`lwa.shocks`); the rule falls short of this limit by 25.7 % for
  spheres.

These are rules; their errors are bounds of measured errors (cf. Job et al., Granular Matter 10, 13
(2007)).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import sympy as sp

from lwa.base import latex
from lwa.base.exact import InputError, demand_numbers, positive, shorten
from lwa.base.frozen import Estimate, Value
from lwa.base.words import ExtentName, QuantityName
from lwa.cell import Cell, exponent
from lwa.expansion.lattice_wave import LatticeWave, lattice_wave
from lwa.spheres.beads import GRAVITY

MEASURED = (sp.Rational(5, 4), sp.Integer(60))
"""Range of k in which chains were struck: 16 masses of strikers at each of ten exponents.

From k of 10 on beads collide two at a time: the rule is right to 0.13 % for every striker. Below
5/4 the pulse takes more than 50 beads to form.
"""

NEAR = 0.007
"""Largest relative error of the force for strikers of 1.3 to 1.6 beads."""


@dataclass(frozen=True, repr=False)
class Strike(Value):
    """The leading pulse of a chain of equal beads struck by a mass, in the units of the cell.

    Attributes
    ----------
    chain : Cell
        The chain of equal beads, all numbers.
    mass, velocity : sympy.Expr
        Mass and velocity of the striker; its contact is like those of the chain.
    k : sympy.Expr
        Exponent of the contact law.

    Notes
    -----
    The error of the force bounds the differences to struck chains at k from 5/4 to 60, for strikers
    of any mass, and is NaN at other exponents. A contact of the striker half or twice as stiff
    changes the force by up to 2 %.

    Examples
    --------
    >>> strike = pulse_of_strike(Cell([1], spacing=1), mass=1, velocity=1)
    >>> round(strike.force.value, 4), abs(0.63955 - strike.force.value) < strike.force.error < 0.001
    (0.6395, True)
    """

    chain: Cell
    mass: sp.Expr
    velocity: sp.Expr
    k: sp.Expr

    def __repr__(self) -> str:
        width = f"FWHM of the force {self.fwhm()} in time"
        return f"Strike(F={self.force}, dx/dt={self.speed}, {width})"

    @property
    def _ratio(self) -> float:
        """Mass of the striker over that of a bead."""
        return float(self.mass / self.chain.masses[0])

    @cached_property
    def wave(self) -> LatticeWave:
        """The chain's wave of the same peak force; its errors leave out the error of the rule."""
        unit = lattice_wave(self.chain, k=self.k)
        particle = float(self.chain.masses[0])
        # η as measured behind equal strikers at six exponents, to 4e-4
        share = 1 - 0.03 * math.exp(-3.1 * float(self.k - 1))
        if self._ratio > 1:
            particle = unit.estimate("effective_mass").value
            share = 1.0
        # w, with which the particle leaves the striker
        velocity = 2 * float(self.mass * self.velocity) / (float(self.mass) + particle)
        # The square of the velocity may be beyond a double where its power is not.
        power = float(self.k / (self.k + 1))
        # The energy of the wave of force 1 times F^{(k+1)/k} is the share of ½ M w², M the mass of
        # the particle: F^{(k+1)/k} is a factor times w².
        factor = share * particle / (2 * unit.estimate("energy").value)
        try:
            force = factor**power * velocity ** (2 * power)
        except OverflowError:
            reason = (
                f"velocity is {shorten(self.velocity)}: its force exceeds any float"
            )
            raise InputError(reason, velocity=1) from None
        return unit.at_force(force)

    @property
    def force(self) -> Estimate:
        """Peak force of a contact."""
        # The wave's force is exact for the rule; the rule has an error.
        return Estimate(float(self.wave.force), 0.0).widened(self._error)

    @property
    def _error(self) -> float:
        """Relative error of the force: a bound fitted to the deviations of struck chains.

        The bound covers all chains of `MEASURED`; the numbers below are the fit.
        """
        least, most = MEASURED
        epsilon = float(self.k) - 1
        ratio = self._ratio
        if not least <= self.k <= most:
            return math.nan
        if ratio <= 1:
            # Largest for strikers of a third of a bead; η alone is wrong at equal masses.
            unequal = min(1, 3 * (1 - ratio))
            return 5e-4 + 0.028 * math.exp(-1.44 * epsilon) * unequal
        # A bead before a heavy striker reaches twice the velocity: the limit of the error.
        limit = 0.45 * math.exp(-0.5 * epsilon)
        # Just above the mass of a bead the rule is off by the share η, which the rule leaves out.
        just_above = NEAR + 0.021 * math.exp(-5.5 * (epsilon - 0.25))
        return max(just_above, limit * (ratio - 1) / (ratio + 14))

    @property
    def _share(self) -> float:
        """Relative error of the speed, and of times, that the error of the force F makes.

        The speed goes as ``F^{(k-1)/(2k)}``, times as its inverse.
        """
        return float((self.k - 1) / (2 * self.k)) * self._error

    @property
    def speed(self) -> Estimate:
        """Speed dx/dt of the pulse."""
        # The closed form of the wave has an error, and the rule for its force another one.
        return self.wave.estimate("speed").widened(self._share)

    def fwhm(
        self, quantity: QuantityName = "force", extent: ExtentName = "time"
    ) -> Estimate:
        """Full width at half maximum; arguments as in `lwa.LatticeWave.fwhm`."""
        width = self.wave.estimate("fwhm", quantity, extent)
        # A length does not depend on the force.
        if extent == "length":
            return width
        return width.widened(self._share)

    def latex_rows(self) -> list[str]:
        """LaTeX of peak force, speed and width of the force, without units."""
        width = self.fwhm("force", "length")
        return [
            f"F = {self.force.latex()}",
            f"{latex.SPEED} = {self.speed.latex()}",
            f"{latex.fwhm('force')} = {width.latex()}",
        ]

    @property
    def train(self) -> bool:
        """True for strikers above two beads: over a few per cent of the energy follow later."""
        return self._ratio > 2


def pulse_of_strike(
    chain: Cell, mass: Any, velocity: Any = None, *, drop: Any = None, k: Any = "3/2"
) -> Strike:
    """The pulse that a striker sends into a chain of equal beads.

    Parameters
    ----------
    chain : Cell
        The cell, with numbers for mass, stiffness and spacing.
    mass : number
        Mass of the striker, in the units of the cell.
    velocity, drop : number
        Speed v of the striker, or the height h in m of its free fall, ``v = √(2 g h)``.
    k : number
        Exponent of the contact law.

    Returns
    -------
    Strike

    Raises
    ------
    lwa.InputError
        For other chains, and for values that are no positive numbers.
    """
    if not isinstance(chain, Cell) or not chain.uniform:
        raise InputError(
            f"chain is {shorten(chain)}: a Cell of equal beads and contacts is wanted"
        )
    if (velocity is None) == (drop is None):
        raise InputError("velocity or drop: one of the two is wanted")
    # In free fall m g h becomes ½ m v².
    if velocity is None:
        velocity = sp.sqrt(2 * GRAVITY * positive(drop, "drop"))
    striker = positive(mass, "mass")
    velocity = positive(velocity, "velocity")
    k = exponent(k)
    symbols = sp.Tuple(striker, velocity, k).free_symbols
    # The rules are numbers that were measured.
    demand_numbers(symbols.union(chain.symbols), "a strike needs numbers")
    return Strike(chain, striker, velocity, k)
