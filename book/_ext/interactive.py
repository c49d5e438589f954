"""Give the pages that can be turned their script and its formulas.

A page with an element of class ``lwa-chain``, ``lwa-shock``, ``lwa-breather``, ``lwa-light``,
``lwa-arch`` or ``lwa-calculator`` gets `turn.js` and before it, inline, the functions that the
script calls: the JavaScript that `lwa` writes of its own closed forms, and its table of materials.
The script lies outside ``_static``, whose scripts Jupyter Book loads on every page.
"""

from __future__ import annotations

import json
import re
import shutil
from functools import cache
from pathlib import Path

import sympy as sp
from sphinx.application import Sphinx

from lwa import Cell, Material, Sphere, canonical_wave, hertz, homogenize
from lwa.wave.source import Function, module


@cache
def formulas() -> str:
    """A script that defines the object ``lwaFormulas``: closed forms by name, and materials."""
    k, m1, m2, A, D, F = sp.symbols("k m1 m2 A D F", positive=True)
    F_0, p_0, v, B = sp.symbols("F_0 p_0 v B", positive=True)
    wave = canonical_wave(Cell([m1, m2]), k)
    chain = canonical_wave(Cell([m1, m2], stiffnesses=[A, A], spacing=D), k)
    pulse, loaded = chain.at_force(F), chain.at_force(F, precompression=F_0)
    paper = homogenize(
        Cell([m1, m2], stiffnesses=[A, A], spacing=D), k=k
    ).pde.traveling_wave()
    theirs = paper.at_force(F)
    strain = canonical_wave(Cell([1]), k).on_background(p_0).field
    gap = strain.squared_speed(B) - strain.squared_speed(v)
    gradient = v * sp.sqrt(gap / (wave.I / wave.D**2 * strain.force(p_0 + v, 1)))
    solids = sp.symbols("E1 nu1 R1 E2 nu2 R2", positive=True)
    one, two = (
        Sphere(1, R, Material(E=E, nu=nu)) for E, nu, R in (solids[:3], solids[3:])
    )
    values = (k, A, m1, m2, D)
    more = (
        Function("hertz_A", "A of two spheres", solids, hertz.stiffness(one, two)),
        Function("pulse_speed", "dx/dt at the peak force F", (F, *values), pulse.speed),
        Function("pulse_time", "FWHM of F in time", (F, *values), pulse.fwhm("force", "time")),
        Function("paper_speed", "dx/dt by the paper's closure", (F, *values), theirs.speed),
        Function("paper_time", "FWHM of F in time", (F, *values), theirs.fwhm("force", "time")),
        Function("sound_speed", "dx/dt of small waves", (F_0, *values), loaded.sound_speed),
        Function("loaded_speed", "dx/dt at the peak force F", (F, F_0, *values), loaded.speed),
        Function("gradient", "|dv/dxi| where it has risen by v", (v, B, p_0, k, m1, m2), gradient),
    )  # fmt: skip
    names = [
        "beta width fwhm_strain fwhm_force fwhm_velocity speed amplitude profile",
        *(function.name for function in more),
    ]
    materials = {
        name: {key: float(getattr(solid, key)) for key in ("E", "nu", "density")}
        for name, solid in hertz.MATERIALS.items()
    }
    return "\n".join(
        [
            "const lwaFormulas = (() => {",
            wave.code("javascript"),
            module(more, "javascript", ["Chains in units, written by lwa"]),
            f"const materials = {json.dumps(materials)};",
            f"return {{{', '.join(' '.join(names).split())}, materials}};",
            "})();",
        ]
    )


def turn(app: Sphinx, page: str, template: str, context: dict, doctree: object) -> None:
    """Append the scripts to a page that has something to turn."""
    body = context.get("body", "")
    if re.search('class="lwa-(chain|shock|breather|light|arch|calculator)"', body):
        root = context["pathto"]("_static/turn.js", resource=True)
        context["body"] = (
            f'{body}<script>{formulas()}</script><script src="{root}"></script>'
        )


def publish(app: Sphinx, fault: Exception | None) -> None:
    """Copy the script, which no other page loads, beside the built pages."""
    if fault is None:
        shutil.copy(Path(__file__).with_name("turn.js"), Path(app.outdir, "_static"))


def setup(app: Sphinx) -> dict[str, bool]:
    """Sphinx's hook."""
    app.connect("html-page-context", turn)
    app.connect("build-finished", publish)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
