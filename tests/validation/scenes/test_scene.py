"""Scenes: checked values, from numbers, from the theory's cell or from beads."""

import dataclasses
import math
from decimal import Decimal

import pytest
import sympy as sp
from hypothesis import given
from hypothesis import strategies as st

from lwa import Cell, Dimer, InputError
from lwa.law import Law, general, named
from lwa.spheres.hertz import stiffness
from validation.scenes.chains import PTFE_BEAD, STEEL, STEEL_BEAD
from validation.scenes.forcing import Damping, Drive
from validation.scenes.scene import Scene, SceneError

GOOD = dict(masses=(1, 2, 3), stiffnesses=(1, 1), k=1.5, duration=1.0)

NAN, X = math.nan, sp.Symbol("x", positive=True)
OPEN = Law(sp.Piecewise((X, X < 1)), X)
PAIRED = {"k": math.nan}  # a scene without k, for a law
REFUSED = [
    (dict(masses=()), "masses is empty"),
    (dict(masses=(1, 1, NAN)), r"masses\[2\] is nan"),
    (dict(masses=(1, 1e-320, 1)), r"masses\[1\] is 1e-320"),
    (dict(masses=5), "masses is 5"),
    (dict(stiffnesses=(1,)), "1 stiffnesses for 3 beads"),
    (dict(stiffnesses=(1, -1)), r"stiffnesses\[1\] is -1"),
    (dict(k=0.5), "k is 0.5"),
    (dict(k=sp.Symbol("k")), "k is k"),
    (dict(k=Decimal("sNaN")), r"k is Decimal\('sNaN'\)"),
    (dict(gravity=9.81), "gravity is 9.81"),
    (dict(precompression=1), "precompression is 1"),
    (dict(precompression=-1, wall=1), "precompression is -1"),
    (dict(velocities=(1, 1, 1, 1)), "4 velocities for 3 beads"),
    (dict(displacements=(None,)), r"displacements\[0\] is None"),
    (dict(contact_sensors=(2,)), r"contact_sensors\[0\] is 2"),
    (dict(contact_sensors=(0, 0)), r"contact_sensors is \(0, 0\)"),
    (dict(bead_sensors=(1.0,)), r"bead_sensors\[0\] is 1.0"),
    (
        dict(masses=(1,), stiffnesses=(), contact_sensors=(0,)),
        r"contact_sensors is \(0,\)",
    ),
    (dict(spacings=(1,)), "1 spacings for 3 beads"),
    (dict(spacings=(1, 0)), r"spacings\[1\] is 0"),
    (dict(spacings=(1e308, 1e308)), "the chain's length comes out as inf"),
    (dict(samples=1), "samples is 1"),
    (PAIRED, "k is missing"),
    (dict(law=named("exponential", 1)), "k is 1.5 and law"),
    (PAIRED | {"law": "hertz2"}, "law is 'hertz2'"),
    (PAIRED | {"law": named("hertz2")}, "law is "),
    (PAIRED | {"law": general()}, "law is "),
    (PAIRED | {"law": OPEN}, "law is 'Piecewise"),
    (PAIRED | {"law": Law(sp.Max(X, X**2), X)}, r"law is 'Max\("),
    (dict(damping=0.1), "damping is 0.1"),
    (
        dict(
            damping=Damping("restitution", 0.9), k=math.nan, law=named("exponential", 1)
        ),
        "damping",
    ),
    (dict(drive=Drive(velocity=1), velocities=(1,)), "drive moves bead 1"),
    (
        dict(drive=Drive(time=(0, 0.1, 0.2, 0.3), displacement=(0,) * 4)),
        "drive.time ends at 0.3: ",
    ),
    (
        dict(drive=Drive(time=(0, 1, 2, 100), displacement=(0,) * 4)),
        "drive.time ends at 100: one",
    ),
]


