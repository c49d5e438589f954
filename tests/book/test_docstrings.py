"""Docstrings are valid reStructuredText in numpydoc's form, formulas in literals.

Sphinx reads them in the book, editors and `help()` elsewhere.
"""

import ast
import importlib
import inspect
import io
import re
from pathlib import Path

import pytest

pytestmark = pytest.mark.optional("sphinx")

ROOT = Path(__file__).parents[2]
FILES = [
    str(path.relative_to(ROOT))
    for package in ("lwa", "validation")
    for path in sorted((ROOT / package).rglob("*.py"))
]
DOCUMENTED = ast.ClassDef, ast.FunctionDef
ASSIGNED = ast.Assign, ast.AnnAssign

# Characters and signs between blanks that only formulas have. Public docstrings are set as a page.
FORMULA = re.compile(r"[\^∂∫√∑Σ′″]| [=≤≥≈] ")
# The form before numpydoc's, `name : description`. A type has no full stop.
UNTYPED = re.compile(r"^(\w[\w, ]*) : .*(\.|\. .*)$", re.MULTILINE)


def docstrings(path):
    """Names and docstrings of a file: of the module, classes, functions and attributes."""

    def walk(node, name):
        if text := ast.get_docstring(node):
            yield name, text
        before = None
        for child in node.body:
            if isinstance(child, DOCUMENTED):
                yield from walk(child, f"{name}.{child.name}")
            described = isinstance(before, ASSIGNED) and isinstance(child, ast.Expr)
            if described and isinstance(child.value, ast.Constant):
                yield f"{name}:{child.lineno}", inspect.cleandoc(child.value.value)
            before = child

    yield from walk(ast.parse((ROOT / path).read_text(encoding="utf-8")), path)


def parsed(texts):
    """The document of some docstrings, and what docutils reports about it.

    Napoleon converts the sections. One document of many docstrings takes a tenth of the time.
    """
    from docutils.core import publish_doctree
    from docutils.utils import Reporter
    from sphinx.ext.napoleon import Config, NumpyDocstring

    config = Config(napoleon_use_ivar=True, napoleon_use_rtype=False)
    pages = [str(NumpyDocstring(text, config, what="function")) for text in texts]
    page = "\n\n".join([".. default-role:: literal", *pages])
    heard = io.StringIO()
    settings = {"report_level": Reporter.WARNING_LEVEL, "warning_stream": heard}
    document = publish_doctree(page, settings_overrides=settings)
    messages = []
    for message in heard.getvalue().splitlines():
        line = re.match(r"<string>:(\d+):", message)
        messages.append(
            f"{message}: {page.splitlines()[int(line[1]) - 1]}" if line else message
        )
    return document, messages


def prose(document):
    """The texts of a document without its literals."""
    from docutils import nodes

    apart = (
        nodes.literal,
        nodes.literal_block,
        nodes.doctest_block,
        nodes.title_reference,  # a name in single backticks
        nodes.field_name,  # of a parameter, with its type
    )
    for text in document.findall(nodes.Text):
        above = text.parent
        while above is not None and not isinstance(above, apart):
            above = above.parent
        if above is None:
            yield text.astext()


def public(name):
    """Whether no part of a dotted name is private."""
    return not re.search(r"[./]_(?!_)", name)


@pytest.mark.parametrize("path", FILES)
def test_docstrings_are_valid(path):
    shown, hidden = [], []
    for name, text in docstrings(path):
        (shown if public(name) else hidden).append(text)
    _, faults = parsed(hidden)
    document, messages = parsed(shown)
    faults += messages
    for part in prose(document):
        if FORMULA.search(part):
            faults.append(f"a formula outside of a literal: {part!r}")
    for entry in UNTYPED.finditer("\n".join(shown)):
        faults.append(f"a type follows `name :`, the text below: {entry[0]!r}")
    assert not faults, "\n".join(faults)


@pytest.mark.parametrize("package", ["lwa", "validation"])
def test_exported_functions_list_all_their_parameters(package):
    module = importlib.import_module(package)
    for name in module.__all__:
        thing = getattr(module, name)
        if inspect.isfunction(thing):
            section = re.search(r"^ *Parameters\n *-+\n", thing.__doc__, re.MULTILINE)
            assert section or not inspect.signature(thing).parameters, name
