"""Numbers that stand in the text of the book's pages."""

import re
from collections.abc import Iterable
from fractions import Fraction
from pathlib import Path

BOOK = Path(__file__).parents[2] / "book"
OPTIONS = r"(---\n.*?^---\n|(?::[^\n]*\n)*)"
CELL = re.compile(
    rf"^```\{{code-cell\}} python\n{OPTIONS}(.*?)^```$", re.DOTALL | re.MULTILINE
)
NUMBER = r"(-?\d(?:[\d./]*\d)?)"


def said(page: str, words: str) -> list[str]:
    """Numbers of a page, as written, at the only place with these words; # stands for a number."""
    text = " ".join((BOOK / f"{page}.md").read_text(encoding="utf-8").split())
    places = list(re.finditer(re.escape(words).replace(r"\#", NUMBER), text))
    assert len(places) == 1, f"{page}: {words!r} stands at {len(places)} places"
    return list(places[0].groups())


def told(page: str, words: str, *values: object) -> bool:
    """Whether the numbers round to the written ones; of a fraction, twelve digits have to agree."""
    return all(_agrees(*pair) for pair in zip(values, said(page, words), strict=True))


def _agrees(value: object, written: str) -> bool:
    digits = len(written.partition(".")[2])
    tolerance = 1e-12 if "/" in written else 0.501 * 10.0**-digits
    return abs(float(value) - float(Fraction(written))) <= tolerance


def bounds(values: Iterable[object], written: str) -> bool:
    """Whether the largest size stays within the written bound and exceeds four fifths of it."""
    bound = float(Fraction(written))
    return 0.8 * bound < max(abs(float(value)) for value in values) <= bound


def limited(page: str, words: str, *values: Iterable[object]) -> None:
    """Assert that the bounds of a sentence hold for these values and are not much too large."""
    for several, written in zip(values, said(page, words), strict=True):
        assert bounds(several, written), f"{page}: {words}: {several} for {written}"
