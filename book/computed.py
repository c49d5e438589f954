"""Numbers in the sentences of the pages, computed when the book is built.

In a page's text ``{{name}}`` stands for the number ``name`` of the page's function in `PAGES`;
`_ext/filled.py` puts it there, in formulas as well. Captions are parts of cells, which are executed
before: they have no such numbers.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable
from functools import cache

import numpy as np
import published
import sympy as sp
from studies.gravity import front_width
from studies.hard import three_beads
from studies.widths import widths
from trust import STRIP, nearest, trust
from turned import LOSSES

from lwa import (
    Cell,
    Dimer,
    LoadedChain,
    Material,
    Power,
    Sphere,
    canonical_wave,
    envelope,
    expand,
    homogenize,
    lattice_wave,
    pulse_of_strike,
)
from lwa.cell import k
from lwa.expansion.dimers import exponent_of_light_beads
from lwa.expansion.joined import FORMS, phi_series
from validation import exact_wave, simulate

HALF = "3/2"
UNIFORM = Cell([1], spacing=1)
PAPER = "123/450"  # mass of a PTFE bead over that of a steel bead
STEEL = Material(E="193e9", nu="0.3")

Numbers = dict[str, str]

beside = cache(trust)
"""The theories beside a struck chain at an exponent and a mass ratio."""


@cache
def numbers(page: str) -> Numbers:
    """The numbers of a page; none of a page without a function here."""
    return PAGES[page]() if page in PAGES else {}


def bound(share: float) -> str:
    """A share in percent, with one decimal that is not below it."""
    return f"{math.ceil(1000 * share) / 10:.1f}"


def fill(page: str, text: str) -> str:
    """A page's text with its numbers; a name without a number raises `KeyError`."""
    return re.sub(r"\{\{(\w+)\}\}", lambda name: numbers(page)[name[1]], text)


def ball() -> Sphere:
    """The first page's steel ball of 19 mm."""
    return Sphere("29.0e-3", "9.525e-3", STEEL)


def intro() -> Numbers:
    """The pulse of a ball that falls 5 mm onto a row of such balls."""
    strike = pulse_of_strike(Cell.of_spheres([ball()]), ball().mass, drop="0.005")
    return {
        "force": f"{strike.force.value:.0f}",
        "duration": f"{1e6 * strike.fwhm('force', 'time').value:.0f}",
        "speed": f"{strike.speed.value:.0f}",
    }


def equal() -> Numbers:
    """The arch beside the lattice's wave."""
    arch = float(canonical_wave(UNIFORM, HALF).fwhm("force"))
    lattice = exact_wave([1], 1.5).fwhm("force")
    return {
        "arch": f"{arch:.4f}",
        "lattice": f"{lattice:.4f}",
        "wide": f"{100 * (arch / lattice - 1):.1f}",
    }


def paper() -> Numbers:
    """The paper's pulse beside the lattice's."""
    return {"narrow": f"{-100 * beside(HALF, PAPER).widths[0]:.0f}"}


def cells() -> Numbers:
    """The pulse of the cell that is computed by hand."""
    cell = canonical_wave(Cell([4, 1, 1, 1], spacing=1), HALF)
    longer = math.sqrt(12 * float(cell.I))
    return {"longer": f"{longer:.2f}", "balls": f"{float(cell.sites):.1f}"}


