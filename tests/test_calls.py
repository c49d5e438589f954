"""Odd arguments of public functions and methods are answered or refused, and never evaluated."""

import inspect
import os
import random
import warnings
from types import FunctionType

import numpy as np
import pytest
import sympy as sp

import lwa
import validation
from lwa import (
    Cell,
    Dimer,
    Link,
    Material,
    Power,
    Sphere,
    homogenize,
)
from lwa.base import LONGEST_MESSAGE
from lwa.law import named
from tests.lwa.test_values import MADE

TEXT = "__import__('os').system('true')"
STEEL = Sphere(1, 1, Material(1, "0.3", 1))
HERTZ = Power("3/2")
ODD = (
    None, "", "m", "3/2", "strain", "time", "full", b"x", True, 0, -1, 1, 2, 3, 7, 0.5, -0.25, 1e-5,
    1e300, float("nan"), float("inf"), sp.Symbol("x"), sp.sqrt(2), sp.I, sp.oo, [], [1, 2],
    [[1], [2]], {"a": 1}, np.array([1.0, 2.0]), np.array(3.0), object(),
    np.ma.array([1.0, 2.0], mask=[True, False]), np.ma.masked,
)  # fmt: skip
# Methods by which the package's own classes speak to each other, and constructors whose objects a
# function returns: no user calls them, and they may fail in any way.
OWN = {
    "CompactWave", "LatticeWave", "InputError", "LoadedWave", "NoSolitaryWave", "SceneError",
    "MeasureError", "IntegrationError", "check_strain", "compression", "Expansion", "latex_rows",
    "of_strain", "phi", "replaced", "ExactWave", "Pulse", "Run",
    "plot", "simulate_many",  # these two take objects of others
}  # fmt: skip

# Values that callers give to a parameter of this name, so that the others are reached too.
VALUES = {
    "cell": Dimer(1, 2), "k": "3/2", "law": HERTZ, "masses": (1, 2), "m1": 1, "m2": 2,
    "order": 4, "n": 2, "delta": 1, "p": 1, "D": 1, "x": 1, "xi": 0, "force": 3, "rise": 1,
    "quantity": "force", "name": "hertz2", "spheres": [STEEL, STEEL], "sphere": STEEL,
    "other": STEEL, "material": STEEL.material, "radius": 1, "behind": 2, "ahead": 1, "value": 1,
    "F": sp.Symbol("delta", positive=True) ** 2, "E": 1, "nu": 0, "mass": 1, "i": 0, "j": 1,
    "links": [Link(0, 1, HERTZ)], "bead": 0, "stiffness": 1, "direction": "across",
    "chain": Cell([1], spacing=1),
}  # fmt: skip


# Further arguments that a call needs before it reads the others.
FURTHER = {
    "envelope": {"background": 1},
    "pulse_of_strike": {"velocity": 1},
    "Shock.estimate": {"name": "leading_speed"},
}

# Classes of values that a user gives; other classes are those of results.
GIVEN = {"Cell", "Lattice", "Link", "Resonator", "Material", "Sphere", "Dispersion"}

# What no parameter of these names takes, whatever function has the parameter.
WRONG = {
    "E radius density mass m1 m2 spacing factor cosine diameter stiffness rtol": (0, -1),
    "order N": (0, 1.5),
    "quantity extent closure branch field rule language direction missing method kind": (
        "wall", b"x",
    ),
    "t x delta": ("now", np.nan), "wavenumber": (np.nan,), "cell": ([1, 2], 1), "law": ([1],),
    "material": ("steel",), "masses": ("m1,m2", [1, 0], []),
}  # fmt: skip


SYMBOLIC = "linear pde closure wave dispersion law power cell shock"


