"""Kernels for the book's pages, and the pages' shell commands, that are forked from one process.

That process has loaded the pages' packages (`loaded.py`). A kernel of its own would load them
again, which takes more CPU than most pages.
"""

from __future__ import annotations

import asyncio
import atexit
import json
import os
import subprocess
import sys
from importlib.metadata import EntryPoint
from pathlib import Path
from shutil import rmtree
from tempfile import mkdtemp
from threading import Lock
from typing import Any

from jupyter_client.provisioning import KernelProvisionerFactory, LocalProvisioner

PROGRAM = Path(__file__).with_name("loaded.py")
COMMAND = Path(__file__).with_name("command.py")


class Loaded:
    """The process that forks, which ends with this one."""

    def __init__(self, address: Path) -> None:
        command = [sys.executable, str(PROGRAM), str(address)]
        pipe = subprocess.PIPE
        self.process = subprocess.Popen(command, stdin=pipe, stdout=pipe, text=True)
        self.lock = Lock()

    def kernel(self, **request: Any) -> int:
        """Start a kernel and return the number of its process."""
        asked, told = self.process.stdin, self.process.stdout
        assert asked
        assert told
        with self.lock:
            print(json.dumps(request), file=asked, flush=True)
            return int(told.readline())


class Forked(LocalProvisioner):
    """A forked process as the kernel that Jupyter starts, watches and ends."""

    loaded: Loaded

    async def launch_kernel(self, cmd: list[str], **options: Any) -> Any:
        self.process = self.loaded.kernel(
            connection=self.parent.connection_file,
            folder=str(options["cwd"]),
            environment=dict(options["env"]),
        )
        return self.connection_info

    async def send_signal(self, signum: int) -> None:
        if self.process is not None:
            os.killpg(self.process, signum)

    async def poll(self) -> int | None:
        try:
            os.kill(self.process, 0)  # a question, no signal
        except ProcessLookupError:
            return 0
        return None

    async def wait(self) -> int:
        while await self.poll() is None:
            await asyncio.sleep(0.1)
        self.process = None
        return 0


def prepare() -> None:
    """Start the process that forks, and make its kernels the default of Jupyter."""
    # Read by Matplotlib when it is loaded, and set by kernels only where it is missing.
    os.environ["MPLBACKEND"] = "module://matplotlib_inline.backend_inline"
    # The pages' matrices are small, and threads that wait for each other burn time.
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    # Pages show commands of the environment in which this program runs.
    programs = Path(mkdtemp())
    atexit.register(rmtree, programs)
    address = programs / "socket"
    for name in ("lwa", "lwa-validate"):
        program = programs / name
        line = f'exec {sys.executable} -IS {COMMAND} {address} {name} "$@"'
        program.write_text(f"#!/bin/sh\n{line}\n", encoding="utf-8")
        program.chmod(0o755)
    places = [str(programs), str(Path(sys.executable).parent), os.environ["PATH"]]
    os.environ["PATH"] = os.pathsep.join(places)
    Forked.loaded = Loaded(address)
    group = KernelProvisionerFactory.GROUP_NAME
    entry = EntryPoint("forked", f"{__name__}:Forked", group)
    KernelProvisionerFactory.provisioners["forked"] = entry
    os.environ["JUPYTER_DEFAULT_PROVISIONER_NAME"] = "forked"
