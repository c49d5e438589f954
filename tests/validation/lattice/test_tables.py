"""Chains whose contact law is a table, from a file or from numbers."""

import json

import numpy as np
import pytest

from lwa.law import Law, named
from tests.commands import ended
from validation import Scene, cli, simulate
from validation.lattice import laws
from validation.lattice.cost import IntegrationError
from validation.lattice.laws import Contact
from validation.scenes import scenefile
from validation.scenes.scene import SceneError

PLACES = np.geomspace(1e-3, 4, 60)
FORCES = PLACES**1.5 + PLACES**2.5
METHODS = ("RKN86", "SRKN14", "DOP853")


def chain(law, velocity=1.0):
    return Scene(
        masses=(1,) * 30, stiffnesses=(1,) * 29, law=law, velocities=(velocity,), duration=20,
        contact_sensors=(20,), wall=0.5,
    )  # fmt: skip


@pytest.mark.parametrize(("method", "rtol"), [("RKN86", 1e-9), ("SRKN14", 1e-5)])
def test_a_chain_moves_as_under_the_law_that_made_the_table(method, rtol):
    """F = δ^{3/2} + δ^{5/2}, which the table of 60 points follows to 1e-5; energy on the books."""
    ours = simulate(chain(Law.table(PLACES, FORCES)), method=method, rtol=rtol)
    laws = named("hertz2", 1, 1), Law.table(PLACES, FORCES)
    law, table = (simulate(chain(law), method="DOP853").contact_force for law in laws)
    size = law.max()
    assert np.abs(ours.contact_force - law).max() < 2e-4 * size
    assert np.abs(ours.contact_force - table).max() < 1e3 * rtol
    assert abs(ours.energy_drift) < 1e3 * rtol


@pytest.mark.parametrize("method", METHODS)
def test_a_contact_beyond_the_last_point_ends_the_run(method):
    with pytest.raises(IntegrationError, match=r"^the law.s table ends at compression 4"):
        simulate(chain(Law.table(PLACES, FORCES), velocity=30.0), method=method, rtol=1e-5)


def test_the_compiled_functions_are_those_of_numpy():
    """F, F′ and energy below, at and between the points; NaN beyond the last one, 0 where open."""
    contact = Contact(1.0, Law.table(PLACES, FORCES))
    places = np.concatenate(([-1.0, 0.0, 1e-4], PLACES, np.geomspace(2e-3, 3.9, 50), [4.1]))
    wanted = contact.force(places), contact.stiffness(places), contact.energy(places)
    for compiled, values in zip(laws._machine_code(contact.law), wanted, strict=True):
        found = np.array([compiled.ctypes(d) for d in places])
        assert np.isnan(found[-1])
        np.testing.assert_allclose(found, values, rtol=1e-13)


SCENE = """
duration = 20
chain = {{cell = [1], repeat = 30, law = "table:{}"}}
striker = {{velocity = 1}}
sensors = {{contacts = [20]}}
"""


@pytest.mark.parametrize(
    ("header", "sizes"),
    [
        ("compression,force", (1, 1)),
        ("compression_value,force_value,force_error_value", (1, 1)),
        ("# measured\ncompression (mm),force (kN)", (1e3, 1e-3)),
    ],
)
def test_a_scene_file_names_the_table(capsys, tmp_path, header, sizes):
    """The file that --out writes holds the points, and reads as the same scene."""
    points, file, out = (tmp_path / name for name in ("law.csv", "scene.toml", "out.json"))
    d, F = np.transpose((PLACES, FORCES)).T * np.array(sizes)[:, None]
    rows = (f"{a!r},{b!r},0" for a, b in zip(d.tolist(), F.tolist(), strict=True))
    points.write_text("\n".join((header, *rows)))
    file.write_text(SCENE.format(points.name))  # in the scene's folder
    scene = scenefile.read_scene(file)
    assert scene.law.points == (pytest.approx(PLACES, rel=1e-12), pytest.approx(FORCES, rel=1e-12))
    status, _, err = ended(capsys, cli.main, "run", str(file), "--out", str(out))
    assert (status, err) == (0, "")
    assert scenefile.scene(json.loads(out.read_text())) == scene


@pytest.mark.parametrize(
    ("text", "named_value"),
    [
        ("compression,force\n1,1\n2,2\n3,3\n", "compressions holds 3"),
        ("compression,force\n1,1\n2,2\n3,3\n3,4\n", "compressions has 3 after 3"),
        ("compression,speed\n1,1\n2,2\n3,3\n3,4\n", "one column force"),
        ("compression (ft),force\n1,1\n", "column compression is in 'ft'"),
    ],
)
def test_bad_tables_are_refused_by_name(tmp_path, text, named_value):
    points = tmp_path / "law.csv"
    points.write_text(text)
    with pytest.raises(SceneError, match=named_value) as refused:
        scenefile.scene({"duration": 1, "chain": {"cell": [1], "law": f"table:{points}"}})
    assert str(refused.value).count(str(points)) == 1


def test_an_inline_table_is_checked():
    chain = {"cell": [1, 1], "law": {"compression": [1, 2, 3, 4, 5], "force": [1, 2, 3, 4]}}
    with pytest.raises(SceneError, match="5 compressions and 4 forces"):
        scenefile.scene({"duration": 1, "chain": chain})
