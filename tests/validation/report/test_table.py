"""Tables hold the same numbers as text, JSON and CSV; findings hold or fail."""

import csv
import io
import json
import math

import numpy as np
import pytest
import sympy as sp
from hypothesis import example, given, strategies as st

from lwa import Estimate
from validation.report.table import Column, Estimates, Finding, Table, aligned, plain

TABLE = Table(
    (
        Column("k", "k"),
        Column("chain", format=lambda name: f"chain {name}"),
        Estimates("time", "arrival (s)"),
        Column("error_value.F_m", "by F_m", format="+.1%"),
        Column("", "unit"),
    ),
    [
        dict(zip(("k", "chain", "time", "error_value.F_m", "unit"), cells, strict=True))
        for cells in (
            (sp.Rational(3, 2), "a", Estimate(4e-4, 0.5e-5), 0.25, "m/s"),
            (sp.Integer(2), "b", None, -0.5, "<m/s>"),
            (sp.Integer(3), "a", Estimate(2e-7, 0.25e-7), math.nan, "m/s"),
        )
    ],
    "rows",
    errors="a deviation",
    by="chain",
)


def test_the_rows_of_a_document_and_of_a_csv():
    """In SI with all digits."""
    names = "k", "chain", "time_value", "time_error_value", "error_value.F_m"
    cells = (
        ("3/2", "a", 4e-4, 0.5e-5, 0.25),
        ("2", "b", None, None, -0.5),
        ("3", "a", 2e-7, 0.25e-7, None),
    )
    rows = [dict(zip(names, row, strict=True)) for row in cells]
    for row, found in zip(rows, csv.DictReader(io.StringIO(TABLE.csv())), strict=True):
        assert found == {name: "" if x is None else str(x) for name, x in row.items()}
        row["error_value"] = {"F_m": row.pop("error_value.F_m")}
    assert json.loads(json.dumps(TABLE.document(), allow_nan=False)) == rows


def test_text_falls_into_parts_and_has_one_prefix_a_column():
    first, second = TABLE.text().split("\n\n")
    heading, names, *lines = first.splitlines()
    assert heading == "chain a"
    assert names.split() == ["k", "arrival", "(µs)", "by", "F_m", "unit"]
    assert [line.split()[:2] for line in lines] == [["3/2", "400"], ["3", "0.20"]]
    assert "+25.0%" in lines[0]
    assert second.splitlines()[2].split() == ["2", "-", "-50.0%", "<m/s>"]
    assert second.splitlines()[-1].startswith(
        "±: a deviation; at least one in the last"
    )


def test_a_table_without_labels_is_for_programs():
    silent = Table((Column("k"),), [{"k": 1}], "rows", note="alone")
    assert (silent.text(), silent.csv()) == ("", "k\n1\n")


CELLS = st.lists(
    st.lists(st.text("aω±", min_size=1, max_size=9), min_size=4, max_size=4), min_size=1
)


@given(CELLS, st.integers(20, 60))
@example([["aaaaaaaaa"] * 4], 42)  # fills the line
@example([["aaaaaaaaa"] * 4], 41)
def test_columns_beyond_a_line_follow_in_blocks(lines, width):
    """No line is too long, no cell is lost, and each block begins with the first column."""
    text = aligned(lines, width)
    assert max(map(len, text.splitlines())) <= width
    blocks = [
        [line.split() for line in block.splitlines()] for block in text.split("\n\n")
    ]
    fits = (
        sum(max(map(len, column)) + 2 for column in zip(*lines, strict=True)) - 2
        <= width
    )
    assert (len(blocks) == 1) == fits
    for i, line in enumerate(lines):
        assert all(block[i][0] == line[0] for block in blocks)
        assert [cell for block in blocks for cell in block[i][1:]] == line[1:]


def test_numbers_of_numpy_and_sympy_become_plain():
    held = {"a": np.arange(3), "b": (sp.sqrt(2), np.inf), "d": np.bool_(True)}
    assert plain(held) == {"a": [0, 1, 2], "b": ["sqrt(2)", None], "d": True}


@pytest.mark.parametrize(
    ("value", "low", "high", "error", "ok"),
    [
        (1.0, 1.0, 1.0, None, True),
        (0.1, 0.0, 2.0, 0.2, False),
        (math.nan, -math.inf, math.inf, None, False),
    ],
)
def test_a_finding_holds_with_its_error(value, low, high, error, ok):
    assert Finding("x", value, low, high, error).ok is ok
