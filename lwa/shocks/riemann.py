"""The Riemann problem of a chain: the shock or the rarefaction between two strains.

A wall that moves at v_p into a chain of strain p₊ compresses the chain to the strain p₋, with
``v_p = ∫ c dp``, c the speed of sound. Let r be the ratio c₋/c₊. If it is above 1, sound is faster
behind the front, and the front is a dispersive shock, a wave train between two edges; else a
rarefaction ``c(p) = x/t`` joins c₋ and c₊.

Edges. Let f(κ) be the frequency of the linear chain over the speed of sound, and
``f̃(q) = -i f(iq)``. El's conditions (Chaos 15, 037103 (2005)) are::

    trailing edge   ∫₀^κ (1 - f′)/f dκ = ln r,      speed f′(κ) in units of c₋,
    leading edge    ∫₀^q (f̃′ - 1)/f̃ dq = ln r,      speed f̃(q)/q in units of c₊.

For equal beads ``f = 2 sin κ/2`` makes the integrals ``-2 ln cos κ/4`` and ``2 ln cosh q/4``, so
that the speeds are ``2/r - 1`` and ``√(r(r-1))/arcosh √r``.

Doubling rule. The leading pulse is the solitary wave on p₊ whose beads move at 2 v_p at most; exact
for Toda's law, small jumps (KdV) and hard spheres. `lwa.shocks.waves` has the closed forms of the
canonical wave.

Errors were measured on driven chains of equal beads, until their pulses were steady: powers
with a load, k from 0.3 to 7, and without, k from 1.05 to 10, and the laws hertz2, magnetic,
polynomial and lennard-jones, c₋/c₊ up to 200. `tests/test_errors.py` drives some of them again,
random ones among them. The measure is the pulse's steepness Δ, by its saturating form::

    ρ = 1 - e^{-Δ} = 1 - V²/F′(p₊+B),

which vanishes for small jumps, where every rule is exact, and tends to 1 for hard spheres.
"""

from __future__ import annotations

import math
from contextlib import suppress
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Literal, get_args

import sympy as sp

from lwa.base import latex
from lwa.base.exact import InputError, brief, demand_numbers, number, one_of, read_exact
from lwa.base.frozen import Estimate
from lwa.cell import Cell, Parametric
from lwa.law import ContactLaw
from lwa.loaded.background import Background
from lwa.shocks.waves import DIGITS, WORKING, Pulse, demand_one_sign, velocity

RuleName = Literal["dispersion", "doubling"]
"""A rule for the leading edge: El's, or the solitary wave with beads at 2 v_p."""

RULES: tuple[RuleName, ...] = get_args(RuleName)

EstimatedName = Literal["trailing_speed", "leading_speed", "peak", "peak_force"]
"""A result of a shock with a measured error."""

# r up to which the trailing edge is given; against the lattice it is 3 % too slow for Hertz
# contacts at p₋/p₊ = 2, r = 1.19, and 9 % at p₋/p₊ = 3, r = 1.32
STEEPEST = sp.Rational(13, 10)

RESTING = 2
"""r up to which the beads at the wall come to rest beside it.

A theorem for Toda's law (Venakides, Deift & Oba, Comm. Pure Appl. Math. 44, 1171 (1991)).
"""


