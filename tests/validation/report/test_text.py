"""Tables and documents say what the result says."""

import dataclasses
import json

import pytest

from validation.report.text import document, table, text
from validation.studies.limits import Limits
from validation.studies.porter2008.experiment import paper


def test_columns_line_up():
    lines = table(("a", "long header"), (("first row", "1"), ("b", "23"))).splitlines()
    assert lines == ["a          long header", "first row            1", "b                   23"]


def test_limits(limits_result):
    found = json.loads(json.dumps(document(limits_result), allow_nan=False))
    assert found["ok"] is True
    assert len(found["rows"]) == len(limits_result.rows)
    for row, told in zip(limits_result.rows, found["rows"], strict=True):
        assert told["lattice_value"] == row.lattice.value
        assert told["lattice_error_value"] == row.lattice.error
        error = told["theory_value"] / told["lattice_value"] - 1
        assert told["error_value"] == pytest.approx(error, rel=1e-12)
        assert abs(told["error_value"]) <= told["bound_value"]
    shown = text(limits_result)
    assert shown.count("  ok") == len(limits_result.rows)
    assert shown.endswith("47 checks: all hold")
    assert "FAILS" not in shown


def test_a_failing_row_is_shown(limits_result):
    first, *others = limits_result.rows
    broken = Limits((dataclasses.replace(first, bound=1e-6), *others))
    assert not broken.ok
    assert document(broken)["ok"] is document(broken)["rows"][0]["ok"] is False
    assert text(broken).count("FAILS") == 1
    assert text(broken).endswith("47 checks: 1 of 47 fail")


def test_paper():
    result = paper(beads=20, sensors=(8, 15))
    found = json.loads(json.dumps(document(result), allow_nan=False))
    assert (found["beads"], found["sensors"], found["gravity_value"]) == (20, [8, 15], 0)
    for row, compared in zip(found["rows"], result.rows, strict=True):
        assert row["lattice_error_value"] == compared.lattice.error
        for source, value in row["theory_value"].items():
            assert row["error_value"][source] == value / row["lattice_value"] - 1
    shown = text(result)
    assert shown.splitlines()[0].startswith("20 beads, steel (the striker, 1.37 m/s) and PTFE")
    assert shown.count("  set") == 2  # what fixes the amplitude agrees by construction
    assert "F_15" in shown


def test_other_things_have_no_report():
    for function in (text, document):
        with pytest.raises(TypeError):
            function(3)