@pytest.mark.parametrize(("change", "named"), REFUSED)
def test_a_bad_value_is_refused_by_name(change, named):
    assert issubclass(SceneError, InputError)
    with pytest.raises(SceneError, match=rf"^{named}[^\n]{{,130}}$"):
        Scene(**{**GOOD, **change})


@pytest.mark.parametrize(
    ("kind", "given", "named"),
    [
        (Damping, ("x", 1), "damping is 'x'"),
        (Damping, ("restitution", 2), "restitution is 2"),
        (Damping, ("contact", -1), "contact is -1"),
        (Drive, {}, "drive has not one motion"),
        (
            Drive,
            {"velocity": 1, "amplitude": 1, "frequency": 1},
            "drive has not one motion",
        ),
        (Drive, {"amplitude": 1, "frequency": 0}, "drive.frequency is 0"),
        (
            Drive,
            {"amplitude": 1e300, "frequency": 1e10},
            "the drive's acceleration comes out as",
        ),
        (Drive, {"amplitude": 1, "frequency": 1, "ramp": 1e-200}, "the drive's accel"),
        (Drive, {"velocity": 1, "ramp": "x"}, "drive.ramp is 'x'"),
        (Drive, {"time": (0, 1), "displacement": (0, 1)}, "drive has 2 times"),
        (Drive, {"time": (0, 1, 2, 2), "displacement": (0,) * 4}, "drive.time must"),
        (
            Drive,
            {"time": range(4), "displacement": (0, 1e308, -1e308, 0)},
            "the drive's accel",
        ),
    ],
)
def test_a_bad_damping_or_drive_is_refused_by_name(kind, given, named):
    with pytest.raises(SceneError, match=f"^{named}"):
        kind(**given) if isinstance(given, dict) else kind(*given)


words = st.text("a1é ", max_size=3)
numbers = st.integers() | st.just(10**400) | st.floats() | st.complex_numbers()
anything = st.none() | st.booleans() | numbers | words
anything |= st.lists(st.floats() | words | st.none(), max_size=4)


@given(st.sampled_from([f.name for f in dataclasses.fields(Scene)]), anything)
def test_any_value_is_stored_or_refused(field, value):
    try:
        scene = Scene(**{**GOOD, field: value})
    except SceneError:
        return
    found = getattr(scene, field)
    value = float(value) if field == "k" else value  # "3" is a number there
    assert found == (tuple(value) if isinstance(value, list) else value)


def test_of_cell_repeats_the_theorys_cell():
    scene = Scene.of_cell(
        Cell((1, "1/2", 3), stiffnesses=(4, 5, 6)), 2, "5/4", duration=1
    )
    assert scene.masses == (1, 0.5, 3, 1, 0.5, 3)
    assert scene.stiffnesses == (4, 5, 6, 4, 5)
    assert scene.k == 1.25
    assert Scene(**GOOD | {"k": "3/2"}).k == 1.5
    for bad, k, words in (
        (Dimer("m1", 1), 2, "m1"),
        (Dimer(1, 1), "k", "k is k"),
        (Dimer(1, 1), -1, "k is -1"),
    ):
        with pytest.raises(SceneError, match=words):
            Scene.of_cell(bad, 2, k, duration=1)


def test_of_beads():
    scene = Scene.of_beads([STEEL_BEAD, PTFE_BEAD, PTFE_BEAD], wall=STEEL, duration=1)
    assert (scene.masses, scene.k) == ((0.45e-3, 0.123e-3, 0.123e-3), 1.5)
    pairs = (STEEL_BEAD, PTFE_BEAD), (PTFE_BEAD, PTFE_BEAD), (PTFE_BEAD, STEEL)
    assert (*scene.stiffnesses, scene.wall) == tuple(
        float(stiffness(*pair)) for pair in pairs
    )
    for bad in ([], [STEEL_BEAD, "bead"], STEEL_BEAD):
        with pytest.raises(SceneError, match=r"^bead"):
            Scene.of_beads(bad, duration=1)
