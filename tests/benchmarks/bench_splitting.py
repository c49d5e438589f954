"""CPU time of the engine and of a bare loop where all beads of a long chain move.

    python -m pytest -s tests/benchmarks/bench_splitting.py

The bare loop makes the steps of `BLANES_MOAN` (order 4) on equal Hertz beads, and nothing else:
no front, no load, no choice of a law or a step. Prints CPU time against the root mean square error
of the displacements; no time is asserted.
"""

from functools import partial

import numba
import numpy as np
import pytest

from book.studies.accuracy import timed
from validation.lattice.schemes import BLANES_MOAN
from validation.lattice.simulate import COMPILED, simulate
from validation.scenes.chains import struck


@numba.njit(fastmath={"nsz", "arcp", "contract"}, error_model="numpy")
def splitting(start, kicks, drifts, h, steps):
    """Displacements after some steps from velocities ``start``."""
    n = len(start)
    y, v, force = np.zeros(n), start.copy(), np.zeros(n + 1)
    for _ in range(steps):
        for s in range(len(kicks)):
            for i in range(n - 1):
                d = max(y[i] - y[i + 1], 0.0)
                force[i + 1] = d * np.sqrt(d)
            for i in range(n):
                v[i] += h * kicks[s] * (force[i] - force[i + 1])
                y[i] += h * drifts[s] * v[i]
    return y


@pytest.mark.parametrize(("n", "duration"), [(20_000, 10.0), (200_000, 3.0)])
def test_a_maxwellian_start(n, duration):
    start = np.random.default_rng(0).normal(size=n)
    scene = struck((1,), n, velocities=start, duration=duration)
    exact = simulate(scene, rtol=1e-11).displacements
    # No drift follows the last kick.
    table = BLANES_MOAN.kicks, np.append(BLANES_MOAN.drifts, 0)

    def show(name, run):
        run()  # compiles
        found, seconds = timed(run)
        y = getattr(found, "displacements", found)
        error = np.sqrt(np.mean((y - exact) ** 2))
        print(f"{n} beads, {name}: error {error:.1e}, {1e3 * seconds:.1f} ms")
        assert error < 1e-2

    for steps in (20, 50, 100, 200, 400):
        bare = partial(splitting, start, *table, duration / steps, steps)
        show(f"bare loop, {steps} steps", bare)
    for method in COMPILED:
        for rtol in (1e-3, 1e-4, 1e-5, 1e-6):
            show(
                f"{method} {rtol:g}", partial(simulate, scene, rtol=rtol, method=method)
            )
