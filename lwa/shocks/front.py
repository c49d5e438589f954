"""The front between two strains, or in front of a moving wall, read from a user's values.

Exact powers such as ``0.392**2.091`` pass through integers of thousands of digits, and so do those
of symbols. Floats of `lwa.shocks.waves.WORKING` digits take their place.
"""

from __future__ import annotations

from typing import Any

import sympy as sp

from lwa.base.exact import InputError, demand_numbers, positive, read_exact, shorten
from lwa.cell import Cell, k as symbol_k
from lwa.law import ContactLaw, for_cell
from lwa.loaded.background import Background
from lwa.shocks.riemann import Shock
from lwa.shocks.waves import WORKING, demand_one_sign, strain

SHORT = 64
"""Largest numerator and denominator of numbers whose powers are kept exact.

The longest of these powers, ``64^64``, has 116 digits.
"""

SMALLEST = sp.Rational(1, 10**15)
"""Smallest jump of the strain, relative; half of the digits of results are left there."""


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
    """The front of a chain between two strains.

    Results are exact for symbols and short fractions where they have a closed form, else floats of
    30 digits.

    Parameters
    ----------
    cell : Cell
        The chain.
    behind, ahead : number or str
        The strains on the left and on the right, not negative under a power law.
    law : ContactLaw, optional
        The law of the contacts, by default a power.
    k : number or str
        Exponent of the power.

    Raises
    ------
    InputError
        For other strains, for a jump below 1e-15 of the strains, where sound is equally fast on
        both, and unless ``F′`` is positive and ``F″`` keeps its sign between the strains.

    Examples
    --------
    >>> from lwa import Cell
    >>> front = shock(Cell([1], spacing=1), 1, 0, k="3/2")
    >>> front
    Shock(behind=1, ahead=0, wall at 0.979796, law=Power(k=3/2))
    >>> round(front.leading_speed() / front.sound(1), 4), round(front.peak.n(), 4)
    (0.8543, 1.7480)
    """
    contact = _read(law, cell, k)
    return _front(
        cell, contact, read_exact(behind, "behind"), read_exact(ahead, "ahead")
    )


def piston(
    cell: Cell,
    velocity: Any,
    ahead: Any = 0,
    *,
    law: ContactLaw | None = None,
    k: Any = symbol_k,
) -> Shock:
    """The front that a moving wall drives into a chain.

    Parameters
    ----------
    cell : Cell
        The chain.
    velocity : number or str
        Velocity ``dx/dt`` of the wall, positive, in the units of the cell: m/s for
        `lwa.Cell.of_spheres`.
    ahead : number or str
        The strain ahead.
    law : ContactLaw, optional
        The law of the contacts, by default a power.
    k : number or str
        Exponent of the power.

    Raises
    ------
    InputError
        For input that `shock` refuses, and for a velocity that the law does not reach.

    Examples
    --------
    >>> from lwa import Cell
    >>> piston(Cell([1], spacing=1), "v", k=3).behind
    sqrt(2)*3**(3/4)*sqrt(v)/3
    """
    contact = _read(law, cell, k)
    speed = positive(velocity, "velocity")
    if speed.is_number and not speed.is_Rational:
        speed = sp.N(speed, WORKING)  # powers of roots take long
    speed, p0 = _floats(contact, speed, read_exact(ahead, "ahead"))
    field = Background(cell, contact, p0)
    return _front(cell, contact, strain(field, speed / field.time_scale), p0)


def _front(cell: Cell, law: ContactLaw, behind: sp.Expr, ahead: sp.Expr) -> Shock:
    """Return the front between two strains, or refuse the strains."""
    for name, p in (("behind", behind), ("ahead", ahead)):
        # Also where the sign of p or of k - 1 is unknown: symbols are taken to be in range.
        if law.homogeneous and p.is_negative:
            raise InputError(
                f"{name} is {shorten(p)}: contacts of a power law only push"
            )
        if law.homogeneous and p.is_zero and (law.exponent - 1).is_nonpositive:
            raise InputError(
                f"{name} is 0 and k {law.exponent}: a front without load wants k > 1"
            )
    # Equal strains are refused below, with the words for equal speeds of sound. Strains in symbols
    # may differ by a number, such as p and p + 1: their ratio is not known.
    jump = abs(behind - ahead)
    numbers = not sp.Tuple(behind, ahead).free_symbols
    if numbers and 0 < jump < SMALLEST * max(abs(behind), abs(ahead)):
        raise InputError(
            f"the jump of the strain is {sp.N(jump, 3)}: 1e-15 of it at least is wanted"
        )
    strains = _floats(law, behind, ahead)
    # The spacing only scales the results of numbers under a power law. Elsewhere it stands in
    # sums with floats, whose sign is not known.
    in_sums = cell.spacing.is_Symbol and not (law.homogeneous and numbers)
    if in_sums and any(p.has(sp.Float) for p in strains):
        raise InputError(
            f"spacing is {cell.spacing}: beside long decimals a number is wanted",
            spacing=1,
        )
    front = Shock(cell, law, *strains)
    gain = front._sound_gain
    demand_one_sign(front._field, front.behind, front.ahead)
    if gain.is_zero:
        raise InputError(
            "sound is as fast behind as ahead: there is no shock and no rarefaction"
        )
    return front


def _floats(law: ContactLaw, *values: sp.Expr) -> tuple[sp.Expr, ...]:
    """Floats of numbers, unless all numbers and the constants of their law are short fractions.

    Parameters
    ----------
    law : ContactLaw
        The law.
    *values : Expr
        Strains and velocities.

    Raises
    ------
    InputError
        For symbols of a value or of the law beside long fractions.
    """
    constants = {x for x in values if x.is_Rational} | law.F.atoms(sp.Rational)
    largest = max(max(abs(int(x.p)), int(x.q)) for x in constants | {sp.S.One})
    if largest <= SHORT:
        return values
    why = f"beside fractions above {SHORT} a front needs numbers"
    demand_numbers(law.symbols, why)
    found = []
    for value in values:
        demand_numbers(value.free_symbols, why)
        # 0 stays exact: without load a power law has closed forms.
        found.append(value if value.is_zero else sp.N(value, WORKING))
    return tuple(found)
