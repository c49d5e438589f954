"""Files of scenes: meaning of each key, bad files."""

import copy
import dataclasses
import io
import json
import math
import re
import tomllib
from contextlib import suppress

import pytest
from hypothesis import given, strategies as st

from lwa.base import files
from lwa.law import named
from lwa.spheres.beads import CHAIN, FILE, STRIKER
from lwa.spheres.hertz import Material, Sphere, stiffness
from tests.validation.scenes.test_scene import anything
from validation.lattice.simulate import simulate
from validation.scenes.chains import STEEL
from validation.scenes.forcing import Damping, Drive
from validation.scenes.scene import Scene, SceneError
from validation.scenes.scenefile import packaged, read_scene, scene
from validation.studies.paper import recorded_chain
from validation.studies.run import example

PAPER = example("paper")
CONTENT = tomllib.loads(PAPER)

# All other keys: a trimer in units of its own, pressed together, with a defect and a soft contact.
TRIMER = """
duration = 20
precompression = 0.5
chain = {cell = [1, 1, 0.25], repeat = 3, k = 1.25, stiffnesses = [1, 2, 3], spacings = 1}
defects = [{bead = 5, mass = 7}, {contact = 1, stiffness = 0.5}]
wall = {stiffness = 4}
start = {velocities = [1, 1], displacements = [0.1]}
sensors = {beads = [9, 1]}
"""


def test_the_experiment_of_the_paper():
    own = {"duration": 1.2e-3, "contact_sensors": (), "samples": 1001}
    assert scene(CONTENT) == dataclasses.replace(recorded_chain((15, 34)), **own)


def test_every_other_key():
    assert scene(tomllib.loads(TRIMER)) == Scene(
        masses=(1, 1, 0.25, 1, 7, 0.25, 1, 1, 0.25),
        stiffnesses=(0.5, 2, 3, 1, 2, 3, 1, 2),
        k=1.25,
        duration=20,
        precompression=0.5,
        wall=4,
        spacings=(1,) * 8,
        velocities=(1, 1),
        displacements=(0.1,),
        bead_sensors=(8, 0),
    )


def test_the_list_of_keys_reads_as_a_scene():
    """Once the keys that exclude each other are taken out."""
    text = packaged("keys.toml")
    assert text.isascii()
    content = tomllib.loads(text)
    # The keys that `lwa` knows are these, too.
    assert set(content) == set(FILE)
    assert set(content["chain"]) == set(CHAIN)
    assert set(content["striker"]) == set(STRIKER)
    start = content.pop("start")  # what excludes each other
    del content["damping"], content["drive"]
    assert content["chain"].pop("law") == "hertz2:1,2"
    balls = {key: content["chain"].pop(key) for key in ("k", "stiffnesses", "spacings")}
    del content["striker"]["drop"], content["striker"]["mass"]
    del content["wall"]["stiffness"]
    assert scene(content).size == 38
    del content["striker"]
    content |= {"start": start, "chain": {"cell": [1.0, 2.0], "repeat": 19} | balls}
    content |= {"wall": {"stiffness": 1.0}, "defects": [{"bead": 10, "mass": 2.0}]}
    assert scene(content).spacings == (1.0,) * 37


BIG = """
[materials.glass]
E = 72e9
nu = 0.17
[beads.big]
mass = 1e-3
radius = 5e-3
material = "glass"
[[defects]]
bead = 4
like = "big"
"""


def test_a_defect_may_be_another_bead_of_the_file():
    """The contacts beside it are those of its radius and its material."""
    plain = scene(CONTENT)
    steel = Sphere(mass=0.45e-3, radius=2.38e-3, material=STEEL)
    big = Sphere(mass=1e-3, radius=5e-3, material=Material(72e9, 0.17))
    beside = (float(stiffness(steel, big)),) * 2
    assert scene(tomllib.loads(PAPER + BIG)) == dataclasses.replace(
        plain,
        masses=(*plain.masses[:3], 1e-3, *plain.masses[4:]),
        stiffnesses=(*plain.stiffnesses[:2], *beside, *plain.stiffnesses[4:]),
        spacings=(*plain.spacings[:2], 7.38e-3, 7.38e-3, *plain.spacings[4:]),
    )


@pytest.mark.parametrize(
    ("cell", "k", "repeat"),
    [([1], 1.2, 12), ([2, 2, 1], 1.5, 12), ([1, 3], 4.0, 12), ([1], 1.5, 2)],
)
def test_without_a_duration_the_pulse_of_a_striker_leaves_the_last_contact(
    cell, k, repeat
):
    chain = {"cell": cell, "k": k, "repeat": repeat, "stiffnesses": 5}
    content = {"chain": chain, "striker": {"velocity": 0.1}}
    for wall in ({}, WALL):
        last = len(cell) * repeat - 1 + len(wall)
        run = simulate(scene(content | wall | {"sensors": {"contacts": [last]}}))
        (force,) = run.contact_force
        # The peak has passed, and the run is no longer than four times that.
        arrival = run.time[force.argmax()]
        assert arrival < 0.95 * run.time[-1] < 4 * arrival, wall
        assert wall or force[-1] == 0


