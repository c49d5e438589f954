"""The built book in a browser without a network: mathematics, pictures, nothing from outside.

Run by its path, after the book is built: ``python -m pytest tests/book/test_pages.py``. Without a
browser or without the book it fails.
"""

import re
from functools import cache
from pathlib import Path

import nbformat
import pytest
from axe_playwright_python.base import AXE_SCRIPT

import lwa
import validation
from tests.book.probe import DARK, seen

ROOT = Path(__file__).parents[2]
HTML = ROOT / "book" / "_build" / "html"
CHAPTERS = re.findall(r"(?:file|root): (\w+)", (ROOT / "book" / "_toc.yml").read_text())
PAGES = [f"{name}.html" for name in (*CHAPTERS, "genindex", "search")]

PHONE, WINDOW = 390, 1280
"""Widths of a page, in CSS pixels."""
FAULTS = (
    "errors", "unrendered", "merrors", "raw", "broken", "unshown", "axe", "cut",
    "crumbled", "wider", "spoken", "stops",
)  # fmt: skip


@cache
def opened(width, script, part):
    """Reports of a third of the pages: a busy machine needs minutes for all."""
    pages = PAGES[part::3]
    for page in pages:
        assert (HTML / page).is_file(), (
            f"the book is not built: {page} is missing in {HTML}"
        )
    # finds what hinders readers without a mouse or without sight
    source = AXE_SCRIPT if width == WINDOW else ""
    return seen(HTML, pages, width, script, source)


@pytest.mark.parametrize(
    ("width", "script"),
    [(WINDOW, ""), (WINDOW, DARK), (PHONE, "")],
    ids=["light", "dark", "phone"],
)
@pytest.mark.parametrize("part", range(3))
def test_no_page_has_a_fault(width, script, part):
    """The dark pages of a phone have no faults of their own: axe alone asks for colours."""
    faults = {}
    for page, report in opened(width, script, part).items():
        faults |= {(page, fault): report[fault] for fault in FAULTS if report[fault]}
    assert not faults


@pytest.fixture
def reports():
    """All pages in light mode on a desktop."""
    found = {}
    for part in range(3):
        found |= opened(WINDOW, "", part)
    return found


def test_mathematics_and_pictures(reports):
    for page, report in reports.items():
        assert report["mathjax"] or not report["math"], page
    for chapter in CHAPTERS[1:9]:
        assert reports[f"{chapter}.html"]["rendered"] > 4
    # each page has two logos
    assert sum(report["images"] for report in reports.values()) > 2 * len(PAGES)


def test_every_public_name_is_documented_and_no_private_one():
    """No type of a progress function, no text of Python about a type, no mark left unrendered."""
    text = (HTML / "python.html").read_text()
    names = re.findall(r'<dt class="sig[^>]* id="([^"]*)"', text)
    assert not [name for name in names if re.search(r"\._", name)]
    documented = {name.rpartition(".")[2] for name in names}
    documented |= set(re.findall(r'sig-name descname"><span class="pre">(\w+)<', text))
    assert {*lwa.__all__, *validation.__all__} - documented <= {"hertz"}  # a module
    marks = r"Callable\[\[Iterable|PEP 604|Symbol class|\*\*[A-Z][^*]*\*\*|[.;] - \w"
    assert not re.findall(marks, re.sub(r"<[^>]*>", "", text))


@pytest.mark.parametrize("page", PAGES)
def test_a_page_is_small_and_has_a_notebook_of_its_cells(page):
    """With its pictures, the theme and MathJax at most 2.5 MB, 0.15 of them for MathJax's fonts."""
    text, name = (HTML / page).read_text(), f"_sources/{page[:-5]}.ipynb"
    addresses = re.findall(r'(?:src|href)="(_(?:images|static)/[^"?]+)', text)
    files = {(HTML / address).resolve() for address in addresses}
    if "mathjax/startup.js" in text:
        files |= {*(HTML / "mathjax").glob("**/*.js")}
    parts = [file for file in files if "extensions" not in file.parts]
    assert len(text) + sum(file.stat().st_size for file in parts) < 2_350_000
    assert ("turn.js" in text) == ('class="lwa-' in text)
    if cells := text.count('class="cell_input'):
        assert f'href="{name}"' in text
        nbformat.validate(notebook := nbformat.read(HTML / name, 4))
        assert sum(cell.cell_type == "code" for cell in notebook.cells) >= cells


def test_each_thing_to_turn_asks_first(reports):
    """Nothing moves before the answer, but on the first page, where nothing can be turned."""
    for page, report in reports.items():
        source = ROOT / "book" / f"{page[:-5]}.md"
        text = source.read_text() if source.exists() else ""
        things = len(re.findall('^<div class="lwa-', text, re.MULTILINE))
        plain = page == "intro.html"
        assert (report["asked"], report["early"]) == (things - plain, plain), page


BAD = r"""<html lang="en"><head><title>x</title>
<script>
window.MathJax = {startup: {promise: Promise.resolve()}};
fetch("https://example.org/x").catch(() => 0);
</script></head>
<body><main><h1>x</h1><article>
<p style="color: #999">faint words, and \(x\)</p> <span class="math">x</span>
<mjx-merror>x</mjx-merror> <mjx-container tabindex="0">x</mjx-container>
<pre>&lt;Figure size 650x520 with 1 Axes&gt; and a line that is much too long for a phone</pre>
<img alt="x" src="nowhere.png">
<div style="overflow: auto"><table style="width: 80px">
<td><span class="pre" style="overflow-wrap: anywhere">crumbs</span></td>
<td>loooooooooooooooooong</td>
</table></div>
<div class="lwa-chain"><input><output></output></div>
<script>
const output = document.querySelector("output");
document.querySelector("input").addEventListener("input", () => (output.textContent += "x"));
</script>
</article></main></body></html>"""
"""A page at the width of a phone that has each of the faults."""


def test_each_fault_is_found(tmp_path):
    (tmp_path / "bad.html").write_text(BAD)
    (report,) = seen(tmp_path, ["bad.html"], PHONE, axe=AXE_SCRIPT).values()
    assert not [fault for fault in FAULTS if not report[fault]]
    for address in ("example.org", "nowhere.png"):
        assert address in str(report["errors"])
