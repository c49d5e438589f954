"""Each page with cells may be taken along as a notebook, by the theme's own button.

The notebook is the page's source, without what its cells put out.
"""

from __future__ import annotations

from pathlib import Path

import nbformat
from myst_nb.core.read import read_myst_markdown_notebook
from myst_parser.config.main import MdParserConfig
from sphinx.application import Sphinx


def offer(app: Sphinx, page: str, template: str, context: dict, doctree: object) -> None:
    """Write the notebook beside the page's source, where the theme looks for it."""
    source = Path(app.srcdir, f"{page}.md")
    text = source.read_text() if source.exists() else ""
    if app.builder.format != "html" or "{code-cell}" not in text:
        return
    notebook = read_myst_markdown_notebook(text, MdParserConfig())
    for cell in notebook.cells:
        cell.metadata.pop("_source_lines", None)
    target = Path(app.outdir, "_sources", f"{page}.ipynb")
    target.parent.mkdir(parents=True, exist_ok=True)
    nbformat.write(notebook, target)
    context["ipynb_source"] = target.name


def setup(app: Sphinx) -> dict[str, bool]:
    """Sphinx's hook."""
    app.connect("html-page-context", offer, priority=100)  # before the theme's buttons
    return {"parallel_read_safe": True, "parallel_write_safe": True}
