"""Give the pages that can be turned their scripts and the scripts' formulas.

A page with an element of a class such as ``lwa-chain`` gets the scripts of the folder `turn`,
joined in one file, and before it, inline, the functions that they call: the JavaScript that `lwa`
writes of its own closed forms, and its table of materials. In each element stands a still picture
of the thing's start, for readers without JavaScript and on paper; `stills.py` draws them.
"""

from __future__ import annotations

import json
import re
from functools import cache
from pathlib import Path
from typing import Any

import sympy as sp
from sphinx.application import Sphinx

from lwa import Cell, Dimer, Material, Sphere, canonical_wave, hertz, homogenize
from lwa.law import named
from lwa.wave.source import Function, module

FOLDER = Path(__file__).with_name("turn")
SCRIPTS = ("lattice", "pen", "stage", "rows", "waves", "swings", "calculator", "main")
THING = re.compile(r'<div class="lwa-([a-z]+)"[^>]*></div>')

# The laws of the chapter on laws, with the parameters of its figure.
LAWS = {"hertz2": (1, 1), "exponential": (1,), "magnetic": (4, 1)}

# Strengths in Pa, above which a material yields for certain: steel 316, annealed bar, ASM/MatWeb;
# 440C hardened and tempered at 204 °C, nickelalloys.in; 6061-T6 and the hardest brass, ah-engr.com,
# table of strengths; the strongest molded PTFE under compression, treborintl.com. Glass breaks
# before it yields.
STRENGTHS = {
    "steel 316": 240e6,
    "steel 440C": 1900e6,
    "aluminium": 270e6,
    "brass": 550e6,
    "PTFE": 23e6,
}


def written() -> str:
    """All scripts, one after the other."""
    texts = [(FOLDER / f"{name}.js").read_text(encoding="utf-8") for name in SCRIPTS]
    body = "\n".join(texts)
    return f'"use strict";\n(() => {{\nconst f = lwaFormulas;\n{body}}})();\n'


def chain_functions() -> list[Function]:
    """Speeds and widths of waves in units, of a chain of two kinds of bead."""
    k, m1, m2, A, D, F = sp.symbols("k m1 m2 A D F", positive=True)
    F_0, p_0, v, B = sp.symbols("F_0 p_0 v B", positive=True)
    cell = Cell([m1, m2], stiffnesses=[A, A], spacing=D)
    chain = canonical_wave(cell, k)
    pulse = chain.at_force(F)
    loaded = chain.at_force(F, precompression=F_0)
    paper = homogenize(cell, k=k).pde.traveling_wave()
    theirs = paper.at_force(F)
    strain = canonical_wave(Cell([1]), k).on_background(p_0).field
    gap = strain.squared_speed(B) - strain.squared_speed(v)
    I = canonical_wave(Cell([m1, m2], spacing=1), k).I
    gradient = v * sp.sqrt(gap / (I * strain.force(p_0 + v, 1)))
    values = (k, A, m1, m2, D)
    solids = sp.symbols("E1 nu1 R1 E2 nu2 R2", positive=True)
    E1, nu1, R1, E2, nu2, R2 = solids
    one = Sphere(1, R1, Material(E=E1, nu=nu1))
    two = Sphere(1, R2, Material(E=E2, nu=nu2))
    width = pulse.fwhm("force", "time")
    their_width = theirs.fwhm("force", "time")
    rise = (v, B, p_0, k, m1, m2)
    return [
        Function("hertz_A", "A of two spheres", solids, hertz.stiffness(one, two)),
        Function("pulse_speed", "dx/dt at the peak force F", (F, *values), pulse.speed),
        Function("pulse_time", "FWHM of F in time", (F, *values), width),
        Function("paper_speed", "dx/dt by the paper", (F, *values), theirs.speed),
        Function("paper_time", "FWHM of F in time", (F, *values), their_width),
        Function("paper_beta", "beta by the paper", (k, m1, m2, D), paper.beta),
        Function("sound_speed", "dx/dt of sound", (F_0, *values), loaded.sound_speed),
        Function("loaded_speed", "dx/dt at F", (F, F_0, *values), loaded.speed),
        Function("gradient", "|dv/dxi| where the strain rose by v", rise, gradient),
    ]


def law_functions() -> list[Function]:
    """Force, slope and energy of contact laws."""
    found = []
    for name, parameters in LAWS.items():
        law = named(name, *parameters)
        delta = (law.delta,)
        for part, value in (
            ("force", law.F),
            ("slope", law.slope()),
            ("energy", law.energy - law.energy.subs(law.delta, 0)),
        ):
            doc = f"{part} of the law {name}"
            found.append(Function(f"{name}_{part}", doc, delta, value))
    return found


def ansatz() -> dict[str, Any]:
    """Coefficients of the ansatz at the paper's mass ratio, 1 and b_1 … b_4."""
    omega = sp.Rational(123, 450)
    theory = homogenize(Dimer(1, omega), order=4)
    numbers = [float(theory.ansatz[n]) for n in (1, 2, 3, 4)]
    return {"omega": float(omega), "b": [1.0, *numbers]}


@cache
def formulas() -> str:
    """A script that defines ``lwaFormulas``, closed forms and materials, and ``lwaAnsatz``."""
    m1, m2 = sp.symbols("m1 m2", positive=True)
    wave = canonical_wave(Cell([m1, m2]))
    more = [*chain_functions(), *law_functions()]
    names = ["beta", "fwhm_strain", "profile", *(function.name for function in more)]
    materials: dict[str, dict[str, float | None]] = {}
    for name, solid in hertz.MATERIALS.items():
        known = {key: float(getattr(solid, key)) for key in ("E", "nu", "density")}
        materials[name] = known | {"yield": STRENGTHS.get(name)}
    lines = [
        "const lwaFormulas = (() => {",
        wave.code("javascript"),
        module(more, "javascript", ["Chains in units and laws, written by lwa"]),
        f"const materials = {json.dumps(materials)};",
        f"return {{{', '.join(names)}, materials}};",
        "})();",
        f"const lwaAnsatz = {json.dumps(ansatz())};",
    ]
    return "\n".join(lines)


def turn(app: Sphinx, page: str, template: str, context: dict, doctree: object) -> None:
    """Put still pictures and scripts into a page that has something to turn."""
    body = context.get("body", "")
    if not THING.search(body):
        return
    pictures = context["pathto"]("_static/stills/", resource=True)
    script = context["pathto"]("_static/turn.js", resource=True)

    def still(match: re.Match[str]) -> str:
        name = match[1]
        words = f"Still picture: {name}"
        picture = f'<img class="lwa-still" src="{pictures}{name}.svg" alt="{words}">'
        return f'<div class="lwa-{name}">{picture}</div>'

    scripts = f'<script>{formulas()}</script><script src="{script}"></script>'
    context["body"] = THING.sub(still, body) + scripts


def publish(app: Sphinx, fault: Exception | None) -> None:
    """Write the script, which the other pages do not load, beside the built pages."""
    if fault is None:
        Path(app.outdir, "_static", "turn.js").write_text(written(), encoding="utf-8")


def setup(app: Sphinx) -> dict[str, bool]:
    """Sphinx's hook."""
    app.connect("html-page-context", turn)
    app.connect("build-finished", publish)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
