"""Execute the book's pages before Sphinx reads them, as many at a time as there are processors.

MyST-NB executes a page when Sphinx reads the page, one after another. It first looks for the page
in the cache of Jupyter Cache. This extension empties the cache, so that every build executes every
page, and fills it. A page that fails is not in the cache: MyST-NB executes the page once more, and
reports the error.
"""

from __future__ import annotations

import logging
import os
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from jupyter_cache import get_cache
from jupyter_cache.executors.basic import ExecutionWorkerLocalSerial, ProcessData
from kernels import prepare
from sphinx.application import Sphinx

# Pages that take longest are executed first, so that no processor is idle at the end.
LONGEST = ("recipes", "links", "open", "experiment", "expansion", "pressed")


def execute(app: Sphinx) -> None:
    """Fill the cache with the pages of the table of contents that have code."""
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
    pages.sort(key=lambda page: page.stem not in LONGEST)
    jobs = []
    for page in pages:
        reader = {"name": "myst_nb_md", "type": "plugin"}
        record = cache.add_nb_to_project(str(page), read_data=reader)
        timeout = config.execution_timeout
        jobs.append(ProcessData(record.pk, record.uri, cache, timeout, False))
    worker = ExecutionWorkerLocalSerial(logging.getLogger("book"))
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        for _ in pool.map(worker, jobs):
            pass


def setup(app: Sphinx) -> dict[str, bool]:
    """Sphinx's hook."""
    # after the table of contents is read
    app.connect("builder-inited", execute, priority=900)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
