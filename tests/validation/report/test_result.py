"""Reports hold the same numbers as text, JSON, CSV, picture and page."""

import dataclasses
import json

import pytest

from lwa import InputError
from validation.pictures import Curve, Panel
from validation.report.result import Report
from validation.report.table import Column, Finding, Table
from validation.studies.limits import report

PART = Report(
    "a part",
    (Table((Column("n", "sites"),), ((8,),)),),
    (Finding("drift", 0.5, 0.0, 1.0),),
    (Panel("x", "y", (Curve("c", [1, 2], [3, 4]),)),),
)


def test_limits(limits_rows):
    found = json.loads(json.dumps(report(limits_rows).document(), allow_nan=False))
    assert found["ok"] is True
    assert len(found["rows"]) == len(limits_rows)
    for row, written in zip(limits_rows, found["rows"], strict=True):
        assert written["lattice_value"] == row.lattice.value
        assert written["lattice_error_value"] == row.lattice.error
        error = written["theory_value"] / written["lattice_value"] - 1
        assert written["error_value"] == pytest.approx(error, rel=1e-12)
        assert abs(written["error_value"]) <= written["bound_value"]
    shown = report(limits_rows).text()
    assert shown.count("  ok") == len(limits_rows)
    assert shown.endswith("24 checks: all hold")
    assert "FAILS" not in shown


def test_a_failing_row_is_shown(limits_rows):
    first, *others = limits_rows
    broken = report([dataclasses.replace(first, bound=1e-6), *others])
    assert not broken.ok
    assert broken.document()["ok"] is broken.document()["rows"][0]["ok"] is False
    assert broken.text().count("FAILS") == 2  # in the table, and alone below it
    assert broken.text().endswith("24 checks: 1 of 24 fail")


def test_csv_is_the_first_table_with_rows():
    empty = Table((Column("k"),), (), "rows")
    assert Report("", (empty, *PART.tables)).csv() == PART.csv() == "n\n8\n"
    assert Report("", (empty,)).csv() == "k\n"


def test_a_notebook_shows_tables_and_picture():
    page = dataclasses.replace(PART, title="<part>")._repr_html_()
    assert "&lt;part&gt;" in page
    assert page.count("<table>") == 1
    assert page.count("<svg") == page.count("</svg>") == 1
    assert "1 check: all hold" in page
    assert "<svg" not in Report("none")._repr_html_()


def test_a_missing_table_or_picture_is_refused():
    empty = Report("nothing")
    assert (empty.ok, empty.document(), empty.text()) == (True, {}, "nothing")
    with pytest.raises(InputError, match="format is csv: this result has no table"):
        empty.csv()
    with pytest.raises(InputError, match="plot is asked for: this result has no picture"):
        empty.figure()
