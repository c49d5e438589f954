"""Execute the book's pages before Sphinx reads them, as many at a time as there are processors.

MyST-NB executes a page when Sphinx reads the page, one after another. It first looks for the page
in the cache of Jupyter Cache. This extension empties the cache, so that every build executes every
page, and fills it. A page that fails is not in the cache: MyST-NB executes the page once more, and
reports the error.

The pages' kernels are forked from one process that has loaded their packages (`loaded.py`): a
kernel of its own would load them again, which takes more CPU than most pages.
"""

from __future__ import annotations

import asyncio
import logging
import os
import sys
from concurrent.futures import ThreadPoolExecutor
from importlib.metadata import EntryPoint
from multiprocessing import get_context
from pathlib import Path
from typing import Any

from jupyter_cache import get_cache
from jupyter_cache.executors.basic import ExecutionWorkerLocalSerial, ProcessData
from jupyter_client.provisioning import KernelProvisionerFactory, LocalProvisioner
from sphinx.application import Sphinx

FORKS = get_context("forkserver")

# Pages that take longest are executed first, so that no processor is idle at the end.
LONGEST = ("recipes", "links", "open", "experiment", "expansion", "pressed")


def run_kernel(connection: str, folder: str, environment: dict[str, str]) -> None:
    """Serve as the kernel of a connection file, in a session and a folder of its own."""
    from ipykernel.kernelapp import IPKernelApp

    os.setsid()  # signals to the kernel's group reach the page's shell commands
    os.chdir(folder)
    os.environ.update(environment)
    # The kernel ends with the process that it is forked from, and that one with Sphinx.
    parent = f"--IPKernelApp.parent_handle={os.getppid()}"
    pictures = "--InlineBackend.figure_formats={'svg'}"
    options = ["-f", connection, "--log-level=ERROR", parent, pictures]
    IPKernelApp.launch_instance(argv=options)


class Forked(LocalProvisioner):
    """A kernel as a process that is forked from the one with the loaded packages."""

    async def launch_kernel(self, cmd: list[str], **options: Any) -> Any:
        connection = self.parent.connection_file
        values = connection, str(options["cwd"]), options["env"]
        self.process = FORKS.Process(target=run_kernel, args=values, daemon=True)
        self.process.start()
        return self.connection_info

    async def send_signal(self, signum: int) -> None:
        if self.process is not None:
            os.killpg(self.process.pid, signum)

    async def poll(self) -> int | None:
        return 0 if self.process is None else self.process.exitcode

    async def wait(self) -> int | None:
        while await self.poll() is None:
            await asyncio.sleep(0.1)
        self.process = None
        return 0


def prepare() -> None:
    """Make forked kernels the default of Jupyter in this process."""
    # Read by Matplotlib when it is loaded, and set by kernels only where it is missing.
    os.environ["MPLBACKEND"] = "module://matplotlib_inline.backend_inline"
    # The pages' matrices are small, and threads that wait for each other burn time.
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    # Pages show commands of the environment in which this program runs.
    programs = str(Path(sys.executable).parent)
    os.environ["PATH"] = programs + os.pathsep + os.environ["PATH"]
    # "__main__": else each fork would load this program's command again.
    FORKS.set_forkserver_preload(["__main__", "loaded"])
    group = KernelProvisionerFactory.GROUP_NAME
    entry = EntryPoint("forked", f"{__name__}:Forked", group)
    KernelProvisionerFactory.provisioners["forked"] = entry
    os.environ["JUPYTER_DEFAULT_PROVISIONER_NAME"] = "forked"


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
