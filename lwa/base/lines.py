"""Long lines of formulas, broken after commas and operators."""

from __future__ import annotations

import re
import textwrap


class _Wrapper(textwrap.TextWrapper):
    """Line breaker that works after commas and operators, but not within or after **."""

    wordsep_re = re.compile(r"((?<=[,+-])\s+|(?<=[^*/][*/])(?![*/]))")


class _Words(textwrap.TextWrapper):
    """Line breaker that works at spaces, and within a longer word after an operator."""

    wordsep_re = re.compile(r"(\s+|(?<=[^*/][*/])(?![*/\s]))")


def wrapped(line: str, width: int, more: str = "", words: bool = False) -> list[str]:
    """Break a line into lines of at most ``width`` characters; all but the last end in ``more``.

    Further lines are indented by eight columns more. With ``words`` a line also breaks at spaces,
    and within longer numbers.
    """
    start = line[: len(line) - len(line.lstrip())]
    wrapper = (_Words if words else _Wrapper)(
        width - len(more), subsequent_indent=f"{start}        ", break_long_words=words
    )
    *lines, last = wrapper.wrap(line) or [""]
    return [*(part + more for part in lines), last]