@dataclass(frozen=True, repr=False)
class Shock(Parametric):
    """The front between two strains (see `shock`).

    Speeds are ``dx/dt`` in the units of the cell. `rise`, `peak` and `peak_force` are those of the
    leading pulse; they raise `lwa.InputError` for rarefactions, for unequal beads, and for an
    inflection of F within the pulse. So do the edges of a shock.

    Parameters
    ----------
    cell : Cell
        The chain.
    law : ContactLaw
        The law of its contacts.
    behind, ahead : Expr
        The strains behind and ahead of the front.
    """

    cell: Cell
    law: ContactLaw
    behind: sp.Expr
    ahead: sp.Expr

    def __repr__(self) -> str:
        strains = f"behind={brief(self.behind)}, ahead={brief(self.ahead)}"
        return f"Shock({strains}, wall at {brief(self.plateau)}, law={self.law!r})"

    def latex_rows(self) -> list[str]:
        rows = {"p_{-}": self.behind, "p_{+}": self.ahead, "v_{p}": self.plateau}
        # Rows that this front does not have are left out.
        with suppress(InputError):
            rows["s_{-}"] = self.trailing_speed
        with suppress(InputError):
            rows["s_{+}"] = self.leading_speed()
            rows[r"p_{\max}"] = self.peak
        return latex.rows(rows)

    @property
    def kind(self) -> Literal["shock", "rarefaction"]:
        """ "shock" where sound is faster behind the front, else "rarefaction"."""
        if self._sound_gain.is_positive is None:
            demand_numbers(self._sound_gain.free_symbols, "the kind depends on it")
        return "shock" if self._sound_gain.is_positive else "rarefaction"

    @property
    def oscillates(self) -> bool:
        """True if the beads at the wall go on oscillating: a shock of numbers with c₋ > 2 c₊."""
        return bool(self.ratio.is_number and self.ratio > RESTING)

    def sound(self, p: Any) -> sp.Expr:
        """Speed of sound ``dx/dt`` on the strain p; 0 without load under a power law."""
        strain = p if isinstance(p, sp.Expr) else read_exact(p, "p")
        return self._in_time(self._sound(strain))

    def _sound(self, p: sp.Expr) -> sp.Expr:
        """Speed of sound ``dx/dτ`` on the strain p, with all digits."""
        field = self._field.on(p)
        # At k < 1 the speed is infinite there, and fronts are refused.
        if self.law.homogeneous and p.is_zero:
            return sp.S.Zero
        return _evaluated(field.sound_speed)

    def _in_time(self, speed: sp.Expr) -> sp.Expr:
        """The speed ``dx/dt`` of a speed ``dx/dτ``."""
        return _tidy(_evaluated(speed * self._field.time_scale))

    @cached_property
    def ratio(self) -> sp.Expr:
        """Ratio r of the speeds of sound behind and ahead, infinite without load."""
        ahead = self._sound(self.ahead)
        if ahead.is_zero:
            return sp.oo
        return sp.powsimp(_evaluated(self._sound(self.behind) / ahead))

    @cached_property
    def plateau(self) -> sp.Expr:
        """Velocity v_p of the wall, at which the beads behind the front come to rest beside it.

        Where c₋ is above 2 c₊ they go on oscillating (`oscillates`), and the mean strain is below
        p₋.

        >>> from lwa import Cell, shock
        >>> shock(Cell([1], spacing=1), "p", k="3/2").plateau
        2*sqrt(6)*p**(5/4)/5
        """
        return self._in_time(self._wall_velocity)

    @cached_property
    def trailing_speed(self) -> sp.Expr:
        """Speed of the trailing edge by El's condition; for a rarefaction the speed c₋.

        Raises
        ------
        InputError
            For a shock with r above 1.3, and for a shock of unequal beads.

        Examples
        --------
        >>> from lwa import Cell, shock
        >>> shock(Cell([1], spacing=1), 2, "9/5", k=3).trailing_speed
        8*sqrt(3)/5
        """
        # A rarefaction ends at the place that sound behind the front has reached.
        if self._sound_gain.is_negative:
            return self.sound(self.behind)
        r = self._edge_ratio()
        if r.is_number and r > STEEPEST:
            raise InputError(
                f"c₋/c₊ is {sp.N(r, 5)}: the trailing edge holds up to 1.3"
            )
        # f′ = cos κ/2 at -2 ln cos κ/4 = ln r
        sound = self._sound(self.behind) * self._field.time_scale
        return _tidy(sp.expand(sound * (2 / r - 1)))

    def leading_speed(self, rule: RuleName = "doubling") -> sp.Expr:
        """Speed of the leading pulse or edge; for a rarefaction the speed c₊.

        Both rules are exact for Toda's law, where they are one speed; the closed form of the
        canonical wave is not: it makes the doubling rule up to 0.7 % too fast for Hertz contacts,
        5 % for cubic ones without load. Dispersion holds within 1 % for Hertz contacts up to
        strains of the ratio 3 and is 14 % too slow at 50.

        Parameters
        ----------
        rule : {"doubling", "dispersion"}
            The speed of the leading pulse by the doubling rule, or of the leading edge by El's
            condition.

        Raises
        ------
        InputError
            For dispersion without sound ahead, and for unequal beads.
        """
        one_of(rule, RULES, "rule")  # refuses any other word
        if self._sound_gain.is_negative:
            return self.sound(self.ahead)
        if rule == "doubling":
            return self._in_time(self._pulse.speed)
        # f̃(q)/q = sinh(q/2)/(q/2) at 2 ln cosh q/4 = ln r
        r = self._edge_ratio()
        edge = sp.sqrt(r * (r - 1)) / sp.acosh(sp.sqrt(r))
        return self._in_time(self._sound(self.ahead) * edge)

    def _edge_ratio(self) -> sp.Expr:
        """The ratio r for El's edges, of equal beads in a chain with sound ahead."""
        if not self.cell.uniform:
            raise InputError(
                "the beads or contacts differ: edges are known for equal beads only"
            )
        if self.ratio.is_infinite:
            raise InputError(
                "ahead is 0: no sound runs there, and dispersion gives no edge"
            )
        if not self._free:
            _ = self._pulse  # refuses an inflection of F within the leading pulse
        return self.ratio

    def estimate(self, name: EstimatedName, rule: RuleName = "doubling") -> Estimate:
        """A result in floats with a bound on its error, as measured on driven chains.

        Parameters
        ----------
        name : {"trailing_speed", "leading_speed", "peak", "peak_force"}
            The result. Symbols that only scale it, such as a mass, count as 1.
        rule : {"doubling", "dispersion"}
            The rule of a leading speed.

        Returns
        -------
        Estimate
            The error is NaN for a rarefaction, and where none is known.

        Raises
        ------
        InputError
            Where there is no such result, and for symbols of the law and the strains.

        Examples
        --------
        >>> from lwa import Cell, shock
        >>> front = shock(Cell([1], spacing=1), 1, k="3/2")
        >>> speed = front.estimate("leading_speed")
        >>> lattice = 1.0395  # of a driven chain
        >>> abs(speed.value - lattice) < speed.error < 30 * abs(speed.value - lattice)
        True
        """
        one_of(name, get_args(EstimatedName), "name")  # refuses any other name
        front = self._unscaled
        if name == "leading_speed":
            value = number(front.leading_speed(rule))
        else:
            value = number(getattr(front, name))
        try:
            relative = front._relative_error(name, rule)
        except InputError:
            # Errors are measured by the pulse: a rarefaction has none.
            relative = math.nan
        return Estimate(value, abs(value) * relative)

    @cached_property
    def _unscaled(self) -> Shock:
        """This front with 1 in place of the symbols of the cell, such as m, A and D.

        These symbols are units, by which results are multiplied: relative errors are the same.
        Raises `lwa.InputError` if other symbols are left.
        """
        demand_numbers(self._free, "errors are computed in numbers")
        return self.replaced(dict.fromkeys(self.cell.symbols, sp.S.One))

    def _relative_error(self, name: EstimatedName, rule: RuleName) -> float:
        """The relative error of a result of a shock: bounds of what the driven chains showed.

        The module names these chains; ρ measures how steep a pulse is.
        """
        rho = self._pulse.rho
        # The first term is the doubling rule's own error. The second is that of the canonical wave,
        # which is 5 % too fast for cubic contacts without load.
        doubling = 0.01 * rho + 0.08 * rho**3
        if name == "leading_speed" and rule == "doubling":
            return doubling
        if name in ("leading_speed", "trailing_speed"):
            by_doubling = self.leading_speed("doubling")
            by_dispersion = self.leading_speed("dispersion")
            difference = abs(float(by_doubling / by_dispersion) - 1)
            if name == "leading_speed":
                # From dispersion to the doubling rule, and from there to the chain
                return difference + (1 + difference) * doubling
            # The error in c₋, measured up to 5.3 times the difference at the leading edge; 2 % is
            # what the runs resolve.
            in_sound = 0.02 + 6 * difference
            return in_sound * abs(float(self.sound(self.behind) / self.trailing_speed))
        # Error of the rise: the first term is the canonical wave's, the second the rule's own. The
        # lattice's peak is 1.3 % higher for powers without load, k from 1.02 to 1.1, and less for
        # small jumps.
        of_rise = 0.065 * rho**2 + 0.015
        # Floats of 15 digits are enough for an error.
        peak = sp.N(self.peak)
        error = of_rise * sp.N(self._pulse.contact_rise)
        if name == "peak":
            return abs(float(error / peak))
        # towards the strain ahead: the rule is too high, and a law may have a pole beyond the peak
        force = self.law.at(self.cell.spacing * peak)
        less = self.law.at(self.cell.spacing * (peak - error))
        return abs(float(1 - less / force))

    @cached_property
    def _pulse(self) -> Pulse:
        """The leading pulse by the doubling rule; an error for rarefactions and unequal beads."""
        if self._sound_gain.is_negative:
            raise InputError(
                "sound is slower behind the front: a rarefaction has no pulse"
            )
        # The doubling rule
        pulse = Pulse(self._field, 2 * self._wall_velocity)
        # Refused where F″ changes its sign within the pulse; F″ of a power does not.
        if not self.law.homogeneous:
            demand_one_sign(self._field, self.ahead, self.ahead + pulse.rise)
        return pulse

    @property
    def rise(self) -> sp.Expr:
        """Rise of the slope ``u_x`` in the leading pulse, by the doubling rule."""
        return _tidy(self._pulse.rise)

    @property
    def peak(self) -> sp.Expr:
        """Strain of a contact at the peak of the leading pulse, by the doubling rule."""
        return _tidy(self.ahead + self._pulse.contact_rise)

    @property
    def peak_force(self) -> sp.Expr:
        """Contact force at the peak of the leading pulse, in the units of the cell."""
        stiffness = self.cell.stiffness(self.law.exponent)
        return _tidy(stiffness * self.law.at(self.cell.spacing * self.peak))

    @cached_property
    def _field(self) -> Background:
        """The waves of the chain on the strain ahead."""
        return Background(self.cell, self.law, self.ahead)

    @property
    def _free(self) -> set[sp.Symbol]:
        """Symbols on which results depend otherwise than by a factor.

        Symbols of the cell (masses, stiffnesses, the spacing) are only factors, in the strains too,
        unless the ratio r holds them. Under a law that is no power a spacing is compared with the
        law's own length.
        """
        spacing = set() if self.law.homogeneous else self.cell.spacing.free_symbols
        strains = self.behind.free_symbols | self.ahead.free_symbols
        named = strains - {*self.cell.symbols}
        return {*self.ratio.free_symbols, *named, *self.law.symbols, *spacing}

    @cached_property
    def _wall_velocity(self) -> sp.Expr:
        """Velocity v_p as ``du/dτ``, in the units of the wave equation."""
        return _evaluated(velocity(self._field, self.behind))

    @cached_property
    def _sound_gain(self) -> sp.Expr:
        """Difference c₋ - c₊, negative for a rarefaction; symbols are taken to mean a shock."""
        gain = self._sound(self.behind) - self._sound(self.ahead)
        # A symbol for the spacing counts as the unit in which the law has its lengths.
        if self.cell.spacing.is_Symbol and not self.law.homogeneous:
            gain = gain.xreplace({self.cell.spacing: sp.S.One})
        if not gain.free_symbols:
            return sp.N(gain, 5)  # its sign is wanted alone
        # SymPy knows the sign of an expression in symbols in simple forms alone.
        return sp.simplify(gain)


def _evaluated(value: sp.Expr) -> sp.Expr:
    """The value; a number that holds floats as one float.

    SymPy may multiply floats of many digits with roots for ever.
    """
    if value.has(sp.Float) and not value.free_symbols:
        return sp.N(value, WORKING)
    return value


def _tidy(value: sp.Expr) -> sp.Expr:
    """Combine powers; a result with floats has `DIGITS` digits.

    Raises
    ------
    InputError
        For a result that floats do not hold.
    """
    if value.has(sp.zoo, sp.nan, sp.oo):
        raise InputError("the strains are too near, or too far apart, for a number")
    if not value.has(sp.Float):
        return sp.powsimp(value)
    # The factors without symbols are one float.
    factor, rest = value.as_independent(*value.free_symbols, as_Add=False)
    return factor.n(DIGITS) * rest
