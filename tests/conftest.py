"""Settings of all tests: threads, examples, signals, garbage, folders, and the optional parts."""

import fcntl
import gc
import os
import shutil
import signal
from contextlib import chdir
from importlib.util import find_spec
from pathlib import Path

# The tests' linear systems are small: on a busy machine a second thread only waits for the first.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
os.environ.setdefault("MPLBACKEND", "Agg")
# SymPy forgets all but 1000 results of each of its functions: the tests derive an eighth faster.
os.environ.setdefault("SYMPY_CACHE_SIZE", "20000")

import pytest
from hypothesis import Phase, settings

# The processes that a test starts run this tree, whose engine is compiled already.
TREE = str(Path(__file__).parents[1])
os.environ["PYTHONPATH"] = os.pathsep.join(
    filter(None, (TREE, os.environ.get("PYTHONPATH")))
)

settings.register_profile(
    "lwa",
    deadline=None,  # no wall time is asserted, on noisy machines
    max_examples=8,
    derandomize=True,
    # To shrink an example of a wrong formula takes minutes, and the limit of a test would end it.
    phases=(Phase.explicit, Phase.generate),
)
settings.load_profile("lwa")

COMPLETE = "LWA_TESTS_COMPLETE"
"""Environment variable that makes a missing optional part an error; `.ci/run` sets it where
everything optional is installed."""


def pytest_collection_modifyitems(items):
    """Put the theory first: of two processes one derives while the other compiles the engine.

    What the book's demonstrations show is tested with the slow tests.
    """
    items.sort(key=lambda item: not item.nodeid.startswith(("tests/lwa/", "lwa/")))
    for item in items:
        if item.nodeid.startswith(
            ("tests/validation/", "tests/book/studies/", "tests/book/test_numbers.py")
        ):
            item.fixturenames.insert(0, "engine")
        if (
            item.nodeid.startswith("tests/book/studies/")
            and "refusals" not in item.nodeid
        ):
            item.add_marker("slow")


def pytest_collection_finish(session):
    """Look for garbage less often: SymPy's many small objects are none, and this saves a tenth."""
    gc.freeze()
    gc.set_threshold(50_000, 20, 100)


def pytest_runtest_setup(item):
    """Skip a test whose optional parts are missing, before the test starts anything.

    ``@pytest.mark.optional("distributed", "cc")`` names Python packages and programs.
    """
    for mark in item.iter_markers("optional"):
        for part in mark.args:
            if shutil.which(part) is None and find_spec(part) is None:
                reason = f"{part} is not installed"
                if os.environ.get(COMPLETE):
                    pytest.fail(reason, pytrace=False)
                pytest.skip(reason)


@pytest.fixture(autouse=True)
def _interruptible():
    """Let the processes that a test starts hear Ctrl-C.

    A shell starts the jobs of a script's background with SIGINT ignored, and a child inherits
    that; a signal that has a handler is given back to a child as the system's default.
    """
    before = signal.getsignal(signal.SIGINT)
    if before is not signal.SIG_IGN:
        yield
        return
    signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


@pytest.fixture(scope="session")
def engine(tmp_path_factory):
    """Let the first of several processes of tests compile the lattice's engine, and others wait."""
    if "PYTEST_XDIST_WORKER" in os.environ:
        from validation.lattice.simulate import simulate
        from validation.scenes.chains import struck
        from validation.scenes.forcing import Damping

        scenes = (
            struck((1,), 2, duration=1, bead_sensors=(0,)),
            struck((1,), 2, duration=1, damping=Damping("contact", 0.1)),
        )
        with (tmp_path_factory.getbasetemp().parent / "engine.lock").open("w") as lock:
            fcntl.flock(lock, fcntl.LOCK_EX)  # until the file is closed
            assert [simulate(scene).bead_force.shape[0] for scene in scenes] == [1, 0]


@pytest.fixture
def folder(tmp_path):
    """An empty folder, which is the current one."""
    with chdir(tmp_path):
        yield tmp_path
