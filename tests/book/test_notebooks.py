"""Notebooks downloaded from the book run alone: in an empty folder, without MyST."""

import importlib
import re
import sys
from pathlib import Path

import pytest

pytestmark = pytest.mark.optional("nbclient", "jupyter_book")

FOLDER = Path(__file__).parents[2] / "book"
CHAPTERS = [file.stem for file in FOLDER.glob("*.md") if "{code-cell}" in file.read_text()]


@pytest.fixture(scope="module")
def notebooks():
    """The book's extension, which needs what the book needs."""
    sys.path.insert(0, str(FOLDER / "_ext"))
    return importlib.import_module("notebooks")


@pytest.fixture
def of(notebooks):
    """The notebook of a page."""
    book = notebooks.Book(FOLDER, sources=notebooks.sources(FOLDER / "references.bib"))
    return lambda page: notebooks.notebook(page, book)


@pytest.mark.parametrize("page", CHAPTERS)
def test_no_cell_needs_the_book_or_myst(of, page):
    cells = of(page).cells
    assert "pip install" in cells[0].source
    written = {c.source.split()[1] for c in cells if c.source.startswith("%%writefile")}
    for cell in cells:
        if cell.cell_type == "code":
            assert not re.search("myst_nb|glue", cell.source)
            assert "style.mplstyle" not in cell.source or "style.mplstyle" in written
        else:
            assert not re.findall(r"\{[\w:]+\}`|^```\{|^:::", cell.source, re.MULTILINE)


@pytest.mark.slow
@pytest.mark.parametrize("page", ["cells"])
def test_a_notebook_runs_in_an_empty_folder(of, page, tmp_path):
    from nbclient import NotebookClient

    client = NotebookClient(
        of(page), timeout=200, kernel_name="python3", resources={"metadata": {"path": tmp_path}}
    )
    client.execute()


def test_roles_are_rendered(notebooks):
    plain = notebooks.plain
    book = notebooks.Book(
        FOLDER, {"wave": "The wave"}, {"eq-1": "1.2"}, {"fig-x": "3.1"}, {"a": "A 2008"}
    )
    text = "{doc}`wave` {eq}`eq-1` {numref}`fig-x` {cite}`a` {py:obj}`~lwa.Cell`"
    assert plain(text, book) == "*The wave* (1.2) Fig. 3.1 [A 2008] `lwa.Cell`"
    assert plain("$$\nx = 1\n$$ (eq-1)", book) == "$$\nx = 1 \\tag{1.2}\n$$"
    assert plain('<span class="tag">known</span> Sound', book) == "*[known]* Sound"
    assert plain('<div class="lwa-chain"></div>\n\nText.', book) == "\nText."
