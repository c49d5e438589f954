"""Sources of the book's pages."""

import re
from pathlib import Path

BOOK = Path(__file__).parents[2] / "book"
OPTIONS = r"(---\n.*?^---\n|(?::[^\n]*\n)*)"
CELL = re.compile(
    rf"^```\{{code-cell\}} python\n{OPTIONS}(.*?)^```$", re.DOTALL | re.MULTILINE
)
