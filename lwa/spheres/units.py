"""SI units with the prefix that suits a magnitude, for text and pictures.

>>> fitting("s", 3.467e-5), fitting("N", 1130.0), fitting("kg", 4.5e-4)
(Unit(name='µs', size=1e-06), Unit(name='kN', size=1000.0), Unit(name='mg', size=1e-06))
"""

from __future__ import annotations

import math
import re
from dataclasses import dataclass

PREFIXES = ("p", "n", "µ", "m", "", "k", "M", "G", "T")
"""Prefixes of 10⁻¹², 10⁻⁹, … 10¹²."""

PREFIXED = ("s", "m", "N", "J", "Pa", "Hz", "kg", "m/s", "rad/s")
"""Units that take a prefix; any other unit stays as it is."""

_LABEL = re.compile(r"(.+) \(([^()]+)\)")


@dataclass(frozen=True)
class Unit:
    """A unit of measurement.

    Parameters
    ----------
    name : str
        The unit's symbol with its prefix, such as "µs", or a label that ends in the unit.
    size : float
        The unit divided by the SI unit.
    """

    name: str
    size: float = 1.0


def fitting(unit: str, magnitude: float) -> Unit:
    """Return a unit in which a magnitude has one to three digits before the decimal point.

    Beyond the `PREFIXES` it is the least or the largest of these units.

    Parameters
    ----------
    unit : str
        A unit of `PREFIXED`; other units are returned unchanged.
    magnitude : float
        The largest absolute value, in that unit.
    """
    # No prefix suits 0, or a magnitude that is not finite.
    if unit not in PREFIXED or not 0 < magnitude < math.inf:
        return Unit(unit)
    own = 1.0
    if unit == "kg":  # prefixes stand before the gram
        own = 1e-3
        unit = "g"
    # A prefix stands for a power of a thousand, from -4 to 4.
    thousands = math.floor(math.log10(magnitude / own) / 3)
    thousands = min(max(thousands, -4), 4)
    return Unit(PREFIXES[thousands + 4] + unit, 1000.0**thousands * own)


def labelled(label: str, magnitude: float) -> Unit:
    """Return the label of a column or an axis with its unit fitted to a magnitude.

    >>> labelled("arrival (s)", 2e-4), labelled("peak", 2e-4)
    (Unit(name='arrival (µs)', size=1e-06), Unit(name='peak', size=1.0))
    """
    parts = _LABEL.fullmatch(label)
    if parts is None:
        return Unit(label)
    unit = fitting(parts[2], magnitude)
    return Unit(f"{parts[1]} ({unit.name})", unit.size)