# --- what is refused ------------------------------------------------------------------------

GOOD = {
    "duration": 1.0,
    "samples": 11,
    "materials": {"steel": {"E": 1e11, "nu": 0.3}},
    "beads": {"ball": {"mass": 1e-3, "radius": 1e-3, "material": "steel"}},
    "chain": {"cell": [1, 2, 3], "k": 1.5},
    "sensors": {"beads": [2], "contacts": [1]},
}
BALLS, WALL = {"chain": {"cell": ["ball", "ball"]}}, {"wall": {"stiffness": 1}}
MOTION = {"time": [0.0, 0.3, 0.6, 1.0], "displacement": [0.0, 1.0, 0.0, 0.0]}
SI = {"units": "SI"}
ALL = {"sensors": {"beads": "all", "contacts": "all"}}

# A row for each kind of fault
REFUSED = [
    ({"durations": 1}, "durations is unknown: did you mean duration"),
    ({"__import__('os')": 1}, r"\"__import__\('os'\)\" is unknown"),
    (
        {"chain": {"cell": [1], "repeat": 10**6 + 1}},
        "chain.cell and repeat make 1000001",
    ),
    ({"chain": {"cell": [1, 2, 3], "k": [1] * 4}}, "chain.k holds 4: 3, .* or 2, one"),
    ({"defects": [{"bead": 1}]}, "defects number 1 has neither like nor mass"),
    ({"defects": [{"bead": 1, "like": "ball"}]}, "defects number 1.like names a bead"),
    ({"defects": [{"contact": 3, "stiffness": 1}]}, "defects number 1.contact is 3"),
    (
        {"defects": [{"bead": 3, "mass": m} for m in (1, 2)]},
        "bead 3 has two tables of defects",
    ),
    ({"wall": {"material": "steel"}}, "wall.material is given"),
    ({"striker": {"velocity": 1}, "start": {}}, "striker and start are both there"),
    ({"striker": {"velocity": -1}}, "striker.velocity is -1"),
    ({"striker": {"like": "ball"}} | BALLS, "striker has neither velocity nor drop"),
    (
        {"striker": {"like": "ball"}, "defects": [{"bead": 1, "mass": 1.0}]},
        "bead 1 has two tables of defects, or",
    ),
    ({"sensors": {"beads": "some"}}, "sensors.beads is 'some'"),
    ({"units": "cgs"}, "units is 'cgs'"),
]


@pytest.mark.parametrize(("change", "named"), REFUSED)
def test_a_bad_scene_is_refused_by_the_key(change, named):
    with pytest.raises(SceneError, match=rf"^{named}[^\n]{{,160}}$"):
        scene(GOOD | change)


DEEP = b"[" * 100_000
FILES = [
    ("s.toml", b"", "chain is missing"),
    (
        "s.toml",
        b"chain = {cell = [1], k = 2}\nstriker = {velocity = 1}",
        "duration is missing",
    ),
    (
        "s.toml",
        b"chain = {cell = [1, 1], k = 2}\ndrive = {amplitude = 1}\nduration = 1",
        r"drive.frequency is missing; try: frequency = 5000.0 # in \[drive\]$",
    ),
    (
        "s.toml",
        b"beads = {b = {mass = '1 g', radius = 1, material = 'PTFE'}}",
        r"beads.b.mass is '1 g': .* try: mass = 0.00045 # in \[beads.b\]$",
    ),
    (
        "s.toml",
        b"striker = {duration = 1}",
        "striker.duration is unknown: .* try: duration = 0.001 # above all tables$",
    ),
    ("s.toml", b"x = " + DEEP, "nested too deeply"),
    ("s.toml", "# Länge\nduration = 1".encode("latin-1"), "not a text in UTF-8"),
    ("s.toml", b"#" * (files.MOST_BYTES[".toml"] + 1), "more than [0-9]+ bytes"),
    ("s.json", b"[1, 2]", r"the file is \[1, 2\]"),
    ("s.json", b'{"duration": 1' + b"0" * 10**6 + b"}", "not JSON"),
]


@pytest.mark.parametrize(("name", "content", "named"), FILES, ids=range(len(FILES)))
def test_a_bad_file_is_refused_by_its_name(tmp_path, name, content, named):
    file = tmp_path / name
    file.write_bytes(content)
    with pytest.raises(SceneError, match=rf"^{re.escape(str(file))}: {named}"):
        read_scene(file)
    with pytest.raises(SceneError, match="1 is no file name"):
        read_scene(1)


words = st.sampled_from(["ball", "steel", "bead", "mass", "stiffness", "material", "x"])
FULL = CONTENT | {
    "defects": [{"bead": 1, "mass": 1.0}],
    "precompression": 1.0,
}


