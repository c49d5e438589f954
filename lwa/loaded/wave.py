"""Waves under a load in any lattice: one relation between speed, width and the static law.

Let F(p) be the mean force at the mean strain p, W its energy per length, ``W′ = F``, m̄ the mean
mass and D the spacing. A wave ``u_x = p0 + v(x - Vt)`` that rises by B obeys, with
``V̂² = m̄ V²/D``::

    J(p0+v) v′² = V̂² v² - 2 [W(p0+v) - W(p0) - F(p0) v],  V̂² = 2 [W(p0+B) - W(p0) - F(p0) B]/B²:

the speed knows the static law alone, and the width one function more. Small waves on the strain p
have ``Ω² = c² (q² - I(p) q⁴ + …)``: hence ``J = F′ I``.

Proof. Let u be the mass-weighted mean of the displacements w_i of the particles of one cell, and
``y_i = w_i - u``. The kinetic energy of a cell is ``M u_t²/2 + T(y_t)``, without a mixed term. The
elastic energy knows y and the differences of u alone. The equations of y determine y by u_x and its
derivatives, order by order. So the Lagrangian without y is ``M u_t²/2`` plus a function of u_x and
its derivatives in x and t. To the order beyond the static law this function has the terms u_xx² and
u_xt², each times a function of u_x: a term linear in a third derivative is one of these by parts, a
term odd in t is forbidden, and the term of odd order, a(u_x) u_xx, is a divergence. In the wave
both are a part of ``J v′²/2``. ∎

Resonators follow the acceleration of their particles. To the same order ``J = F′ I + R V⁴``, with R
the sum of m_r²/k_r per length and I without the resonators; this J is also right where the speed of
sound is far from V. Their tails vanish at ``V = ω0 D/(2πn)`` (Kevrekidis, Stefanov and Xu, Lett.
Math. Phys. 106, 1067 (2016)), ``ω0² = k_r (1/m_r + 1/m)``. `lwa.loaded.errors` has bounds on the
errors.
"""

from __future__ import annotations

from contextlib import suppress
from dataclasses import dataclass
from functools import cached_property
from math import pi, sqrt
from typing import Any, Literal, Self, get_args

import numpy as np
import sympy as sp
from numpy.typing import ArrayLike

from lwa.base import latex
from lwa.base.arrays import Array, finite
from lwa.base.exact import (
    InputError,
    Quantity,
    brief,
    number,
    positive,
    power,
    read_exact,
    shorten,
)
from lwa.base.frozen import Estimate, NoSolitaryWave, known_extent, known_quantity
from lwa.base.words import ExtentName, QuantityName, one_of
from lwa.cell import Cell, k as symbol_k
from lwa.law import ContactLaw, for_cell
from lwa.loaded.background import Background, KdV, squared_speed
from lwa.loaded.errors import bounds
from lwa.loaded.lattice import Lattice
from lwa.loaded.quadrature import Quadrature
from lwa.loaded.states import States
from lwa.loaded.statics import Function, Samples

# Least ω0 D/(2πV) of a resonator for which the relation between speed and width is promised, by
# measurements in struck chains (`book/studies/struck.py`): slower resonators take energy away.
_SLOWEST = 1.2
# Part of the rise at which the sound ahead of the wave is computed: a law may have no slope at 0
_FOOT = 1e-40

EstimatedName = Literal["speed", "fwhm"]
"""A result with a measured error."""


