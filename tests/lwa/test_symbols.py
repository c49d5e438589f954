"""Results mean the same whatever a caller's symbols are called, but for the paper's own names."""

import sympy as sp

from lwa import (
    Cell,
    Dimer,
    Dispersion,
    envelope,
    expand,
    homogenize,
    lattice_wave,
    loaded_wave,
)
from lwa.law import named
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
    wave = theory.pde.traveling_wave()
    yield from (wave.speed(), wave.at_force().fwhm("force", "time"))
    full = homogenize(cell, 4, k=k, closure="full", field="center")
    yield from (full.pde.I, *full.pde.energy[2].values(), *full.slaved[1][3].values())
    yield Dispersion(Cell((m1, m2), (m2, 2 * m2), D), k).acoustic(4)[4]
    yield lattice_wave(Cell([m1], spacing=D), k=k, force=a).fwhm("force", "time")
    energy = expand(Cell((m1, m2)), 1, k=k).energy
    yield energy.prefactor * energy.coefficients[1]
    mode = envelope(cell, k=k, background=b)
    yield from (mode.frequency, mode.dispersion, mode.nonlinearity)
    law = named("hertz2", a, b)
    center = homogenize(cell, law=law, closure="full", field="center")
    yield at_compression(law, center.pde.G, 3)
    field = loaded_wave(cell, background="1/2", law=law).field
    yield from (field.speed(field.rise), field.kdv.nonlinearity)


def numbers(symbols):
    """The results with a number for each symbol, to 30 digits."""
    values = dict(zip(symbols, VALUES, strict=True))
    # Some results are numbers of Python.
    found = [sp.sympify(x).xreplace(values) for x in results(*symbols)]
    own = [{s: OWN[s.name] for s in x.free_symbols} for x in found]
    return [sp.N(x.subs(letters), 30) for x, letters in zip(found, own, strict=True)]


def test_results_do_not_depend_on_names():
    ours = numbers(sp.symbols("role0:6", positive=True))
    theirs = numbers(
        (
            *sp.symbols("K2 whole"),
            *sp.symbols("xi x", real=True),
            *sp.symbols("p s", positive=True),
        )
    )
    for i, (one, two) in enumerate(zip(ours, theirs, strict=True)):
        # 30 digits, less those that the alternating coefficients lose
        assert abs(one - two) <= 1e-25 * max(1, abs(one)), i
