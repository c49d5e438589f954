"""Numbers and statements of the paper about the software, `book/paper/paper.md`."""

import re
from pathlib import Path

import pytest
import sympy as sp

from lwa import Cell, canonical_wave
from validation import exact_wave
from validation.studies.paper import figures

BOOK = Path(__file__).parents[2] / "book"
TEXT = (BOOK / "paper" / "paper.md").read_text(encoding="utf-8")
D = sp.Symbol("D", positive=True)


# Articles whose DOI is not known here: of a journal that has none, and two that were not looked up.
WITHOUT = {"gurevich1974", "mackay1999", "kekic2018"}


def test_the_sources_are_listed():
    """All that the paper cites; articles with journal, pages and DOI."""
    pybtex = pytest.importorskip("pybtex.database")
    listed = pybtex.parse_file(str(BOOK / "references.bib")).entries
    assert set(re.findall(r"@(\w+)", TEXT.partition("# Summary")[2])) <= {*listed}
    for name, entry in listed.items():
        if entry.type == "article":
            assert {"journal", "pages"} <= {*entry.fields}, name
            assert ("doi" in entry.fields) == (name not in WITHOUT), name


def test_the_widths():
    widths, wave = (
        re.findall(r"\$(1\.\d+)\\,D\$", TEXT),
        canonical_wave(Cell([1]), "3/2"),
    )
    computed = exact_wave([1], 1.5).fwhm("force"), wave.fwhm("force").subs(D, 1)
    assert widths == [f"{float(width):.4f}" for width in computed]
    assert r"$\sqrt{10}/(5D)$" in TEXT
    assert wave.beta == sp.sqrt(10) / (5 * D)


@pytest.mark.slow
def test_the_errors_of_the_width_are_those_of_the_command():
    """Theirs and ours; the old sentence said that one command reproduces them."""
    number = r"([+−]?[\d.]+)"
    theirs = rf"errors of the width, {number}, {number} and {number} percent there"
    ours = rf"the command finds {number}, {number} and {number}, by"
    (stated,) = re.findall(theirs, TEXT)
    (found,) = re.findall(ours, TEXT)
    rows = figures().document()["widths"]
    for row, there, here in zip(rows, stated, found, strict=True):
        assert there == f"{100 * row['stated_error_value']:.3g}"
        assert here.replace("−", "-") == f"{100 * row['error_value']:+.1f}"


SECTIONS = (
    "Summary", "Statement of need", "State of the field", "Software design",
    "Evidence of correctness", "Tests and contributions", "Research impact statement",
    "References",
)  # fmt: skip


def test_the_form_of_the_journal():
    """The words and the sections that the Journal of Open Source Software asks for."""
    assert 750 <= len(TEXT.partition("# Summary")[2].split()) <= 1750
    assert tuple(re.findall("^# (.*)$", TEXT, re.MULTILINE)) == SECTIONS
    (open_,) = re.findall("<!--(.*?)-->", TEXT, re.DOTALL)
    assert {"authors", "affiliations", "date", "history"} <= set(
        re.findall(r"\w+", open_)
    )
