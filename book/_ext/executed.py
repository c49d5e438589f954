"""Execute the book's pages while Sphinx reads, as many at a time as there are processors.

MyST-NB executes a page when Sphinx reads the page, one after another. It first looks for the page
in the cache of Jupyter Cache. This extension empties the cache, so that every build executes every
page, and fills it. Sphinx reads the pages without code first, then each page when it is executed. A
page that fails is not in the cache: MyST-NB executes the page once more, and reports the error.
"""

from __future__ import annotations

import logging
import os
from concurrent.futures import Future, ThreadPoolExecutor
from pathlib import Path

from jupyter_cache import get_cache
from jupyter_cache.executors.basic import ExecutionWorkerLocalSerial, ProcessData
from kernels import prepare
from sphinx.application import Sphinx
from sphinx.environment import BuildEnvironment

# Pages that take longest, in seconds of CPU from 16 to 3, are executed first, so that no processor
# is idle at the end.
LONGEST = (
    "links",
    "recipes",
    "experiment",
    "pressed",
    "open",
    "integration",
    "expansion",
    "shocks",
)


class Pages:
    """The pages with code, in the order of their execution."""

    def __init__(self) -> None:
        self.running: dict[str, Future[object]] = {}

    def execute(self, app: Sphinx) -> None:
        """Begin to fill the cache with the pages of the table of contents that have code."""
        prepare()
        config = app.env.mystnb_config
        cache = get_cache(config.execution_cache_path)
        cache.clear_cache()
        pages = []
        for page in Path(app.srcdir).glob("*.md"):
            # Excluded are all that the table of contents does not have.
            excluded = page.name in app.config.exclude_patterns
            if not excluded and "{code-cell}" in page.read_text(encoding="utf-8"):
                pages.append(page)
        order = dict(zip(LONGEST, range(len(LONGEST)), strict=True))
        pages.sort(key=lambda page: order.get(page.stem, len(order)))
        worker = ExecutionWorkerLocalSerial(logging.getLogger("book"))
        pool = ThreadPoolExecutor(os.cpu_count())
        for page in pages:
            reader = {"name": "myst_nb_md", "type": "plugin"}
            record = cache.add_nb_to_project(str(page), read_data=reader)
            timeout = config.execution_timeout
            job = ProcessData(record.pk, record.uri, cache, timeout, False)
            self.running[page.stem] = pool.submit(worker, job)
        pool.shutdown(wait=False)  # no thread stays when the pages are executed

    def order(self, app: Sphinx, env: BuildEnvironment, names: list[str]) -> None:
        """Let Sphinx read the pages in the order of their execution."""
        places = list(self.running)
        names.sort(key=lambda name: places.index(name) if name in places else -1)

    def wait(self, app: Sphinx, name: str, content: list[str]) -> None:
        """Wait until a page that Sphinx reads is executed."""
        if name in self.running:
            self.running[name].result()


def write_beside(app: Sphinx, env: BuildEnvironment) -> None:
    """Let Sphinx write as many pages at a time as there are processors.

    It is set after Sphinx has read: some of the theme's extensions do not say whether pages may be
    read in parallel, and Sphinx would warn.
    """
    app.parallel = os.cpu_count() or 1


def setup(app: Sphinx) -> dict[str, bool]:
    """Sphinx's hook."""
    pages = Pages()
    # after the table of contents is read
    app.connect("builder-inited", pages.execute, priority=900)
    app.connect("env-before-read-docs", pages.order)
    app.connect("source-read", pages.wait)
    app.connect("env-check-consistency", write_beside)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
