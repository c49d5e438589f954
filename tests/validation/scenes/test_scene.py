"""Scenes: checked values, from numbers, from the theory's cell or from beads."""

import dataclasses

import pytest
import sympy as sp
from hypothesis import given
from hypothesis import strategies as st

from lwa import Cell, Dimer, InputError
from lwa.spheres.hertz import stiffness
from validation.scenes.chains import PTFE_BEAD, STEEL, STEEL_BEAD
from validation.scenes.scene import Scene, SceneError

GOOD = dict(masses=(1, 2, 3), stiffnesses=(1, 1), k=1.5, duration=1.0)


def test_a_scene_is_a_value():
    scene = Scene(**GOOD)
    assert scene == Scene(**GOOD)
    assert hash(scene) == hash(Scene(**GOOD))
    with pytest.raises(dataclasses.FrozenInstanceError):
        scene.k = 2.0


def test_a_scene_has_no_wall_weight_or_sensor_by_default():
    scene = Scene(**GOOD)
    assert (scene.size, scene.contact_count) == (3, 2)
    assert scene.wall is None
    assert scene.gravity == 0
    assert scene.contact_sensors == scene.bead_sensors == scene.velocities == ()
    assert Scene(**GOOD, wall=2).contact_count == 3


BAD = [
    (dict(masses=()), "masses is empty"),
    (dict(masses=(1, 1, float("nan"))), r"masses\[2\] is nan: a finite number is wanted"),
    (dict(masses=5), "masses is 5: a sequence is wanted"),
    (dict(stiffnesses=(1,)), "1 stiffnesses for 3 beads: 2 are wanted"),
    (dict(stiffnesses=(1, -1)), r"stiffnesses\[1\] is -1: it must be positive"),
    (dict(k=0.5), "k is 0.5: the contact law .* k ≥ 1"),
    (dict(k=sp.Symbol("k")), "k is k: the lattice needs numbers"),
    (dict(gravity=9.81), "gravity is 9.81: .* needs a wall"),
    (dict(velocities=(1, 1, 1, 1)), "4 velocities for 3 beads"),
    (dict(displacements=(None,)), r"displacements\[0\] is None: a number is wanted"),
    (dict(contact_sensors=(2,)), r"contact_sensors\[0\] is 2: an integer from 0 to 1 is wanted"),
    (dict(contact_sensors=(0, 0)), "contact_sensors is .*: each may be named once"),
    (dict(bead_sensors=(1.0,)), r"bead_sensors\[0\] is 1.0: an integer from 0 to 2 is wanted"),
    (
        dict(masses=(1,), stiffnesses=(), contact_sensors=(0,)),
        r"contact_sensors is \(0,\): this chain has none",
    ),
    (dict(masses=(1, 1e-320, 1)), r"masses\[1\] is 1e-320: floats below 2e-308 lose their digits"),
    (dict(spacings=(1e308, 1e308)), "the chain's length comes out as inf: choose other units"),
    (dict(samples=1), "samples is 1: an integer from 2 on is wanted"),
]


@pytest.mark.parametrize(("change", "message"), BAD, ids=[str(b[0])[:40] for b in BAD])
def test_bad_input_is_named_in_one_line(change, message):
    with pytest.raises(SceneError, match=rf"^{message}") as caught:
        Scene(**{**GOOD, **change})
    assert isinstance(caught.value, InputError)
    assert "\n" not in str(caught.value)
    assert len(str(caught.value)) < 160


words = st.text("a1é ", max_size=3)
anything = st.one_of(
    st.none(), st.booleans(), st.integers(), st.floats(), words, st.complex_numbers(),
    st.lists(st.one_of(st.floats(), words, st.none()), max_size=4),
)  # fmt: skip


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
    scene = Scene.of_cell(Cell((1, "1/2", 3), stiffnesses=(4, 5, 6)), 2, "5/4", duration=1)
    assert scene.masses == (1, 0.5, 3, 1, 0.5, 3)
    assert scene.stiffnesses == (4, 5, 6, 4, 5)
    assert scene.k == 1.25
    assert Scene(**GOOD | {"k": "3/2"}).k == 1.5


@pytest.mark.parametrize(
    ("cell", "repeats", "k", "message"),
    [
        (None, 3, "3/2", "cell is None: a Cell of lwa is wanted"),
        (Dimer("m1", 1), 2, 1.5, "mass is m1: the lattice needs numbers"),
        (Dimer(1, 1, stiffnesses=("A1", 1)), 2, 1.5, "stiffness is A1"),
        (Dimer(1, 1), 0, 1.5, "repeats is 0: an integer from 1 on is wanted"),
        (Dimer(1, 1), 2, "k", "k is k: the lattice needs numbers"),
        (Dimer(1, 1), 2, -1, "k is -1"),
    ],
)
def test_of_cell_needs_numbers(cell, repeats, k, message):
    with pytest.raises(SceneError, match=rf"^{message}"):
        Scene.of_cell(cell, repeats, k, duration=1)


def test_of_beads():
    scene = Scene.of_beads([STEEL_BEAD, PTFE_BEAD, PTFE_BEAD], wall=STEEL, duration=1)
    assert scene.masses == (0.45e-3, 0.123e-3, 0.123e-3)
    assert scene.stiffnesses == (
        float(stiffness(STEEL_BEAD, PTFE_BEAD)),
        float(stiffness(PTFE_BEAD, PTFE_BEAD)),
    )
    assert scene.wall == float(stiffness(PTFE_BEAD, STEEL))
    assert scene.k == 1.5
    for bad in ([], [STEEL_BEAD, "bead"], STEEL_BEAD):
        with pytest.raises(SceneError, match=r"^bead"):
            Scene.of_beads(bad, duration=1)
