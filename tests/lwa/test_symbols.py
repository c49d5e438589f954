"""Results mean the same whatever a caller's symbols are called, but for the paper's own names."""

import sympy as sp

from lwa import (
    Cell,
    Dimer,
    Dispersion,
    canonical_wave,
    envelope,
    expand,
    homogenize,
    loaded_wave,
)
from lwa.law import DELTA, named
from tests.lwa.fields import at_compression

VALUES = tuple(map(sp.Rational, ("5/3", "2/7", "7/5", "3/4", "2", "1/3")))
"""The numbers for the symbols of `results` when results are compared."""

OWN = {"B": 2, "V_s": 2, "F": 3, "kappa": 1}
"""Numbers for the results' own symbols."""


def results(m1, m2, k, D, a, b):
    """Public results for a dimer with the spacing D, the exponent k, and a law of a and b."""
    cell = Dimer(m1, m2, spacing=D)
    theory = homogenize(cell, 4, k=k)
    yield from (theory.ansatz[4], *theory.pde.coefficients[3].values())
    yield from theory.defect.get(3, {}).values()
    wave = theory.pde.traveling_wave()
    yield from (
        wave.beta,
        wave.amplitude(),
        wave.speed(),
        wave.roots[1],
        wave.time_scale,
    )
    yield from (getattr(wave.reduction(1), name) for name in ("mu", "sigma", "s"))
    yield wave.profile(sp.Rational(1, 5), 2)
    physical = wave.at_force()
    yield from (physical.speed, physical.fwhm("force", "time"))
    yield homogenize(cell, 2, k=k, branch="optical").amplitude_ratio
    full = homogenize(cell, 4, k=k, closure="full", field="center")
    yield from (full.pde.I, *full.pde.energy[2].values(), *full.slaved[1][3].values())
    yield full.at(**{m2.name: 3}).pde.I
    yield Dispersion(Cell((m1, m2), (m2, 2 * m2), D), k).acoustic(4)[4]
    yield canonical_wave(Cell((m1, m1, m2), spacing=D), k).fwhm("force")
    series = expand(Cell((m1, m2)), 1, k=k)
    for row in (series.c2, series.energy, series.fwhm("velocity")):
        yield row.prefactor * row.coefficients[1]
    mode = envelope(cell, k=k, background=b)
    yield from (mode.frequency, mode.dispersion, mode.nonlinearity)
    law = named("hertz2", a, b)
    yield from (law.phi(3).subs(DELTA, 3), law.energy.subs(DELTA, 3))
    center = homogenize(cell, law=law, closure="full", field="center")
    yield at_compression(law, center.pde.G, 3)
    field = loaded_wave(cell, background="1/2", law=law).field
    yield from (field.speed(field.rise), field.kdv.speed(), field.kdv.width())


def numbers(symbols):
    """The results with a number for each symbol, to 30 digits."""
    values = dict(zip(symbols, VALUES, strict=True))
    found = [sp.sympify(x).xreplace(values) for x in results(*symbols)]
    own = [{s: OWN[s.name] for s in x.free_symbols} for x in found]
    return [sp.N(x.subs(letters), 30) for x, letters in zip(found, own, strict=True)]


def test_results_do_not_depend_on_names():
    ours = numbers(sp.symbols("role0:6", positive=True))
    theirs = numbers(
        (
            *sp.symbols("x I"),
            *sp.symbols("xi q", real=True),
            *sp.symbols("mu c1", positive=True),
        )
    )
    for i, (one, two) in enumerate(zip(ours, theirs, strict=True)):
        # 30 digits, less those that the alternating coefficients lose
        assert abs(one - two) <= 1e-25 * max(1, abs(one)), i
