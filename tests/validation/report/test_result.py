"""Reports hold the same numbers as text, JSON, CSV, picture and page."""

import dataclasses
import json

import pytest

from lwa import InputError
from validation.pictures import Curve, Panel
from validation.report.result import Report
from validation.report.table import Column, Finding, Table

TABLE, PANEL = (
    Table((Column("n", "sites"),), ((8,),)),
    Panel("x", "y", (Curve("c", [1], [3]),)),
)
PART = Report("a part", (TABLE,), (Finding("drift", 0.5, 0.0, 1.0),), (PANEL,))


@pytest.mark.parametrize("high", [1.0, 0.1])
def test_findings_of_a_document(high):
    """Beside a table, text shows only those that fail."""
    report = dataclasses.replace(
        PART, findings=(*PART.findings, Finding("loss", 0.5, high=high))
    )
    ok = high > 0.5
    document = json.loads(json.dumps(report.document(), allow_nan=False))
    assert document["ok"] is report.ok is ok
    assert [row["ok"] for row in document["findings"]] == [True, ok]
    assert report.text().count("FAILS") == (not ok)
    assert "drift" not in report.text()
    assert report.text().endswith("2 checks: " + ("all hold" if ok else "1 of 2 fail"))


def test_csv_is_the_first_table_with_rows():
    empty = Table((Column("k"),), (), "rows")
    assert Report("", (empty, *PART.tables)).csv() == PART.csv() == "n\n8\n"
    assert Report("", (empty,)).csv() == "k\n"


def test_a_notebook_shows_tables_and_picture():
    page = dataclasses.replace(PART, title="<part>")._repr_html_()
    assert "&lt;part&gt;" in page
    assert page.count("<pre>") == 1
    assert page.count("<svg") == page.count("</svg>") == 1
    assert "1 check: all hold" in page
    assert "<svg" not in Report("none")._repr_html_()


def test_a_missing_table_or_picture_is_refused():
    empty = Report("nothing")
    assert (empty.ok, empty.document(), empty.text()) == (True, {}, "nothing")
    with pytest.raises(InputError, match="format is csv: this result has no table"):
        empty.csv()
    with pytest.raises(
        InputError, match="plot is asked for: this result has no picture"
    ):
        empty.figure()
