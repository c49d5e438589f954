"""Chains thrown against a wall, beside the plateau and the leading pulse of the theory."""

import json

import pytest

from book.studies.shock import shock
from lwa import InputError
from tests.commands import ended


def test_toda_and_hertz_under_load():
    found = shock(jumps=("3/2",), beads=400)
    assert found.ok
    toda, hertz, cubic = found.document()["rows"]
    assert toda["law"] == "Toda"
    for row in (toda, hertz, cubic):
        assert abs(row["plateau_error_value"]) < 0.005
    assert abs(toda["dispersion_error_value"]) < 0.003
    assert toda["doubling_value"] == pytest.approx(toda["dispersion_value"], rel=1e-12)
    assert abs(hertz["doubling_error_value"]) < 0.006


def test_hertz_without_load_by_the_series():
    """s₊ 0.8487 c₋ and peak strain 1.7360 p₋ on long chains; the rule is within 0.8 %."""
    (row,) = shock(k="3/2", ahead=0, jumps=(1,), beads=600).document()["rows"]
    sound = 1.5**0.5
    assert row["speed_value"] / sound == pytest.approx(0.8487, abs=5e-4)
    assert row["peak_value"] == pytest.approx(1.7360, abs=6e-3)
    assert abs(row["doubling_error_value"]) < 0.004
    assert abs(row["peak_error_value"]) < 0.008
    assert row["dispersion_value"] is None


def test_a_dimer_has_els_edge_and_no_rule():
    (row,) = shock(k="3/2", masses=(1, "1/2"), jumps=(2,), beads=400).document()["rows"]
    assert row["doubling_value"] is None
    assert abs(row["dispersion_error_value"]) < 0.02
    assert abs(row["plateau_error_value"]) < 0.005


def test_the_program(capsys):
    options = "--k", "3/2", "--jumps", "3/2", "--beads", "400", "--format", "json"
    status, out, err = ended(capsys, shock.main, *options)
    assert (status, err) == (0, "")
    assert json.loads(out)["rows"][0]["behind_value"] == 1.5
    status, out, err = ended(capsys, shock.main, "--jumps", "1")
    assert (status, out, err.count("\n")) == (2, "", 1)
    assert "there is no front" in err
    with pytest.raises(InputError, match="contacts of a power law only push"):
        shock(k="3/2", ahead=-1)
