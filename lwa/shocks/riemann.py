"""The Riemann problem of a chain: the shock or the rarefaction between two strains.

A wall that moves at v_p into a chain of strain p₊ compresses the chain to the strain p₋, with
v_p = ∫ c dp, c = √F′(p) the speed of sound. If r = c₋/c₊ > 1, sound is faster behind the front, and
the front is a dispersive shock, a wave train between two edges; else a rarefaction c(p) = x/t joins
c₋ and c₊.

Edges. Let f(κ) be the frequency of the linear chain over the speed of sound, f̃(q) = -i f(iq). El's
conditions (Chaos 15, 037103 (2005)) are

    trailing edge   ∫₀^κ (1 - f′)/f dκ = ln r,      speed f′(κ) in units of c₋,
    leading edge    ∫₀^q (f̃′ - 1)/f̃ dq = ln r,      speed f̃(q)/q in units of c₊.

For equal beads f = 2 sin κ/2 makes the integrals -2 ln cos κ/4 and 2 ln cosh q/4, so that the
speeds are 2/r - 1 and √(r(r-1))/arcosh √r.

Doubling rule: the leading pulse is the solitary wave on p₊ whose beads move at 2 v_p at most; exact
for Toda's law, small jumps (KdV) and hard spheres. For k = 1.05 … 3 the lattice's own wave has
the measured speed within 0.25 % and strain within 1.5 %; `lwa.shocks.waves` has the closed forms of
the canonical wave, `lwa.shocks.waves` the errors.
"""

from __future__ import annotations

from contextlib import suppress
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import sympy as sp

from lwa.base import latex
from lwa.base.exact import InputError, one_of, positive, read_exact, shorten
from lwa.base.frozen import Value
from lwa.cell import Cell
from lwa.cell import k as symbol_k
from lwa.law import ContactLaw, for_cell
from lwa.loaded.background import Background
from lwa.shocks import waves
from lwa.shocks.waves import Pulse, demand_one_sign, floats, strain, tidy, velocity

RULES = (
    "dispersion",
    "doubling",
)  # El's leading edge; the solitary wave with beads at 2 v_p

# r up to which the trailing edge is given; against the lattice it is 3 % too slow for Hertz
# contacts at p₋/p₊ = 2, r = 1.19, and 9 % at p₋/p₊ = 3, r = 1.32
STEEPEST = sp.Rational(13, 10)

SMALLEST = sp.Rational(1, 10**15)
"""Smallest jump of the strain, relative; 30 digits of the floats are left there."""


