"""The cache of machine code depends on all sources of the kernel, and is optional."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

import validation
from validation.lattice.simulate import simulate
from validation.scenes.scene import Scene

PACKAGES = Path(validation.__file__).parents[1]

RUN = """
import os
from numba.core.event import Listener, register
from validation.lattice.kernel.advance import advance
from validation.lattice.simulate import simulate
from validation.scenes.scene import Scene

class Compilation(Listener):
    def on_start(self, event):
        if event.data["dispatcher"] is advance:
            print("compiled", flush=True)
            os._exit(0)  # it takes ten seconds
    def on_end(self, event):
        pass

register("numba:compile", Compilation())
run = simulate(Scene(masses=(1, 1), stiffnesses=(1,), k=1.5, duration=9, velocities=(1,)))
print((run.velocities.round(6) + 0.0).tolist())
"""

SMALL = """
from validation.lattice.kernel.compiled import cached

@cached
def double(x):
    return 2 * x

print(double(3))
"""


@pytest.fixture
def kernel(engine, tmp_path):
    """The kernel's folder in a copy of the package, with its machine code."""
    simulate(Scene(masses=(1,), stiffnesses=(), k=1.5, duration=1))
    shutil.copytree(PACKAGES / "validation", tmp_path / "validation")
    return tmp_path / "validation" / "lattice" / "kernel"


def ended(kernel, program, **environment):
    """Output and messages of a program in a process of its own."""
    paths = f"{kernel.parents[2]}{os.pathsep}{PACKAGES}"
    done = subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, check=True, timeout=300,
        cwd=kernel, env=os.environ | {"PYTHONPATH": paths} | environment,
    )  # fmt: skip
    return done.stdout.strip(), done.stderr.strip()


@pytest.mark.slow
def test_an_edit_of_any_source_of_the_kernel_compiles_again(kernel):
    assert ended(kernel, RUN) == ("[0.0, 1.0]", "")
    force = kernel / "force.py"
    force.write_text(force.read_text() + "# edited\n")
    assert ended(kernel, RUN) == ("compiled", "")


@pytest.mark.slow
def test_without_a_directory_to_write_to_a_function_runs(kernel):
    """A file is where a folder belongs, which root cannot make either."""
    program = kernel / "program.py"
    program.write_text(SMALL)
    shutil.rmtree(kernel / "__pycache__")
    (kernel / "__pycache__").write_text("")
    places = dict.fromkeys(("HOME", "XDG_CACHE_HOME", "NUMBA_CACHE_DIR"), "/dev/null/home")
    command = f"exec(compile(open('program.py').read(), {str(program)!r}, 'exec'))"
    assert ended(kernel, command, **places) == ("6", "")
