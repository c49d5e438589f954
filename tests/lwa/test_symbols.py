"""Results mean the same whatever a caller's symbols are called, but for the paper's own names."""

from functools import cache

import numpy as np
import pytest
import sympy as sp
from hypothesis import assume, example, given, settings
from hypothesis import strategies as st

from lwa import (
    Cell,
    Dimer,
    Dispersion,
    InputError,
    Law,
    canonical_wave,
    expand,
    homogenize,
    loaded_wave,
)
from lwa.law import DELTA, named
from lwa.wave.numeric import NumericWave
from tests.lwa.fields import at_compression

OURS = """
mu0 mu1 c0 c1 a0 a1 tau lambda p a mu eta sigma s m z v G H I X x u w omega kappa r1 s1
s0 Z x0 x1 y P M gamma math k0 xi epsilon t alpha beta q math b1 phi2 p0
"""
"""Names inside the derivations; a symbol named k, D, B, F or V_s is the result's own symbol."""

ROLES = {
    "m1": sp.Rational(5, 3),
    "m2": sp.Rational(2, 7),
    "k": sp.Rational(7, 5),
    "D": sp.Rational(3, 4),
}
"""The number that stands for each symbol when results are compared."""

assumptions = st.sampled_from([{}, {"real": True}, {"positive": True}])
symbols = st.builds(
    lambda name, given: sp.Symbol(name, **given), st.sampled_from(OURS.split()), assumptions
)


def results(m1, m2, k, D):
    """Names and values of the public results of the symbols."""
    cell = Dimer(m1, m2, spacing=D)
    theory = homogenize(cell, 4, k=k)
    yield from theory.ansatz.items()
    for found in (theory.pde.coefficients[3], theory.defect.get(3, {})):
        yield from found.items()
    wave = theory.pde.traveling_wave()
    yield from (("beta", wave.beta), ("B", wave.amplitude(2)), ("root", wave.roots[1]))
    for name in ("mu", "sigma", "s"):
        yield name, getattr(wave.reduction(1, V=3), name)
    yield "own speed", wave.speed().subs(sp.Symbol("B", positive=True), 2)
    yield "own amplitude", wave.amplitude().subs(sp.Symbol("V_s", positive=True), 2)
    yield "profile", wave.profile(sp.Rational(1, 5), 2)
    yield "scale", wave.time_scale
    physical = wave.at_force(3)
    yield from (("dx/dt", physical.speed), ("time", physical.fwhm("force", "time")))
    yield "own force", wave.at_force().speed.subs(sp.Symbol("F", positive=True), 3)
    yield "optical", homogenize(cell, 2, k=k, branch="optical").amplitude_ratio
    full = homogenize(cell, 4, k=k, closure="full", field="center")
    yield "I", full.pde.I
    yield from full.pde.energy[2].items()
    yield from full.slaved[1][3].items()
    yield "at", full.at(**{m2.name: 3}).pde.I.subs(m1, 1)
    chain = Dispersion(Cell((m1, m2), (m2, 2 * m2), D), k)
    yield "acoustic", chain.acoustic(4)[4]
    yield "canonical", canonical_wave(Cell((m1, m1, m2), spacing=D), k).fwhm("force")
    numeric = NumericWave(wave)
    yield "numeric", sp.Float(float(numeric.beta(1.4, 0.2)), 17)
    series = expand(Cell((m1, m2)), 1, k=k)
    for row in (series.c2, series.energy, series.fwhm("velocity")):
        yield row.quantity, row.prefactor * row.coefficients[1]


NEUTRAL = {role: sp.Symbol(f"role_{role}", positive=True) for role in ROLES}


def numbers(given):
    """The results with a number for each symbol, 30 digits."""
    values = {given[role]: number for role, number in ROLES.items()}
    return ((name, sp.N(sp.sympify(x).xreplace(values), 30)) for name, x in results(**given))


@cache
def expected_numbers():
    return list(numbers(NEUTRAL))


@settings(max_examples=1)
@given(st.fixed_dictionaries(dict.fromkeys(ROLES, symbols)))
@example(dict(zip(ROLES, sp.symbols("p lambda kappa I"), strict=True)))
def test_results_do_not_depend_on_names(given):
    assume(len({symbol.name for symbol in given.values()}) == len(given))
    for (name, expected), (same, number) in zip(expected_numbers(), numbers(given), strict=True):
        assert name == same
        # 30 digits, less those that the alternating coefficients lose; doubles to 4 ulps
        tolerance = 4 * np.finfo(float).eps if name == "numeric" else 1e-25
        assert abs(number - expected) <= tolerance * max(1, abs(expected)), name


def law_results(a, b):
    """What a law with the parameters a and b gives, with the wave's B = 2 put in last."""
    law = named("hertz2", a, b)
    cell = Dimer(1, 3)
    theory = homogenize(cell, law=law, closure="full", field="center")
    yield at_compression(law, theory.pde.G, 3).subs(theory.cell.spacing, 1)
    yield law.phi(3).subs(DELTA, 3)
    field = loaded_wave(cell, background="1/2", law=law).field
    for value in (field.speed(field.rise), field.kdv.speed(), field.kdv.width()):
        rise = [s for s in value.free_symbols if s.name == "B"]
        yield value.subs(dict.fromkeys(rise, 2)).subs(sp.Symbol("D", positive=True), 1)


@settings(max_examples=1)
@given(a=symbols, b=symbols)
@example(a=sp.Symbol("tau"), b=sp.Symbol("x"))
def test_results_do_not_depend_on_the_names_of_a_laws_parameters(a, b):
    assume(a.name != b.name)
    values = (x.subs({a: 2, b: sp.Rational(1, 3)}) for x in law_results(a, b))
    for x, expected in zip(values, law_results(2, "1/3"), strict=True):
        assert abs(sp.N(x, 30) / sp.N(expected, 30) - 1) < 1e-25


def test_two_symbols_of_one_name_are_refused_where_a_name_is_looked_up():
    cell = Cell([sp.Symbol("a"), sp.Symbol("a", positive=True)])
    with pytest.raises(InputError, match="'a' names two symbols"):
        cell.at(a=1)
    a, d = sp.symbols("a d", positive=True)
    with pytest.raises(InputError, match="'d': the name means the compression"):
        loaded_wave(Cell([1]), background=1, law=Law(a * d + d**2, d)).at(a="d")
