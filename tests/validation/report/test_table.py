"""Tables hold the same numbers as text, JSON, CSV and HTML; findings hold or fail."""

import csv
import io
import json
import math

import numpy as np
import pytest
import sympy as sp
from hypothesis import given
from hypothesis import strategies as st

from lwa import Estimate
from validation.report.table import Column, Finding, Table, aligned, plain

TABLE = Table(
    (
        Column("k", "k"),
        Column("chain", format=lambda name: f"chain {name}"),
        Column("speed", "speed (m/s)", error=True),
        Column("error_value.F_m", "by F_m", format="+.1%"),
        Column("", "unit"),
    ),
    (
        (sp.Rational(3, 2), "a", Estimate(2.0, 0.25), 0.25, "m/s"),
        (sp.Integer(2), "b", None, -0.5, "<m/s>"),
        (sp.Integer(3), "a", Estimate(4.0, 0.5), None, "m/s"),
    ),
    "rows",
    by="chain",
)


def test_the_rows_of_a_document_and_of_a_csv():
    names = "k", "chain", "speed_value", "speed_error_value", "error_value.F_m"
    cells = (
        ("3/2", "a", 2.0, 0.25, 0.25),
        ("2", "b", *[None] * 2, -0.5),
        ("3", "a", 4.0, 0.5, None),
    )
    rows = [dict(zip(names, row, strict=True)) for row in cells]
    found = csv.DictReader(io.StringIO(TABLE.csv()))
    assert [*found] == [
        {name: "" if x is None else str(x) for name, x in r.items()} for r in rows
    ]
    for row in rows:
        row["error_value"] = {"F_m": row.pop("error_value.F_m")}
    assert json.loads(json.dumps(TABLE.document(), allow_nan=False)) == rows


def test_text_falls_into_parts():
    first, second = TABLE.text().split("\n\n")
    assert [line.split() for line in first.splitlines()] == [
        ["chain", "a"],
        ["k", "speed", "(m/s)", "by", "F_m", "unit"],
        ["3/2", "2.0", "±", "2e-01", "+25.0%", "m/s"],
        ["3", "4.0", "±", "5e-01", "-", "m/s"],
    ]
    assert [line.split() for line in second.splitlines()] == [
        ["chain", "b"],
        ["k", "speed", "(m/s)", "by", "F_m", "unit"],
        ["2", "-", "-50.0%", "<m/s>"],
    ]


def test_a_table_without_labels_is_for_programs():
    silent = Table((Column("k"),), ((1,),), "rows", title="k", note="alone")
    assert (silent.text(), silent.csv()) == ("", "k\n1\n")


CELLS = st.lists(
    st.lists(st.text("aω±", min_size=1, max_size=9), min_size=4, max_size=4), min_size=1
)


@given(CELLS, st.integers(20, 60))
def test_columns_beyond_a_line_follow_in_blocks(lines, width):
    """No line is too long, no cell is lost, and each block begins with the first column."""
    shown = [
        [line.split() for line in block.splitlines()]
        for block in aligned(lines, width).split("\n\n")
    ]
    assert max(map(len, aligned(lines, width).splitlines())) <= width
    for i, line in enumerate(lines):
        assert all(block[i][0] == line[0] for block in shown)
        assert [cell for block in shown for cell in block[i][1:]] == line[1:]


@given(st.floats(-1e5, 1e5), st.floats(1e-15, 10))
def test_a_printed_number_covers_what_it_leaves_out(value, error):
    number = Estimate(value, error)
    shown, about = map(float, str(number).split(" ± "))
    assert abs(shown - value) + number.error <= 2 * about
    assert len(f"{shown:.12g}".replace("-", "").replace(".", "").lstrip("0")) <= 6


def test_numbers_of_numpy_and_sympy_become_plain():
    held = {
        "a": np.arange(3),
        "b": np.float64(0.5),
        "c": (sp.sqrt(2), np.inf),
        "d": np.bool_(True),
    }
    assert plain(held) == {"a": [0, 1, 2], "b": 0.5, "c": ["sqrt(2)", None], "d": True}


@pytest.mark.parametrize(
    ("value", "low", "high", "error", "ok"),
    [
        (1.0, 0.0, 2.0, None, True),
        (1.0, 1.0, 1.0, None, True),
        (3.0, 0.0, 2.0, None, False),
        (1.0, 1.1, math.inf, None, False),
        (1.9, 0.0, 2.0, 0.2, False),
        (1.9, 0.0, 2.0, 0.05, True),
        (0.1, 0.0, 2.0, 0.2, False),
        (math.nan, -math.inf, math.inf, None, False),
        (math.inf, 0.0, math.inf, None, True),
    ],
)
def test_a_finding_holds_with_its_error(value, low, high, error, ok):
    assert Finding("x", value, low, high, error).ok is ok
