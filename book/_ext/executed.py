"""Execute the book's pages before Sphinx reads them, as many at a time as there are processors.

MyST-NB executes a page when Sphinx reads the page, one after another. It first looks for the page
in the cache of Jupyter Cache. This extension empties the cache, so that every build executes every
page, and fills it by Jupyter Cache's own executor. A page that fails is not in the cache: MyST-NB
executes the page once more, and reports the error. The lattice's engine is compiled before, as
kernels that start together would each compile it.
"""

from __future__ import annotations

import logging
import os
from pathlib import Path

from jupyter_cache import get_cache
from jupyter_cache.executors import load_executor
from sphinx.application import Sphinx

from validation import Scene, simulate


def execute(app: Sphinx) -> None:
    """Fill the cache with the pages of the table of contents that have code.

    Pages run beside each other: threads of linear algebra within a page would only wait, which
    takes several times the CPU.
    """
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    config = app.env.mystnb_config
    cache = get_cache(config.execution_cache_path)
    cache.clear_cache()
    for page in Path(app.srcdir).glob("*.md"):
        excluded = (
            page.name in app.config.exclude_patterns
        )  # all that no table of contents has
        if not excluded and "{code-cell}" in page.read_text(encoding="utf-8"):
            cache.add_nb_to_project(
                str(page), read_data={"name": "myst_nb_md", "type": "plugin"}
            )
    beads = Scene(masses=(1, 1), stiffnesses=(1,), k=1.5, duration=1, bead_sensors=(0,))
    simulate(beads)  # one engine serves every scene
    executor = load_executor(
        "local-parallel", cache=cache, logger=logging.getLogger("book")
    )
    executor.run_and_cache(timeout=config.execution_timeout)


def setup(app: Sphinx) -> dict[str, bool]:
    """Sphinx's hook."""
    app.connect(
        "builder-inited", execute, priority=900
    )  # after the table of contents is read
    return {"parallel_read_safe": True, "parallel_write_safe": True}