def samples():
    """An object of each class whose methods take values: with symbols, and in numbers."""
    yield from (MADE[name]() for name in SYMBOLIC.split())
    dimer = homogenize(Dimer(1, 2, spacing=1), k="3/2").pde.traveling_wave()
    yield from (dimer, dimer.at_force(1), lwa.expand(Cell([1]), 3, k="3/2"), HERTZ)
    yield from (named("hertz2"), named("polynomial"))
    yield from (STEEL, STEEL.material, Link(0, 1, HERTZ))
    yield lwa.envelope(Cell([1]), law=HERTZ, background=1, wavenumber=1)
    yield validation.exact_wave([1], 1.5)


def calls():
    """Every public function, class and method that takes an argument, as (name, callable)."""
    for package in (lwa, validation, lwa.law, lwa.hertz):
        for name in getattr(package, "__all__", ("named", "read_law", "stiffness")):
            found = getattr(package, name, None)
            if isinstance(found, FunctionType | type):
                yield name, found
    for sample in samples():
        for name in dir(type(sample)):
            found = inspect.getattr_static(type(sample), name)
            method = isinstance(found, FunctionType | classmethod)
            if method and not name.startswith("_"):
                yield f"{type(sample).__name__}.{name}", getattr(sample, name)


def parameters(call):
    """Names of the parameters of a call, values of those that it needs, and the kinds."""
    try:
        every = inspect.signature(call).parameters.values()
    except ValueError:
        return [], {}, set()
    single = [x for x in every if x.kind in (x.POSITIONAL_OR_KEYWORD, x.KEYWORD_ONLY)]
    needed = {x.name: VALUES.get(x.name, TEXT) for x in single if x.default is x.empty}
    return [x.name for x in single], needed, {x.kind for x in every}


def attempts(call, draw, odds):
    """Yield arguments with the text, or one of so many odd values, in one place."""
    names, needed, kinds = parameters(call)
    if inspect.Parameter.VAR_KEYWORD in kinds:
        names = [*names, "m1", "k", "omega", "D"]
    for name in names:
        for value in (TEXT, (TEXT,), *draw.sample(ODD, odds)):
            yield (), needed | {name: value}
    if inspect.Parameter.VAR_POSITIONAL in kinds:
        for value in (TEXT, *draw.sample(ODD, odds)):
            yield (*needed.values(), value), {}


@pytest.mark.parametrize("odds", [1, pytest.param(len(ODD), marks=pytest.mark.slow)])
def test_arguments_are_answered_or_refused_and_never_evaluated(monkeypatch, odds):
    executed, answered, longest, draw = [], 0, 0, random.Random(odds)
    monkeypatch.setattr(os, "system", executed.append)
    for name, call in calls():
        own = name.split(".")[-1] in OWN
        for positional, keywords in attempts(call, draw, odds):
            try:
                with warnings.catch_warnings():
                    warnings.simplefilter("ignore" if own else "error")
                    found = call(*positional, **keywords)
            except (lwa.InputError, lwa.NoSolitaryWave) as refusal:
                longest = max(longest, len(str(refusal)))
                continue
            except Exception as error:
                if not own:
                    pytest.fail(f"{name}(*{positional}, **{keywords}): {error!r}")
                continue
            answered += 1
            if isinstance(found, float | np.ndarray):
                assert not np.isnan(found).any(), (name, positional, keywords)
        assert not executed, name
    assert answered > 100
    assert longest <= LONGEST_MESSAGE


def test_every_reader_refuses_wrong_values_by_name():
    """0 for a mass, a word that is none: whatever the function, the message names the parameter."""
    wrong = {name: WRONG[names] for names in WRONG for name in names.split()}
    tried = named = 0
    for name, call in calls():
        names, needed, _ = parameters(call)
        if name.split(".")[-1] in OWN or (isinstance(call, type) and name not in GIVEN):
            continue
        for parameter in wrong.keys() & {*names}:
            for value in wrong[parameter]:
                arguments = needed | FURTHER.get(name, {}) | {parameter: value}
                with pytest.raises((lwa.InputError, lwa.NoSolitaryWave)) as refusal:
                    print(name, parameter, value, call(**arguments))
                named += parameter in str(refusal.value)
                tried += 1
    assert named > 100
    assert tried - named < 20  # a mass is called by its number
