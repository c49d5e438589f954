"""Waves under a load in any lattice: one relation between speed, width and the static law.

Let F(p) be the mean force at the mean strain p, W′ = F its energy per length, m̄ the mean mass and D
the spacing. A wave u_x = p0 + v(x - Vt) that rises by B obeys, with V̂² = m̄ V²/D,

    J(p0+v) v′² = V̂² v² - 2 [W(p0+v) - W(p0) - F(p0) v],  V̂² = 2 [W(p0+B) - W(p0) - F(p0) B]/B²:

the speed knows the static law alone, and the width one function more. Small waves on the strain p
have Ω² = c² (q² - I(p) q⁴ + …): hence J = F′ I.

Proof. To the order beyond the static law u_t²/2 - W(u_x) the terms of a Lagrangian density L are
the squares u_xt², u_xx u_tt, u_tt², u_xx², each times a function of u_x; in the wave all four are a
part of J v′²/2. No other term is left. Let E(L) be the Euler-Lagrange expression. The mean field's
equation is blind to u → u + a + bt, so that E(L) is free of u and u_t. Then E(∂L/∂u_t) =
∂E(L)/∂u_t = 0: ∂L/∂u_t is a null Lagrangian, beyond the leading order a divergence D_xA + D_tB with
A and B free of u (others are 1, u_x, u_t: their integrals are a divergence, u_x u_t, which time
reversal forbids, and the kinetic energy). As ∂/∂u_t commutes with D_x and D_t on functions free of
u, L less D_x∫A du_t + D_t∫B du_t is free of u_t. Third and fourth derivatives are linear, squares
by parts; terms odd in t are forbidden. At the odd order a(u_x) u_xx is a divergence; c(u_x) u_tt is
none, but c times the equation of motion and a divergence: u → u + c(u_x) removes it. ∎

Resonators follow the acceleration, a term u_tt²: J = F′ I + R V⁴ with R the sum of m_r²/k_r per
length and I without the resonators. Their tails vanish at V = ω0 D/(2πn) (Kevrekidis, Stefanov and
Xu, Lett. Math. Phys. 106, 1067 (2016)), ω0² = k_r (1/m_r + 1/m).

Errors are bounds on measured differences to exact and struck waves (`book/studies/links.py`,
`book/studies/struck.py`) in units of the amplitude Δ = ln(F′(p0+B)/V̂²), which vanishes with B/p0,
and without load with k - 1. Strongly unlike contacts driven hard have widths 20 to 34 % too small
and squared speeds up to 6 % off: there, and without load, the width of a pair has no bound: NaN.
Unlike masses without load radiate, some all of the wave: neither has a bound.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from math import log, nan, pi, sqrt
from typing import Any

import numpy as np
import sympy as sp
from numpy.typing import ArrayLike

from lwa.base import latex
from lwa.base.arrays import Array, finite, function_of
from lwa.base.exact import (
    InputError,
    Quantity,
    demand_numbers,
    number,
    positive,
    power,
    read_exact,
    shorten,
)
from lwa.base.frozen import (
    NoSolitaryWave,
    known_extent,
    known_quantity,
)
from lwa.cell import Cell
from lwa.cell import k as symbol_k
from lwa.law import ContactLaw, for_cell, substituted
from lwa.loaded.background import Background, KdV
from lwa.loaded.ends import Ends
from lwa.loaded.lattice import Lattice

_FASTEST = 1.2  # least ω0 D/(2πV) of a resonator at which the relation holds (`struck`)
_BARE = (
    1 - 1e-6
)  # part of V² that the wave adds to the sound's from which there is no load
_FOOT = 1e-40  # part of the rise at which the sound ahead of the wave is computed

# Errors of V² - c0² and of widths in parts of Δ, and Δ up to which they hold, measured by the
# studies `links` (exact waves) and `struck`.
_ALIKE = 0.1, 0.15, 1.8  # equal particles and nearest links, with and without a load
_FARTHER = 0.1, 0.3, 1.2  # one particle a cell, links to farther ones
_LOADED_PAIR = 0.5, 0.8, 0.3  # two unlike masses or links under a load
_BARE_PAIR = 0.16, nan, 1.8  # two equal masses with unlike links, without a load
_NONE = nan, nan, nan


@dataclass(frozen=True)
class LoadedWave(Ends):
    """The wave on a static load, or without load, in a chain or a lattice (see `loaded_wave`).

    Speeds are dx/dt in the units of the chain.
    """

    def __post_init__(self) -> None:
        if self.by_force:
            load = read_exact(self.ahead, "precompression")
            ahead = load if load.is_zero else positive(load, "precompression")
            peak = positive(self.peak, "force")
            if ahead == peak:
                raise NoSolitaryWave(
                    f"force and precompression are both {shorten(peak)}: no wave"
                )
        else:
            ahead, peak = (
                read_exact(self.ahead, "background"),
                read_exact(self.peak, "rise"),
            )
            if peak.is_zero:
                raise InputError("rise is 0: `kdv` is the limit of small waves")
        object.__setattr__(self, "ahead", ahead)
        object.__setattr__(self, "peak", peak)
        if not self.by_force:
            self.field  # noqa: B018 - a strain at which no sound runs is refused here
        self._check()

    def _check(self) -> None:
        """Raise an error for numbers without a wave."""
        if self.law is not None and self.law.homogeneous:
            reason = _refusal_under_power(
                self.law.exponent - 1, self.background, self.strain
            )
        elif self._free or (self.law is not None and self.law.formless):
            if self.by_force and (self.law or not self.lattice.exact):
                demand_numbers(
                    self._free, "forces under laws that are no powers are numbers"
                )
            return
        else:
            p0, B = self._quadrature.p0, self._quadrature.B
            reason = self._quadrature.refusal()
            if not reason and not np.all(
                self._samples(p0 + B * np.linspace(0.01, 1, 100))[2] > 0
            ):
                reason = "I is not positive from the load to the peak"
        ahead, peak = shorten(self.ahead), shorten(self.peak)
        place = f"p0 = {ahead}, B = {peak}"
        if self.by_force:
            below = "below " * bool((self.peak - self.ahead).is_negative)
            place = f"force is {peak}, {below}precompression {ahead}"
        if reason:
            raise NoSolitaryWave(f"{place}: {reason}")
        for resonator in self.lattice.resonators:
            speed = number(self.speed / self.chain.spacing)
            ratio = self.lattice.resonance(resonator) / (2 * pi * speed)
            if ratio < _FASTEST:
                raise InputError(
                    f"{place}: a resonator's ω0 is {ratio:.3g} times 2πV/D; the relation holds "
                    f"from {_FASTEST} times on"
                )

    def latex_rows(self) -> list[str]:
        rows: dict[str, sp.Expr] = {"p_{0}": self.background}
        if self.by_force:
            rows = {"F_{0}": self.precompression, "F": self.force}
        laws = [] if self.law is None else self.law.latex_rows()
        return [*laws, *latex.rows(rows | {"B": self.strain, latex.SPEED: self.speed})]

    def at(self, **values: Any) -> LoadedWave:
        """Substitute values for symbols of a chain, as `lwa.CompactWave.at`."""
        if isinstance(self.chain, Lattice):
            raise InputError("the symbols of a lattice are given where it is made")
        chain, law, ahead, peak = substituted(
            values, self.chain, self.law, self.ahead, self.peak
        )
        return LoadedWave(chain, law, ahead, peak, self.by_force)

    @cached_property
    def speed(self) -> sp.Expr:
        """The speed V."""
        if not self.by_force:
            return self.field.speed(self.strain) * self.field.time_scale
        ahead, rise = self._ends
        if isinstance(self.chain, Cell):
            energy, delta = self.law.energy, self.law.delta
            A = self.chain.stiffness(self.law.exponent)
            work = A * (energy.subs(delta, ahead + rise) - energy.subs(delta, ahead))
        elif self.lattice.exact:
            work = self.lattice.energy(self._states[1]) - self.lattice.energy(
                self._states[0]
            )
        else:
            return (
                sp.Float(sqrt(self._square / number(self.lattice.mass)))
                * self.chain.spacing
            )
        square = 2 * (work - self.precompression * rise) / rise**2
        return self.chain.spacing * self._written(
            power(square / self.lattice.mass, sp.S.Half)
        )

    @cached_property
    def sound_speed(self) -> sp.Expr:
        """The speed of long small waves ahead of the wave."""
        if isinstance(self.chain, Cell):
            if not self.by_force:
                return sp.powdenest(self.field.sound_speed * self.field.time_scale)
            stiffness = self.chain.stiffness(self.law.exponent) * self.law.at(
                self._ends[0], 1
            )
        elif self.lattice.in_series:
            stiffness = self.lattice.stiffness(self._states[0])
        else:
            stiffness = sp.Float(self._slope(_FOOT))
        return self.chain.spacing * self._written(
            power(stiffness / self.lattice.mass, sp.S.Half)
        )

    @property
    def bead_velocity(self) -> sp.Expr:
        """The peak velocity B V of the particles."""
        return self.strain * self.speed

    @cached_property
    def kdv(self) -> KdV:
        """The limit of small waves on the load, in the time t; in numbers for a lattice.

        Raises `lwa.NoSolitaryWave` where no sound runs, and where small waves disperse.
        """
        c0, D = self.sound_speed, self.chain.spacing
        if c0.is_zero or c0.is_finite is False:
            raise NoSolitaryWave(
                "there is no load, and no sound runs, so that no wave is small"
            )
        if isinstance(self.chain, Cell):
            bend, slope = (self.law.at(self._ends[0], n) for n in (2, 1))
            I = self.field.I
        else:
            values = self.lattice.statics.samples(np.array(self._quadrature.p0))
            slope, bend, I = (sp.Float(float(x)) for x in values)
            I = D**2 * (
                I + self.lattice.resonance_sum * slope / self.lattice.mass**2
            )  # V̂² = F′
        if bend.is_zero:
            raise NoSolitaryWave(
                "F″ is 0 at the load: waves of small amplitude disperse"
            )
        # V² = c0² (1 + F″ B/(3F′) + …), hence V = c0 + α B/3; Ω² = c0² (q² - I q⁴) gives γ = I c0/2
        return KdV(c0, c0 * D * self._written(sp.powsimp(bend / slope) / 2), I * c0 / 2)

    def fwhm(self, quantity: str = "force", extent: str = "length") -> sp.Expr:
        """Full width at half maximum of the rise of "strain", "force" or "velocity", in numbers.

        extent : "length", a multiple of a spacing that is a symbol, or "time" of passage.
        """
        sites = 2 * self._quadrature.half_width(known_quantity(quantity) == "force")
        if known_extent(extent) == "time":
            return sp.Float(sites / number(self.speed / self.chain.spacing))
        return sp.Float(sites) * self.chain.spacing

    def along(self, x: ArrayLike, quantity: str = "force") -> Array:
        """Profile in space: rises above the load at the positions x when the peak is at x = 0.

        Strains and velocities are right to 1e-9 of the larger of v and B/1000, forces to rounding
        of the load.
        """
        places = np.abs(finite(x, "x")) / number(self.chain.spacing)
        wave = self._quadrature
        ratio = wave.profile(places.ravel()).reshape(places.shape)
        if known_quantity(quantity) != "force":
            return ratio * number(
                self.strain if quantity == "strain" else self.bead_velocity
            )
        law = self.law
        force = function_of(law.delta, law.F) if law else self.lattice.statics.force
        low = max(wave.p0, _FOOT * abs(wave.B))  # no force is computed at 0
        rises = force(np.maximum(wave.p0 + wave.B * ratio, low)) - force(np.array(low))
        peak = force(np.array(wave.p0 + wave.B)) - force(np.array(low))
        return np.asarray(rises / peak * number(self.force - self.precompression))

    @cached_property
    def _bounds(self) -> tuple[float, float]:
        """Bounds on the relative errors of the speed and of widths, NaN where none was measured."""
        delta = log(self._slope(1.0) / self._square)
        added = 1 - self._slope(_FOOT) / self._square  # of V² to the sound's
        lattice, bare, rule = self.lattice, added > _BARE, _NONE
        if lattice.alike or lattice.size == 1:
            rule = _ALIKE if lattice.alike else _FARTHER
        elif lattice.size == 2 and not bare:
            rule = _LOADED_PAIR
        elif lattice.size == 2 and len({*lattice.masses}) == 1:
            rule = _BARE_PAIR
        heard = lattice.resonators and not (
            bare and lattice.alike and lattice.size == 1
        )
        if delta > rule[2] or heard or self._quadrature.B < 0:
            rule = _NONE
        # Measured in parts of the lattice's value: x of that is x/(1 - x) of the theory's.
        excess, width = (part * delta / (1 - part * delta) for part in rule[:2])
        return excess * added / 2, width

    @property
    def speed_error(self) -> float:
        """Bound on the error of the speed; NaN where no such wave was measured, as for B < 0."""
        return self._bounds[0] * number(self.speed)

    def fwhm_error(self, quantity: str = "force", extent: str = "length") -> float:
        """Bound on the error of a width; NaN where no such lattice was measured."""
        return self._bounds[1] * number(self.fwhm(quantity, extent))


def _refusal_under_power(excess: sp.Expr, p0: sp.Expr, B: sp.Expr) -> str:
    """Reason why δ^k has no wave of the rise B on the strain p0; empty if there may be a wave.

    excess : k - 1. Speeds scale as strain^{(k-1)/2}.
    """
    stiffens, softens = excess.is_positive, excess.is_negative
    cases = {
        "at k = 1 the chain is linear, and its waves disperse": excess.is_zero,
        "k < 1 and there is no load: the speed falls with the strain": softens
        and p0.is_zero,
        "k > 1: speeds grow with the strain, and only B > 0 has a wave": stiffens
        and B.is_negative,
        "k < 1: speeds fall with the strain, and only B < 0 has a wave": softens
        and B.is_positive,
        "the contacts would open": p0.is_negative or (p0 + B).is_nonpositive,
    }
    return next((reason for reason, holds in cases.items() if holds), "")


def loaded_wave(
    chain: Cell | Lattice,
    *,
    force: Quantity = "F",
    precompression: Quantity = 0,
    rise: Quantity | None = None,
    background: Quantity | None = None,
    law: ContactLaw | None = None,
    k: Quantity = symbol_k,
) -> LoadedWave:
    """The wave on a static load in a chain of a cell, or in a lattice, in the canonical field.

    force, precompression : peak of the total contact force (the mean force along a lattice), and
        static force; 0 for no load. A ``force`` below the load is a rarefaction wave's.
    rise, background : in place of forces, in the chain of a cell: the rise B of the strain, by
        default a symbol, on the static strain p0, by default 0.
    law, k : the law of a cell's contacts, δ^k unless given. The links of a lattice have their own.

    Symbols are taken where results are closed forms: by strain under any law, by force under
    powers. For equal spheres V²/c0² is Nesterenko's (4/15) (3 + 2 ζ^{5/2} - 5 ζ) / (ζ - 1)²,
    ζ = (F/F0)^{2/3}.

    Raises `lwa.InputError` for forces that are not positive or not reached, for other symbols, and
    for resonators slower than 1.2 · 2πV/D; `lwa.NoSolitaryWave` without a wave.

    >>> wave = loaded_wave(Cell([1], spacing=1), rise=1, background=1, k="3/2")
    >>> wave.speed, wave.fwhm("strain").n(12)
    (sqrt(6)*sqrt(-28/15 + 32*sqrt(2)/15)/2, 3.15563100805)
    >>> from lwa import Link, Power
    >>> pair = Lattice([1, 1], [Link(0, 1, Power("3/2")), Link(1, 2, Power(1))])
    >>> wave = loaded_wave(pair, force=2, precompression=1)
    >>> round(float(wave.speed), 6), round(float(wave.fwhm("strain")), 6)
    (1.114528, 6.772308)
    """
    by_force = rise is None and background is None
    given = read_exact(force, "force"), read_exact(precompression, "precompression")
    if not by_force and given != (read_exact("F", "force"), 0):
        raise InputError("a wave is given by its forces or by its strains, not by both")
    if isinstance(chain, Lattice):
        if law is not None or k != symbol_k:
            raise InputError("a law is given: the links of a lattice have their own")
        if not by_force:
            raise InputError(
                "a strain is given: the wave of a lattice is given by forces"
            )
        return LoadedWave(chain, None, precompression, force)
    law = for_cell(law, chain, k)
    if by_force:
        return LoadedWave(chain, law, precompression, force)
    p0 = 0 if background is None else background
    B = Background(chain, law, p0).rise if rise is None else rise
    return LoadedWave(chain, law, p0, B, False)
