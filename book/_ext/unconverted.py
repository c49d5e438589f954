"""Conversion of docstrings that are not yet in numpydoc's form to reStructuredText.

Paragraphs, ``name : text`` in aligned lines, indented blocks (formulas), doctests, and `names` or
``code`` between backticks; all else is text. It goes when all docstrings are rewritten.
"""

from __future__ import annotations

import io
import re
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context

from docutils.core import publish_doctree
from sphinx.application import Sphinx
from sphinx.ext.napoleon import Config, NumpyDocstring

_CODE = re.compile(r"``(.+?)``|`(.+?)`")
_ENTRY = re.compile(r"([^\W\d][^:()]*?) : (\S.*)")
_BOLD = re.compile(r"(?<!\S)\\\*\\\*([A-Z].*?)\\\*\\\*")
_TITLE = re.compile(r"(?<!\S)\\\*([A-Z][^*]*)\\\*")


def converted(lines: list[str]) -> list[str]:
    """Convert the lines of a docstring to reStructuredText, without their indentation."""
    result: list[str] = []
    for block in _blocks(lines):
        result += [*_block(block), ""]
    return result


def _blocks(lines: list[str]) -> Iterator[list[str]]:
    block: list[str] = []
    for line in [*lines, ""]:
        if line.strip():
            block.append(line.rstrip())
        elif block:
            yield block
            block = []


def _block(block: list[str]) -> list[str]:
    first = block[0]
    if len(block) > 1 and re.fullmatch(r"-{3,}", block[1].strip()):
        return (
            [f".. rubric:: {first.strip()}", "", *_block(block[2:])]
            if block[2:]
            else []
        )
    if first.startswith(">>>"):
        return block
    if all(line.startswith(" ") for line in block):
        return ["::", "", *("    " + line for line in block)]
    # entries begin at the margin, and what continues them is indented
    begins = [bool(_ENTRY.match(line)) for line in block]
    margin = [not line.startswith(" ") for line in block]
    if all(begin for begin, at in zip(begins, margin, strict=True) if at):
        return list(_entries(block))
    if first.startswith("- ") and all(line.startswith(("- ", "  ")) for line in block):
        items = "\n".join(block).removeprefix("- ").split("\n- ")
        return [f"- {_text(' '.join(item.split()))}" for item in items]
    # an indented block is literal, with "::" before it or without
    return [_text(re.sub("::$", ":", " ".join(line.strip() for line in block)))]


def _entries(block: list[str]) -> Iterator[str]:
    for line in block:
        if entry := _ENTRY.match(line):  # an indented line is none
            name, text = entry.groups()
            yield f"``{name.strip('`')}``"
            yield f"    {_text(text)}"
        else:
            yield f"    {_text(line.strip())}"


def _text(text: str) -> str:
    """Escape a text for docutils, with its code as literals."""
    parts: list[str] = []
    last = 0
    for match in _CODE.finditer(text):
        parts += [_escaped(text[last : match.start()]), _literal(match[1] or match[2])]
        last = match.end()
    # "\ " ends a literal without leaving a space
    return "\\ ".join([*parts, _escaped(text[last:])])


def _literal(code: str) -> str:
    return f"``{code.strip()}``"


def _escaped(text: str) -> str:
    plain = re.sub(r"([\\*|_`\[\]])", r"\\\1", text)
    plain = _BOLD.sub(r"**\1**", plain)
    return _TITLE.sub(r"*\1*", plain)  # of a book: *Title*


_UNTYPED = re.compile(r"^\w[\w, ]* : .*(\.|\. .*)$", re.MULTILINE)


def is_old(text: str) -> bool:
    """Whether a docstring has entries without a type, or is no valid reStructuredText."""
    if _UNTYPED.search(text):
        return True
    html = str(NumpyDocstring(text, Config(), what="function"))
    heard = io.StringIO()
    settings = {"report_level": 2, "warning_stream": heard}
    publish_doctree(".. default-role:: literal\n\n" + html, settings_overrides=settings)
    return bool(heard.getvalue())


# Sphinx's own roles and directives, which docutils would find in this process, want an environment.
_APART = ProcessPoolExecutor(1, mp_context=get_context("spawn"))


def _process(
    app: Sphinx, what: str, name: str, obj: object, options: object, lines: list
) -> None:
    if _APART.submit(is_old, "\n".join(lines)).result():
        lines[:] = converted(lines)


def setup(app: Sphinx) -> dict[str, bool]:
    """Sphinx's hook."""
    app.connect("autodoc-process-docstring", _process, priority=100)  # before napoleon
    return {"parallel_read_safe": True, "parallel_write_safe": True}
