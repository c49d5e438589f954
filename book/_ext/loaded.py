"""A program that forks kernels which have the pages' packages loaded; `kernels.py` runs it.

Each line of its input asks for a kernel, each line of its output is the number of the process.
Loading costs four seconds of CPU, reading the compiled engine another one.
"""

import json
import os
import signal
import sys
from contextlib import suppress
from importlib import import_module
from pathlib import Path

import matplotlib.pyplot as plt
from ipykernel.kernelapp import IPKernelApp

import lwa
import validation

for name in ("matplotlib.backends.backend_svg", "sympy"):
    import_module(name)
# Packages load the modules of what they export at its first use.
for package in (lwa, validation):
    for name in package.__all__:
        getattr(package, name)

# The engine, which is compiled here if it is not yet: one serves every scene.
beads = validation.Scene(
    masses=(1, 1), stiffnesses=(1,), k=1.5, duration=1, bead_sensors=(0,)
)
validation.simulate(beads)
validation.exact_wave([1], 1.5)

# The look of all pictures
plt.style.use(Path(__file__).parents[1] / "style.mplstyle")


def serve(connection: str, folder: str, environment: dict[str, str]) -> None:
    """Serve as the kernel of a connection file, in a session and a folder of its own."""
    os.setsid()  # signals to the kernel's group reach the page's shell commands
    signal.signal(signal.SIGCHLD, signal.SIG_DFL)
    os.dup2(os.open(os.devnull, os.O_RDONLY), 0)
    os.dup2(2, 1)
    os.chdir(folder)
    os.environ.update(environment)
    # The kernel ends when this program does.
    parent = f"--IPKernelApp.parent_handle={os.getppid()}"
    pictures = "--InlineBackend.figure_formats={'svg'}"
    options = ["-f", connection, "--log-level=ERROR", parent, pictures]
    IPKernelApp.launch_instance(argv=options)


def reap(*_: object) -> None:
    """Wait for the kernels that have ended, so that their numbers are free and their CPU counts."""
    with suppress(ChildProcessError):
        while os.waitpid(-1, os.WNOHANG)[0]:
            pass


signal.signal(signal.SIGCHLD, reap)
for line in sys.stdin:
    number = os.fork()
    if not number:
        serve(**json.loads(line))
        break
    print(number, flush=True)
