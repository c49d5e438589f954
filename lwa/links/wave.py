"""Waves of any lattice: one relation between speed, width and the static law.

Let F(p) be the mean force at the mean strain p, W′ = F its energy per length, m̄ the mean mass and D
the spacing. To the order beyond the static law a Lagrangian density that is blind to u → u + a + bt
holds u_t²/2 - W(u_x) and the squares u_xt², u_xx u_tt, u_tt², u_xx², each times a function of u_x;
odd orders, and terms with u_t undifferentiated, are derivatives or are excluded. A wave
u_x = p0 + v(x - Vt) makes of all four the one term J(p) v′²/2, so that its first integral is

    J(p0+v) v′² = V̂² v² - 2 [W(p0+v) - W(p0) - F(p0) v],    V̂² = m̄ V²/D:

the speed of a wave that rises by B, V̂² = 2 [W(p0+B) - W(p0) - F(p0) B]/B², knows the static law
alone, and its width one function more. Small waves on the strain p have Ω² = c² (q² - I(p) q⁴ + …):
hence J = F′ I. Resonators follow the acceleration, a term u_tt²: J = F′ I + R V⁴ with R the sum of
m_r²/k_r per length and I without the resonators. Their tails vanish at V = ω0 D/(2πn) (Kevrekidis,
Stefanov and Xu, Lett. Math. Phys. 106, 1067 (2016)), ω0² = k_r (1/m_r + 1/m).

Errors are bounds on measured differences to exact and struck waves (`book/studies/links.py`,
`book/studies/struck.py`) in units of the amplitude Δ = ln(F′(p0+B)/V̂²), which vanishes with B/p0,
and without load with k - 1. Strongly unlike contacts driven hard have widths 20 to 34 % too small
and squared speeds up to 6 % off: there, and without load, the width of a pair has no bound: NaN.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from math import log, nan, pi, sqrt
from typing import Any

import numpy as np
import sympy as sp
from numpy.typing import ArrayLike

from lwa.base.arrays import Array, finite
from lwa.base.exact import InputError, demand_numbers, integer, number, positive, read_exact
from lwa.base.frozen import Value
from lwa.base.quantities import (
    NoSolitaryWave,
    known_extent,
    known_quantity,
)
from lwa.links.lattice import Lattice
from lwa.wave.quadrature import Quadrature, Samples

_FASTEST = 1.2  # least ω0 D/(2πV) of a resonator at which the relation holds; measured
_BARE = 1 - 1e-6  # part of V² that the wave adds to the sound's from which there is no load
_FOOT = 1e-40  # part of the rise at which the sound ahead of the wave is computed


# Measured bounds: errors of V² - c0² and of widths in parts of Δ, and Δ up to which they hold.
_ALIKE = 0.1, 0.15, 1.8  # equal particles and nearest links, with and without a load
_FARTHER = 0.1, 0.3, 1.2  # one particle a cell, links to farther ones
_LOADED_PAIR = 0.5, 0.8, 0.3  # two unlike masses or links under a load
_BARE_PAIR = 0.16, nan, 1.8  # two unlike masses or links without a load
_NONE = nan, nan, nan


@dataclass(frozen=True)
class LatticeWave(Value):
    """The wave of a given peak force in a lattice, without or under a load.

    force, precompression : mean force F along the lattice at the peak, and ahead of the wave. A
        ``force`` below the load is a rarefaction wave's. They may be symbols where the lattice is
        `Lattice.exact`; ``speed``, ``sound_speed`` and ``strain`` then are closed forms.

    Raises `lwa.InputError` for forces that are not positive or not reached and for resonators
    slower than 1.2 · 2πV/D, and `lwa.NoSolitaryWave` without a wave.
    """

    lattice: Lattice
    force: sp.Expr
    precompression: sp.Expr

    def __post_init__(self) -> None:
        load = read_exact(self.precompression, "precompression")
        load = load if load.is_zero else positive(load, "precompression")
        object.__setattr__(self, "precompression", load)
        object.__setattr__(self, "force", positive(self.force, "force"))
        if self.force == self.precompression:
            raise NoSolitaryWave(f"force and precompression are both {self.force}: no wave")
        if not self.lattice.exact or not self._free:
            self._check()

    @property
    def _free(self) -> set[sp.Symbol]:
        forces: set[sp.Symbol] = self.force.free_symbols | self.precompression.free_symbols
        return forces.union(self.lattice.symbols)

    def _check(self) -> None:
        """Raise an error for numbers without a wave."""
        at = f"precompression = {self.precompression}, force = {self.force}"
        p0, B = self._ends
        if reason := self._quadrature(self._static).refusals(p0, B)[0]:
            raise NoSolitaryWave(f"{at}: {reason}")
        if not np.all(self._samples(p0 + B * np.linspace(0.01, 1, 100))[2] > 0):
            raise NoSolitaryWave(f"{at}: I is not positive from the load to the peak")
        for resonator in self.lattice.resonators:
            ratio = self.lattice.resonance(resonator) / (2 * pi * self._rate)
            if ratio < _FASTEST:
                raise InputError(
                    f"{at}: a resonator's ω0 is {ratio:.3g} times 2πV/D; the relation holds from "
                    f"{_FASTEST} times on"
                )

    @cached_property
    def _means(self) -> tuple[sp.Expr, sp.Expr]:
        """Mean compression D p0 ahead of the wave, and its rise D B."""
        ahead, peak = map(self.lattice.mean_compression, (self.precompression, self.force))
        return ahead, peak - ahead

    @cached_property
    def _ends(self) -> tuple[Array, Array]:
        demand_numbers(self._free, "numbers are wanted")
        ahead, rise = (np.array([number(x)]) for x in self._means)
        return ahead, rise

    def _quadrature(self, samples: Samples) -> Quadrature:
        return Quadrature(samples)

    def _static(self, e: Array) -> tuple[Array, Array, Array]:
        """F′, F″ and I, without what resonators add, at mean compressions."""
        return self.lattice.statics.samples(e)[:3]

    def _samples(self, e: Array) -> tuple[Array, Array, Array]:
        """F′, F″ and J/F′ at mean compressions; lengths in spacings."""
        F1, F2, I = self._static(e)
        R = number(self.lattice.resonance_sum)
        return F1, F2, I + R * self._rate**4 / F1 if R else I

    @cached_property
    def _square(self) -> float:
        """The square V̂² in units of the spacing."""
        return float(self._quadrature(self._static).squares(*self._ends)[0])

    @property
    def _rate(self) -> float:
        """The speed in spacings per time."""
        return sqrt(self._square / number(self.lattice.mass))

    @property
    def strain(self) -> sp.Expr:
        """The rise B of the mean strain."""
        return self._means[1] / self.lattice.spacing

    @cached_property
    def speed(self) -> sp.Expr:
        """The speed V = dx/dt."""
        if not self.lattice.exact:
            return sp.Float(self._rate) * self.lattice.spacing
        rise = self._means[1]
        work = self.lattice.energy(self.force) - self.lattice.energy(self.precompression)
        square = 2 * (work - self.precompression * rise) / rise**2
        return self.lattice.spacing * sp.sqrt(square / self.lattice.mass)

    @cached_property
    def sound_speed(self) -> sp.Expr:
        """The speed dx/dt of long small waves ahead of the wave."""
        return self.lattice.spacing * sp.sqrt(self._stiffness_ahead / self.lattice.mass)

    @cached_property
    def _stiffness_ahead(self) -> sp.Expr:
        if self.lattice.in_series:
            return self.lattice.stiffness(self.precompression)
        p0, B = self._ends
        return sp.Float(float(self._static(p0 + _FOOT * B)[0][0]))

    @property
    def bead_velocity(self) -> sp.Expr:
        """The peak velocity B dx/dt of the particles."""
        return self.strain * self.speed

    def fwhm(
        self, quantity: str = "force", extent: str = "length", link: int | None = None
    ) -> sp.Expr:
        """Full width at half maximum of the rise of "strain", "force" or "velocity", in numbers.

        extent : "length", or "time" of passage. link : number of a link of the cell, for the
            width of its compression or force in place of the mean's.
        """
        known_extent(extent)
        force, statics = known_quantity(quantity) == "force", self.lattice.statics
        if link is not None:
            integer(link, "link", 0, len(self.lattice.links) - 1)

        def rate(e: Array, F1: Array) -> Array:
            if link is None:
                return F1
            share = statics.samples(e)[3][..., link]
            return share * statics.values(statics.compressions(e), 1)[..., link] if force else share

        plain = link is None and not force
        half = self._quadrature(self._samples).half_widths(*self._ends, None if plain else rate)
        width = sp.Float(2 * half[0])
        return width * self.lattice.spacing if extent == "length" else width / self._rate

    def along(self, x: ArrayLike, quantity: str = "force") -> Array:
        """Profile in space: rises above the load at the positions x when the peak is at x = 0."""
        D = number(self.lattice.spacing)
        places = np.abs(finite(x, "x")) / D
        p0, B = self._ends
        profile = self._quadrature(self._samples).profile(p0, B, places.ravel())
        ratio = profile.reshape(places.shape)
        if known_quantity(quantity) == "force":
            e = np.maximum(p0 + B * ratio, _FOOT * B)  # no force is computed at 0
            return self.lattice.statics.force(e) - number(self.precompression)
        return ratio * number(self.strain if quantity == "strain" else self.bead_velocity)

    @cached_property
    def _bounds(self) -> tuple[float, float]:
        """Bounds on the relative errors of the speed and of widths, NaN where none was measured."""
        p0, B = self._ends
        delta = log(self._static(p0 + B)[0][0] / self._square)
        added = 1 - number(self._stiffness_ahead) / self._square  # of V² to the sound's
        lattice, bare, rule = self.lattice, added > _BARE, _NONE
        if lattice.alike or lattice.size == 1:
            rule = _ALIKE if lattice.alike else _FARTHER
        elif lattice.size == 2:
            rule = _BARE_PAIR if bare else _LOADED_PAIR
        heard = lattice.resonators and not (bare and lattice.alike and lattice.size == 1)
        if delta > rule[2] or heard or B < 0:
            rule = _NONE
        # Measured in parts of the lattice's value: x of that is x/(1 - x) of the theory's.
        excess, width = (part * delta / (1 - part * delta) for part in rule[:2])
        return excess * added / 2, width

    @property
    def speed_error(self) -> float:
        """Bound on the error of the speed; NaN where no such wave was measured, as for B < 0."""
        return self._bounds[0] * number(self.speed)

    def fwhm_error(self, quantity: str = "force", extent: str = "length") -> float:
        """Bound on the error of a width of the mean; NaN where no such lattice was measured."""
        return self._bounds[1] * number(self.fwhm(quantity, extent))


def lattice_wave(lattice: Lattice, force: Any = "F", precompression: Any = 0) -> LatticeWave:
    """The wave of a lattice whose mean force peaks at ``force`` on the load ``precompression``.

    >>> from lwa import Lattice, Link, Power, lattice_wave
    >>> pair = Lattice([1, 1], [Link(0, 1, Power("3/2")), Link(1, 2, Power(1))])
    >>> wave = lattice_wave(pair, force=2, precompression=1)
    >>> round(float(wave.speed), 6), round(float(wave.fwhm("strain")), 6)
    (1.114528, 6.772308)
    """
    return LatticeWave(lattice, force, precompression)