@dataclass(frozen=True, repr=False)
class LoadedWave(States):
    """The wave on a static load, or without load, in a chain or a lattice (see `loaded_wave`).

    Speeds are dx/dt in the units of the chain. Parameters are those of
    `lwa.loaded.states.States`.

    Raises
    ------
    NoSolitaryWave
        For numbers without a wave.
    InputError
        For resonators that are too slow.
    """

    def __post_init__(self) -> None:
        super().__post_init__()
        # The law is None for a lattice, whose links have laws of their own. Under a power signs are
        # enough, which symbols have, too.
        if self.law is not None and self.law.homogeneous:
            reason = _refusal_under_power(
                self.law.exponent - 1, self.background, self.strain
            )
        elif self.symbols or (self.law is not None and self.law.formless):
            # Nothing to check: only numbers, under a law with an expression, tell whether there is
            # a wave, and whether a resonator is fast enough.
            return
        else:
            reason = self._quadrature.refusal()
        if reason:
            # The user may have given either, and taken the total force for the rise.
            strains = f"p0 = {brief(self.background)}, B = {brief(self.strain)}"
            forces = (
                f"from F0 = {brief(self.precompression)} to F = {brief(self.force)}"
            )
            raise NoSolitaryWave(f"{strains}, {forces}: {reason}")
        # Only a lattice has resonators; one with symbols has returned above.
        for resonator in self.lattice.resonators:
            rate = number(self.speed / self.chain.spacing)  # V/D
            ratio = self.lattice.resonance(resonator) / (2 * pi * rate)
            if ratio < _SLOWEST:
                raise InputError(
                    f"a resonator's ω0 is {ratio:.3g} times 2πV/D: the relation holds from "
                    f"{_SLOWEST} times on"
                )

    def __repr__(self) -> str:
        return (
            f"LoadedWave(F={brief(self.force)}, F0={brief(self.precompression)}, "
            f"p0={brief(self.background)}, B={brief(self.strain)}, dx/dt={brief(self.speed)})"
        )

    def latex_rows(self) -> list[str]:
        """LaTeX of the law and of the wave; of numbers with their errors, where these are known."""
        rows = latex.rows(
            {
                "F_{0}": self.precompression,
                "F": self.force,
                "p_{0}": self.background,
                "B": self.strain,
                latex.SPEED: self.speed,
            }
        )
        with suppress(InputError):  # symbols have no estimate
            speed = self.estimate("speed").latex()
            width = self.estimate("fwhm").latex()
            rows[-1] += rf" \approx {speed}"
            rows.append(f"{latex.fwhm('force')} = {width}")
        if self.law is None:
            return rows
        return [*self.law.latex_rows(), *rows]

    def at(self, **values: Any) -> Self:
        """Substitute values for symbols of the chain of a cell, as `lwa.CompactWave.at`."""
        if isinstance(self.chain, Lattice):
            raise InputError("the symbols of a lattice are given where it is made")
        return super().at(**values)

    @cached_property
    def speed(self) -> sp.Expr:
        """The speed V."""
        D = self.chain.spacing
        # Without a closed form of the work, the integral of the force, V² is an integral in floats.
        if self.work is None:
            square = self._quadrature.square / number(self.lattice.mass)
            return D * sp.Float(sqrt(square))
        square = squared_speed(self.work, self.precompression, self.exact_compression)
        rate = power(square / self.lattice.mass, sp.S.Half)
        return D * self.written(rate)

    @cached_property
    def sound_speed(self) -> sp.Expr:
        """The speed of long small waves ahead of the wave."""
        stiffness = self.stiffness
        if stiffness is None:
            stiffness = sp.Float(float(self._quadrature.at(_FOOT).slope))
        rate = power(stiffness / self.lattice.mass, sp.S.Half)
        return self.chain.spacing * self.written(rate)

    @property
    def bead_velocity(self) -> sp.Expr:
        """The peak velocity B V of the particles."""
        return self.strain * self.speed

    @cached_property
    def kdv(self) -> KdV:
        """The limit of small waves on the load, in the time t; in numbers for a lattice.

        Raises
        ------
        NoSolitaryWave
            Where no sound runs, and where small waves disperse.
        """
        D = self.chain.spacing
        if isinstance(self.chain, Cell):
            slope = self.law.at(self.exact_static_compression, 1)
            bend = self.law.at(self.exact_static_compression, 2)
            I = self.field.I
        else:
            law = self._quadrature.at(0)
            slope = sp.Float(float(law.slope))
            bend = sp.Float(float(law.bend))
            # Resonators add R V⁴ to J = F′ I. A small wave has V² = F′/m̄ at D = 1, so that they
            # add R F′/m̄² to I.
            resonance = self.lattice.resonance_sum * slope / self.lattice.mass**2
            dispersion = sp.Float(float(law.dispersion)) + resonance
            I = D**2 * dispersion  # the dispersion of a lattice is that of D = 1
        return KdV.of_slopes(self.sound_speed, slope, D * bend, I)

    def fwhm(
        self, quantity: QuantityName = "force", extent: ExtentName = "length"
    ) -> sp.Expr:
        """Full width at half maximum of the rise of a quantity, in numbers.

        Parameters
        ----------
        quantity : {"force", "strain", "velocity"}
            The quantity.
        extent : {"length", "time"}
            A length, in which the spacing may be a symbol, or the time of passage.
        """
        # The particles move at V v: strain and velocity have one width.
        of_force = known_quantity(quantity) == "force"
        sites = 2 * self._quadrature.half_width(of_force)
        if known_extent(extent) == "time":
            return sp.Float(sites / number(self.speed / self.chain.spacing))
        return sp.Float(sites) * self.chain.spacing

    def along(self, x: ArrayLike, quantity: QuantityName = "force") -> Array:
        """Profile in space: rises above the load at positions x, with the peak at ``x = 0``.

        Strains and velocities are right to 1e-9 of the larger of v and B/1000, forces to rounding
        of the load.
        """
        places = np.abs(finite(x, "x")) / number(self.chain.spacing)
        wave = self._quadrature
        ratio = wave.profile(places.ravel()).reshape(places.shape)
        if known_quantity(quantity) == "strain":
            return ratio * number(self.strain)
        if quantity == "velocity":
            return ratio * number(self.bead_velocity)
        if self.law is None:
            force: Function = self.lattice.statics.force
        else:
            force = self.law.function()
        # A law may have no value at 0: the foot of a wave without load stands a little above.
        low = max(wave.p0, _FOOT * abs(wave.B))
        at_rest = force(np.array(low))
        strains = np.maximum(wave.p0 + wave.B * ratio, low)
        rises = force(strains) - at_rest
        peak = force(np.array(wave.p0 + wave.B)) - at_rest
        # The unit of the force in floats is not that of the chain; the ratio has none.
        known_peak = number(self.force - self.precompression)
        return rises / peak * known_peak

    def estimate(
        self,
        name: EstimatedName,
        quantity: QuantityName = "force",
        extent: ExtentName = "length",
    ) -> Estimate:
        """A result in floats with a bound on its error, as measured on lattices.

        Parameters
        ----------
        name : {"speed", "fwhm"}
            The result; a length in spacings where the spacing of a cell is a symbol.
        quantity, extent : str
            Arguments of `fwhm`.

        Returns
        -------
        Estimate
            The error is NaN where no such wave was measured.

        Examples
        --------
        >>> wave = loaded_wave(Cell([1], spacing=1), force=1, k="3/2")
        >>> speed = wave.estimate("speed")
        >>> lattice = 0.905516  # the exact wave of the lattice
        >>> abs(speed.value - lattice) < speed.error < 30 * abs(speed.value - lattice)
        True
        """
        one_of(name, get_args(EstimatedName), "name")  # refuses any other name
        spacing = self.chain.spacing
        if spacing.is_Symbol and not self.exact_compression.has(spacing):
            return self.at(**{spacing.name: 1}).estimate(name, quantity, extent)
        wave = self._quadrature
        # `bounds` takes a wave for one without load if the slope F′ at its foot is nearly 0. For k
        # near 1 it falls so slowly towards the foot that 1e-280 of the rise tells more than 1e-40.
        # In a lattice the slopes of a power k = 3 would be no floats there.
        foot = _FOOT if self.law is None else 1e-280
        known = bounds(
            self.lattice,
            slope_at_rest=float(wave.at(foot).slope),
            slope_at_peak=float(wave.at(1).slope),
            square=wave.square,
            rises=wave.B > 0,
        )
        if name == "speed":
            value = number(self.speed)
            relative = known["speed"]
        else:
            value = number(self.fwhm(quantity, extent))
            relative = known[quantity]
            if extent == "time":  # the width divided by the speed
                relative += known["speed"]
        return Estimate(value, value * relative)

    @cached_property
    def _quadrature(self) -> Quadrature:
        """The wave in floats: mean compressions over a unit, lengths in spacings."""
        p0 = self.exact_static_compression
        B = self.exact_compression
        if self.law is None:
            lattice = self.lattice
            # `Quadrature` has V̂² for V², and in J, at D = 1, R V⁴ is (R/m̄²) V̂⁴.
            resonance = number(lattice.resonance_sum / lattice.mass**2)
            return Quadrature(lattice.statics.samples, number(p0), number(B), resonance)
        if self.law.homogeneous:
            # A power has no length of its own: the unit is the larger compression, at the peak,
            # or for k < 1, where waves lower it, ahead.
            unit = p0 + B if (self.law.exponent - 1).is_positive else p0
            p0 = p0 / unit
            B = B / unit
        slope = self.law.function(1)
        bend = self.law.function(2)
        # All contacts of a cell share one law up to a factor, so that I is one number.
        I = number(self.field.I / self.chain.spacing**2)

        def samples(e: Array) -> Samples:
            dispersion = np.full(e.shape, I)
            return Samples(slope(e), bend(e), dispersion)

        return Quadrature(samples, number(p0), number(B))


