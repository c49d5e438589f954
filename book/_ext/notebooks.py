"""Download each page with cells as a notebook that runs alone.

The theme's own download button links to the notebook. The notebook is the page's source without
outputs, changed so that neither the book's folder nor MyST is needed: the first cell says what to
install, the next cells write the files that pages share (style, tables, studies), roles become
text, and equations and captions keep their numbers.
"""

from __future__ import annotations

import os
import re
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from functools import cache
from importlib import import_module
from pathlib import Path

import nbformat
from myst_nb.core.read import read_myst_markdown_notebook
from myst_parser.config.main import MdParserConfig
from pybtex.database import parse_file
from sphinx.application import Sphinx

INSTALL = """*This notebook is a page of the book* Long waves in granular chains. *It needs
Python 3.11 or newer and* `lwa`: *in a clone of its repository*, `pip install . jupyter`.
*The next cells write the files that the book's pages share into the folder of the notebook.*"""

_STYLE = "style.mplstyle"

# What the book's own kernels have by `executed.py`: pictures, and the commands on the path.
LOOK = f"""%config InlineBackend.figure_formats = ["svg"]
import os
import sys
from pathlib import Path

import matplotlib.pyplot as plt

plt.style.use("{_STYLE}")
programs = str(Path(sys.executable).parent)
os.environ["PATH"] = programs + os.pathsep + os.environ["PATH"]"""

_IMPORT = re.compile(r"^\s*(?:from|import) +([\w.]+)", re.MULTILINE)
_ROLE = re.compile(r"\{([\w:]+)\}`([^`]*)`")
_LABELLED = re.compile(r"\$\$\n?(.*?)\n?\$\$ \(([\w-]+)\)", re.DOTALL)
_FENCE = re.compile(
    r"^(`{3,}|:{3,})\{([\w:-]+)\} *([^\n]*)\n(.*?)^\1 *$", re.DOTALL | re.MULTILINE
)
_OPTION = re.compile(r"\A(?::[\w-]+:[^\n]*\n)+")
_TARGET = re.compile(r"^\([\w-]+\)=\n", re.MULTILINE)
_TAG = re.compile(r'<span class="tag">([^<]*)</span>')
_HTML = re.compile(r"^<div\b[^\n]*\n", re.MULTILINE)


@dataclass(frozen=True)
class Book:
    """Titles, numbers and sources that a page refers to.

    folder : the book's sources.
    titles : page → title.
    equations, figures : label → number, as in "3.4".
    sources : key → authors and year of a cited work.
    fill : the text of a page with its numbers, from both.
    """

    folder: Path
    titles: Mapping[str, str] = field(default_factory=dict)
    equations: Mapping[str, str] = field(default_factory=dict)
    figures: Mapping[str, str] = field(default_factory=dict)
    sources: Mapping[str, str] = field(default_factory=dict)
    fill: Callable[[str, str], str] = lambda page, text: text


@cache
def sources(bibliography: Path) -> dict[str, str]:
    """Authors and year of each entry, as in "Porter et al. 2008"."""
    found = {}
    for key, entry in parse_file(str(bibliography)).entries.items():
        names = [
            " ".join(person.last_names) for person in entry.persons.get("author", [])
        ]
        listed = " and ".join(names) if len(names) < 3 else f"{names[0]} et al."
        found[key] = f"{listed} {entry.fields['year']}"
    return found


def notebook(page: str, book: Book) -> nbformat.NotebookNode:
    """The notebook of a page of the book."""
    text = Path(book.folder, f"{page}.md").read_text(encoding="utf-8")
    text = book.fill(page, text)
    found = read_myst_markdown_notebook(text, MdParserConfig())
    cells = [nbformat.v4.new_markdown_cell(INSTALL)]
    code = "\n".join(cell.source for cell in found.cells if cell.cell_type == "code")
    for name in shared(code, book.folder):
        shown = (
            f"%%writefile {name}\n{Path(book.folder, name).read_text(encoding='utf-8')}"
        )
        if "/" in name:
            folder = (
                f"import os\n\nos.makedirs({name.rpartition('/')[0]!r}, exist_ok=True)"
            )
            cells.append(nbformat.v4.new_code_cell(folder))
        cells.append(nbformat.v4.new_code_cell(shown))
    cells.append(nbformat.v4.new_code_cell(LOOK))
    for cell in found.cells:
        cell.metadata.pop("_source_lines", None)
        figure = cell.metadata.get("mystnb", {}).get("figure", {})
        if cell.cell_type == "markdown":
            cell.source = plain(cell.source, book)
        cells.append(cell)
        if caption := figure.get("caption"):
            number = book.figures.get(figure.get("name", ""), "")
            named = f"**Figure {number}.** " if number else ""
            cells.append(nbformat.v4.new_markdown_cell(named + plain(caption, book)))
    found.cells = cells
    for number, cell in enumerate(cells):
        cell["id"] = f"{page.replace('_', '-')}-{number}"
    return found


