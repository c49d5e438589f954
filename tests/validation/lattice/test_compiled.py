"""The cache of machine code: it knows all sources of the kernel, and runs do without it."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

import validation

PACKAGES = Path(validation.__file__).parents[1]
RUN = """
from validation.lattice.simulate import simulate
from validation.scenes.scene import Scene
run = simulate(Scene(masses=(1, 1), stiffnesses=(1,), k=1.5, duration=9, velocities=(1,)))
from validation.lattice.kernel.advance import advance
print((run.velocities.round(6) + 0.0).tolist(), sum(advance.stats.cache_hits.values()))
"""


@pytest.fixture
def kernel(tmp_path):
    """The kernel's folder in a copy of the package, with its machine code."""
    exec(RUN, {})
    shutil.copytree(PACKAGES / "validation", tmp_path / "validation")
    return tmp_path / "validation" / "lattice" / "kernel"


def run(kernel, **environment):
    """A run in a process of its own: its output and its messages."""
    paths = f"{kernel.parents[2]}{os.pathsep}{PACKAGES}"
    done = subprocess.run(
        [sys.executable, "-c", RUN], capture_output=True, text=True, check=True, timeout=300,
        cwd=kernel, env=os.environ | {"PYTHONPATH": paths} | environment,
    )  # fmt: skip
    return done.stdout.strip(), done.stderr.strip()


@pytest.mark.slow  # compiles
def test_an_edit_of_any_source_of_the_kernel_compiles_again(kernel):
    assert run(kernel) == ("[0.0, 1.0] 1", "")
    force = kernel / "force.py"
    source = force.read_text()
    edited = source.replace("A[i] * value(d, k)", "0.0 * value(d, k)")
    assert edited != source
    force.write_text(edited)
    assert run(kernel) == ("[1.0, 0.0] 0", "")  # the beads feel nothing


@pytest.mark.slow  # compiles
def test_without_a_directory_to_write_to_the_engine_runs(kernel):
    """A file is where a folder belongs, which root cannot make either."""
    shutil.rmtree(kernel / "__pycache__")
    (kernel / "__pycache__").write_text("")
    places = dict.fromkeys(("HOME", "XDG_CACHE_HOME", "NUMBA_CACHE_DIR"), "/dev/null/home")
    assert run(kernel, **places) == ("[0.0, 1.0] 0", "")
