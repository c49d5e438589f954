"""Bounds on the errors of waves under a load, as measured.

The theory was compared with exact waves of the lattice and with struck chains
(`book/studies/links.py`, `book/studies/struck.py`). The measure of a wave is its steepness::

    Δ = ln(F′(p0+B) / V̂²),

which vanishes with B/p0, and without load with k - 1. Over Δ the error of V̂², divided by the
difference ``F′(p0+B) - F′(p0)``, and the relative error of widths are nearly constant: for one
particle a cell and any law the first is at most 0.027, and the second at most 0.116, with links to
farther particles 0.24. Velocities are narrower than strains, which are means of velocities over a
spacing: the theory has one width for both, at most 0.242 too large for equal particles. The rules
below are bounds, each up to a largest Δ.

Strongly unlike contacts driven hard have widths 20 to 34 % too small and squared speeds up to 6 %
off: there, and without load, the width of a pair has no bound. Unlike masses without load radiate,
some all of the wave: neither has a bound. Nor have rarefactions, and resonators but in a chain of
equal beads without load. An unknown bound is NaN.
"""

from __future__ import annotations

from math import log, nan
from typing import NamedTuple

from lwa.loaded.lattice import Lattice

# A wave is without load if the squared speed of sound is less than this part of V². `wave` computes
# it at 1e-280 of the peak, that of lattices at 1e-40. So the waves of a power without load are
# taken for waves under a load at k < 1.03 (lattices: 1.15).
_BARE = 1e-6


class Rule(NamedTuple):
    """Largest measured errors of a kind of lattice, in parts of Δ.

    Parameters
    ----------
    square : float
        Error of V², divided by the rise of ``F′`` from the load to the peak.
    width : float
        Relative error of widths of forces and strains.
    largest : float
        Largest Δ that was measured.
    velocity : float
        Relative error of widths of velocities.
    """

    square: float
    width: float
    largest: float
    velocity: float = nan


# Equal particles and nearest links, with and without a load
ALIKE = Rule(square=0.03, width=0.12, largest=1.8, velocity=0.26)
# One particle a cell, with links to farther particles
FARTHER = Rule(square=0.03, width=0.3, largest=1.8)
# Two unlike masses or links under a load
LOADED_PAIR = Rule(square=0.25, width=1.1, largest=0.3)
# Two equal masses with unlike links, without a load
BARE_PAIR = Rule(square=0.16, width=nan, largest=1.8)
UNKNOWN = Rule(nan, nan, nan)


def bounds(
    lattice: Lattice,
    slope_at_rest: float,
    slope_at_peak: float,
    square: float,
    rises: bool,
) -> dict[str, float]:
    """Bounds on the relative errors of the speed and of widths; NaN where none was measured.

    Parameters
    ----------
    lattice : Lattice
        The lattice.
    slope_at_rest, slope_at_peak : float
        The slopes ``F′(p0)`` and ``F′(p0+B)``.
    square : float
        The squared speed ``V̂²``, in the unit of the slopes.
    rises : bool
        False for a rarefaction.

    Returns
    -------
    dict
        Bounds of the "speed", and of the width of each quantity by its name.
    """
    rule = _rule(lattice, bare=slope_at_rest < _BARE * square)
    delta = log(slope_at_peak / square)
    if not rises or delta > rule.largest:
        rule = UNKNOWN
    # The rules count the error of V² in this unit, relative to V². The error of V is half as large.
    stiffening = (slope_at_peak - slope_at_rest) / square
    width = rule.width * delta
    return {
        "speed": rule.square * delta * stiffening / 2,
        "strain": width,
        "force": width,
        "velocity": rule.velocity * delta,
    }


def _rule(lattice: Lattice, bare: bool) -> Rule:
    """The rule of a lattice, without load or under a load."""
    single = lattice.size == 1
    if lattice.resonators and not (bare and lattice.alike and single):
        return UNKNOWN
    if lattice.alike:
        return ALIKE
    if single:
        return FARTHER
    if lattice.size == 2 and not bare:
        return LOADED_PAIR
    if lattice.size == 2 and len({*lattice.masses}) == 1:
        return BARE_PAIR
    return UNKNOWN