def shared(code: str, folder: Path) -> Iterator[str]:
    """Files of the book's folder that code needs, each after those that it needs itself."""
    seen: dict[str, None] = {_STYLE: None}

    def collect(text: str) -> None:
        for module in _IMPORT.findall(text):
            name = f"{module.replace('.', '/')}.py"
            if name not in seen and (file := folder / name).is_file():
                collect(file.read_text(encoding="utf-8"))
                seen[name] = None

    collect(code)
    return iter(seen)


def plain(text: str, book: Book) -> str:
    """MyST's text as Markdown: roles, directives, labels and targets rendered."""
    text = _HTML.sub("", _TARGET.sub("", _TAG.sub(r"*[\1]*", text)))
    while (rendered := _FENCE.sub(_directive, text)) != text:
        text = rendered
    text = _LABELLED.sub(
        lambda m: f"$$\n{m[1]} \\tag{{{book.equations.get(m[2], m[2])}}}\n$$", text
    )
    return _ROLE.sub(lambda m: _role(m[1], m[2], book), text)


def _directive(match: re.Match[str]) -> str:
    title, body = match[3], _OPTION.sub("", match[4])
    if match[2] in ("eval-rst", "bibliography", "raw"):
        return ""
    return f"**{title}.**\n{body}" if title and match[2] != "grid" else body


def _role(name: str, text: str, book: Book) -> str:
    label = re.sub(r".*<(.*)>", r"\1", text)
    if name == "doc":
        own = text.partition(" <")[0] if label != text else book.titles.get(text, text)
        return f"*{own}*"
    if name == "eq":
        return f"({book.equations.get(text, text)})"
    if name == "numref":
        return f"Fig. {book.figures.get(text, text)}"
    if name.startswith("cite"):
        return f"[{'; '.join(book.sources.get(key, key) for key in text.split(','))}]"
    return f"`{text.lstrip('~')}`"


def _numbers(app: Sphinx, kind: str) -> dict[str, str]:
    """Label → number of all equations or figures of the book."""
    tables = app.env.toc_fignumbers.values()
    found = {
        name: number for table in tables for name, number in table.get(kind, {}).items()
    }
    dotted = {
        name.removeprefix("equation-"): ".".join(map(str, number))
        for name, number in found.items()
    }
    labels = app.env.get_domain("std").anonlabels
    return dotted | {
        label: dotted[id_] for label, (_, id_) in labels.items() if id_ in dotted
    }


def offer(
    app: Sphinx, page: str, template: str, context: dict, doctree: object
) -> None:
    """Write the notebook beside the page's source, where the theme looks for it."""
    source = Path(app.srcdir, f"{page}.md")
    text = source.read_text(encoding="utf-8") if source.exists() else ""
    if app.builder.format != "html" or "{code-cell}" not in text:
        return
    folder = Path(app.srcdir)
    book = Book(
        folder,
        {name: title.astext() for name, title in app.env.titles.items()},
        _numbers(app, "displaymath"),
        _numbers(app, "figure"),
        sources(folder / "references.bib"),
        import_module("computed").fill,
    )
    target = Path(app.outdir, "_sources", f"{page}.ipynb")
    target.parent.mkdir(parents=True, exist_ok=True)
    nbformat.write(notebook(page, book), target)
    context["ipynb_source"] = target.name


def setup(app: Sphinx) -> dict[str, bool]:
    """Sphinx's hook."""
    # for the kernels: their matrices are small, and threads that wait for each other burn time
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    # Matplotlib lists the fonts of a new machine, and says so on stderr, before a cell would
    import_module("matplotlib.font_manager")
    app.connect("html-page-context", offer, priority=100)  # before the theme's buttons
    return {"parallel_read_safe": True, "parallel_write_safe": True}
