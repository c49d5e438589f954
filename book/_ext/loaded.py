"""A program that forks processes which have the pages' packages loaded; `kernels.py` runs it.

Each line of its input asks for a kernel, each line of its output is the number of the process. The
socket of its argument serves the pages' shell commands: `command.py` is the other end. Loading
costs four seconds of CPU, reading the compiled engine another one.
"""

import json
import os
import selectors
import signal
import socket
import sys
from contextlib import suppress
from importlib import import_module
from importlib.metadata import entry_points
from pathlib import Path

import matplotlib.pyplot as plt
from ipykernel.kernelapp import IPKernelApp

import lwa
import validation
from lwa.base import progress

# Commands that come while the packages load wait for them.
server = socket.socket(socket.AF_UNIX)
server.bind(sys.argv[1])
server.listen()

# What the packages load when it is needed, and several pages need
later = (
    "matplotlib.backends.backend_svg",
    "scipy.integrate",
    "scipy.interpolate",
    "scipy.optimize",
    "scipy.signal",
    "sympy",
    "validation.pulses.steady",
    "validation.studies.records",
)
for name in later:
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


def run(connection: socket.socket) -> None:
    """Run the package's command for the process at the other end of a connection."""
    request, descriptors, *_ = socket.recv_fds(connection, 2**20, 3)
    name, arguments, folder, environment = json.loads(request)
    signal.signal(signal.SIGCHLD, signal.SIG_DFL)
    for standard, given in enumerate(descriptors):
        os.dup2(given, standard)
    # Streams without what the old ones have buffered
    sys.stdin = os.fdopen(0)
    sys.stdout = os.fdopen(1, "w")
    sys.stderr = os.fdopen(2, "w")
    os.chdir(folder)
    os.environ.clear()
    os.environ.update(environment)
    # Signs of life depend on how busy the machine is: they are no part of a page.
    progress.QUIET = progress.EVERY = 1e6
    sys.argv = [name, *arguments]
    (program,) = entry_points(group="console_scripts", name=name)
    try:
        status = program.load()()
    except SystemExit as end:
        status = end.code
    sys.stdout.flush()
    connection.sendall(bytes([status or 0]))


def reap(*_: object) -> None:
    """Wait for the processes that have ended, so that their numbers are free, their CPU counts."""
    with suppress(ChildProcessError):
        while os.waitpid(-1, os.WNOHANG)[0]:
            pass


signal.signal(signal.SIGCHLD, reap)
requests = selectors.DefaultSelector()
requests.register(sys.stdin, selectors.EVENT_READ)
requests.register(server, selectors.EVENT_READ)
while True:
    asked = [key.fileobj for key, _ in requests.select()]
    if server in asked:
        connection, _ = server.accept()
        if not os.fork():
            run(connection)
            break
        connection.close()
    if sys.stdin in asked:
        # The sender waits for each answer: one line at most is there.
        line = sys.stdin.readline()
        if not line:
            break
        number = os.fork()
        if not number:
            serve(**json.loads(line))
            break
        print(number, flush=True)
