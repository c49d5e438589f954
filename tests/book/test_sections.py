"""Sources of the book's pages: tags, chapters, code that fits, one meaning a letter."""

import re
from collections import Counter

import pytest

from lwa import hertz
from lwa.law import NAMES
from tests.book.prose import BOOK, CELL

SOURCES = [*BOOK.glob("*.md"), *BOOK.glob("paper/*.md")]
TEXTS = {page.stem: page.read_text(encoding="utf-8") for page in BOOK.glob("*.md")}
PROSE = {page: CELL.sub("", text) for page, text in TEXTS.items()}
PARTS = (BOOK / "_toc.yml").read_text().split("caption:")[1:4]
CHAPTERS = [page for part in PARTS for page in re.findall(r"file: (\w+)", part)]

NEW = 16  # sections with results that were looked up in the literature and not found
LINES = 3400  # of Markdown on all pages
COLUMN = 85  # characters of visible code that a page shows without scrolling


def every(pattern, texts=PROSE):
    """Matches of a pattern on all pages."""
    return [
        x for text in texts.values() for x in re.findall(pattern, text, re.MULTILINE)
    ]


def test_a_tag_begins_its_section():
    tag, tags = re.compile(r'<span class="tag">([^<]*)</span>'), Counter()
    for page in PROSE.keys() - {"symbols"}:  # which explains the tags
        for section in re.split(r"^##+ .*\n", PROSE[page], flags=re.MULTILINE)[1:]:
            found = tag.findall(section)
            assert not found or tag.match(section.lstrip()), (
                f"{page}: no tag at the head: {found}"
            )
            assert found != ["known"] or "{cite}" in section, (
                f"{page}: known, without a source"
            )
            tags.update(found)
    assert set(tags) == {"the paper's", "known", "new here"}
    assert tags["new here"] <= NEW


@pytest.mark.parametrize("page", CHAPTERS)
def test_a_chapter_has_its_frame(page):
    """What it needs, scene, question, a thing to turn, answer: in this order."""
    opening = re.search(r"^# .*?(?=^## )", TEXTS[page], re.DOTALL | re.MULTILINE)[0]
    marks = (
        r"^\*Needs: .* About \d+ minutes\..*\*$",
        r"^\w",
        r"^\*[^*]+\?\*$",
        r"^<div class=\"lwa-",
        r"^\*\*The answer\.\*\* \w",
    )
    places = [
        m and m.start()
        for m in (re.search(mark, opening, re.MULTILINE) for mark in marks)
    ]
    assert None not in places, (
        f"of needs, scene, picture, question and answer: {places}"
    )
    assert places == sorted(places)


@pytest.mark.parametrize("page", TEXTS)
def test_cells_and_exercises(page):
    """Cells assert nothing and fit the column; each exercise has a folded solution."""
    for options, code in CELL.findall(TEXTS[page]):
        assert "assert " not in code
        fits = all(len(line) <= COLUMN for line in code.splitlines())
        assert fits or re.search("(hide|remove)-input", options)
    exercises = re.split(r"^## Exercises?\n", TEXTS[page], flags=re.MULTILINE)[1:]
    assert all(re.search("hide-cell|} Solution", text) for text in exercises)


def test_names_on_the_pages():
    """Files that are there, kinds of statements, the materials, letters and labels that are one."""
    texts = PROSE | {"README": (BOOK.parent / "README.md").read_text()}
    files = every(r"`(?:pytest )?((?:tests|book|lwa|validation)/[\w/.]*)`", texts)
    assert len(files) > 8
    assert not [name for name in files if not (BOOK.parent / name).exists()]
    assert not every(r"^:::\{admonition\} (?!Theorem|Rule|Conjecture)(.*)$")
    (listed,) = every(r"`Material.named` knows (.*?) \|")
    assert re.split(r", | and ", listed) == list(hertz.MATERIALS)
    laws = re.findall(r"^\| `([\w-]+)` \|", PROSE["laws"], re.MULTILINE)
    assert {*laws, "general"} == {*NAMES}
    rows = re.findall(r"^\| (\$.*?) \|", PROSE["symbols"], re.MULTILINE)
    letters = [x.strip(" $") for row in rows for x in re.split("[,;]", row)]
    labels = every(r"^(?:\$\$ \(|    name: (?=fig-))([\w-]+)", TEXTS)
    for names in (letters, labels):
        assert len(names) > 70
        assert not [name for name, n in Counter(names).items() if n > 1]


def test_paragraphs_and_the_book_are_short():
    """At most 110 words, formulas counted as one; tables and lists apart."""
    for text in PROSE.values():
        text = re.sub(
            r"^```.*?^```$|\$\$.*?\$\$", "", text, flags=re.DOTALL | re.MULTILINE
        )
        for part in re.split(r"\n\s*\n|\n(?=\d\. )", text):
            words = re.sub(r"\$[^$]*\$", "x", part).split()
            assert len(words) <= 110 or part.startswith(("|", "- ", "---", ":::")), (
                part[:80]
            )
    texts = (page.read_text(encoding="utf-8") for page in SOURCES)
    assert sum(len(text.splitlines()) for text in texts) <= LINES
