"""Conversion of docstrings, plain text with formulas in Unicode, to reStructuredText.

What they use, and nothing else: paragraphs, "Parameters" with a line of dashes, ``name : text`` in
aligned lines, indented blocks (formulas), doctests, and `names` or ``code`` between backticks. All
else is text, so that a ``*``, ``|`` or trailing ``_`` of a formula stays itself.

Three directives are for the pages about the interface: ``names`` documents public names by
themselves or by package, ``studies`` all studies of `validation`, and ``methods`` the method and
source in each module's docstring, without the module's members.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from importlib import import_module
from inspect import isroutine
from pkgutil import walk_packages
from types import ModuleType

from docutils import nodes
from sphinx.application import Sphinx
from sphinx.ext.autodoc import FunctionDocumenter
from sphinx.util.docutils import SphinxDirective

from validation.cli import STUDIES
from validation.report.command import Study

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


class Names(SphinxDirective):
    """Documentation of names, or of all public names of a package; of classes with members."""

    has_content = True

    def run(self) -> list[nodes.Node]:
        names = [
            name for entry in " ".join(self.content).split() for name in _public(entry)
        ]
        return self.parse_text_to_nodes(
            "\n".join(line for n in names for line in _directive(n))
        )


def _public(name: str) -> Iterator[str]:
    """Return the name itself, or the names that a package exports, without its modules."""
    if "." in name:
        yield name
        return
    package = import_module(name)
    for exported in sorted(package.__all__, key=str.lower):
        if not isinstance(getattr(package, exported), ModuleType):
            yield f"{name}.{exported}"


def _directive(name: str) -> Iterator[str]:
    home, _, last = name.rpartition(".")
    thing = getattr(import_module(home), last)
    if isinstance(thing, Study):
        kind = "study"
    elif isinstance(thing, type):
        kind = "class"
    else:
        kind = "function" if isroutine(thing) else "data"
    yield from (f".. auto{kind}:: {name}", "   :no-index:" * (kind == "data"), "")


class Studies(SphinxDirective):
    """Every study as a function."""

    def run(self) -> list[nodes.Node]:
        found = (
            f"validation.studies.{module}.{name}"
            for name, (module, _) in STUDIES.items()
        )
        text = "\n".join(line for name in found for line in _directive(name))
        return self.parse_text_to_nodes(text)


class Methods(SphinxDirective):
    """Docstrings of all modules of packages, each under the module's name."""

    has_content = True

    def run(self) -> list[nodes.Node]:
        found = (
            name for entry in " ".join(self.content).split() for name in _modules(entry)
        )
        text = "\n".join(
            f"{name}\n{'^' * len(name)}\n\n.. automodule:: {name}\n   :no-members:\n"
            for name in found
        )
        return self.parse_text_to_nodes(text, allow_section_headings=True)


def _modules(package: str) -> Iterator[str]:
    """Modules of a package with more than one sentence to say, in the order of their names."""
    root = import_module(package)
    for info in walk_packages(root.__path__, f"{package}."):
        if not info.name.endswith("__main__"):
            text = import_module(info.name).__doc__ or ""
            if "\n" in text.strip():
                yield info.name


class StudyDocumenter(FunctionDocumenter):
    """Document a study as a function."""

    objtype = "study"
    directivetype = "function"
    priority = FunctionDocumenter.priority + 10

    @classmethod
    def can_document_member(
        cls, member: object, name: str, own: bool, parent: object
    ) -> bool:
        """Whether it is one."""
        return isinstance(member, Study)


def _process(
    app: Sphinx, what: str, name: str, obj: object, options: object, lines: list
) -> None:
    # a value without a text of its own comes with that of its type
    of_type = what == "data" and lines and lines[0] in (type(obj).__doc__ or "")
    of_tuple = lines and lines[0].startswith(
        "Alias for field number"
    )  # a named one's fields
    lines[:] = [] if of_type or of_tuple else converted(lines)


_PROGRESS = re.compile(r"(?<=progress): [^=]*(?= = |\)$)")


def _plain(
    app: Sphinx,
    what: str,
    name: str,
    obj: object,
    options: object,
    signature: str | None,
    back: str,
) -> tuple[str | None, str] | None:
    """Remove the type of the progress function, which callers do not pass, from a signature."""
    return (_PROGRESS.sub("", signature), back) if signature else None


def setup(app: Sphinx) -> dict[str, bool]:
    """Sphinx's hook."""
    for name, directive in (
        ("names", Names),
        ("studies", Studies),
        ("methods", Methods),
    ):
        app.add_directive(name, directive)
    app.add_autodocumenter(StudyDocumenter)
    app.connect("autodoc-process-docstring", _process)
    app.connect("autodoc-process-signature", _plain)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