@dataclass(frozen=True)
class Shock(Value):
    """The front between the strains ``behind`` and ``ahead`` (see `shock`).

    Speeds are dx/dt in the units of the cell. `rise`, `peak` and `peak_force` are those of the
    leading pulse; they raise `lwa.InputError` for rarefactions, for unequal beads, and for an
    inflection of F within the pulse. So do the edges of a shock.
    """

    cell: Cell
    law: ContactLaw
    behind: sp.Expr
    ahead: sp.Expr

    def latex_rows(self) -> list[str]:
        names = {"p_{-}": self.behind, "p_{+}": self.ahead, "v_{p}": self.plateau}
        with suppress(InputError):
            names["s_{-}"] = self.trailing_speed
        with suppress(InputError):
            names |= {"s_{+}": self.leading_speed(), r"p_{\max}": self.peak}
        return latex.rows(names)

    @property
    def kind(self) -> str:
        """ "shock" where sound is faster behind the front, else "rarefaction"."""
        if self._gain.is_positive is None:
            raise InputError("kind depends on symbols: give numbers")
        return "shock" if self._gain.is_positive else "rarefaction"

    @property
    def oscillates(self) -> bool:
        """True if the beads at the wall go on oscillating: a shock of numbers with c₋ > 2 c₊."""
        return bool(self.ratio.is_number and self.ratio > waves.RESTING)

    def sound(self, p: Any) -> sp.Expr:
        """Speed of sound dx/dt on the strain p; 0 without load under a power law."""
        return tidy(self._sound(p if isinstance(p, sp.Expr) else read_exact(p, "p")))

    def _sound(self, p: sp.Expr) -> sp.Expr:
        field = self._field.on(p)
        if self.law.homogeneous and p.is_zero:
            return sp.S.Zero
        return field.sound_speed * field.time_scale

    @cached_property
    def ratio(self) -> sp.Expr:
        """Ratio r = c₋/c₊ of the speeds of sound, infinite without load."""
        behind, ahead = (
            self._sound(p) / self._field.time_scale for p in (self.behind, self.ahead)
        )
        return sp.oo if ahead.is_zero else sp.powsimp(behind / ahead)

    @cached_property
    def plateau(self) -> sp.Expr:
        """Velocity v_p of the wall, at which the beads behind the front come to rest beside it.

        Beyond c₋ = 2 c₊ they go on oscillating (`oscillates`), and the mean strain is below p₋.

        >>> from lwa import Cell
        >>> shock(Cell([1], spacing=1), "p", k="3/2").plateau
        2*sqrt(6)*p**(5/4)/5
        """
        return tidy(self._gained * self._field.time_scale)

    @cached_property
    def trailing_speed(self) -> sp.Expr:
        """Speed s₋ of the trailing edge by El's condition; for a rarefaction the speed c₋.

        Raises `lwa.InputError` for a shock beyond r = 1.3, and for a shock of unequal beads.

        >>> from lwa import Cell
        >>> shock(Cell([1], spacing=1), 2, "9/5", k=3).trailing_speed
        8*sqrt(3)/5
        """
        if self._gain.is_negative:
            return self.sound(self.behind)
        r = self._edge_ratio()
        if r.is_number and r > STEEPEST:
            raise InputError(
                f"c₋/c₊ is {sp.N(r, 5)}: the trailing edge holds up to 1.3"
            )
        return tidy(sp.expand(self._sound(self.behind) * (2 / r - 1)))

    def leading_speed(self, rule: str = "doubling") -> sp.Expr:
        """Speed s₊ of the leading pulse by "doubling", or of the leading edge by El's "dispersion".

        Both are exact for Toda's law, where they are one speed; the closed form of the canonical
        wave is not: it makes the doubling rule up to 0.7 % too fast for Hertz contacts, 5 % for
        k = 3 without load. Dispersion holds within 1 % for Hertz contacts up to p₋/p₊ = 3 and is
        14 % too slow at 50. `errors` has the errors.

        For a rarefaction the speed is c₊. Raises `lwa.InputError` for dispersion without sound
        ahead, and for unequal beads.
        """
        one_of(rule, RULES, "rule")
        if self._gain.is_negative:
            return self.sound(self.ahead)
        if rule == "doubling":
            return tidy(self._pulse.speed * self._field.time_scale)
        r = self._edge_ratio()
        return tidy(
            self._sound(self.ahead) * sp.sqrt(r * (r - 1)) / sp.acosh(sp.sqrt(r))
        )

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
        if not (self._free or self.law.homogeneous):
            _ = self._pulse  # refuses an inflection of F within the leading pulse
        return self.ratio

    @cached_property
    def errors(self) -> dict[str, float]:
        """Relative errors of the results, as measured on driven chains (`lwa.shocks.waves`).

        The keys are "trailing_speed", "dispersion" and "doubling" (of `leading_speed`), "peak" and
        "peak_force". Unknown errors and those of symbols are left out.
        """
        if self._free or self.kind == "rarefaction":
            return {}
        found: dict[str, float] = {}
        for errors in (self._pulse_errors, self._edge_errors):
            with suppress(InputError):
                found |= errors()
        return found

    def _pulse_errors(self) -> dict[str, float]:
        pulse, peak = self._pulse, sp.N(self.peak)
        share = waves.rise_error(pulse.stiffening) * sp.N(pulse.contact_rise)
        # towards the strain ahead: the rule is too high, and a law may have a pole beyond the peak
        force, less = (self.law.at(self.cell.spacing * p) for p in (peak, peak - share))
        found = {"doubling": waves.speed_error(pulse.stiffening)}
        found |= {"peak": share / peak, "peak_force": 1 - less / force}
        return {name: abs(float(x)) for name, x in found.items()}

    def _edge_errors(self) -> dict[str, float]:
        """Errors of El's edges, by the doubling rule."""
        ratio = self.leading_speed("doubling") / self.leading_speed("dispersion")
        off = abs(float(ratio) - 1)
        found = {"dispersion": waves.leading_error(off, self._pulse.stiffening)}
        with suppress(InputError):
            share = float(self.sound(self.behind) / self.trailing_speed)
            found["trailing_speed"] = waves.trailing_error(off) * abs(share)
        return found

    @cached_property
    def _pulse(self) -> Pulse:
        """The leading pulse by the doubling rule; an error for rarefactions and unequal beads."""
        if self._gain.is_negative:
            raise InputError(
                "sound is slower behind the front: a rarefaction has no pulse"
            )
        pulse = Pulse(self._field, 2 * self._gained)
        if not self.law.homogeneous:
            demand_one_sign(self._field, self.ahead, self.ahead + pulse.rise)
        return pulse

    @property
    def rise(self) -> sp.Expr:
        """Rise B = 2 v_p/s₊ of u_x in the leading pulse, by the doubling rule."""
        return tidy(self._pulse.rise)

    @property
    def peak(self) -> sp.Expr:
        """Strain of a contact at the peak of the leading pulse, by the doubling rule."""
        return tidy(self.ahead + self._pulse.contact_rise)

    @property
    def peak_force(self) -> sp.Expr:
        """Contact force A F at the peak of the leading pulse, in the units of the cell."""
        stiffness = self.cell.stiffness(self.law.exponent)
        return tidy(stiffness * self.law.at(self.cell.spacing * self.peak))

    @cached_property
    def _field(self) -> Background:
        """The waves of the chain on the strain ahead."""
        return Background(self.cell, self.law, self.ahead)

    @property
    def _free(self) -> set[sp.Symbol]:
        """Symbols of the law and the strains, and of the spacing unless the law is a power."""
        scaled = set() if self.law.homogeneous else self.cell.spacing.free_symbols
        strains = self.ratio.free_symbols | self.behind.free_symbols
        return {*strains, *self.law.symbols, *scaled}

    @cached_property
    def _gained(self) -> sp.Expr:
        """Velocity v_p as du/dτ, in the units of the wave equation."""
        return velocity(self._field, self.behind)

    @cached_property
    def _gain(self) -> sp.Expr:
        """Difference c₋ - c₊, negative for a rarefaction; symbols are taken to mean a shock."""
        gain = self._sound(self.behind) - self._sound(self.ahead)
        if self.cell.spacing.is_Symbol and not self.law.homogeneous:
            gain = gain.xreplace({self.cell.spacing: sp.S.One})  # its unit of length
        if not gain.free_symbols:
            return sp.N(gain, 5)
        return sp.simplify(gain)  # only then is its sign known beside symbols