def entries(content):
    """Tables and lists of a file, with the keys and places of their entries."""
    keys = content if isinstance(content, dict) else range(len(content))
    for key in keys:
        yield content, key
        if isinstance(content[key], dict | list):
            yield from entries(content[key])


@given(st.data())
def test_any_file_is_read_or_refused(data):
    content = copy.deepcopy(FULL)
    table, key = data.draw(st.sampled_from([*entries(content)]))
    table[key] = data.draw(anything | words | st.dictionaries(words, anything))
    with suppress(SceneError):
        scene(content)


def four(**keys):
    return {"chain": {"cell": [1, 2], "repeat": 2} | keys}


@pytest.mark.parametrize(
    ("keys", "fields"),
    [
        (ALL, {"bead_sensors": (0, 1, 2), "contact_sensors": (0, 1)}),
        (ALL | WALL, {"contact_sensors": (0, 1, 2)}),
        (four(k=1.5, stiffnesses=3), {"stiffnesses": (3, 3, 3)}),
        (four(k=1.5, stiffnesses=[1, 2]), {"stiffnesses": (1, 2, 1)}),
        (four(k=1.5, stiffnesses=[1, 2, 3]), {"stiffnesses": (1, 2, 3)}),
        (four(law="power:3/2"), {"k": 1.5, "law": None}),
        (four(law="hertz2:1,1/2"), {"law": named("hertz2", 1, "1/2")}),
        ({"drive": {"velocity": 2.0}}, {"drive": Drive(velocity=2)}),
        ({"drive": MOTION}, {"drive": Drive(**MOTION)}),
        # sqrt(2 g h)
        ({"striker": {"drop": 0.05}}, {"velocities": (math.sqrt(2 * 9.81 * 0.05),)}),
        ({"damping": {"contact": 0.9}}, {"damping": Damping("contact", 0.9)}),
        # Values of contacts that differ: as long as the cell, or as the row of contacts with the
        # wall's, the last one
        (
            WALL | four(k=2) | {"damping": {"contact": [0, 2]}},
            {"damping": Damping("contact", (0, 2, 0, 2))},
        ),
        (
            WALL | four(law=["power:3/2", "exponential:1"]),
            {"contact_laws": ((1.5, None), (1.0, named("exponential", 1))) * 2},
        ),
        (WALL | four(k=[1, 2, 3, 4]), {"k": (1, 2, 3, 4)}),
        (four(k=[1.5, 2]), {"k": (1.5, 2, 1.5)}),
        (four(law=["power:3/2"] * 3), {"law": None}),
    ],
)
def test_keys_and_the_fields_that_they_set(keys, fields):
    found = scene(GOOD | keys)
    assert {name: getattr(found, name) for name in fields} == fields


def test_a_drive_is_read_from_a_file_beside_the_scene(folder):
    def drive(table, si=SI, **stated):
        (folder / "shaker.csv").write_text(table)
        content = GOOD | si | {"drive": {"file": "shaker.csv", **stated}}
        (folder / "scene.json").write_text(json.dumps(content))
        return read_scene("scene.json").drive

    plain = "time,displacement\n0,0\n0.5,1\n1,2\n2,0\n"
    in_units = plain.replace("time,displacement", "time (s),displacement (mm)")
    assert drive(plain, {}).displacement == (0, 1, 2, 0)
    assert drive(in_units).displacement == (0, 1e-3, 2e-3, 0)
    with pytest.raises(SceneError, match="it states units"):
        drive(in_units, {})
    columns, units = {"displacement": 1}, {"displacement": "um"}
    found = drive(plain, columns=columns, units=units, step="0.5 s")
    assert found.displacement == pytest.approx((0, 5e-7, 1e-6, 2e-6), rel=1e-15)
    assert found.time == (0, 0.5, 1, 1.5)
    unnamed = in_units.replace("time (s)", "a's: 'b'").replace("displacement", "x")
    with pytest.raises(SceneError, match=r"# in \[drive\]$") as fault:
        drive(unnamed)
    _, lines = str(fault.value).split("; try: ")
    stated = tomllib.loads(lines.replace(" and ", "\n"))
    assert drive(unnamed, **stated).displacement == (0, 1e-3, 2e-3, 0)
    with pytest.raises(SceneError, match=r"^none.csv: No such file"):
        scene(GOOD | {"drive": {"file": "none.csv"}})


@pytest.mark.parametrize("other", [{"like": "ptfe"}, {"mass": 1e-3}])
def test_a_striker_unlike_the_beads_is_a_defect_of_bead_1(other):
    struck = scene(CONTENT | {"striker": CONTENT["striker"] | other})
    assert struck == scene(CONTENT | {"defects": [{"bead": 1, **other}]})
    assert struck.masses[0] != scene(CONTENT).masses[0]


def test_a_scene_is_read_from_standard_input(monkeypatch):
    for text in (PAPER, json.dumps(CONTENT)):
        monkeypatch.setattr("sys.stdin", io.TextIOWrapper(io.BytesIO(text.encode())))
        assert read_scene("-") == scene(CONTENT)
