"""Width of the contact force by each theory, and the lattice's, over the mass ratio.

The map of the theories shows these widths. Units: the heavy bead's mass, A and D are 1, so that
widths are in sites.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import sympy as sp
from pulse import StruckPulse, struck_pulse

from lwa import (
    Cell,
    Dimer,
    LatticeWave,
    NoSolitaryWave,
    canonical_wave,
    homogenize,
    lattice_wave,
)

# Mass ratios of the map of the theories.
STRIP = (
    "1/100", "1/30", "1/10", "1/5", "3/10", "2/5", "1/2", "7/10", "4/5", "9/10", "1",
)  # fmt: skip

THEORIES = ("paper's closure", "canonical wave", "closed form")


@dataclass(frozen=True)
class Trust:
    """Errors of the theories at one mass ratio.

    Parameters
    ----------
    pulse : StruckPulse
        The lattice's pulse between the contacts 40 and 80.
    widths, speeds : tuple of float
        Full width at half maximum (FWHM) of the contact force, and speed at the lattice's peak
        force: theory over lattice less one, in the order of `THEORIES`; NaN where a theory has no
        wave.
    estimate : float
        Relative error of its width that the closed form states; NaN likewise.
    name : str
        The theory behind the closed form.
    """

    pulse: StruckPulse
    widths: tuple[float, ...]
    speeds: tuple[float, ...]
    estimate: float
    name: str


def nearest(k: Any, omega: Any) -> LatticeWave | None:
    """The wave that is nearest to the lattice's, of masses 1 and ω; None where there is none."""
    cell = Cell([1], spacing=1) if omega == 1 else Dimer(1, omega, spacing=1)
    try:
        return lattice_wave(cell, k=k)
    except NoSolitaryWave:
        return None


def trust(k: Any, omega: Any) -> Trust:
    """Compare the theories with a struck chain of masses 1 and omega."""
    k, omega = sp.Rational(str(k)), sp.Rational(str(omega))
    pulse = struck_pulse(k, omega)
    chain = Dimer(1, omega, spacing=1)
    closed = nearest(k, omega)
    waves = (
        homogenize(chain, k=k).pde.traveling_wave().at_force(1),
        canonical_wave(chain, k).at_force(1),
        closed,
    )
    growth = pulse.force ** float((k - 1) / (2 * k))  # of speeds with the force
    widths, speeds = [], []
    for wave in waves:
        width = math.nan if wave is None else float(wave.fwhm("force"))
        speed = math.nan if wave is None else float(wave.speed)
        widths.append(width / pulse.width - 1)
        speeds.append(speed * growth / pulse.speed - 1)
    if closed is None:
        return Trust(pulse, tuple(widths), tuple(speeds), math.nan, "no steady pulse")
    stated = closed.estimate("fwhm").relative_error
    return Trust(pulse, tuple(widths), tuple(speeds), stated, closed.theory)
