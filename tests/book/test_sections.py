"""Sources of the book's pages: tags, chapters, code that fits, one meaning a letter."""

import re
from collections import Counter
from collections.abc import Iterator
from pathlib import Path

import pytest

from lwa import hertz

BOOK = Path(__file__).parents[2] / "book"
PARTS = [
    re.findall(r"file: (\w+)", part)
    for part in (BOOK / "_toc.yml").read_text().split("caption:")[1:]
]
CHAPTERS = [page for part in PARTS[:3] for page in part if page not in ("map", "proofs")]
PAGES = [page.stem for page in BOOK.glob("*.md")]
LATER = {"pressed", "disorder", "upright", "damping", "column", "open", "experiment"}
"""Pages that still have hidden assertions, exercises without a solution and a tag a section."""

TAGS = {"the paper's", "known", "new here"}
NEW = 14
LINES = 3800
COLUMN, FOLDED = 88, 85
"""Results that were looked up and not found, and lines of Markdown, at most; characters of visible
code, and of the code of a solution."""


def cells(page: str) -> Iterator[tuple[str, str]]:
    """Tags and code of each cell of a page."""
    text = (BOOK / f"{page}.md").read_text(encoding="utf-8")
    for _, body in re.findall(
        r"^(```)\{code-cell\} python\n(.*?)^```$", text, re.DOTALL | re.MULTILINE
    ):
        options = re.match(r"(?:---\n.*?^---\n|(?::.*\n)*)", body, re.DOTALL | re.MULTILINE)
        yield options[0], body[options.end() :]


def prose(page: str) -> str:
    """Text of a page without its code."""
    text = (BOOK / f"{page}.md").read_text(encoding="utf-8")
    return re.sub(r"^```\{code-cell\}.*?^```$", "", text, flags=re.DOTALL | re.MULTILINE)


def sections(page: str) -> list[tuple[str, str]]:
    """Headings of a page below its title, and their text up to the next heading."""
    _, *parts = re.split(r"^##+ (.*)\n", prose(page), flags=re.MULTILINE)
    return list(zip(parts[::2], parts[1::2], strict=True))


def test_a_tag_begins_its_section():
    tag = re.compile(r'<span class="tag">([^<]*)</span>')
    tags = Counter()
    for page in set(PAGES) - LATER - {"symbols"}:  # which explains the tags
        for heading, text in sections(page):
            found = tag.findall(text)
            assert not found or len(found) == len(TAGS.intersection(found)) == 1, heading
            assert not found or tag.match(text.lstrip()), f"{heading}: no tag at its head"
            assert found != ["known"] or "{cite}" in text, f"{heading}: known, without a source"
            tags.update(found)
    assert 0 < tags["new here"] <= NEW


@pytest.mark.parametrize("page", CHAPTERS)
def test_a_chapter_has_its_frame(page):
    """Scene, picture, question, answer: in this order."""
    text = (BOOK / f"{page}.md").read_text(encoding="utf-8")
    opening = text[text.index("\n# ") : text.index("\n## ")]
    marks = (r"^\w", r"^    name: fig-|^<div class", r"^\*[^*]+\?\*$", r"^\*\*The answer\.\*\* \w")
    places = [
        m.start() if (m := re.search(mark, opening, re.MULTILINE)) else None for mark in marks
    ]
    assert None not in places, f"of scene, picture, question and answer: {places}"
    assert places == sorted(places), "scene, picture, question, answer: in this order"


def test_a_page_asserts_nothing_and_each_exercise_has_a_folded_solution():
    """Assertions stand in the tests; an exercise is the last section of its page."""
    for page in set(PAGES) - LATER:
        assert not any("assert " in code for _, code in cells(page)), page
        text = (BOOK / f"{page}.md").read_text(encoding="utf-8")
        exercises = text.partition("\n## Exercise\n")[2]
        assert "## Exercises" not in text, page
        assert not exercises or re.search("hide-cell|dropdown} Solution", exercises), page


def test_tests_and_programs_that_pages_name_are_there():
    named = {x for page in PAGES for x in re.findall(r"`((?:tests|book)/[\w/.]+)`", prose(page))}
    assert len(named) > 3
    assert not [name for name in named if not (BOOK.parent / name).exists()]


@pytest.mark.parametrize("page", PAGES)
def test_visible_code_fits_the_column(page):
    for options, code in cells(page):
        if "remove-" not in options:
            widest = FOLDED if "hide-cell" in options else COLUMN
            assert not [line for line in code.splitlines() if len(line) > widest]


def test_statements_are_theorems_rules_or_conjectures():
    for page in PAGES:
        for title in re.findall(r"^:::\{admonition\} (.*)$", prose(page), re.MULTILINE):
            assert title.startswith(("Theorem", "Rule", "Conjecture")), f"{page}: {title}"


def test_paragraphs_are_short():
    """At most 110 words, formulas counted as one; tables and lists apart."""
    for page in BOOK.glob("*.md"):
        text = re.sub(r"^```.*?^```$", "", prose(page.stem), flags=re.DOTALL | re.MULTILINE)
        text = re.sub(r"\$\$.*?\$\$", "", text, flags=re.DOTALL)
        for part in re.split(r"\n\s*\n|\n(?=\d\. )", text):
            words = re.sub(r"\$[^$]*\$", "x", part).split()
            assert len(words) <= 110 or part.startswith(("|", "- ", "---", ":::")), part[:80]


@pytest.mark.parametrize("page", CHAPTERS)
def test_a_chapter_says_what_it_needs(page):
    text = (BOOK / f"{page}.md").read_text(encoding="utf-8")
    assert re.search(r"^\*Needs: .*\. About \d+ minutes\.\*$", text, re.MULTILINE)


def test_the_named_materials_are_listed():
    (listed,) = re.findall(r"`Material.named` knows (.*?) \|", prose("api"))
    assert re.split(r", | and ", listed) == list(hertz.MATERIALS)


def test_every_letter_has_one_meaning():
    """No symbol stands twice in the first column of the table."""
    table = prose("symbols")
    rows = re.findall(r"^\| (\$.*?) \|", table, re.MULTILINE)
    letters = [x.strip(" $") for row in rows for x in re.split("[,;]", row)]
    assert len(letters) > 70
    assert not [letter for letter, n in Counter(letters).items() if n > 1]


def test_every_label_stands_once():
    """Labels of equations and figures are shared by all pages."""
    label = re.compile(r"^\$\$ \(([\w-]+)\)$|^    name: (fig-[\w-]+)$", re.MULTILINE)
    found = [
        max(m.groups(""), key=len) for f in BOOK.glob("*.md") for m in label.finditer(f.read_text())
    ]
    assert len(found) > 70
    assert not [name for name, n in Counter(found).items() if n > 1]


def test_the_book_is_short():
    assert sum(len(page.read_text("utf-8").splitlines()) for page in BOOK.glob("*.md")) <= LINES
