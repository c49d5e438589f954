"""Directives for the pages about the interface; Sphinx's autodoc and napoleon do the rest.

``public`` documents what a package exports, ``methods`` the docstrings of its modules, which state
methods and sources. Both fold each entry under its name and first line, so that a page of a hundred
entries can be looked over.
"""

from __future__ import annotations

import inspect
import re
from collections.abc import Iterator
from importlib import import_module
from pkgutil import walk_packages
from types import ModuleType

from docutils import nodes
from sphinx.application import Sphinx
from sphinx.util.docutils import SphinxDirective

from validation.cli import STUDIES


def folded(title: str, summary: str, directive: str, *options: str) -> str:
    """A folded entry with a directive in it, in reStructuredText."""
    text = summary.replace("|", "\\|")  # a formula's bar begins no substitution
    # A name in it is no link: the line itself is what is clicked.
    text = re.sub(r"(?<!`)`([^`]+)`(?!`)", r"``\1``", text)
    lines = [f".. dropdown:: ``{title}`` {text}", "", f"   .. {directive}"]
    lines += [f"      :{option}:" for option in options]
    return "\n".join([*lines, ""])


def first_line(thing: object) -> str:
    """The first line of a docstring."""
    line = (inspect.getdoc(thing) or "").partition("\n")[0]
    return line.removesuffix("::")  # of a line that ends in front of a formula


def exported(package: str) -> Iterator[str]:
    """Entries of all names that a package exports, but for its modules."""
    module = import_module(package)
    for name in sorted(module.__all__, key=str.lower):
        thing = getattr(module, name)
        if not isinstance(thing, ModuleType):
            kind = "class" if isinstance(thing, type) else "function"
            yield folded(name, first_line(thing), f"auto{kind}:: {package}.{name}")


def studies(package: str) -> Iterator[str]:
    """Entries of all studies; a study is documented like its function."""
    for name, (module, _) in STUDIES.items():
        study = getattr(import_module(f"{package}.{module}"), name)
        entry = f"autofunction:: {package}.{module}.{name}"
        yield folded(name, first_line(study), entry)


def modules(package: str) -> Iterator[str]:
    """Entries of all modules of a package with more to say than a line."""
    root = import_module(package)
    for info in walk_packages(root.__path__, f"{package}."):
        if info.name.endswith("__main__"):
            continue
        module = import_module(info.name)
        if "\n" in (inspect.getdoc(module) or ""):
            entry = f"automodule:: {info.name}"
            options = "no-members", "no-inherited-members", "no-index"
            yield folded(info.name, first_line(module), entry, *options)


class Folded(SphinxDirective):
    """The entries of a package, which the directive's argument names."""

    required_arguments = 1

    def run(self) -> list[nodes.Node]:
        entries = {"public": exported, "studies": studies, "methods": modules}[
            self.name
        ]
        return self.parse_text_to_nodes("\n".join(entries(self.arguments[0])))


def guard(
    _app: Sphinx,
    what: str,
    _name: str,
    _thing: object,
    _options: object,
    lines: list[str],
) -> None:
    """Begin a property's docstring by an empty comment, so that napoleon leaves its line whole.

    Napoleon takes the words before a colon in this line for the type of the property.
    """
    if what == "property":
        lines[:0] = ["..", ""]


def join(
    _app: Sphinx,
    _what: str,
    _name: str,
    _thing: object,
    _options: object,
    lines: list[str],
) -> None:
    """Write the names of a field without blanks: Sphinx reads all names but the last as a type."""
    for i, line in enumerate(lines):
        if field := re.match(r":(?:ivar|vartype) [^:]*:", line):
            lines[i] = field[0].replace(", ", ",") + line[field.end() :]


def setup(app: Sphinx) -> dict[str, bool]:
    """Sphinx's hook."""
    # Napoleon has the priority 500.
    app.connect("autodoc-process-docstring", guard, priority=400)
    app.connect("autodoc-process-docstring", join, priority=600)
    for name in ("public", "studies", "methods"):
        app.add_directive(name, Folded)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
