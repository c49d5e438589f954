"""Numbers that things to turn show, for the pages and for their still pictures.

Each function returns a script that defines a constant of the scripts in `_ext/turn`.
"""

from __future__ import annotations

import json
import math
from fractions import Fraction
from typing import Any

import numpy as np
import sympy as sp
from studies.breather import Standing
from trust import nearest

from lwa import Cell, Dimer, Power, envelope, expand
from validation import exact_wave

ORDERS = 60

# Losses of ln F at a single bead, over the square and over the power 5/2 of its excess of mass, as
# the chapter on the paper's experiment measures them for spheres.
LOSSES = {
    "heavier": {"square": 0.01345, "power": 0.1907},
    "lighter": {"square": 0.0201, "power": 0.327},
}

DETUNINGS = ("1/1000", "3/2000", "1/400", "1/250", "1/200")
BEADS = (
    60  # on each side of a breather's middle bead: seven lengths of the widest envelope
)


class Script(str):
    """A script element, which a notebook runs."""

    def _repr_html_(self) -> str:
        return self


def script(name: str, value: Any) -> Script:
    """A script element that defines a constant; NaN stands for a refused value."""
    return Script(f"<script>const {name} = {json.dumps(value)};</script>")


def sums() -> Script:
    """``lwaSums``: errors of the partial sums of c² over their order, for some k."""
    series = expand(Cell([1]), ORDERS).c2
    coefficients = np.array([float(c) for c in series.coefficients])
    found = []
    for tenths in range(11, 21):
        k = Fraction(tenths, 10)
        truth = exact_wave([1], float(k)).c2
        terms = coefficients * float(k - 1) ** np.arange(ORDERS + 1)
        errors = np.abs(np.cumsum(terms) - truth)
        summed = abs(float(series.at(sp.Rational(tenths, 10)).value) - truth)
        row = {"k": float(k), "truth": truth, "summed": float(f"{summed:.2g}")}
        found.append(row | {"errors": [float(f"{error:.2g}") for error in errors]})
    return script("lwaSums", found)


def breathers() -> Script:
    """``lwaBreathers``: orbits of a dimer under load, and amplitude and width of the envelope."""
    cell = Dimer(1, "1/2", spacing=1)
    edge = envelope(cell, law=Power("3/2"), precompression=1)
    found = []
    for detuning in DETUNINGS:
        theory = edge.breather(detuning=detuning)
        orbit = Standing(cell, 1.5, theory, BEADS).orbit
        row = {
            "nu": float(Fraction(detuning)),
            "start": [float(f"{u:.6g}") for u in orbit.displacements(0.0)],
            "amplitude": float(abs(orbit.amplitude).max()),
            "U": float(abs(theory.amplitude[1])),
            "b": 1 / float(theory.width),
        }
        found.append(row)
    return script("lwaBreathers", found)


def losses() -> Script:
    """``lwaLosses``: coefficients of the loss at a heavier and at a lighter bead."""
    return script("lwaLosses", LOSSES)


def closed_forms() -> Script:
    """``lwaForms``: ln ω, speed and width of spheres at unit force, and their relative errors."""
    rows = []
    for omega in np.geomspace(0.01, 1, 41):
        ratio = sp.Rational(round(1e6 * omega), 10**6)
        wave = nearest(sp.Rational(3, 2), ratio)
        row = [float(np.log(omega))]
        for name in ("speed", "fwhm"):
            if wave is None:
                row += [math.nan, math.nan]
            else:
                value = wave.estimate(name)
                row += [value.value, value.relative_error]
        rows.append(row)
    return script("lwaForms", rows)
