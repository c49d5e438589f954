"""Random arguments of lwa's public interface: an answer or an `lwa.InputError`, never a NaN."""

import inspect
import random
import warnings

import numpy as np
import pytest
import sympy as sp

from lwa import NoSolitaryWave
from lwa.base import InputError
from tests.test_security import VALUES, calls

ODD = (
    None, "", "m", "3/2", "strain", "time", "full", b"x", True, 0, -1, 1, 2, 3, 7, 0.5, -0.25, 1e-5,
    1e300, float("nan"), float("inf"), sp.Symbol("x"), sp.sqrt(2), sp.I, sp.oo, [], [1, 2],
    [[1], [2]], {"a": 1}, np.array([1.0, 2.0]), object(),
)  # fmt: skip
# Methods by which the package's own classes speak to each other, and constructors whose objects a
# function returns: no user calls them.
OWN = {
    "CompactWave", "ExpandedWave", "InputError", "LoadedWave", "NoSolitaryWave", "SceneError",
    "TravelingWave", "anew", "check_strain", "compression", "compressions",
    "latex_rows", "of_strain", "phi", "replaced",
}  # fmt: skip


def arguments(name, parameters, draw):
    """Return positional and named arguments, some of them as no user should give them."""
    positional, named = (), {}
    for x in parameters:
        if x.kind is x.VAR_POSITIONAL and name != "named":
            positional = draw.choices(ODD, k=draw.randint(0, 2))
        elif x.kind is x.VAR_KEYWORD:
            named[draw.choice(("m1", "k", "omega", "D"))] = draw.choice(ODD)
        elif x.kind in (x.POSITIONAL_OR_KEYWORD, x.KEYWORD_ONLY):
            if x.default is x.empty:
                named[x.name] = VALUES.get(x.name, 1)
            if draw.random() < 0.35:
                named[x.name] = draw.choice(ODD)
    return positional, named


@pytest.mark.parametrize("number", [200, pytest.param(20_002, marks=pytest.mark.slow)])
def test_random_arguments_are_answered_or_refused(number):
    draw = random.Random(number)
    public = [
        (name, call)
        for name, call in calls()
        if not call.__module__.startswith("validation") and name.split(".")[-1] not in OWN
    ]
    answered = 0
    for name, call in draw.choices(public, k=number):
        positional, named = arguments(name, inspect.signature(call).parameters.values(), draw)
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("error")
                found = call(*positional, **named)
        except (InputError, NoSolitaryWave):
            continue
        except Exception as error:
            pytest.fail(f"{name}(*{positional}, **{named}): {error!r}")
        answered += 1
        if isinstance(found, float | np.ndarray):
            assert not np.isnan(found).any(), (name, positional, named)
    assert number / 4 < answered < 3 * number / 4
