"""Text is never evaluated: it reaches every public function and method of both packages."""

import inspect
import os
from contextlib import suppress
from types import FunctionType

import pytest
import sympy as sp

import lwa
import validation
from lwa import (
    Cell,
    Dimer,
    Dispersion,
    Link,
    Material,
    Power,
    Sphere,
    envelope,
    expand,
    homogenize,
    shock,
)
from lwa.law import general, named

TEXT = "__import__('os').system('true')"
STEEL = Sphere(1, 1, Material(1, "0.3", 1))
HERTZ = Power("3/2")

# Values that callers give to a parameter of this name, so that the others are reached too.
VALUES = {
    "cell": Dimer(1, 2), "k": "3/2", "law": HERTZ, "masses": (1, 2), "m1": 1, "m2": 2,
    "order": 4, "n": 2, "delta": 1, "p": 1, "D": 1, "V": 1, "B": 1, "p0": 1, "x": 1, "xi": 0,
    "force": 3, "rise": 1, "quantity": "force", "extent": "time", "name": "k", "low": 0,
    "spheres": [STEEL, STEEL], "sphere": STEEL, "other": STEEL, "material": STEEL.material,
    "radius": 1, "F": sp.Symbol("delta", positive=True) ** 2, "background": 1, "behind": 2,
    "ahead": 1, "kappa": 1, "q": 1, "value": 1, "exponent": 2, "base": 2, "digits": 10,
}  # fmt: skip


def samples():
    """An object of each class whose methods take values."""
    theory = homogenize(Dimer("m1", "m2"))
    wave = theory.pde.traveling_wave()
    numbers = homogenize(Dimer(1, 2), k="3/2").pde.traveling_wave()
    link = Link(0, 1, HERTZ)
    yield from (Cell(["m1", "m2"]), HERTZ, general(), named("hertz2"), named("polynomial"))
    yield from (theory, theory.pde, theory.closure, wave, numbers, numbers.at_force(1))
    yield from (Dispersion(Dimer("m1", "m2")), expand(Cell([1]), 3, k="3/2"), link)
    yield from (STEEL, STEEL.material, shock(Cell([1]), law=HERTZ, behind=2, ahead=1))
    yield from (envelope(Cell([1]), law=HERTZ, background=1, wavenumber=1),)


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
            if not name.startswith("_") and isinstance(found, FunctionType | classmethod):
                yield f"{type(sample).__name__}.{name}", getattr(sample, name)


def attempts(call):
    """Arguments with the text in one place; the others as callers give them."""
    try:
        parameters = inspect.signature(call).parameters.values()
    except ValueError:
        return
    named_ones = [x for x in parameters if x.kind in (x.POSITIONAL_OR_KEYWORD, x.KEYWORD_ONLY)]
    needed = {x.name: VALUES.get(x.name, TEXT) for x in named_ones if x.default is x.empty}
    for parameter in named_ones:
        yield (), needed | {parameter.name: TEXT}
        yield (), needed | {parameter.name: (TEXT,)}
    if any(x.kind is x.VAR_POSITIONAL for x in parameters):
        yield (TEXT,), {}
    if any(x.kind is x.VAR_KEYWORD for x in parameters):
        for name in ("m1", "k", "omega", "D"):
            yield (), {name: TEXT}


@pytest.mark.filterwarnings("ignore")
def test_no_text_is_evaluated(monkeypatch):
    executed, guilty, reached = [], set(), 0
    monkeypatch.setattr(os, "system", executed.append)
    for name, call in calls():
        for positional, keywords in attempts(call):
            with suppress(Exception):  # any refusal will do here
                call(*positional, **keywords)
            reached += 1
            if executed:
                guilty.add(name)
                executed.clear()
    assert guilty == set()
    assert reached > 300
