"""Long lines of formulas, broken after commas and operators."""

from __future__ import annotations

import re
import textwrap

# Places of a break: after commas and operators, but not within or after **
_IN_CODE = re.compile(r"((?<=[,+-])\s+|(?<=[^*/][*/])(?![*/]))")
# Places of a break: spaces, and within a longer word after an operator
_IN_TEXT = re.compile(r"(\s+|(?<=[^*/][*/])(?![*/\s]))")


def wrapped(line: str, width: int, more: str = "", words: bool = False) -> list[str]:
    """Break a line into lines of at most ``width`` characters; all but the last end in ``more``.

    Further lines are indented by eight columns more. With ``words`` a line also breaks at spaces,
    and within longer numbers.
    """
    start = line[: len(line) - len(line.lstrip())]
    indent = f"{start}        "
    wrapper = textwrap.TextWrapper(width - len(more), "", indent, break_long_words=words)
    wrapper.wordsep_re = _IN_TEXT if words else _IN_CODE
    *lines, last = wrapper.wrap(line) or [""]
    return [*(part + more for part in lines), last]