def expansion() -> Numbers:
    """The approximant of the speed, slopes in ω, and the theories over the mass ratio."""
    speed = phi_series("speed", 2)
    bottom = -speed[2] / speed[1]  # of the approximant [1/1]
    limit = lattice_wave(Dimer(1, sp.Rational(1, 10**9), spacing=1), k=HALF)
    slopes = {
        name: float(exponent_of_light_beads(name).subs(k, sp.Rational(3, 2)))
        for name in ("speed", "force")
    }
    # The width of the closed form whose φ is a number, the exercise's.
    rest = math.exp(-float(phi_series("force", 0)[0]) / 2)
    two_bodies = float(FORMS["force"].two_bodies.subs(k, sp.Rational(3, 2)))
    rough = math.sqrt(two_bodies**2 + 8 / 3 * math.log(2) * rest)
    lattice = exact_wave([1], 1.5).fwhm("force")
    known = [n for n in range(1, 100) if nearest(HALF, sp.Rational(n, 100))]
    light = max(n for n in known if n < 60)
    alike = min(n for n in known if n > 60)
    near = [beside(HALF, ratio) for ratio in ("1/10", "0.12", "0.15", "0.18", "1/5")]
    speeds = np.abs([beside(HALF, ratio).speeds[:2] for ratio in STRIP]).max(axis=0)
    return {
        "top": f"{float(speed[0]):.6f}",
        "slope": f"{float(speed[1] + speed[0] * bottom):.6f}",
        "bottom": f"{float(bottom):.6f}",
        "lattice": f"{lattice:.4f}",
        "rough": f"{rough:.4f}",
        "below": f"{100 * (1 - rough / lattice):.1f}",
        "square": f"{float(limit.speed) ** 2:.4f}",
        "squareslope": f"{2 * slopes['speed']:.2f}",
        "width": f"{2 * lattice:.4f}",
        "widthslope": f"{slopes['force']:.2f}",
        "light": f"{light / 100:.2f}",
        "alike": f"{alike / 100:.2f}",
        "decays": f"{(light + 1) / 100:.2f}",
        "decayed": f"{(alike - 1) / 100:.2f}",
        "near": bound(max(abs(one.widths[0]) for one in near)),
        "papers": f"{100 * beside(HALF, PAPER).widths[0]:.0f}",
        "paperspeed": bound(speeds[0]),
        "canonicalspeed": bound(speeds[1]),
    }


def pressed() -> Numbers:
    """The width of a weak blow's front, and a blow in m/s."""
    bead = Sphere("0.45e-3", "2.38e-3", STEEL)
    A = float(Cell.of_spheres([bead]).stiffnesses[0])
    weight = 0.45e-3 * 9.81
    unit = math.sqrt(9.81 * np.cbrt((weight / A) ** 2))  # √(g ℓ), ℓ = (m g/A)^{2/3}
    return {"front": f"{front_width(1.5):.4f}", "blow": f"{1000 * unit:.2f}"}


def integration() -> Numbers:
    """Hard cases of the default method and of the closed forms."""
    # two contacts in series: A_eff = A 2^-k
    limit = 2 * exact_wave([1], 1.5).c * 2 ** (-1.5 / 3)
    pulse = beside(HALF, "1/1000").pulse
    below = 1 - pulse.speed / pulse.force ** (1 / 6) / limit
    drift = abs(simulate(three_beads(False, 1500.0), rtol=1e-5).energy_drift) / 1500
    wide = float(canonical_wave(UNIFORM, "1.001").fwhm("force"))
    return {
        "below": f"{100 * below:.2f}",
        "drift": f"{1e8 * drift:.1f}",
        "wide": f"{wide:.0f}",
    }


def modes() -> Numbers:
    """Frequencies of the experiment of Boechler et al., and where contacts open."""
    aluminium = Sphere("9.75e-3", "9.525e-3", Material(E="73.5e9", nu="0.33"))
    chain = Cell.of_spheres([Sphere("28.84e-3", "9.525e-3", STEEL), aluminium])
    edge = LoadedChain(chain, Power(HALF), 20).bands.edges()[1, 0] / (2000 * math.pi)
    pair = envelope(chain, law=Power(HALF), precompression=20).numeric()
    strain = pair.mean_strain[0] / pair.squared_strains[0] * pair.static_compressions[0]
    mean = float(strain) / 4
    swing = (1 - math.sqrt(1 - 4 * mean)) / (2 * mean)  # 1 = s - mean s²: contacts open
    return {
        "edge": f"{edge:.3f}",
        "opening": f"{swing**2 * 3 / 128:.4f}",
    }