def _refusal_under_power(excess: sp.Expr, p0: sp.Expr, B: sp.Expr) -> str:
    """Reason why ``δ^k`` has no wave of the rise B on the strain p0; empty if there may be a wave.

    Speeds scale as strain^{(k-1)/2}; ``excess`` is k - 1.
    """
    if excess.is_zero:
        return "at k = 1 the chain is linear, and its waves disperse"
    if excess.is_negative and p0.is_zero:
        return "k < 1 and there is no load: the speed falls with the strain"
    if excess.is_positive and B.is_negative:
        return "k > 1: speeds grow with the strain, and only B > 0 has a wave"
    if excess.is_negative and B.is_positive:
        return "k < 1: speeds fall with the strain, and only B < 0 has a wave"
    if p0.is_negative or (p0 + B).is_nonpositive:
        return "the contacts would open"
    return ""


def loaded_wave(
    chain: Cell | Lattice,
    *,
    force: Quantity | None = None,
    precompression: Quantity | None = None,
    rise: Quantity | None = None,
    background: Quantity | None = None,
    law: ContactLaw | None = None,
    k: Quantity = symbol_k,
) -> LoadedWave:
    """The wave on a static load in a chain of a cell, or in a lattice, in the canonical field.

    Symbols are taken where results are closed forms: by strain under any law, by force under
    powers. For equal spheres V²/c0² is Nesterenko's ``(4/15) (3 + 2 ζ^{5/2} - 5 ζ) / (ζ - 1)²``,
    ``ζ = (F/F0)^{2/3}``.

    Parameters
    ----------
    chain : Cell or Lattice
        The chain of a cell, or a lattice.
    force : number or str, optional
        Peak of the total contact force (the mean force along a lattice), by default a symbol F. A
        force below the load is that of a rarefaction wave.
    precompression : number or str, optional
        Static force, by default 0.
    rise : number or str, optional
        Rise B of the strain, in place of forces in the chain of a cell; by default a symbol.
    background : number or str, optional
        Static strain p0, in place of forces; by default 0.
    law : ContactLaw, optional
        Law of a cell's contacts, by default ``δ^k``. The links of a lattice have their own.
    k : number or str
        Exponent of the law.

    Raises
    ------
    InputError
        For forces that are not positive or not reached, for other symbols, and for resonators
        slower than 1.2 · 2πV/D.
    NoSolitaryWave
        Without a wave.

    Examples
    --------
    >>> wave = loaded_wave(Cell([1], spacing=1), rise=1, background=1, k="3/2")
    >>> wave.speed, wave.fwhm("strain").n(12)
    (sqrt(-14/5 + 16*sqrt(2)/5), 3.15563100805)
    >>> from lwa import Link, Power
    >>> pair = Lattice([1, 1], [Link(0, 1, Power("3/2")), Link(1, 2, Power(1))])
    >>> wave = loaded_wave(pair, force=2, precompression=1)
    >>> round(float(wave.speed), 6), round(float(wave.fwhm("strain")), 6)
    (1.114528, 6.772308)
    """
    by_strain = rise is not None or background is not None
    if by_strain and (force is not None or precompression is not None):
        raise InputError("a wave is given by its forces or by its strains, not by both")
    if isinstance(chain, Lattice):
        contact = None
        if law is not None or k != symbol_k:
            raise InputError("a law is given: the links of a lattice have their own")
        if by_strain:
            raise InputError(
                "a strain is given: the wave of a lattice is given by forces"
            )
    else:
        contact = for_cell(law, chain, k)
        if by_strain:
            field = Background(chain, contact, 0 if background is None else background)
            B = field.rise if rise is None else read_exact(rise, "rise")
            if B.is_zero:
                raise InputError("rise is 0: `kdv` is the limit of small waves")
            return LoadedWave.of_strains(field, B)
    load = read_exact(0 if precompression is None else precompression, "precompression")
    if not load.is_zero:
        load = positive(load, "precompression")
    peak = positive("F" if force is None else force, "force")
    if load == peak:
        raise NoSolitaryWave(
            f"force and precompression are both {shorten(peak)}: no wave"
        )
    return LoadedWave.of_forces(chain, contact, load, peak)
