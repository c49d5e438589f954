"""Reports hold the same numbers as text, JSON, CSV, picture and page."""

import dataclasses
import re

import pytest

import validation.report as room
from lwa import InputError
from validation.pictures import Curve, Panel
from validation.report.study import Report
from validation.report.table import Column, Finding, Table

TABLE = Table((Column("n", "sites"),), [{"n": 8}])
PANEL = Panel("x", "y", (Curve("c", [1], [3]),))
PART = Report("a part", (TABLE,), (Finding("drift", 0.5, 0.0, 1.0),), (PANEL,))


def test_a_table_without_keys_is_in_json_and_csv():
    """Its labels are the names; the CSV is the first table that has rows."""
    cubes = Table((Column("", "n"), Column("", "n³")), [{"n": 2, "n³": 8}])
    report = Report("cubes", (Table((Column("k"),), []), cubes))
    assert report.document() == {"tables": [[], [{"n": 2, "n³": 8}]]}
    assert report.csv() == "n,n³\n2,8\n"


def test_a_notebook_shows_tables_and_picture():
    page = dataclasses.replace(PART, title="<part>")._repr_html_()
    assert "&lt;part&gt;" in page
    assert page.count("<svg") == page.count("</svg>") == 1
    assert "1 check: all hold" in page


def test_a_missing_table_is_refused():
    with pytest.raises(InputError, match="format is csv: this result has no table"):
        Report("nothing").csv()


def test_the_recipe_of_a_study_is_a_command_with_numbers_in_json(capsys):
    """The program of the room's docstring; its help ends with its example."""
    _, _, code = room.__doc__.partition("::\n")
    program = "\n".join(re.findall(r"^    (.*)$", code, re.MULTILINE))
    names = {}
    exec(program, names)
    for arguments, shown in (
        (["--k", "2", "--format", "json"], '"rows"'),
        (["-h"], ""),
    ):
        with pytest.raises(SystemExit) as end:
            names["cubes"].main(arguments)
        out = capsys.readouterr().out
        assert end.value.code == 0
        assert shown in out
    assert "Examples:\n    lwa-validate cubes --k 2\n\n  In the book: reference" in out