def column() -> Numbers:
    """The canonical wave at equal force, and losses at a single bead."""
    losses = {
        name: f"{value:.4g}"
        for side, pair in LOSSES.items()
        for name, value in ((side + part, number) for part, number in pair.items())
    }
    return losses | {"slow": calculator()["pairslow"]}


def calculator() -> Numbers:
    """The theories beside the lattice for equal beads and for steel and PTFE; strikers."""
    arch, lattice = canonical_wave(UNIFORM, HALF), exact_wave([1], 1.5)
    pair = beside(HALF, PAPER)
    speeds = [
        float(homogenize(cell, k=HALF).pde.traveling_wave().at_force(1).speed)
        for cell in (Cell([1, PAPER], spacing=1), Cell([PAPER, 1], spacing=1))
    ]
    light, heavy = (
        max(
            pulse_of_strike(UNIFORM, mass, velocity=1).force.relative_error
            for mass in masses
        )
        for masses in (("0.02", "0.3", "1"), ("1.3", "1.6"))
    )
    mass = lattice_wave(UNIFORM, k=HALF).estimate("effective_mass").value
    strike = pulse_of_strike(UNIFORM, 1, velocity=1).force.value
    wide = float(arch.fwhm("force")) / lattice.fwhm("force") - 1
    return {
        "slow": f"{100 * (1 - float(arch.at_force(1).speed) / lattice.c):.1f}",
        "wide": f"{100 * wide:.1f}",
        "pairslow": f"{-100 * pair.speeds[1]:.0f}",
        "pairnarrow": f"{-100 * pair.widths[1]:.0f}",
        "swapped": f"{speeds[1] / speeds[0]:.2f}",
        "light": bound(light),
        "heavy": bound(heavy),
        "mass": f"{mass:.3f}",
        "strike": f"{strike:.4f}",
    }


def late_terms() -> Numbers:
    """The best partial sum of c² of spheres."""
    coefficients = np.array([float(c) for c in expand(UNIFORM, 60).c2.coefficients])
    sums = np.cumsum(coefficients * 0.5 ** np.arange(len(coefficients)))
    error = np.abs(sums - exact_wave([1], 1.5).c2).min()
    return {"nearest": f"{1e9 * error:.0f}"}


def experiment() -> Numbers:
    """The glass that is read from an echo."""
    return {"glass": f"{float(Material.named('glass').E) / 1e9:.1f}"}


def literature() -> Numbers:
    """This project's numbers, and their differences to those that others published."""
    (ptfe,) = (
        row
        for row in widths().document()["definitions"]
        if row["quantity"].startswith("PTFE") and row["unit"] == "s"
    )
    off = {name: 100 * error for name, error in ptfe["error_value"]["linear"].items()}
    rows = published.rows() | {
        "wide_light": published.Beside(9.2, off["m1 ≫ m2"], 1),
        "wide_equal": published.Beside(published.UNSTATED, off["m1 = m2"], 1),
        "wide_paper": published.Beside(published.UNSTATED, off["m2/m1 = 0.27"], 1),
    }
    found = {}
    for name, row in rows.items():
        found[name] = signed(row.here, row.digits)
        digits = 1 if row.unit == "%" else row.digits
        found[f"{name}_off"] = f"{signed(row.off, digits)} {row.unit}".rstrip()
    deeper = published.column(3200)
    for name in ("velocity", "displacement"):
        found[f"deeper_{name}"] = f"{deeper[f'column_{name}'].here:.3f}"
    return found


def signed(value: float, digits: int) -> str:
    """A number with a typographic minus, and none before a zero."""
    rounded = round(value, digits) + 0.0
    return f"{rounded:.{digits}f}".replace("-", "−")


PAGES: dict[str, Callable[[], Numbers]] = {
    "intro": intro,
    "equal": equal,
    "paper": paper,
    "cells": cells,
    "expansion": expansion,
    "pressed": pressed,
    "modes": modes,
    "integration": integration,
    "column": column,
    "calculator": calculator,
    "experiment": experiment,
    "literature": literature,
    "open": late_terms,
}
"""Functions of the pages' numbers."""
