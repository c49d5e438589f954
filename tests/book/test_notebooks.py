"""Notebooks downloaded from the book run alone: in an empty folder, without MyST."""

import importlib
import os
import re
import sys
from pathlib import Path
from shutil import copy

import pytest

from tests.book.prose import CELL

pytestmark = pytest.mark.optional("nbclient", "jupyter_book")

FOLDER = Path(__file__).parents[2] / "book"
CHAPTERS = [
    file.stem for file in FOLDER.glob("*.md") if "{code-cell}" in file.read_text()
]


@pytest.fixture(scope="module")
def notebooks():
    """The book's extension, which needs what the book needs."""
    sys.path.insert(0, str(FOLDER / "_ext"))
    return importlib.import_module("notebooks")


@pytest.fixture(scope="module")
def book(notebooks):
    return notebooks.Book(FOLDER, sources=notebooks.sources(FOLDER / "references.bib"))


@pytest.mark.parametrize("page", CHAPTERS)
def test_no_cell_needs_the_book_or_myst(notebooks, book, page):
    cells = notebooks.notebook(page, book).cells
    assert "pip install" in cells[0].source
    written = {c.source.split()[1] for c in cells if c.source.startswith("%%writefile")}
    for cell in cells:
        if cell.cell_type == "code":
            assert not re.search("myst_nb|glue", cell.source)
            assert "style.mplstyle" not in cell.source or "style.mplstyle" in written
        else:
            assert not re.findall(r"\{[\w:]+\}`|^```\{|^:::", cell.source, re.MULTILINE)


def executed(cells, folder):
    """Run a notebook's cells in a folder."""
    from nbclient import NotebookClient

    there = {"metadata": {"path": folder}}
    client = NotebookClient(cells, timeout=200, kernel_name="python3", resources=there)
    client.execute()


@pytest.mark.slow
@pytest.mark.parametrize("page", ["cells", "experiment"])
def test_a_notebook_runs_in_an_empty_folder(notebooks, book, tmp_path, page):
    copy(FOLDER / "record.csv", tmp_path)  # the page's download
    executed(notebooks.notebook(page, book), tmp_path)


@pytest.mark.slow
@pytest.mark.parametrize("page", CHAPTERS)
def test_what_a_page_shows_runs_when_it_is_copied_in_order(tmp_path, page, monkeypatch):
    """Without the folded code of pictures, and without the book's own modules."""
    import nbformat

    notebook = nbformat.v4.new_notebook()
    for options, code in CELL.findall((FOLDER / f"{page}.md").read_text()):
        if not re.search("hide-input|remove-", options):
            notebook.cells.append(nbformat.v4.new_code_cell(code))
    copy(FOLDER / "record.csv", tmp_path)
    programs = Path(sys.executable).parent
    monkeypatch.setenv("PATH", f"{programs}{os.pathsep}{os.environ['PATH']}")
    executed(notebook, tmp_path)


def test_roles_are_rendered(notebooks):
    book = notebooks.Book(
        FOLDER, {"wave": "Wave"}, {"eq-1": "1.2"}, {"fig-x": "3.1"}, {"a": "A"}
    )
    text = '<span class="tag">known</span> {doc}`wave` {eq}`eq-1` {numref}`fig-x` {cite}`a`'
    assert notebooks.plain(text, book) == "*[known]* *Wave* (1.2) Fig. 3.1 [A]"
    assert notebooks.plain("$$\nx = 1\n$$ (eq-1)", book) == "$$\nx = 1 \\tag{1.2}\n$$"
