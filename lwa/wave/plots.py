"""Pictures of a wave. Matplotlib is loaded where one is drawn: the theory itself wants none."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import sympy as sp

from lwa.base.quantities import QUANTITIES, strain_power
from lwa.wave.curves import arch, number

if TYPE_CHECKING:
    from lwa.wave.closed import CompactWave
    from lwa.wave.physical import PhysicalWave

POINTS = 501


def axes(ax: Any) -> Any:
    """The axes that are given, or those of a new picture."""
    if ax is None:
        from matplotlib import pyplot  # here: only a picture wants it

        ax = pyplot.figure().add_subplot()
    return ax


def profiles(wave: CompactWave, ax: Any) -> Any:
    """Strain and contact force over their peaks, along the chain in sites."""
    k = number(wave.k)
    beta = number((wave.k - 1) / (2 * sp.sqrt(wave.dispersion)))
    sites = np.linspace(-0.6, 0.6, POINTS) * np.pi / beta
    ax = axes(ax)
    for quantity in QUANTITIES[:2]:
        power = 2 * strain_power(quantity, k) / (k - 1)
        ax.plot(sites, arch(beta * sites, power), label=quantity)
    ax.set(xlabel="ξ/D", ylabel="over its peak", title=f"compact wave, k = {wave.k}")
    ax.legend()
    return ax


def passage(answer: PhysicalWave, ax: Any, units: tuple[str, str]) -> Any:
    """The force of a contact and of a bead as the wave passes."""
    half = number(answer.fwhm("force", "time"))
    t = np.linspace(-2 * half, 2 * half, POINTS)
    ax = axes(ax)
    for of in ("contact", "bead"):
        ax.plot(t, answer.curve(t, of=of), label=of)
    names = (
        f"{name} ({unit})" if unit else name
        for name, unit in zip(("t", "force"), units, strict=True)
    )
    ax.set(**dict(zip(("xlabel", "ylabel"), names, strict=True)))
    ax.legend()
    return ax
