"""Width of the contact force by each theory, and the lattice's, over the mass ratio.

The map of the theories, the calculator and the chapter on the series show these widths.
Units: the heavy bead's mass, A and D are 1, so that widths are in sites.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cache
from typing import Any

import sympy as sp
from pulse import StruckPulse, struck_pulse

from lwa import Cell, Dimer, InputError, canonical_wave, expand, homogenize
from lwa.expansion.sums import Resummed

THEORIES = ("paper's closure", "canonical wave", "series, 8 orders")
ORDERS = 8
_M1, _M2 = sp.symbols("m1 m2", positive=True)


@dataclass(frozen=True)
class Trust:
    """Errors of the theories at one mass ratio.

    pulse : the lattice's pulse between the contacts 40 and 80.
    errors : FWHM of the contact force, theory over lattice less one, in the order of `THEORIES`;
        NaN where the series refuses a number.
    estimate : error that the series expects of itself, over the lattice's width; NaN likewise.
    """

    pulse: StruckPulse
    errors: tuple[float, float, float]
    estimate: float


def trust(k: Any, omega: Any) -> Trust:
    """Compare the theories with a struck chain of masses 1 and omega."""
    k, omega = sp.Rational(str(k)), sp.Rational(str(omega))
    pulse = struck_pulse(k, omega)
    widths = [float(wave.fwhm(float(k), float(omega), "force")) for wave in _compact()]
    summed, estimate = series_width(k, omega)
    paper, canonical, series = (width / pulse.width - 1 for width in (*widths, summed))
    return Trust(pulse, (paper, canonical, series), estimate / pulse.width)


def series_width(k: Any, omega: Any) -> tuple[float, float]:
    """Return the FWHM of the force by the series and its estimate of its error; NaN if refused."""
    try:
        total = _series(sp.Rational(str(omega))).at(sp.Rational(str(k)))
        return float(total.value), float(total.error)
    except InputError:
        return math.nan, math.nan


@cache
def _series(omega: sp.Rational) -> Resummed:
    """Width of the force as a series in k - 1."""
    return expand(Cell([1]) if omega == 1 else Dimer(1, omega), ORDERS).fwhm("force")


@cache
def _compact() -> tuple[Any, Any]:
    """Compact waves of the paper's closure and of the full one, as functions of k and ω."""
    theories = (
        homogenize(Dimer(_M1, _M2)).pde.traveling_wave(),
        canonical_wave(Dimer(_M1, _M2)),
    )
    return theories[0].numeric(), theories[1].numeric()
