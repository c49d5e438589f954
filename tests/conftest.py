"""Settings for all tests."""

import gc
import os

# The tests' linear systems are small: on a busy machine a second thread only waits for the first.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

from hypothesis import settings

# No wall time is asserted, on noisy machines.
settings.register_profile("lwa", deadline=None, max_examples=40, derandomize=True)
settings.load_profile("lwa")


def pytest_collection_finish(session):
    """SymPy's many small objects are no garbage: to look for it less often saves a tenth."""
    gc.freeze()
    gc.set_threshold(50_000, 20, 100)