def _read(law: Any, cell: Cell, k: Any) -> ContactLaw:
    """Read a law with an expression."""
    contact = for_cell(law, cell, k)
    if contact.formless:
        raise InputError(
            f"law is {contact.text}: a front between two strains needs an expression"
        )
    return contact


def shock(
    cell: Cell,
    behind: Any,
    ahead: Any = 0,
    *,
    law: ContactLaw | None = None,
    k: Any = symbol_k,
) -> Shock:
    """The front of a chain whose strain is ``behind`` on its left and ``ahead`` on its right.

    Strains are numbers or symbols, not negative under a power law; the contacts are δ^k unless a
    law is given. Results are exact for symbols and short fractions where they have a closed form,
    else floats of 30 digits. Raises `lwa.InputError` for other strains, for a jump below 1e-15 of
    the strains, where sound is equally fast on both, and unless F′ > 0 and F″ keeps its sign
    between the strains.

    >>> from lwa import Cell
    >>> front = shock(Cell([1], spacing=1), 1, 0, k="3/2")
    >>> round(front.leading_speed() / front.sound(1), 4), round(front.peak.n(), 4)
    (0.8543, 1.7480)
    """
    contact = _read(law, cell, k)
    return _front(
        cell, contact, read_exact(behind, "behind"), read_exact(ahead, "ahead")
    )


def _front(cell: Cell, law: ContactLaw, behind: sp.Expr, ahead: sp.Expr) -> Shock:
    for name, p in (("behind", behind), ("ahead", ahead)):
        if law.homogeneous and p.is_negative:
            raise InputError(
                f"{name} is {shorten(p)}: contacts of a power law only push"
            )
        if law.homogeneous and p.is_zero and (law.exponent - 1).is_nonpositive:
            raise InputError(
                f"{name} is 0 and k {law.exponent}: a front without load wants k > 1"
            )
    jump = behind - ahead
    if (
        jump.is_number
        and not jump.is_zero
        and abs(jump) < SMALLEST * max(abs(behind), abs(ahead))
    ):
        raise InputError(
            f"the jump of the strain is {sp.N(jump, 3)}: 1e-15 of it at least is wanted"
        )
    strains = floats(behind, ahead, constants=law.F.atoms(sp.Rational))
    if (
        not law.homogeneous
        and cell.spacing.is_Symbol
        and any(p.is_Float for p in strains)
    ):
        raise InputError(
            f"spacing is {cell.spacing}: beside long decimals a number is wanted"
        )
    front = Shock(cell, law, *strains)
    gain = front._gain
    demand_one_sign(front._field, front.behind, front.ahead)
    if gain.is_zero:
        raise InputError(
            "sound is as fast behind as ahead: there is no shock and no rarefaction"
        )
    return front


def piston(
    cell: Cell,
    velocity: Any,
    ahead: Any = 0,
    *,
    law: ContactLaw | None = None,
    k: Any = symbol_k,
) -> Shock:
    """The front that a wall moving at this velocity drives into a chain of strain ``ahead``.

    The velocity dx/dt, positive, is in the units of the cell: m/s for `lwa.Cell.of_spheres`.
    Raises `lwa.InputError` as `shock`, and for a velocity that the law does not reach.

    >>> from lwa import Cell
    >>> piston(Cell([1], spacing=1), "v", k=3).behind
    sqrt(2)*3**(3/4)*sqrt(v)/3
    """
    contact = _read(law, cell, k)
    speed, p0 = positive(velocity, "velocity"), read_exact(ahead, "ahead")
    speed, p0 = floats(speed, p0, constants=contact.F.atoms(sp.Rational))
    field = Background(cell, contact, p0)
    return _front(cell, contact, strain(field, speed / field.time_scale), p0)
