"""The cache of machine code depends on all sources of the kernel, and is optional."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

import validation
from validation.lattice.kernel.advance import advance
from validation.lattice.kernel.compiled import SOURCES
from validation.lattice.kernel.samples import interpolate
from validation.lattice.kernel.symplectic import advance_split

pytestmark = pytest.mark.slow
PACKAGES = Path(validation.__file__).parents[1]
RUN = """
import os
from validation import Scene, simulate
n = int(os.environ["BEADS"])
scene = Scene(masses=(1,) * n, stiffnesses=(1,) * (n - 1), k=1.5, duration=4.5 * n, velocities=(1,))
print(*simulate(scene, rtol=1e-6).velocities)
"""
FORCED = """
from dataclasses import replace
from validation import Damping
print(*simulate(replace(scene, damping=Damping("restitution", 0.8)), rtol=1e-6).velocities)
"""
SMALL = """
from validation.lattice.kernel.compiled import cached

@cached
def double(x):
    return 2 * x

print(double(3))
"""


def output(folder, program, **environment):
    """Output of a program in a folder, in a process of its own."""
    (folder / "program.py").write_text(program)
    paths = f"{folder}{os.pathsep}{PACKAGES}"
    done = subprocess.run(
        [sys.executable, "program.py"], capture_output=True, text=True, check=True, timeout=300,
        cwd=folder, env=os.environ | {"PYTHONPATH": paths} | environment,
    )  # fmt: skip
    return done.stdout


def test_an_edit_of_any_source_of_the_kernel_compiles_again(tmp_path):
    """The hash of the sources is the stamp of each cached function of the engine."""
    for function in (advance, advance_split, interpolate):
        assert function._cache._cache_file._source_stamp == SOURCES
    cached = {"NUMBA_DEBUG_CACHE": "1", "NUMBA_CACHE_DIR": str(tmp_path / "cache")}
    shutil.copytree(PACKAGES / "validation", tmp_path / "validation")
    assert "data saved" in output(tmp_path, SMALL, **cached)
    assert "data saved" not in output(tmp_path, SMALL, **cached)
    force = tmp_path / "validation" / "lattice" / "kernel" / "force.py"
    force.write_text(force.read_text() + "# edited\n")
    assert "data saved" in output(tmp_path, SMALL, **cached)


def test_the_process_that_compiles_gives_the_same_digits_as_later_ones(tmp_path):
    options = dict(NUMBA_CACHE_DIR=str(tmp_path / "cache"), BEADS="40")
    first = output(tmp_path, RUN + FORCED, **options)
    assert output(tmp_path, RUN + FORCED, **options) == first


def test_a_damaged_cache_is_written_again(tmp_path):
    cache = {"NUMBA_CACHE_DIR": str(tmp_path / "cache")}
    output(tmp_path, SMALL, **cache)
    (file,) = (tmp_path / "cache").rglob("*.nbi")
    whole = file.read_bytes()
    file.write_bytes(whole[:-40])
    assert output(tmp_path, SMALL, **cache) == "6\n"
    assert len(file.read_bytes()) == len(whole)


@pytest.mark.parametrize(
    ("head", "places"),
    [
        (
            "",
            dict.fromkeys(
                ("HOME", "XDG_CACHE_HOME", "NUMBA_CACHE_DIR"), "/dev/null/home"
            ),
        ),
        ("import resource\nresource.setrlimit(resource.RLIMIT_FSIZE, (0, 0))\n", {}),
    ],
    ids=("no directory", "full disk"),
)
def test_a_function_runs_where_no_cache_can_be_written(tmp_path, head, places):
    """A file is where a folder belongs, which root cannot make either."""
    if places:
        (tmp_path / "__pycache__").write_text("")
    assert output(tmp_path, head + SMALL, **places) == "6\n"


def test_the_engine_runs_uncompiled(tmp_path):
    """For a debugger, numba's own switch turns the compilation off."""
    velocities = output(tmp_path, RUN, NUMBA_DISABLE_JIT="1", BEADS="2").split()
    assert [*map(float, velocities)] == pytest.approx([0, 1], abs=1e-5)


COUNT = """
import os
import validation.lattice.kernel.advance as loop

correct = loop.correct_contact
corrected = []

def counted(*arguments):
    corrected.append(arguments[-1])
    return correct(*arguments)

loop.correct_contact = counted
"""


def test_a_contact_is_corrected_as_often_as_it_closes_and_opens(tmp_path):
    """A contact of a struck chain closes once and opens once. Weak ones are left out, and steps
    that are tried again correct theirs again: 20 corrections of 15 contacts. With marks at the
    front, where forces are no floats, there were 63, and long chains took twice the time."""
    program = COUNT + RUN + "print(len(corrected))"
    found = output(tmp_path, program, NUMBA_DISABLE_JIT="1", BEADS="16").split()
    assert 0 < int(found[-1]) <= 2 * 15
