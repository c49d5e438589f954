"""Scenes: checked values, from numbers, from the theory's cell or from beads."""

import dataclasses
import math
from dataclasses import replace

import pytest
import sympy as sp
from hypothesis import given, strategies as st

from lwa import Cell, Dimer
from lwa.law import Law, named
from validation.scenes.chains import STEEL_BEAD
from validation.scenes.forcing import Damping, Drive
from validation.scenes.scene import Scene, SceneError

GOOD = dict(masses=(1, 2, 3), stiffnesses=(1, 1), k=1.5, duration=1.0)

X = sp.Symbol("x", positive=True)
TODA = named("exponential", 1)
RISING = {"time": (0, 0.1, 0.2, 0.3), "displacement": (0,) * 4}
# A row for each kind of fault
REFUSED = [
    ({"masses": ()}, "masses is empty"),
    ({"masses": (1, 1, math.nan)}, r"masses\[2\] is nan"),
    ({"stiffnesses": (1,)}, "1 stiffnesses for 3 beads: 2 are wanted"),
    ({"velocities": (1, 1, 1, 1)}, "4 velocities for 3 beads"),
    ({"spacings": (1e308, 1e308)}, "the chain's length comes out as inf"),
    ({"precompression": 1}, "precompression is 1"),
    ({"gravity": -1, "wall": 1}, "gravity is -1"),
    ({"contact_sensors": (0, 0)}, "contact_sensors have one"),
    ({"bead_sensors": (3,)}, r"bead_sensors\[0\] is 3"),
    ({"k": 0.5}, "k is 0.5"),
    ({"k": math.nan}, "k is missing"),
    ({"k": (1.5, 2, 3)}, "k has 3 entries: .* each of the 2"),
    ({"law": TODA}, "k is 1.5 and law"),
    ({"k": math.nan, "law": Law(sp.Piecewise((X, X < 1)), X)}, "law is 'Piecewise"),
    ({"k": math.nan, "law": Law(sp.Max(X, X**2), X)}, r"law is 'Max\("),
    ({"damping": Damping("restitution", 0.9), "k": math.nan, "law": TODA}, "damping"),
    ({"damping": Damping("contact", (1, 2, 3))}, "damping contact has 3 entries"),
    ({"drive": Drive(velocity=1), "velocities": (1,)}, "drive moves bead 1"),
    ({"drive": Drive(**RISING)}, "drive.time ends at 0.3: one to 100 times"),
    ({"drive": Drive(**RISING), "duration": 1e-4}, "drive.time ends at 0.3"),
    (
        {"spacings": (1, 2), "displacements": (0, 2.5)},
        r"displacements\[1\] is 2.5, .* behind bead 3, .* 2 from it",
    ),
    (
        {"spacings": (1, 2), "wall": 1, "displacements": (0, 0, 1.1)},
        r"displacements\[2\] is 1.1, .* inside the wall, 1 from it",
    ),
]


@pytest.mark.parametrize(("change", "named"), REFUSED)
def test_a_bad_value_is_refused_by_name(change, named):
    """A start of half the distance in front of the wall, a bead's radius, is none inside it."""
    at_the_wall = {"spacings": (1, 2), "wall": 1, "displacements": (0, 0, 1)}
    assert Scene(**GOOD | at_the_wall).size == 3
    with pytest.raises(SceneError, match=rf"^{named}[^\n]{{,200}}$"):
        Scene(**GOOD | change)


@pytest.mark.parametrize(
    ("kind", "given", "named"),
    [
        (Damping, {"kind": "x", "value": 1}, "damping is 'x'"),
        (Damping, {"kind": "restitution", "value": (1, 2)}, "restitution is 2"),
        (Damping, {"kind": "contact", "value": 0}, "contact is 0"),
        (Drive, {}, "drive has not one motion"),
        (Drive, {"velocity": 1, "amplitude": 1, "frequency": 1}, "drive has not one"),
        (Drive, {"velocity": 1, "ramp": 1}, "drive.ramp is 1"),
        (Drive, {"amplitude": 1, "frequency": 0}, "drive.frequency is 0"),
        (Drive, RISING | {"displacement": (0, 1e308, -1e308, 0)}, "drive.displacement"),
        (Drive, {"time": (0, 1), "displacement": (0, 1)}, "drive has 2 times"),
        (Drive, {"time": (0, 1, 2, 2), "displacement": (0,) * 4}, "drive.time must"),
    ],
)
def test_a_bad_damping_or_drive_is_refused_by_name(kind, given, named):
    with pytest.raises(SceneError, match=f"^{named}"):
        kind(**given)


def test_contacts_that_are_alike_are_the_same_chain_however_they_are_written():
    base = GOOD | {"k": math.nan}
    alike = Scene(**base | {"k": (1.5, "3/2"), "damping": Damping("contact", (2, 2))})
    assert alike == Scene(**GOOD, damping=Damping("contact", 2))
    power, toda = named("power", "3/2"), named("exponential", 1)
    assert Scene(**base | {"law": (power, power)}) == Scene(**GOOD)
    mixed = Scene(**base | {"law": (power, toda)})
    assert (mixed.k, mixed.law) == ((1.5, 1.0), (None, toda))
    assert mixed.contact_laws == ((1.5, None), (1.0, toda))
    assert str(mixed) == "3 beads, 2 contacts, 2 contact laws; duration 1"
    # A wall's contact has the last entry; a contact of another law may be left without damping.
    damped = replace(mixed, wall=1, k=math.nan, law=(power, power, toda))
    assert damped.contact_laws[2] == (1.0, toda)
    replace(damped, damping=Damping("restitution", (0.9, 0.9, 1)))


words = st.text("a1é ", max_size=3)
numbers = st.integers() | st.just(10**400) | st.floats() | st.complex_numbers()
anything = st.none() | st.booleans() | numbers | words
anything |= st.lists(st.floats() | words | st.none(), max_size=4)


@given(st.sampled_from([f.name for f in dataclasses.fields(Scene)]), anything)
def test_any_value_is_stored_or_refused(field, value):
    try:
        scene = Scene(**GOOD | {field: value})
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
    with pytest.raises(SceneError, match="m1"):
        Scene.of_cell(Dimer("m1", 1), 2, 2, duration=1)


def test_beads_that_are_no_spheres_are_refused():
    with pytest.raises(SceneError, match=r"^bead"):
        Scene.of_beads([STEEL_BEAD, "bead"], duration=1)
