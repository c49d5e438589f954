"""Put the numbers that `computed.py` computes into the text of the pages."""

from __future__ import annotations

import sys
from importlib import import_module

from sphinx.application import Sphinx


def fill(app: Sphinx, page: str, content: list[str]) -> None:
    """Fill the source of a page before Sphinx parses the page."""
    content[0] = import_module("computed").fill(page, content[0])


def setup(app: Sphinx) -> dict[str, bool]:
    """Sphinx's hook."""
    sys.path.append(str(app.srcdir))  # the pages' own modules
    # after the page is executed: the engine is compiled then
    app.connect("source-read", fill, priority=900)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
